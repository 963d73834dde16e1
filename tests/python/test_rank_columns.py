import json

import numpy as np
import pytest

import slideway
from conftest import ROOT

RANDOM = np.random.default_rng(2)
SIGNAL = RANDOM.normal(size=256).cumsum()


def test_is_the_program_s_ranking(program):
    file = ROOT / "data" / "axis-ranking.csv"
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    columns = np.genfromtxt(lines, delimiter=",", names=True)
    names = columns.dtype.names
    options = ("--wavelet", "db4", "--level", "3")
    said = program("rank", file, "--signal", names[1], "--candidates", *names[2:], *options,
                   "--json", "-")  # fmt: skip
    ours = slideway.rank_columns(
        columns[names[1]], {name: columns[name] for name in names[2:]}, "db4", 3
    )
    assert [vars(row) for row in ours] == json.loads(said)["ranking"]


def test_coefficients_are_those_of_numpy():
    other = RANDOM.normal(size=256)
    ranking = slideway.rank_columns(SIGNAL, {"other": other, "itself": -3 * SIGNAL + 1})
    assert [row.candidate for row in ranking] == ["itself", "other"]
    assert ranking[0].raw == ranking[0].low_band == pytest.approx(-1.0, abs=1e-14)
    assert ranking[1].raw == pytest.approx(np.corrcoef(SIGNAL, other)[0, 1], abs=1e-14)


@pytest.mark.parametrize(
    ("candidate", "options", "error", "message"),
    [
        (SIGNAL[1:], {}, slideway.DataError, "candidate 'c': 255 samples; accepted: as many as"),
        (SIGNAL + np.nan, {}, slideway.DataError, "candidate 'c': sample 0 is not finite"),
        ([SIGNAL], {}, slideway.UsageError, "candidate 'c': an array of 2 dimensions"),
        (SIGNAL, {"wavelet": "haar"}, slideway.UsageError, "haar"),
        (SIGNAL, {"level": 9}, slideway.DataError, "level 9"),
    ],
)
def test_what_can_not_be_ranked_is_refused(candidate, options, error, message):
    with pytest.raises(error, match=message):
        slideway.rank_columns(SIGNAL, {"c": candidate}, **options)
