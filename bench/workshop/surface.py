"""A face as a lathe leaves it and a stylus reads it: geometry and time, no model of an estimator.

Lengths along the face are mm, heights µm, times s, angles rad.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

REACH = 4  # turns on either side whose groove may be the lowest at a point


@dataclass(frozen=True)
class Pass:
    """Where and when the tool is as it crosses points of the face."""

    r: Array  # of the tool's lowest point, mm
    theta: Array  # on the workpiece, rad
    turns: Array  # of the spindle since the cut began
    seconds: Array  # since the cut began
    metres: Array  # cut so far


Motion = Callable[[Pass], Array]  # height of the tool tip, µm
Form = Callable[[Array, Array], Array]  # (r, theta): what the part does once it is unchucked, µm


@dataclass(frozen=True)
class Cut:
    """One facing cut: a spiral of constant feed at a constant spindle speed."""

    radius: float
    feed: float  # mm per turn
    rpm: float
    inward: bool
    nose: float  # radius of the tool's nose, mm
    inner: float = 0.0  # radius of the bore

    def turns(self, r: Array) -> Array:
        """Turns until the tool is at r."""
        return (self.radius - r if self.inward else r - self.inner) / self.feed

    def at(self, turns: Array, theta: Array) -> Pass:
        """State of the tool after so many turns: t = turns / n, s = 2π ∫ r dturns."""
        way = self.feed * turns
        r = self.radius - way if self.inward else self.inner + way
        start = self.radius if self.inward else self.inner
        metres = np.pi * np.abs(r**2 - start**2) / self.feed / 1000
        return Pass(r, theta, turns, turns * 60 / self.rpm, metres)

    def seconds(self) -> float:
        return (self.radius - self.inner) / self.feed * 60 / self.rpm


def round_nose(distance: Array, nose: float) -> Array:
    """Height of a round nose above its lowest point, µm; beyond the nose nothing is cut."""
    inside = np.abs(distance) < nose
    depth = nose - np.sqrt(np.where(inside, nose**2 - distance**2, 0.0))
    return np.where(inside, 1000 * depth, np.inf)


def cut_face(cut: Cut, motion: Motion, r: Array, theta: Array) -> Array:
    """The face: of the grooves that neighbouring turns leave, the lowest at each point, µm."""
    share = np.mod(theta / (2 * np.pi), 1.0)
    first = np.floor(cut.turns(r) - share)
    lowest = np.full(r.shape, np.inf)
    for turn in range(1 - REACH, REACH + 1):
        there = cut.at(first + turn + share, theta)
        is_cut = (there.turns >= 0) & (there.r >= 0)
        groove = motion(there) + round_nose(r - there.r, cut.nose)
        lowest = np.minimum(lowest, np.where(is_cut, groove, np.inf))
    return lowest


def rolled_ball(height: Array, step: float, tip: float) -> Array:
    """Lowest point of a ball of radius tip that rolls over a profile sampled at step."""
    reach = min(int(np.ceil(0.15 * tip / step)), 60)
    path = height.copy()
    for shift in range(1, reach + 1):
        if shift * step >= tip:
            break
        gap = float(round_nose(np.array(shift * step), tip))
        path[shift:] = np.maximum(path[shift:], height[:-shift] - gap)
        path[:-shift] = np.maximum(path[:-shift], height[shift:] - gap)
    return path


@dataclass(frozen=True)
class Trace:
    """A straight trace over the face: stations along it from the point nearest the axis."""

    x: Array  # evenly spaced, mm
    azimuth: float = 0.0
    aside: float = 0.0  # distance of the trace from the axis, mm
    tip: float = 0.005  # radius of the stylus, mm
    averages: bool = True  # over the sampling step, as a data logger does; else single points


def half_path(cut: Cut, motion: Motion, forms: list[Form], trace: Trace,
              side: float) -> tuple[Array, Array]:
    """Distances from the point nearest the axis on one side of it, and what a stylus reads there.

    Forty points a groove, the ridges among them: on other points a ball finds each ridge lower by
    another part, and the trace gets a wave that no instrument reads.
    """
    fine = cut.feed / 40
    share = np.mod((trace.azimuth + (0.0 if side > 0 else np.pi)) / (2 * np.pi), 1.0)
    ridge = cut.at(np.array(share + 0.5), np.array(0.0)).r
    last = float(np.max(side * trace.x)) + float(trace.x[1] - trace.x[0])
    x: Array = np.arange(np.mod(ridge, fine), last, fine)
    theta = trace.azimuth + np.arctan2(trace.aside, side * x)
    r = np.clip(np.hypot(x, trace.aside), cut.inner, cut.radius)
    height = cut_face(cut, motion, r, theta)
    for form in forms:
        height = height + form(r, theta)
    return x, rolled_ball(height, fine, trace.tip)


def traced(cut: Cut, motion: Motion, forms: list[Form], trace: Trace) -> Array:
    """What an errorless instrument reads at the stations, µm."""
    step = float(trace.x[1] - trace.x[0])
    z = np.zeros(len(trace.x))
    for side in (1.0, -1.0):
        low, high = side * trace.x - step / 2, side * trace.x + step / 2
        if high.max() <= 0:
            continue
        x, path = half_path(cut, motion, forms, trace, side)
        if trace.averages:
            sums = np.concatenate([[0.0], np.cumsum(0.5 * (path[1:] + path[:-1]) * np.diff(x))])
            low, high = np.maximum(low, 0.0), np.maximum(high, 0.0)
            z += (np.interp(high, x, sums) - np.interp(low, x, sums)) / step
        else:
            z += np.where(side * trace.x >= 0, np.interp(side * trace.x, x, path), 0.0)
    return z
