import numpy as np
import pytest

import slideway

pywt = pytest.importorskip("pywt")

MODES = (
    "zero constant symmetric periodic smooth periodization reflect antisymmetric antireflect"
).split()
SIGNAL = np.random.default_rng(1).normal(size=1000).cumsum()


def bands_of_pywavelets(signal, wavelet, level, mode):
    """a_1 ... a_L, d_1 ... d_L at full length, each by the inverse transform of it alone."""

    def up(coefficients, part, steps, lengths):
        for step in reversed(range(steps)):
            pair = (coefficients, None) if part == "a" else (None, coefficients)
            coefficients = pywt.idwt(*pair, wavelet, mode)[: lengths[step]]
            part = "a"
        return coefficients

    lengths, approximation, approximations, details = [], signal, [], []
    for step in range(1, level + 1):
        lengths.append(len(approximation))
        approximation, detail = pywt.dwt(approximation, wavelet, mode)
        approximations.append(up(approximation, "a", step, lengths))
        details.append(up(detail, "d", step, lengths))
    return np.array(approximations), np.array(details)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(("wavelet", "level"), [("db1", 5), ("db4", 5), ("db19", 3)])
@pytest.mark.parametrize("n", [1000, 999])
def test_bands_are_those_of_pywavelets(wavelet, level, mode, n):
    ours = slideway.decompose(SIGNAL[:n], wavelet, level, mode)
    approximations, details = bands_of_pywavelets(SIGNAL[:n], wavelet, level, mode)
    scale = np.abs(SIGNAL).max()  # rounding of some hundred products; PyWavelets' taps to 1e-13
    np.testing.assert_allclose(ours.approximations, approximations, rtol=0, atol=1e-11 * scale)
    np.testing.assert_allclose(ours.details, details, rtol=0, atol=1e-11 * scale)


def test_bands_add_up_to_the_signal():
    bands = slideway.decompose(SIGNAL)
    assert bands.approximations.shape == bands.details.shape == (5, 1000)
    np.testing.assert_allclose(
        bands.approximations[-1] + bands.details.sum(axis=0), SIGNAL, rtol=0, atol=1e-11
    )


@pytest.mark.parametrize(
    ("signal", "options", "error", "message"),
    [
        (SIGNAL, {"wavelet": "haar"}, slideway.UsageError, "haar"),
        (SIGNAL, {"boundary": "mirror"}, slideway.UsageError, "mirror"),
        (SIGNAL, {"level": 0}, slideway.UsageError, "level: 0 is out of range; accepted: 1 to 30"),
        (SIGNAL, {"level": 31}, slideway.UsageError, "level: 31"),
        (SIGNAL[:31], {}, slideway.DataError, "31 samples; level 5 needs 32"),
        ([1.0, np.nan] * 16, {}, slideway.DataError, "sample 1 is not finite"),
        ([SIGNAL], {}, slideway.UsageError, "signal: an array of 2 dimensions; accepted: 1"),
    ],
)
def test_what_can_not_be_split_is_refused(signal, options, error, message):
    with pytest.raises(error, match=message):
        slideway.decompose(signal, **options)
