"""Noise of instruments and textures of metal: n values of standard deviation 1 each."""

import numpy as np

from surface import Array

Rng = np.random.Generator


def unit(values: Array) -> Array:
    """Mean 0, standard deviation 1."""
    return (values - values.mean()) / values.std()


def white(rng: Rng, n: int) -> Array:
    return rng.standard_normal(n)


def heavy(rng: Rng, n: int) -> Array:
    """Student's t with three degrees of freedom, variance 3 before scaling."""
    return rng.standard_t(3, n) / np.sqrt(3)


def smoothed(rng: Rng, n: int, length: float) -> Array:
    """White noise under a Gaussian of standard deviation `length` samples."""
    half = int(4 * length) + 1
    kernel = np.exp(-0.5 * (np.arange(-half, half + 1) / length) ** 2)
    kernel /= np.sqrt(np.sum(kernel**2))
    return np.convolve(rng.standard_normal(n + 2 * half), kernel, mode="valid")


def exponential(rng: Rng, n: int, length: float) -> Array:
    """Correlation exp(-lag / length): grain after grain, not differentiable."""
    keep = np.exp(-1 / length)
    values = rng.standard_normal(n) * np.sqrt(1 - keep**2)
    values[0] = rng.standard_normal()
    for i in range(1, n):
        values[i] += keep * values[i - 1]
    return values


def texture(rng: Rng, n: int) -> Array:
    """Several correlation lengths at once, from one sample to a twentieth of the trace."""
    lengths = np.exp(rng.uniform(0, np.log(n / 20), 3))
    parts = [exponential(rng, n, float(length)) for length in lengths]
    weights = rng.dirichlet(np.ones(3))
    return np.sum([np.sqrt(w) * p for w, p in zip(weights, parts)], axis=0)


def one_over_f(rng: Rng, n: int, alpha: float) -> Array:
    """Spectral density f^-alpha, of a record eight times as long (no period in the trace)."""
    long = 8 * n
    frequency = np.fft.rfftfreq(long, 1.0)
    frequency[0] = frequency[1]
    spectrum = rng.standard_normal(len(frequency)) + 1j * rng.standard_normal(len(frequency))
    values = np.fft.irfft(spectrum * frequency ** (-alpha / 2), long)
    start = int(rng.integers(0, long - n))
    return unit(values[start : start + n])


def random_walk(rng: Rng, n: int) -> Array:
    return unit(np.cumsum(rng.standard_normal(n)))


def torn(rng: Rng, n: int) -> Array:
    """Metal that tears: pits with a raised lip, one in about forty samples, one to six long."""
    values = np.zeros(n)
    for start in np.flatnonzero(rng.random(n) < 1 / 40):
        length = int(rng.integers(1, 7))
        depth = rng.exponential()
        values[start : start + length] -= depth
        values[start + length : start + length + 1] += 0.7 * depth
    return values / max(float(values.std()), 1e-9)


def gaussian_filter(values: Array, cutoff: float) -> Array:
    """ISO 16610-21 Gaussian low-pass, cutoff in samples, ends mirrored."""
    alpha = np.sqrt(np.log(2) / np.pi)
    half = int(np.ceil(cutoff))
    kernel = np.exp(-np.pi * (np.arange(-half, half + 1) / (alpha * cutoff)) ** 2)
    kernel /= kernel.sum()
    return np.convolve(np.pad(values, half, mode="symmetric"), kernel, mode="valid")
