"""A problem built in code: the keys of a problem file that most need, with their types."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, Literal

from numpy.typing import ArrayLike

Arrays = tuple[ArrayLike, ...]
_APART = ("position", "value", "time", "more")


def _keys(table: Any, apart: Sequence[str] = _APART) -> dict[str, Any]:
    given = {each.name: getattr(table, each.name) for each in fields(table)}
    known = {key: value for key, value in given.items() if key not in apart and value is not None}
    return known | dict(table.more)


@dataclass(kw_only=True)
class Profile:
    """A ``[[profile]]``, of arrays or of a file: ``slideway help problem-file`` lists all keys.

    >>> Profile(name="face", position=x, value=z, kind="face", position_unit="mm", value_unit="um",
    ...         center_mm=60.0, feed_mm_per_min=50.0, spindle_rpm=800.0, cut_direction="inward")
    """

    name: str
    position: ArrayLike | None = None
    """shape (n,), in ``position_unit``"""
    value: ArrayLike | None = None
    """shape (n,), in ``value_unit``; NaN is a missing point"""
    time: ArrayLike | None = None
    """shape (n,), in ``time_unit``: when each station was read"""
    file: str | None = None
    kind: Literal["face", "slide"] = "face"
    quantity: Literal["height", "slope"] | None = None
    position_unit: Literal["m", "mm", "um", "nm", "inch", "s"] | None = None
    value_unit: str | None = None
    """of heights as of positions; of slopes rad mrad urad arcsec um_per_m mm_per_m"""
    time_unit: Literal["s", "min", "h"] | None = None
    center_mm: float | None = None
    """face: where the spindle axis lies in the trace"""
    feed_mm_per_min: float | None = None
    spindle_rpm: float | None = None
    cut_direction: Literal["inward", "outward"] | None = None
    cut_radius_mm: float | None = None
    base_mm: float | None = None
    """slope: between the feet of the level or the mirror"""
    free: Sequence[str] | None = None
    """what levelling left undetermined: "offset", "tilt" """
    more: Mapping[str, Any] = field(default_factory=dict)
    """all other keys"""


@dataclass(kw_only=True)
class Term:
    """An ``[[effect]]`` of the declared model, of the catalogue or one of one's own by name."""

    name: str
    degree: int | None = None
    profiles: Sequence[str] | None = None
    """names of the profiles it is confined to"""
    more: Mapping[str, Any] = field(default_factory=dict)
    """all other keys"""


@dataclass(kw_only=True)
class Problem:
    """A problem for `identify`, `rank` and `simulate`; a wrong value raises `UsageError` there.

    >>> problem = Problem(profiles=[...], effects=[Term(name="squareness")],
    ...                   machine={"lever": "paper"})
    >>> report = slideway.identify(problem)
    """

    profiles: Sequence[Profile]
    effects: Sequence[Term]
    title: str | None = None
    machine: Mapping[str, Any] | None = None
    about: Mapping[str, str] | None = None
    tolerance: Mapping[str, float] | None = None
    low_band: Mapping[str, Any] | None = None
    more: Mapping[str, Any] = field(default_factory=dict)
    """all other tables and keys"""

    def to_dict(self) -> dict[str, Any]:
        """The keys of a problem file, without arrays."""
        return {
            "profile": [_keys(profile) for profile in self.profiles],
            "effect": [_keys(effect) for effect in self.effects],
        } | _keys(self, ("profiles", "effects", "more"))

    def arrays(self) -> dict[str, Arrays]:
        """What the profiles hold, by name: (position, value) or (position, value, time)."""
        return {
            profile.name: tuple(
                each for each in (profile.position, profile.value, profile.time) if each is not None
            )
            for profile in self.profiles
            if profile.position is not None
        }
