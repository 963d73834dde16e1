"""The report, key for key as the program's ``--json`` has it.

Units are in the names (``rms_um``, ``lag_mm``); a parameter has its own in ``unit``. ``None`` is a
number that could not be determined, or does not apply. Of a pair such as ``rms_um`` and
``rms_urad`` the first belongs to height profiles, the second to slope profiles.
"""

from __future__ import annotations

import dataclasses
import functools
import types
from dataclasses import dataclass
from typing import Any, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Outlier:
    """A sample that its neighbours contradict; ``row`` counts from 1, values in ``unit``."""

    row: int
    value: float
    expected: float
    unit: str
    kind: str


@dataclass(frozen=True)
class Input:
    """One profile as it was read. ``file`` and ``format`` are "arrays" for numbers from arrays."""

    name: str
    file: str
    format: str
    sha256: str
    kind: str
    quantity: str
    role: str
    samples: int
    missing: int
    left_out: int
    outlier_count: int
    outliers: list[Outlier]
    position_min_mm: float
    position_max_mm: float
    rms_um: float | None
    pv_um: float | None
    rms_urad: float | None
    pv_urad: float | None
    notes: list[str]


@dataclass(frozen=True)
class Misclosure:
    """What one line reads where it meets others, against what they say.

    ``difference_um`` is that of the data as they stand; ``closure_um`` is None where nothing checks it.
    """

    profile: str
    x_mm: float
    y_mm: float
    difference_um: float | None
    closure_um: float | None
    standard_uncertainty_um: float | None


@dataclass(frozen=True)
class Repeat:
    """Two profiles of one line, at the station at which they differ most; "agree", "do not agree"."""

    a: str
    b: str
    stations: int
    x_mm: float
    y_mm: float
    difference_um: float
    standard_uncertainty_um: float
    limit: float
    verdict: str


@dataclass(frozen=True)
class Closure:
    """Whether lines agree where they meet: ``verdict`` "closes", "does not close", "not judged".

    ``limit`` is that of ``closure_um / standard_uncertainty_um``; ``suspects`` are the lines without
    any one of which the rest closes; ``tied`` heights were made to agree before.
    """

    verdict: str
    lines: int
    places: int
    redundancy: int
    false_alarm: float
    limit: float | None
    tied: bool
    readings: list[Misclosure]
    repeats: list[Repeat]
    suspects: list[str]
    notes: list[str]


@dataclass(frozen=True)
class LowBand:
    wavelet: str
    level: int
    boundary: str
    values: int


@dataclass(frozen=True, eq=False)
class Running:
    """Coefficients over a growing part of the trace, Figs. 8 and 9.

    ``samples`` and ``raw`` have shape (k,): the coefficient of the first ``samples`` samples.
    ``low_band`` has shape (m,), m <= k, evenly over the same trace: (i + 1) / m of it.
    """

    samples: NDArray[np.int64]
    raw: NDArray[np.float64]
    low_band: NDArray[np.float64]


@dataclass(frozen=True)
class Ranking:
    """Pearson's coefficient of an effect and a profile, Eqs. (6), (19), (20)."""

    effect: str
    profile: str
    raw: float
    low_band: float
    lag_mm: float
    lag_coefficient: float
    effective_observations: float
    p_value: float
    running: Running


@dataclass(frozen=True)
class CandidateCorrelation:
    a: str
    b: str
    profile: str
    coefficient: float


@dataclass(frozen=True)
class Travel:
    """What the fitted profiles cover of the slide, and the levers that act on it."""

    lever: str
    slide_min_mm: float
    slide_max_mm: float
    spindle_position_mm: float | None
    overhang_mm: float | None


@dataclass(frozen=True)
class Dominant:
    by_correlation: str | None
    by_fit: str | None
    agree: bool | None
    doubt: str


@dataclass(frozen=True)
class Parameter:
    """A fitted parameter: value ± expanded_uncertainty, k = coverage_factor, in ``unit``."""

    name: str
    symbol: str
    standard_name: str
    value: float | None
    unit: str
    standard_uncertainty: float | None
    expanded_uncertainty: float | None
    coverage_factor: float
    degrees_of_freedom: float | None
    identifiable: bool
    at_bound: bool


@dataclass(frozen=True)
class Undetermined:
    """A direction in parameter space that no data given here tell anything of."""

    combination: dict[str, float]
    advice: str


@dataclass(frozen=True)
class Determined:
    """What the data say of parameters they cannot tell apart."""

    combination: dict[str, float]
    value: float
    unit: str
    standard_uncertainty: float
    expanded_uncertainty: float


@dataclass(frozen=True)
class Identifiability:
    parameters: int
    rank: int
    condition: float
    unidentifiable: list[Undetermined]
    determined: list[Determined]


@dataclass(frozen=True)
class Noise:
    profile: str
    scaling: str
    order: int
    standard_deviation_um: float | None
    standard_deviation_urad: float | None
    correlation_mm: float
    effective_observations: float
    ljung_box_p: float


@dataclass(frozen=True)
class Contribution:
    """An effect's part of a profile's low band: rms about its mean, and share of the whole."""

    effect: str
    profile: str
    share: float
    rms_um: float | None = None
    rms_urad: float | None = None


@dataclass(frozen=True)
class Residual:
    profile: str
    role: str
    rms_um: float | None = None
    pv_um: float | None = None
    rms_urad: float | None = None
    pv_urad: float | None = None


@dataclass(frozen=True)
class Fit:
    converged: bool
    message: str
    rms_um: float | None
    rms_urad: float | None
    observations: int
    effective_observations: float
    chi_square: float
    degrees_of_freedom: float
    parameters: list[Parameter]
    nuisances: list[Parameter]
    correlations: list[tuple[str, str, float]]
    identifiability: Identifiability
    noise: list[Noise]
    contributions: list[Contribution]
    residuals: list[Residual]
    neglected_um: float | None
    implausible: str
    notes: list[str]


@dataclass(frozen=True)
class Squareness:
    """Squareness of the fit against that of the run-out, Eq. (21)."""

    fit_rad: float | None
    fit_U_rad: float | None
    indirect_rad: float | None
    indirect_U_rad: float | None
    En: float | None
    verdict: str
    reason: str
    travel_mm: float | None
    fit_amplitude_um: float | None
    indirect_amplitude_um: float | None


@dataclass(frozen=True)
class Crosscheck:
    squareness: Squareness | None


@dataclass(frozen=True)
class Tried:
    """A candidate of the loop; ``refused`` says why it was not accepted."""

    effect: str
    delta_bic: float
    p_value: float
    rms_um: float | None
    parameters: list[Parameter]
    refused: str | None


@dataclass(frozen=True)
class Round:
    """One effect that entered the model."""

    accepted: str
    ambiguous_with: list[str]
    before_rms_um: float | None
    after_rms_um: float | None
    before_rms_urad: float | None
    after_rms_urad: float | None
    before_holdout_rms_um: float | None
    after_holdout_rms_um: float | None
    delta_bic: float
    p_value: float
    parameters: list[Parameter]
    candidates: list[Tried]


@dataclass(frozen=True)
class Unnamed:
    """What is left and has no name: how much, where, on which clock."""

    p_value: float
    profile: str
    from_mm: float
    to_mm: float
    clock: str
    log_evidence: dict[str, float]
    correlation_length: float
    correlation_unit: str
    dominant_period_mm: float | None
    odd_share: float | None
    rms_um: float | None = None
    pv_um: float | None = None
    rms_urad: float | None = None
    pv_urad: float | None = None


@dataclass(frozen=True)
class NotTestable:
    effect: str
    needs: str


@dataclass(frozen=True)
class NotSeparable:
    effect: str
    same_as: str


@dataclass(frozen=True)
class LimitAtShape:
    """The size found with 80 % probability at one shape, in the unit of its DetectionLimit."""

    shape: float
    value: float


@dataclass(frozen=True)
class DetectionLimit:
    """The size an effect must have to be found with 80 % probability, at the middle shape."""

    effect: str
    parameter: str
    unit: str
    value: float
    at: str
    by_shape: list[LimitAtShape]


@dataclass(frozen=True)
class Trace:
    """The closed loop. ``verdict`` is "nothing_missing", "explained", "ambiguous", "unnamed" or
    "not_identifiable"."""

    verdict: str
    rounds: list[Round]
    unnamed: Unnamed | None
    advice: list[str]
    not_testable: list[NotTestable]
    not_separable: list[NotSeparable]
    refused: list[Tried]
    detection_limits: list[DetectionLimit]
    lack_of_fit_p: float
    notes: list[str]


@dataclass(frozen=True)
class Model:
    """Residual and parameters of the declared model, or of that with the accepted effects."""

    rms_um: float | None
    rms_urad: float | None
    parameters: list[Parameter]


@dataclass(frozen=True)
class Report:
    """All that is found in one problem; ``print(report)`` is the program's text."""

    schema: str
    version: str
    title: str
    inputs: list[Input]
    closure: Closure | None
    travel: Travel | None
    low_band: LowBand
    ranking: list[Ranking]
    candidate_correlations: list[CandidateCorrelation]
    ranking_notes: list[str]
    dominant: Dominant
    fit: Fit | None
    crosscheck: Crosscheck
    trace: Trace | None
    before: Model | None = None
    after: Model | None = None
    # What the page shows beside, as the document has it.
    model: list[dict[str, Any]] | None = None
    setups: list[dict[str, Any]] | None = None
    options: dict[str, Any] | None = None
    straightness: dict[str, Any] | None = None
    uncertainty_budget: list[dict[str, Any]] | None = None
    what_if: list[dict[str, Any]] | None = None
    curves: dict[str, Any] | None = None
    text: str = dataclasses.field(default="", repr=False, compare=False)

    def __str__(self) -> str:
        return self.text


@functools.cache
def _fields(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


def made(kind: Any, value: Any) -> Any:
    """The value of a JSON document as the type that stands in a dataclass above."""
    if value is None:
        return None
    origin = get_origin(kind)
    if origin in (types.UnionType, Union):
        return made(get_args(kind)[0], value)
    if origin is list:
        return [made(get_args(kind)[0], each) for each in value]
    if origin is tuple:
        return tuple(value)
    if origin is np.ndarray:
        return np.asarray(value, get_args(get_args(kind)[1])[0])
    if dataclasses.is_dataclass(kind):
        hints = _fields(kind)
        return kind(**{key: made(hints[key], each) for key, each in value.items() if key in hints})
    return value
