"""What no polynomial makes: ways, chucking, one cut of three, the set-up, growth by heat, blunders."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

import noise
from shop import NAMES, Case, Hidden, Profile, Setup, Shop, Way, between, carriage, draw_shop
from shop import Value, drawn_way, polynomial_way, profile, sign, three_cuts, whole
from surface import Array, Pass

Rng = np.random.Generator
Motions = list[Callable[[Pass], Array]]
LOCAL = ("local_form", "straightness")


def bent(rng: Rng, draw: Rng, form: Callable[[Array], Array], names: tuple[str, ...] = LOCAL,
         pad: float = 0.03, most: int = 5) -> Case:
    """A case whose way has a form beside its polynomial, 0 with slope 0 at the spindle axis.

    The form is scaled: with its pitch on its lever it moves the tool by 5 to 60 sigma.
    """
    shop = draw_shop(rng)
    shop = replace(shop, degree=min(shop.degree, most), bow=shop.bow[: most - 1])
    way = drawn_way(shop, lambda x: form(x / shop.radius), pad)
    x, times = np.linspace(0, shop.radius, 2000), between(rng, 5, 60)
    moved = carriage(replace(shop, squareness=0.0), way)(Pass(x, x, x, x, x))
    scale = times * shop.sigma / float(np.ptp(moved))
    scaled = Way(lambda at: scale * way.height(at), lambda at: scale * way.slope(at))
    return whole(shop, draw, [Hidden(names, of_noise=times)], way=scaled)


def kink(rng: Rng, draw: Rng) -> Case:
    """A way ground in two settings: its slope changes at one place."""
    place, side = rng.uniform(0.2, 0.85), sign(rng)
    return bent(rng, draw, lambda u: side * np.maximum(u - place, 0))


def joint(rng: Rng, draw: Rng) -> Case:
    """Two lengths of bed: a step and a change of slope."""
    place, slope, side = rng.uniform(0.2, 0.85), rng.normal(0, 3), sign(rng)
    return bent(rng, draw, lambda u: side * (u > place) * (1 + slope * (u - place)))


def dip(rng: Rng, draw: Rng) -> Case:
    """A dip, a tenth of the radius wide."""
    place, width = rng.uniform(0.4, 0.8), between(rng, 0.05, 0.1)
    return bent(rng, draw, lambda u: -np.exp(-0.5 * ((u - place) / width) ** 2))


def narrow_dip(rng: Rng, draw: Rng) -> Case:
    """A dent, one or two hundredths of the radius wide, under a short carriage."""
    place, width = rng.uniform(0.2, 0.9), between(rng, 0.01, 0.02)
    return bent(rng, draw, lambda u: -np.exp(-0.5 * ((u - place) / width) ** 2), pad=0.01)


def worn_zone(rng: Rng, draw: Rng) -> Case:
    """A flat worn zone where the carriage works most, with soft edges."""
    start, wide, edge = rng.uniform(0.3, 0.5), rng.uniform(0.15, 0.4), between(rng, 0.01, 0.06)
    return bent(rng, draw, lambda u: np.tanh((u - start - wide) / edge) - np.tanh((u - start) / edge))


def varying_wave(rng: Rng, draw: Rng) -> Case:
    """A wave of the way whose amplitude grows from the axis and whose pitch drifts."""
    waves, drift = rng.uniform(4, 12), rng.uniform(-0.3, 0.3)
    return bent(rng, draw, lambda u: u**2 * np.cos(2 * np.pi * waves * (u + drift * u**2)),
                (*LOCAL, "slide_periodic"))


def walking_way(rng: Rng, draw: Rng) -> Case:
    """A scraped way: a random walk that grows from the axis."""
    walk, at = noise.random_walk(rng, 400), np.linspace(0, 1, 400)
    return bent(rng, draw, lambda u: u * np.interp(u, at, walk - walk[0]), pad=0.1)


def sag(rng: Rng, draw: Rng) -> Case:
    """Sag with the fourth power of x, a cubic or a parabola declared."""
    side = sign(rng)
    return bent(rng, draw, lambda u: side * u**4, (*LOCAL, "gantry_sag"), most=3)


def bore(rng: Rng, draw: Rng) -> Case:
    """A face round a bore of a third to two thirds of the radius; nothing is missing."""
    shop = draw_shop(rng, diameter=False)
    return whole(replace(shop, inner=shop.radius * float(rng.uniform(0.33, 0.67))), draw)


def lobes(rng: Rng, draw: Rng, order: int) -> Case:
    """Lobes 0.2 to 1.9 µm high, growing as (r/R)^n; three azimuths of one disc, or of two."""
    shop = draw_shop(rng)
    size, start = between(rng, 0.2, 1.9), float(rng.uniform(0, 40))
    azimuths = start + np.array([0, rng.uniform(35, 80), rng.uniform(95, 160)])
    cuts = [(name, cut) for name, cut in zip(NAMES, three_cuts(shop))][:: int(rng.choice([2, 3]))]
    profiles: list[Profile] = []
    for name, cut in cuts:
        phase = rng.uniform(0, 2 * np.pi)
        form = lambda r, theta, p=phase: size * (r / shop.radius) ** order * np.cos(order * theta - p)
        for number, azimuth in enumerate(azimuths):
            keys: dict[str, Value] = {"azimuth_deg": float(azimuth), "surface": f"disc {name}"}
            setup = Setup(float(azimuth), keys=keys)
            profiles.append(profile(shop, draw, f"{name}{number}", cut,
                                    [carriage(shop, polynomial_way(shop))], forms=[form],
                                    setup=setup))
    hidden = Hidden(("chucking_lobes",), of_noise=size / shop.sigma)
    return Case(shop, profiles, [hidden])


def two_lobes(rng: Rng, draw: Rng) -> Case:
    """A part clamped between two jaws."""
    return lobes(rng, draw, 2)


def three_lobes(rng: Rng, draw: Rng) -> Case:
    """A three-jaw chuck."""
    return lobes(rng, draw, 3)


def four_lobes(rng: Rng, draw: Rng) -> Case:
    """A four-jaw chuck."""
    return lobes(rng, draw, 4)


def in_one_cut(rng: Rng, draw: Rng, names: tuple[str, ...], times: float,
               motion: Callable[[Shop, float, float], Callable[[Pass], Array]]) -> Case:
    """Something happens in one cut of three; motion(shop, amplitude, seconds of that cut)."""
    shop, where = draw_shop(rng), int(rng.integers(3))
    amplitude = sign(rng) * times * shop.sigma
    seconds = three_cuts(shop)[where].seconds()
    hidden = Hidden(names, cuts=(NAMES[where],), of_noise=times)
    return whole(shop, draw, [hidden],
                 only=lambda cut: [motion(shop, amplitude, seconds)] if cut == where else [])


def step_in_one(rng: Rng, draw: Rng) -> Case:
    """The tool slips or its edge chips once in one cut: 10 to 60 times the noise."""
    place = rng.uniform(0.15, 0.85)
    return in_one_cut(rng, draw, ("step",), between(rng, 10, 60), lambda shop, size, seconds:
                      lambda tool: np.where(tool.seconds > place * seconds, size, 0.0))


def crash_in_one(rng: Rng, draw: Rng) -> Case:
    """A collision: the tool jumps, and settles back by half within a hundredth of the cut."""
    place = rng.uniform(0.15, 0.85)
    def motion(shop: Shop, size: float, seconds: float) -> Callable[[Pass], Array]:
        def jump(tool: Pass) -> Array:
            after = tool.seconds / seconds - place
            return np.where(after > 0, size * (1 + np.exp(-np.maximum(after, 0) / 0.01)) / 2, 0.0)
        return jump
    return in_one_cut(rng, draw, ("step", "local_form"), between(rng, 10, 60), motion)


def drift_in_one(rng: Rng, draw: Rng) -> Case:
    """Coolant came on late: a steady drift in one cut."""
    return in_one_cut(rng, draw, ("linear_drift",), between(rng, 10, 60), lambda shop, size, seconds:
                      lambda tool: size * tool.seconds / seconds)


def warm_up_in_one(rng: Rng, draw: Rng) -> Case:
    """The machine was cold in one cut: a growth that fades, a tenth to a third of the cut long."""
    part = rng.uniform(0.1, 0.33)
    return in_one_cut(rng, draw, ("thermal_drift",), between(rng, 10, 60), lambda shop, size, seconds:
                      lambda tool: size * (1 - np.exp(-tool.seconds / (part * seconds))))


def off_centre(rng: Rng, draw: Rng) -> Case:
    """The axis lies 0.2 to 1 mm from where the problem file says, on a cone of 50 to 400 µrad."""
    shop = draw_shop(rng, diameter=True, cone=(50, 400))
    where = [sign(rng) * float(rng.uniform(0.2, 1)) for _ in NAMES]
    size = 1000 * abs(shop.squareness) * max(abs(w) for w in where) / shop.sigma
    return whole(shop, draw, [Hidden(("centring",), of_noise=size)],
                 setup=lambda cut: Setup(off_centre=where[cut]))


def chord(rng: Rng, draw: Rng) -> Case:
    """The traces pass the axis at 0.3 to 2 mm, on a cone of 50 to 400 µrad."""
    shop = draw_shop(rng, diameter=True, cone=(50, 400))
    where = [float(rng.uniform(0.3, 2)) for _ in NAMES]
    size = 1000 * abs(shop.squareness) * max(where) / shop.sigma
    return whole(shop, draw, [Hidden(("chord", "centre_height"), of_noise=size)],
                 setup=lambda cut: Setup(aside=where[cut]))


def backlash(rng: Rng, draw: Rng) -> Case:
    """After a reversal the slide takes up its play within 2 to 10 % of the travel, by 5 to 30 sigma."""
    shop = draw_shop(rng)
    size, part = shop.sigma * between(rng, 5, 30), rng.uniform(0.02, 0.1)
    def only(cut: int) -> Motions:
        way = 1.0 if three_cuts(shop)[cut].inward else -1.0
        seconds = three_cuts(shop)[cut].seconds()
        return [lambda tool: way * size * np.exp(-tool.seconds / (part * seconds))]
    return whole(shop, draw, [Hidden(("hysteresis",), of_noise=size / shop.sigma)], only=only)


def growth(rng: Rng, draw: Rng) -> Case:
    """Heat both ways: the spindle grows along its axis, the bed bends and tilts the slide."""
    shop = draw_shop(rng)
    seconds = three_cuts(shop)[0].seconds()
    tall, slow = sign(rng) * shop.sigma * between(rng, 5, 30), seconds * between(rng, 0.1, 1)
    tilt, bend = sign(rng) * shop.sigma * between(rng, 5, 30), seconds * between(rng, 0.3, 3)
    def motion(tool: Pass) -> Array:
        bending = tilt * (1 - np.exp(-tool.seconds / bend)) * tool.r / shop.radius
        return tall * (1 - np.exp(-tool.seconds / slow)) + bending
    hidden = Hidden(("thermal_drift",), of_noise=(abs(tall) + abs(tilt)) / shop.sigma)
    return whole(shop, draw, [hidden], [motion])


def blundered(rng: Rng, draw: Rng, words: str, change: Callable[[Profile], Profile]) -> Case:
    """One of three profiles is declared or exported wrongly; the face has some µm of form."""
    shop, where = draw_shop(rng, cone=(30, 100)), int(rng.integers(3))
    case = whole(shop, draw, [Hidden((), cuts=(NAMES[where],), words=words)])
    profiles = [change(p) if i == where else p for i, p in enumerate(case.profiles)]
    return replace(case, profiles=profiles)


def wrong_sign(rng: Rng, draw: Rng) -> Case:
    """Heights of one profile point into the part."""
    return blundered(rng, draw, r"\bsign\b", lambda p: replace(p, z=-p.z))


def scaled(rng: Rng, draw: Rng, factor: float) -> Case:
    """Heights of one profile too large or too small by a factor."""
    if rng.random() < 0.5:
        return blundered(rng, draw, f"{factor:g} times too large", lambda p: replace(p, z=p.z * factor))
    return blundered(rng, draw, f"{factor:g} times too small", lambda p: replace(p, z=p.z / factor))


def inch(rng: Rng, draw: Rng) -> Case:
    """Heights of one profile were written in inch and read in mm, or the other way round."""
    return scaled(rng, draw, 25.4)


def thousand(rng: Rng, draw: Rng) -> Case:
    """Heights of one profile are in nm or mm and declared µm."""
    return scaled(rng, draw, 1000)


def metres(rng: Rng, draw: Rng) -> Case:
    """Positions of one profile are metres and declared mm."""
    return blundered(rng, draw, r"positions.*1000",
                     lambda p: replace(p, x=p.x / 1000))


def swapped_direction(rng: Rng, draw: Rng) -> Case:
    """The direction of one cut is declared the wrong way round, and the tool warmed up as it cut."""
    return clock_blunder(rng, draw, r"direction", "cut_direction")


def shifted_start(rng: Rng, draw: Rng) -> Case:
    """start_s of one cut is wrong by a good part of the cut, and the tool warmed up as it cut."""
    return clock_blunder(rng, draw, r"start_s", "start_s")


def clock_blunder(rng: Rng, draw: Rng, words: str, key: str) -> Case:
    """A thermal drift in every cut, not declared, and a wrong clock in one."""
    shop, where = draw_shop(rng), int(rng.integers(3))
    seconds = [cut.seconds() for cut in three_cuts(shop)]
    size, part = sign(rng) * shop.sigma * between(rng, 20, 60), rng.uniform(0.1, 0.4) * seconds[0]
    late = rng.uniform(0.2, 0.5) * seconds[where]
    starts = [late if key == "start_s" and i == where else 0.0 for i in range(3)]
    def only(cut: int) -> Motions:
        return [lambda tool: size * (1 - np.exp(-(tool.seconds + starts[cut]) / part))]
    hidden = Hidden(("thermal_drift",), cuts=(NAMES[where],), words=words,
                    of_noise=abs(size) / shop.sigma)
    case = whole(shop, draw, [hidden], only=only)
    profiles = list(case.profiles)
    if key == "cut_direction":
        wrong = "inward" if profiles[where].keys[key] == "outward" else "outward"
        profiles[where] = replace(profiles[where], keys=profiles[where].keys | {key: wrong})
    return replace(case, profiles=profiles)


WAYS = [kink, joint, dip, narrow_dip, worn_zone, varying_wave, walking_way, sag, bore]
LOBES = [two_lobes, three_lobes, four_lobes]
ONE_CUT = [step_in_one, crash_in_one, drift_in_one, warm_up_in_one]
SETUP = [off_centre, chord, backlash]
THERMAL = [growth]
BLUNDERS = [wrong_sign, inch, thousand, metres, swapped_direction, shifted_start]
