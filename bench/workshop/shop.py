"""A workshop: a lathe, a tool, an instrument, and the problem file its user would write."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

import noise
from surface import Array, Cut, Form, Motion, Pass, Trace, traced

Rng = np.random.Generator
Value = float | int | str | list[str]


def between(rng: Rng, low: float, high: float) -> float:
    """Log-uniform."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def sign(rng: Rng) -> float:
    return float(rng.choice([-1.0, 1.0]))


@dataclass(frozen=True)
class Shop:
    """What all cuts and traces of one case have in common."""

    radius: float
    rpm: float
    feed: float  # of the first cut, mm per turn
    nose: float
    points: int
    diameter: bool
    sigma: float  # noise of a reading, µm
    tip: float
    averages: bool
    traverse: float  # mm/s
    wavelet: str
    level: int
    lever: str
    overhang: float
    degree: int
    squareness: float  # rad
    bow: tuple[float, ...]  # µm at the rim, of x^2, x^3, ...
    inner: float = 0.0

    def stations(self) -> Array:
        """Along the trace, from the point nearest the axis."""
        rim = 0.995 * self.radius
        start = -rim if self.diameter else max(0.004 * self.radius, 1.005 * self.inner)
        return np.linspace(start, rim, self.points)


def draw_shop(rng: Rng, diameter: bool | None = None, cone: tuple[float, float] = (2, 40)) -> Shop:
    """A finishing cut of an ordinary workshop; cone: the squareness error, from to, µrad."""
    nose = between(rng, 0.4, 1.6)
    scallop = between(rng, 2e-5, 3e-3)  # mm: f = sqrt(8 r h), the feed of that height
    degree = int(rng.choice([3, 3, 3, 2, 5]))
    lever = str(rng.choice(["paper", "paper", "paper", "split"]))
    return Shop(
        radius=between(rng, 40, 300), rpm=between(rng, 200, 1500), nose=nose,
        feed=float(np.sqrt(8 * nose * scallop)), points=int(rng.integers(600, 1401)),
        diameter=bool(rng.integers(2)) if diameter is None else diameter,
        sigma=between(rng, 0.02, 0.08), tip=float(rng.choice([0.002, 0.005, 0.5])),
        averages=bool(rng.random() < 0.8), traverse=float(rng.choice([0.25, 0.5, 1.0])),
        wavelet=str(rng.choice(["db1", "db4"])), level=int(rng.choice([2, 3])), lever=lever,
        overhang=float(rng.uniform(20, 200)) if lever == "split" else 0.0, degree=degree,
        squareness=sign(rng) * between(rng, *cone) * 1e-6,
        bow=tuple(sign(rng) * between(rng, 0.1, 2) for _ in range(2, degree + 1)))


def three_cuts(shop: Shop) -> list[Cut]:
    """Inward, inward at two and a half times the feed, outward."""
    def cut(feed: float, inward: bool) -> Cut:
        return Cut(shop.radius, feed, shop.rpm, inward, shop.nose, shop.inner)
    return [cut(shop.feed, True), cut(2.5 * shop.feed, True), cut(shop.feed, False)]


NAMES = ["cut1", "cut2", "cut3"]


@dataclass(frozen=True)
class Way:
    """Form of the guideway along the slide, µm, and its slope, µm/mm."""

    height: Callable[[Array], Array]
    slope: Callable[[Array], Array]


def polynomial_way(shop: Shop) -> Way:
    terms = list(enumerate(shop.bow, start=2))
    def height(x: Array) -> Array:
        return np.sum([b * (x / shop.radius) ** k for k, b in terms], axis=0)
    def slope(x: Array) -> Array:
        slopes = [k * b * (x / shop.radius) ** (k - 1) for k, b in terms]
        return np.sum(slopes, axis=0) / shop.radius
    return Way(height, slope)


def drawn_way(shop: Shop, form: Callable[[Array], Array], pad: float = 0.03) -> Way:
    """A way of any form under a carriage whose pads average over pad · radius."""
    x = np.linspace(0, shop.radius, 4001)
    half = int(pad * 2000)
    long = np.pad(form(x), half, mode="edge")
    sums = np.cumsum(np.concatenate([[0.0], long]))
    height = (sums[2 * half + 1 :] - sums[: -2 * half - 1]) / (2 * half + 1)
    slope = np.gradient(height, x)
    return Way(lambda at: np.interp(at, x, height), lambda at: np.interp(at, x, slope))


def carriage(shop: Shop, way: Way) -> Motion:
    """Tool tip of the rigid carriage: the way, less its pitch and the squareness on their levers."""
    def motion(tool: Pass) -> Array:
        lever = tool.r if shop.lever == "paper" else np.full_like(tool.r, shop.overhang)
        return way.height(tool.r) - way.slope(tool.r) * lever - 1000 * shop.squareness * tool.r
    return motion


@dataclass(frozen=True)
class Profile:
    """One trace as written and as declared."""

    name: str
    x: Array
    z: Array
    keys: dict[str, Value]


@dataclass(frozen=True)
class Setup:
    """How one trace is taken, where it differs from what the problem file says."""

    azimuth_deg: float = 0.0
    off_centre: float = 0.0
    aside: float = 0.0
    reads: tuple[Callable[[Array], Array], ...] = ()  # errors of the instrument along X, µm
    keys: dict[str, Value] = field(default_factory=dict)


def profile(shop: Shop, rng: Rng, name: str, cut: Cut, motions: Sequence[Motion],
            errors: Array | None = None, forms: Sequence[Form] = (),
            setup: Setup = Setup()) -> Profile:
    """A trace with its noise (white unless given) and the keys a user would write for it."""
    along = shop.stations()
    trace = Trace(along - setup.off_centre, np.radians(setup.azimuth_deg), setup.aside, shop.tip,
                  shop.averages)
    z = traced(cut, lambda tool: np.sum([m(tool) for m in motions], axis=0), list(forms), trace)
    for read in setup.reads:
        z = z + read(along)
    if errors is None:
        errors = shop.sigma * noise.white(rng, shop.points)
    tilt = rng.uniform(-0.05, 0.05) if shop.diameter else 0.0
    centre = shop.radius if shop.diameter else 0.0
    keys: dict[str, Value] = {
        "feed_mm_per_min": cut.feed * cut.rpm, "spindle_rpm": cut.rpm,
        "cut_direction": "inward" if cut.inward else "outward", "cut_radius_mm": cut.radius,
        "traverse_mm_per_s": shop.traverse, "nose_radius_mm": cut.nose, "center_mm": centre,
        "free": ["offset", "tilt"] if shop.diameter else ["offset"]}
    z = z + errors + rng.uniform(-5, 5) + tilt * along
    return Profile(name, along + centre, z, keys | setup.keys)


@dataclass(frozen=True)
class Hidden:
    """What is in the face and not in the declared model."""

    names: tuple[str, ...]  # names that are right
    parameter: str = ""  # of names[0], with its size
    size: float = 0.0
    shape: float = 0.0
    cuts: tuple[str, ...] = ()  # the profiles that have it; none: all
    words: str = ""  # a blunder: the words of a report that found it, a regular expression
    of_noise: float = 0.0  # amplitude in standard deviations of the noise


@dataclass(frozen=True)
class Case:
    shop: Shop
    profiles: list[Profile]
    hidden: list[Hidden] = field(default_factory=list)


def whole(shop: Shop, rng: Rng, hidden: Sequence[Hidden] = (), motions: Sequence[Motion] = (),
          way: Way | None = None, only: Callable[[int], Sequence[Motion]] = lambda cut: (),
          errors: Callable[[int], Array | None] = lambda cut: None, forms: Sequence[Form] = (),
          setup: Callable[[int], Setup] = lambda cut: Setup(), cuts: int = 3) -> Case:
    """Three cuts with the same carriage; what differs between them by number."""
    base = [carriage(shop, polynomial_way(shop))]
    if way is not None:
        base.append(carriage(replace(shop, squareness=0.0), way))
    profiles = [profile(shop, rng, NAMES[i], cut, [*base, *motions, *only(i)], errors(i), forms,
                        setup(i))
                for i, cut in enumerate(three_cuts(shop)[:cuts])]
    return Case(shop, profiles, list(hidden))


def toml(value: Value) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return f'"{value}"' if isinstance(value, str) else repr(value)


def write(case: Case, folder: Path, title: str) -> Path:
    """problem.toml and a CSV for each profile."""
    folder.mkdir(parents=True, exist_ok=True)
    shop = case.shop
    lines = [f"title = {toml(title)}", "", "[machine]", f"lever = {toml(shop.lever)}"]
    lines += [f"overhang_mm = {shop.overhang!r}"] if shop.lever == "split" else []
    lines += ["", "[low_band]", f"wavelet = {toml(shop.wavelet)}", f"level = {shop.level}"]
    for one in case.profiles:
        rows = "".join(f"{x:.6f},{z:.5f}\n" for x, z in zip(one.x, one.z))
        (folder / f"{one.name}.csv").write_text("x_mm,z_um\n" + rows)
        given = {"name": one.name, "file": f"{one.name}.csv", "kind": "face", "quantity": "height",
                 "position_column": "x_mm", "value_column": "z_um", "position_unit": "mm",
                 "value_unit": "um"}
        lines += ["", "[[profile]]"] + [f"{k} = {toml(v)}" for k, v in (given | one.keys).items()]
    lines += ["", "[[effect]]", 'name = "squareness"', "", "[[effect]]", 'name = "straightness"',
              f"degree = {shop.degree}", ""]
    path = folder / "problem.toml"
    path.write_text("\n".join(lines))
    return path
