"""The whole job as people script it in Python: job.py FILE loadtxt|pandas. Reads two columns,
transforms with db1 over 5 levels with all bands, correlates with two candidates, fits the low band
with covariance, prints."""
import sys

import numpy as np

path, reader = sys.argv[1:]
if reader == "pandas":
    import pandas

    data = pandas.read_csv(path)
    x, z = data["x_mm"].to_numpy(), data["z_um"].to_numpy()
else:
    x, z = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)


def blocks(signal):
    """db1 approximation of the fifth level"""
    signal = signal[: len(signal) // 32 * 32]
    return signal.reshape(-1, 32).sum(axis=1) / 32**0.5


if reader == "pandas":  # all bands, by the library
    import pywt
    from scipy import stats

    parts = pywt.wavedec(z, "db1", level=5, mode="symmetric")
    for kept in range(6):
        pywt.waverec([p if i == kept else 0 * p for i, p in enumerate(parts)], "db1", "symmetric")
    for shape in (x, x**2):
        print(stats.pearsonr(z, shape)[0])
else:
    for shape in (x, x**2):
        print(np.corrcoef(z, shape)[0, 1])
u = 2 * blocks(x) / 32**0.5 / x[-1] - 1
matrix = np.polynomial.legendre.legvander(u, 5)
low = blocks(z)
coefficients, squares, *_ = np.linalg.lstsq(matrix, low, rcond=None)
print(coefficients, squares / len(low) * np.linalg.inv(matrix.T @ matrix))
