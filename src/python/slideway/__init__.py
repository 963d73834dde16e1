"""Carriage errors of a lathe from the measured flatness of a turned face.

>>> import slideway
>>> report = slideway.identify("problem.toml")
>>> print(report.trace.verdict)

A problem is the path of a problem file, a dict of the same keys, or a `Problem`; its profiles come
from the files it names, or from arrays. What is wrong with a problem raises `UsageError`, what is wrong with
the numbers `DataError`; both are `ValueError`. Results are those of the program to the last digit.
"""

from __future__ import annotations

import inspect
import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from slideway import _slideway
from slideway._made import made
from slideway._problem import AnyProblem, source
from slideway._run import Progress, run
from slideway._slideway import DataError, UsageError, __version__
from slideway._typed import Arrays, Problem, Profile, Term
from slideway.report import Report

__all__ = [
    "ColumnRanking",
    "DataError",
    "Decomposition",
    "Effect",
    "Problem",
    "Profile",
    "Report",
    "SimulatedProfile",
    "Term",
    "UsageError",
    "__version__",
    "decompose",
    "identify",
    "rank",
    "rank_columns",
    "simulate",
]


@dataclass(frozen=True, eq=False)
class Decomposition:
    """Bands at full length: ``approximations[-1] + details.sum(axis=0)`` is the signal."""

    approximations: NDArray[np.float64]
    """shape (level, n): a_1 ... a_L, in the signal's unit"""
    details: NDArray[np.float64]
    """shape (level, n): d_1 ... d_L, in the signal's unit"""


@dataclass(frozen=True)
class ColumnRanking:
    """One column held against a signal."""

    candidate: str
    raw: float
    """correlation coefficient of the columns as they are"""
    low_band: float
    """and of their low bands"""
    lag: int
    """low-band values by which a shift makes the coefficient largest"""
    lag_coefficient: float
    """the coefficient at that shift"""
    effective_observations: float
    """independent values in the low bands"""
    p_value: float
    """chance of as large a coefficient without a connection"""


@dataclass(frozen=True, eq=False)
class SimulatedProfile:
    """A profile as an instrument would have it."""

    kind: str
    """face or slide"""
    quantity: str
    """height or slope"""
    unit: str
    """of ``value``, as ``value_unit`` of a problem has it: "um" (heights) or "urad" (slopes)"""
    position: NDArray[np.float64]
    """shape (n,), mm, increasing"""
    value: NDArray[np.float64]
    """shape (n,), in ``unit``"""


Bounds = tuple[str, float, float]


@dataclass(frozen=True)
class Effect:
    """An effect of one's own: a function of arrays, looked for by the loop.

    >>> Effect(lambda t, a, tau: a * (1 - np.exp(-t / tau)), {"a": "um", "tau": ("s", 1, 600)})

    Arguments that are no parameters are variables: arrays of shape (n,) of r, x, X, z, R (mm), theta
    (rad), t, m, t_read (s), k (turns), s (m), feed (mm/min), rpm. It returns shape (n,), um of a
    height; it must give the same for the same arguments.
    """

    function: Callable[..., ArrayLike]
    parameters: Mapping[str, str | Bounds]
    """unit of what enters linearly, "um" or "urad", alone or by another; (unit, lower, upper) of
    all else"""
    cause: str = ""
    source: str = ""
    typical: str = ""


def _effect(name: str, effect: Effect) -> tuple[
    str,
    Callable[..., ArrayLike],
    list[str],
    list[tuple[str, str, float | None, float | None]],
    str,
    str,
    str,
]:
    arguments = list(inspect.signature(effect.function).parameters)
    missing = [each for each in effect.parameters if each not in arguments]
    if missing:
        raise UsageError(f"effect {name!r}: the function has no argument {missing[0]!r}")
    parameters: list[tuple[str, str, float | None, float | None]] = []
    for each, about in effect.parameters.items():
        unit, lower, upper = (about, None, None) if isinstance(about, str) else about
        parameters.append((each, unit, lower, upper))
    variables = [each for each in arguments if each not in effect.parameters]
    return (
        name,
        effect.function,
        variables,
        parameters,
        effect.cause,
        effect.source,
        effect.typical,
    )


Profiles = Mapping[str, Arrays]


def _data_folder(data: str | os.PathLike[str] | None) -> str | os.PathLike[str] | None:
    return data or os.environ.get("SLIDEWAY_DATA") or None


def _analysed(
    problem: AnyProblem,
    profiles: Profiles | None,
    data: str | os.PathLike[str] | None,
    ranks_only: bool,
    closes_loop: bool,
    effects: Mapping[str, Effect] | None = None,
    progress: Progress | None = None,
    timeout: float | None = None,
) -> Report:
    if profiles is None:
        profiles = problem.arrays() if isinstance(problem, Problem) else {}
    columns = {
        name: tuple(np.asarray(column, float) for column in arrays)
        for name, arrays in profiles.items()
    }
    given, folder = source(problem), _data_folder(data)
    own = [_effect(name, effect) for name, effect in (effects or {}).items()]
    document, text = run(
        lambda tell, cancellation: _slideway.analyse(
            given, columns, folder, ranks_only, closes_loop, own, tell, cancellation
        ),
        "rank" if ranks_only else "identify",
        progress,
        timeout,
    )
    report: Report = made(Report, json.loads(document) | {"text": text, "json": document})
    return report


def identify(
    problem: AnyProblem,
    profiles: Profiles | None = None,
    *,
    data: str | os.PathLike[str] | None = None,
    trace: bool = True,
    effects: Mapping[str, Effect] | None = None,
    progress: Progress | None = None,
    timeout: float | None = None,
) -> Report:
    """The main job: low band, ranking, fit, cross-check, and the closed loop.

    :param problem: path of a problem file, a `Problem`, or a dict of the same keys: ``{"machine": {"lever":
        "paper"}, "profile": [{"name": ...}], "effect": [{"name": ...}]}``. Paths are relative to
        the problem file, those of a dict to the working directory.
    :param profiles: arrays instead of files, ``{name: (position, value)}``, the name that of a
        ``[[profile]]``; two arrays of shape (n,), in the ``position_unit`` and ``value_unit`` of
        that profile. A value that is NaN is a missing point. A profile of a dict that has arrays
        needs no ``file``. With a ``time_column``: ``(position, value, time)``, in ``time_unit``.
    :param data: what ``${SLIDEWAY_DATA}`` in the problem stands for; default: the environment
        variable
    :param trace: False stops before the closed loop
    :param effects: effects of one's own that the loop looks for, by name
    :param progress: told what the loop is at and which part of that is done, 0 to 1, in the
        calling thread
    :param timeout: seconds; Ctrl-C ends the call at any time as well
    :raises TimeoutError: not done in that time
    :raises UsageError: the problem is wrong, or an argument
    :raises DataError: the numbers cannot be used
    """
    return _analysed(problem, profiles, data, False, trace, effects, progress, timeout)


def rank(
    problem: AnyProblem,
    profiles: Profiles | None = None,
    *,
    data: str | os.PathLike[str] | None = None,
) -> Report:
    """The correlations alone, Eqs. (6), (19), (20): a report without models.

    Arguments and errors as in `identify`.
    """
    return _analysed(problem, profiles, data, True, False)


def rank_columns(
    signal: ArrayLike,
    candidates: Mapping[str, ArrayLike],
    wavelet: str = "db1",
    level: int = 0,
    boundary: str = "symmetric",
) -> list[ColumnRanking]:
    """Correlates any columns with a signal (Fig. 11): the largest low-band coefficient first.

    :param signal: shape (n,), any unit
    :param candidates: arrays of shape (n,) by name, each in any unit
    :param wavelet: "db1" to "db19"
    :param level: of the low band; 0: none, the columns as they are
    :param boundary: as in `decompose`
    :raises UsageError: an unknown wavelet or boundary
    :raises DataError: lengths that differ, a sample that is not finite, too few for the level
    """
    columns = {name: np.asarray(column, float) for name, column in candidates.items()}
    return [
        ColumnRanking(*row)
        for row in _slideway.rank_columns(
            np.asarray(signal, float), columns, wavelet, level, boundary
        )
    ]


def simulate(
    problem: AnyProblem,
    *,
    seed: int | None = None,
    data: str | os.PathLike[str] | None = None,
) -> dict[str, SimulatedProfile]:
    """The profiles that ``[truth]`` of a problem makes, by name.

    Positions are those of the profile's file where it exists, else ``truth.samples`` over its
    ``window``, else over the face of ``cut_radius_mm``.

    :param seed: instead of the seed in ``[truth]``
    :raises UsageError: no ``[truth]``, nothing that tells the positions
    """
    if seed is not None and not 0 <= seed < 2**64:
        raise UsageError(f"seed: {seed} is out of range; accepted: 0 to 2^64 - 1")
    return {
        name: SimulatedProfile(
            kind, quantity, "urad" if quantity == "slope" else "um", position, value
        )
        for name, kind, quantity, position, value in _slideway.simulate(
            source(problem), seed, _data_folder(data)
        )
    }


def decompose(
    signal: ArrayLike, wavelet: str = "db4", level: int = 5, boundary: str = "symmetric"
) -> Decomposition:
    """Splits a signal into wavelet bands of its own length.

    :param signal: shape (n,), evenly spaced, any unit; n at least 2^level
    :param wavelet: "db1" to "db19"
    :param boundary: how the signal goes on beyond its ends: zero, constant, symmetric, periodic,
        smooth, periodization, reflect, antisymmetric, antireflect
    :raises UsageError: an unknown wavelet or boundary, a level outside 1 to 30
    :raises DataError: too few samples, a sample that is not finite
    """
    return Decomposition(
        *_slideway.decompose(np.asarray(signal, float), wavelet, level, boundary)
    )
