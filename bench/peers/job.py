"""The whole job as people script it in Python: job.py FILE loadtxt|pandas|lmfit. Reads two columns,
transforms with db1 over 5 levels with all bands, correlates with two candidates, fits the low band
with covariance, prints."""
import sys

import numpy as np
import pywt

path, reader = sys.argv[1:]
if reader == "loadtxt":
    x, z = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)
else:
    import pandas
    from scipy import stats

    data = pandas.read_csv(path)
    x, z = data["x_mm"].to_numpy(), data["z_um"].to_numpy()

parts = pywt.wavedec(z, "db1", level=5, mode="symmetric")
for kept in range(6):
    pywt.waverec([p if i == kept else 0 * p for i, p in enumerate(parts)], "db1", "symmetric")
for shape in (x, x**2):
    if reader == "loadtxt":
        print(np.corrcoef(z, shape)[0, 1])
    else:
        print(stats.pearsonr(z, shape)[0])

low = parts[0]
u = 2 * pywt.wavedec(x, "db1", level=5, mode="symmetric")[0] / 32**0.5 / x[-1] - 1
matrix = np.polynomial.legendre.legvander(u, 5)
if reader == "lmfit":
    import lmfit

    start = lmfit.Parameters()
    for k in range(6):
        start.add(f"c{k}", 0.0)
    fit = lmfit.minimize(lambda p: matrix @ list(p.valuesdict().values()) - low, start)
    print(fit.params.valuesdict(), fit.covar)
else:
    coefficients, squares, *_ = np.linalg.lstsq(matrix, low, rcond=None)
    print(coefficients, squares / len(low) * np.linalg.inv(matrix.T @ matrix))
