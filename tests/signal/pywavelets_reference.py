"""Multilevel transforms by PyWavelets of the cases in a file, for pywavelets_test.cpp.

A case is one line: wavelet, mode, level, then the signal. Each answer is level + 2 lines: a_L, d_L,
..., d_1, and the signal rebuilt from a_L and the details halved. Ends with 77 if PyWavelets is
missing.
"""
import sys
import warnings

try:
    import pywt
except ImportError:
    sys.exit(77)

warnings.simplefilter("ignore")  # "level too high": short signals are meant here
for line in open(sys.argv[1], encoding="ascii"):
    wavelet, mode, level, *signal = line.split()
    parts = pywt.wavedec([float(x) for x in signal], wavelet, mode, int(level))
    rebuilt = pywt.waverec([parts[0]] + [0.5 * d for d in parts[1:]], wavelet, mode)
    for values in [*parts, rebuilt[: len(signal)]]:
        print(*(repr(float(x)) for x in values))
