"""Clean faces: nothing is missing from the declared model, and the noise is not white."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

import noise
from shop import NAMES, Case, Setup, Shop, between, carriage, draw_shop, polynomial_way, profile
from shop import three_cuts, whole
from surface import Array, Pass

Rng = np.random.Generator


def of(rng: Rng, draw: Rng, values: Callable[[Shop, Rng, int], Array]) -> Case:
    """A clean case whose readings carry sigma · values(shop, draw, cut)."""
    shop = draw_shop(rng)
    return whole(shop, draw, errors=lambda cut: shop.sigma * values(shop, draw, cut))


def white(rng: Rng, draw: Rng) -> Case:
    """White noise of the instrument."""
    return of(rng, draw, lambda shop, d, cut: noise.white(d, shop.points))


def one_profile(rng: Rng, draw: Rng) -> Case:
    """White noise, and only one cut was measured."""
    return whole(draw_shop(rng), draw, cuts=1)


def correlated(rng: Rng, draw: Rng) -> Case:
    """A texture of several lengths and a little white noise."""
    def values(shop: Shop, d: Rng, cut: int) -> Array:
        return 0.9 * noise.texture(d, shop.points) + 0.4 * noise.white(d, shop.points)
    return of(rng, draw, values)


def heavy_tails(rng: Rng, draw: Rng) -> Case:
    """Student's t with three degrees of freedom: dust and flight of the stylus."""
    return of(rng, draw, lambda shop, d, cut: noise.heavy(d, shop.points))


def quantised(rng: Rng, draw: Rng) -> Case:
    """An instrument that reads in steps of 0.1 µm."""
    case = of(rng, draw, lambda shop, d, cut: noise.white(d, shop.points))
    return replace(case, profiles=[replace(p, z=np.round(p.z, 1)) for p in case.profiles])


def growing(rng: Rng, draw: Rng) -> Case:
    """Noise that grows with the radius, as the cutting speed does."""
    def values(shop: Shop, d: Rng, cut: int) -> Array:
        r = np.abs(shop.stations()) / shop.radius
        return (0.3 + 1.4 * r) * noise.white(d, shop.points)
    return of(rng, draw, values)


def unequal(rng: Rng, draw: Rng) -> Case:
    """Each cut has its own noise, up to twice or half that of the others."""
    factors = rng.permutation([0.5, 1.0, 2.0])
    return of(rng, draw, lambda shop, d, cut: factors[cut] * noise.white(d, shop.points))


def one_tenfold(rng: Rng, draw: Rng) -> Case:
    """One cut is ten times as noisy as its sisters."""
    bad = int(rng.integers(3))
    def values(shop: Shop, d: Rng, cut: int) -> Array:
        return (10.0 if cut == bad else 1.0) * noise.white(d, shop.points)
    return of(rng, draw, values)


def long_memory(rng: Rng, draw: Rng) -> Case:
    """1/f^alpha noise, alpha 0.7 to 1.6, with some white noise."""
    alpha = float(rng.uniform(0.7, 1.6))
    share = float(rng.uniform(0, 0.5))
    def values(shop: Shop, d: Rng, cut: int) -> Array:
        return noise.one_over_f(d, shop.points, alpha) + share * noise.white(d, shop.points)
    return of(rng, draw, values)


def random_walk(rng: Rng, draw: Rng) -> Case:
    """A random walk of one to five sigma and white noise of a third."""
    size = between(rng, 1, 5)
    def values(shop: Shop, d: Rng, cut: int) -> Array:
        return size * noise.random_walk(d, shop.points) + 0.33 * noise.white(d, shop.points)
    return of(rng, draw, values)


def repeats(rng: Rng, draw: Rng) -> Case:
    """Every trace taken twice, nm apart: texture repeats, the noise of the instrument does not."""
    shop = draw_shop(rng)
    share = float(rng.uniform(0.3, 1))
    base = [carriage(shop, polynomial_way(shop))]
    profiles = []
    for name, cut in zip(NAMES, three_cuts(shop)):
        grain = shop.sigma * noise.texture(draw, shop.points)
        for number in "12":
            errors = grain + share * shop.sigma * noise.white(draw, shop.points)
            setup = Setup(keys={"surface": name})
            one = profile(shop, draw, name + number, cut, base, errors, setup=setup)
            off = draw.normal(0, 5e-6) if number == "2" else 0.0
            profiles.append(replace(one, x=one.x + off))
    return Case(shop, profiles)


def chatter(rng: Rng, draw: Rng) -> Case:
    """Narrow-band vibration of the tool, its phase lost within some tens of turns."""
    shop = draw_shop(rng)
    size = shop.sigma * between(rng, 0.5, 2)
    centre, width = float(rng.uniform(0.02, 0.45)), between(rng, 0.005, 0.05)
    def only(cut: int) -> list[Callable[[Pass], Array]]:
        frequency = draw.normal(centre, width, 80)
        phase = draw.uniform(0, 2 * np.pi, 80)
        def motion(tool: Pass) -> Array:
            total = np.zeros_like(tool.turns)
            for f, p in zip(frequency, phase):
                total += np.cos(2 * np.pi * f * tool.turns + p)
            return size * np.sqrt(2 / 80) * total
        return [motion]
    return whole(shop, draw, only=only)


def torn(rng: Rng, draw: Rng) -> Case:
    """Metal that tears: one-sided pits with lips, two to ten sigma, on white noise."""
    size = between(rng, 2, 10)
    def values(shop: Shop, d: Rng, cut: int) -> Array:
        return size * 0.5 * noise.torn(d, shop.points) + noise.white(d, shop.points)
    return of(rng, draw, values)


def ultrasonic(rng: Rng, draw: Rng) -> Case:
    """Ultrasonic vibration of the tool: thousands of cycles a turn, its phase soon lost."""
    shop = draw_shop(rng)
    size = shop.sigma * between(rng, 1, 5)
    cycles, wander = float(rng.uniform(800, 6000)), between(rng, 0.3, 2)
    def only(cut: int) -> list[Callable[[Pass], Array]]:
        number = int(three_cuts(shop)[cut].turns(np.array([0.0, shop.radius])).max()) + 10
        phase = np.cumsum(draw.normal(0, wander, number))
        def motion(tool: Pass) -> Array:
            lost = np.interp(tool.turns, np.arange(number), phase)
            return size * np.cos(2 * np.pi * cycles * tool.turns + lost)
        return [motion]
    return whole(shop, draw, only=only)


def filtered(rng: Rng, draw: Rng) -> Case:
    """The instrument's software already applied a Gaussian low-pass of two to twenty samples."""
    cutoff = between(rng, 2, 20)
    case = of(rng, draw, lambda shop, d, cut: noise.white(d, shop.points))
    passed = [replace(p, z=noise.gaussian_filter(p.z, cutoff)) for p in case.profiles]
    return replace(case, profiles=passed)


def point_samples(rng: Rng, draw: Rng) -> Case:
    """Single points, further apart than the feed: the grooves alias, with a phase of each cut."""
    shop = draw_shop(rng)
    step = (2 if shop.diameter else 1) * shop.radius / shop.points
    feed = min(step * float(rng.uniform(0.3, 0.95)), float(np.sqrt(8 * shop.nose * 1e-3)))
    return whole(replace(shop, averages=False, feed=feed), draw)


def coarse_feed(rng: Rng, draw: Rng) -> Case:
    """An ordinary feed of 0.08 to 0.2 mm a turn: grooves of some µm, each read at several points."""
    shop = draw_shop(rng, diameter=False)
    feed = between(rng, max(0.08, 3 * 40 / shop.points), 0.21)
    feed = min(feed, 0.36 * shop.nose)  # at 2.5 times that, grooves still meet
    return whole(replace(shop, feed=feed, radius=shop.points * feed / 3), draw)


CLASSES = [white, one_profile, correlated, heavy_tails, quantised, growing, unequal, one_tenfold,
           long_memory, random_walk, repeats, chatter, torn, ultrasonic, filtered, point_samples,
           coarse_feed]
