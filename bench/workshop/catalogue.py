"""The catalogue at foreign geometry: one effect, or two, from the noise to fifty times it."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from shop import Case, Hidden, Setup, Shop, between, draw_shop, sign, three_cuts, whole
from surface import Array, Form, Pass

Rng = np.random.Generator


@dataclass(frozen=True)
class Effect:
    """One effect of a given amplitude: where it acts, and the parameter that says its size."""

    parameter: str
    size: float
    shape: float = 0.0
    motion: Callable[[Pass], Array] | None = None
    form: Form | None = None
    read: Callable[[Array], Array] | None = None
    twins: tuple[str, ...] = field(default=())


Maker = Callable[[Shop, Rng, float], Effect]


def linear_drift(shop: Shop, rng: Rng, size: float) -> Effect:
    """Height grows with machining time."""
    rate = size / three_cuts(shop)[0].seconds() * 60
    return Effect("rate_um_per_min", rate, motion=lambda tool: rate * tool.seconds / 60)


def thermal_drift(shop: Shop, rng: Rng, size: float) -> Effect:
    """Growth that fades, its time a twentieth to half of the first cut."""
    fade = three_cuts(shop)[0].seconds() * between(rng, 0.05, 0.5)
    return Effect("amplitude_um", size, fade, lambda tool: size * (1 - np.exp(-tool.seconds / fade)))


def tool_wear(shop: Shop, rng: Rng, size: float) -> Effect:
    """The edge recedes with the distance it has cut, and so the face rises."""
    metres = np.pi * shop.radius**2 / shop.feed / 1000
    rate = abs(size) / metres
    return Effect("rate_um_per_m", rate, motion=lambda tool: rate * tool.metres)


def tool_running_in(shop: Shop, rng: Rng, size: float) -> Effect:
    """The first wear of a fresh edge, over a twentieth to a third of the way it cuts."""
    fade = np.pi * shop.radius**2 / shop.feed / 1000 * between(rng, 0.05, 0.33)
    return Effect("amplitude_um", abs(size), fade,
                  lambda tool: abs(size) * (1 - np.exp(-tool.metres / fade)))


def step(shop: Shop, rng: Rng, size: float) -> Effect:
    """A jump at one radius, in every cut."""
    place = shop.radius * float(rng.uniform(0.15, 0.85))
    return Effect("height_um", size, place, lambda tool: np.where(tool.r < place, size, 0.0))


def wavelength(shop: Shop, rng: Rng) -> float:
    """On the face: from four values of the low band to a fifth of the radius."""
    value = (2 if shop.diameter else 1) * shop.radius / shop.points * 2**shop.level
    return between(rng, min(4 * value, shop.radius / 6), shop.radius / 5)


def slide_periodic(shop: Shop, rng: Rng, size: float) -> Effect:
    """A wave of the guideway that does not tilt the carriage."""
    period, phase = wavelength(shop, rng), rng.uniform(0, 2 * np.pi)
    return Effect("amplitude_um", abs(size), period,
                  lambda tool: abs(size) * np.cos(2 * np.pi * tool.r / period + phase))


def time_periodic(shop: Shop, rng: Rng, size: float) -> Effect:
    """Air conditioning, or a compressor."""
    period = wavelength(shop, rng) / shop.feed * 60 / shop.rpm
    phase = rng.uniform(0, 2 * np.pi)
    return Effect("amplitude_um", abs(size), period,
                  lambda tool: abs(size) * np.cos(2 * np.pi * tool.seconds / period + phase),
                  twins=("revolution_periodic",))


def revolution_periodic(shop: Shop, rng: Rng, size: float) -> Effect:
    """A spindle line near 0 to 3 cycles a turn: read once a turn, along a radius, it is slow."""
    cycles, harmonic = shop.feed / wavelength(shop, rng), int(rng.integers(0, 4))
    phase = rng.uniform(0, 2 * np.pi)
    return Effect("amplitude_um", abs(size), cycles, lambda tool: abs(size) * np.cos(
        2 * np.pi * (harmonic + cycles) * tool.turns + phase), twins=("time_periodic",))


def centre_height(shop: Shop, rng: Rng, size: float) -> Effect:
    """The edge passes the axis at a distance: A (sqrt(r^2 + h^2) - r) / h."""
    high = between(rng, 0.5, 10)
    return Effect("amplitude_um", size, high,
                  lambda tool: size * (np.hypot(tool.r, high) - tool.r) / high)


def speed_effect(shop: Shop, rng: Rng, size: float) -> Effect:
    """The cutting force grows as the speed falls: A ((max(r, 0.02 mm)/R)^-m - 1)."""
    power = float(rng.uniform(0.1, 0.5))
    lift = abs(size) / (0.02**-power - 1)  # from the rim to a fiftieth of the radius it is `size`
    return Effect("amplitude_um", lift, power, lambda tool: lift * (
        (np.maximum(tool.r, 0.02) / shop.radius) ** -power - 1))


def edge_roll_off(shop: Shop, rng: Rng, size: float) -> Effect:
    """The metal yields at the rim, over one to six hundredths of the radius."""
    wide = shop.radius * between(rng, 0.01, 0.06)
    return Effect("amplitude_um", size, wide,
                  form=lambda r, theta: size * np.exp((r - shop.radius) / wide))


def cup(shop: Shop, rng: Rng, size: float) -> Effect:
    """The disc springs back from the chuck."""
    return Effect("sag_um", size, form=lambda r, theta: size * (r / shop.radius) ** 2)


def traverse_datum(shop: Shop, rng: Rng, size: float) -> Effect:
    """The instrument's own guide: an odd cubic of the trace."""
    return Effect("amplitude_um", size, read=lambda x: size * (x / np.abs(x).max()) ** 3)


def centre_step(shop: Shop, rng: Rng, size: float) -> Effect:
    """Axial motion once a turn: one half of the diameter lies higher."""
    return Effect("height_um", size, form=lambda r, theta: size * np.cos(theta))


def traverse_periodic(shop: Shop, rng: Rng, size: float) -> Effect:
    """The floor shakes while the trace is taken."""
    frequency, phase = shop.traverse / wavelength(shop, rng), rng.uniform(0, 2 * np.pi)
    return Effect("amplitude_um", abs(size), frequency, read=lambda x: abs(size) * np.cos(
        2 * np.pi * frequency * (x - x[0]) / shop.traverse + phase))


MAKERS: list[Maker] = [linear_drift, thermal_drift, tool_wear, tool_running_in, step, slide_periodic,
                       time_periodic, revolution_periodic, centre_height, speed_effect, edge_roll_off,
                       cup, traverse_datum, centre_step, traverse_periodic]
ON_DIAMETERS = {traverse_datum, centre_step, centre_height}


def hidden_in(rng: Rng, draw: Rng, makers: list[Maker], least: float, cuts: int = 3) -> Case:
    """Three cuts with these effects, each least to fifty times the noise."""
    shop = draw_shop(rng, diameter=True if ON_DIAMETERS & set(makers) else None)
    effects, hidden = [], []
    for maker in makers:
        times = between(rng, least, 50)
        made = maker(shop, rng, sign(rng) * times * shop.sigma)
        effects.append(made)
        hidden.append(Hidden((maker.__name__, *made.twins), made.parameter, made.size, made.shape,
                             of_noise=times))
    setup = Setup(reads=tuple(e.read for e in effects if e.read))
    return whole(shop, draw, hidden, [e.motion for e in effects if e.motion],
                 forms=[e.form for e in effects if e.form], setup=lambda cut: setup, cuts=cuts)


def two_effects(rng: Rng, draw: Rng) -> Case:
    """Two different effects of the catalogue, each five to fifty times the noise."""
    first, second = rng.permutation(len(MAKERS))[:2]
    return hidden_in(rng, draw, [MAKERS[first], MAKERS[second]], 5)


def effect_of_one_profile(rng: Rng, draw: Rng) -> Case:
    """One effect of the catalogue, and only one cut was measured."""
    return hidden_in(rng, draw, [MAKERS[int(rng.integers(len(MAKERS)))]], 1, cuts=1)


def effect_class(maker: Maker) -> Callable[[Rng, Rng], Case]:
    def make(rng: Rng, draw: Rng) -> Case:
        return hidden_in(rng, draw, [maker], 1)
    make.__name__, make.__doc__ = maker.__name__, maker.__doc__
    return make


SINGLE = [effect_class(maker) for maker in MAKERS]
