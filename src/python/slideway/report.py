"""The report as dataclasses, key for key as the program's ``--json`` has it.

Made of the program's own lists of members (``report_contract --update``): do not edit.

Units are in the names (``rms_um``, ``lag_mm``); a parameter has its own in ``unit``. ``None`` is a
number that could not be determined, or does not apply; of a pair such as ``rms_um`` and
``rms_urad`` the first belongs to heights, the second to slopes. A number that is not finite is NaN,
or ``None`` where that is accepted, and ``notes`` name it.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from slideway._shown import Shown


@dataclass(frozen=True)
class Assumption:
    """A key that the problem file leaves out, and what it was taken as."""

    key: str
    """as in the problem file: profile.feed2.free"""
    value: Any
    """as the problem file would have it"""
    why: str


@dataclass(frozen=True)
class Outlier:
    """A sample that its neighbours contradict."""

    row: int
    """of the data, from 1"""
    value: float
    """in `unit`"""
    expected: float
    """by its neighbours, in `unit`"""
    unit: Literal["um", "urad"]
    kind: Literal["spike", "lost minus sign"]


@dataclass(frozen=True)
class Input:
    """One profile as it was read."""

    name: str
    file: str
    """arrays: the numbers did not come from a file"""
    format: str
    sha256: str
    kind: Literal["face", "slide"]
    quantity: Literal["height", "slope"]
    role: Literal["fit", "holdout"]
    """holdout: never fitted, only predicted"""
    loss: Literal["none", "huber", "cauchy"] | None
    """none: every residual counts by its square"""
    azimuth_deg: float | None
    """of a face"""
    surface: str | None
    """as the problem names it"""
    instrument: str | None
    """as the problem names it"""
    samples: int
    missing: int
    """points of the file that have no value"""
    left_out: int
    """samples left out as the problem asks"""
    outlier_count: int
    outliers: list[Outlier]
    """the 20 largest at most, by row"""
    position_min_mm: float
    position_max_mm: float
    rms_um: float | None
    """about the mean"""
    pv_um: float | None
    rms_urad: float | None
    pv_urad: float | None
    notes: list[str]


@dataclass(frozen=True)
class Misclosure:
    """What one line reads where it meets others, against what they say."""

    profile: str
    x_mm: float
    y_mm: float
    difference_um: float | None
    """as the data stand"""
    closure_um: float | None
    """none: nothing checks it"""
    standard_uncertainty_um: float | None


@dataclass(frozen=True)
class Repeat:
    """Two profiles of one line, at the station at which they differ most."""

    a: str
    b: str
    stations: int
    x_mm: float
    y_mm: float
    difference_um: float
    standard_uncertainty_um: float
    limit: float
    """of the ratio of the two"""
    verdict: Literal["agree", "do not agree"]


@dataclass(frozen=True)
class Closure:
    """Whether lines agree where they meet."""

    verdict: Literal["closes", "does not close", "not judged"]
    lines: int
    places: int
    redundancy: int
    false_alarm: float
    limit: float | None
    """of closure_um / standard_uncertainty_um"""
    tied: bool
    """heights that a reduction has made agree"""
    readings: list[Misclosure]
    repeats: list[Repeat]
    suspects: list[str]
    """lines without any one of which the rest closes"""
    notes: list[str]


@dataclass(frozen=True)
class Travel:
    """What the fitted profiles cover of the slide, and the lever that acts on it."""

    lever: Literal["paper", "split"]
    slide_min_mm: float
    slide_max_mm: float
    spindle_position_mm: float | None
    """none: no face was fitted"""
    overhang_mm: float | None
    """none: no face was fitted, or faces of several overhangs"""


@dataclass(frozen=True)
class LowBand:
    """The low band of one profile."""

    profile: str
    wavelet: str
    level: int
    """0: no low band, the profile as it is"""
    boundary: Literal[
        "zero", "constant", "symmetric", "periodic", "smooth", "periodization", "reflect", "antisymmetric", "antireflect"
    ]
    values: int


@dataclass(frozen=True, eq=False)
class Running:
    """Coefficients over a growing part of the trace, Figs. 8 and 9."""

    samples: NDArray[np.int64]
    """`raw` is the coefficient of the first so many"""
    position_mm: NDArray[np.float64]
    """of the last of them"""
    raw: NDArray[np.float64]
    low_band_position_mm: NDArray[np.float64]
    """to which each value of `low_band` reaches"""
    low_band: NDArray[np.float64]


@dataclass(frozen=True)
class Ranking:
    """Pearson's coefficient of an effect and a profile, Eqs. (6), (19), (20)."""

    effect: str
    profile: str
    raw: float
    low_band: float
    lag_mm: float
    """at which the low-band coefficient is largest"""
    lag_coefficient: float
    effective_observations: float
    p_value: float
    """of `low_band`"""
    running: Running


@dataclass(frozen=True)
class CandidateCorrelation:
    """Correlation of two effects' signals on one profile."""

    a: str
    b: str
    profile: str
    coefficient: float


@dataclass(frozen=True)
class Dominant:
    """The effect with the largest part."""

    by_correlation: str | None
    by_fit: str | None
    agree: bool | None
    doubt: str
    """why none is named"""


@dataclass(frozen=True)
class Parameter:
    """A parameter: value ± expanded_uncertainty, in `unit`."""

    name: str
    symbol: str
    standard_name: str
    value: float | None
    """none: not determined"""
    unit: str
    standard_uncertainty: float | None
    expanded_uncertainty: float | None
    """coverage_factor * standard_uncertainty, 95.45 % coverage"""
    coverage_factor: float | None
    """Student's, for degrees_of_freedom"""
    degrees_of_freedom: float | None
    """none beside a coverage_factor: infinitely many"""
    identifiable: bool
    at_bound: bool
    if_no: list[str]
    """effects that have the same columns in these data: it holds if none of them acts"""


@dataclass(frozen=True)
class StraightnessStation:
    """Height of the slide where it was read."""

    position_mm: float
    """of a reading, or of a foot of a bridge"""
    deviation_um: float
    """from the end-point line"""
    expanded_uncertainty_um: float | None


@dataclass(frozen=True)
class StraightnessError:
    """Largest positive minus largest negative deviation from a reference line, ISO 230-1."""

    line: Literal["end-point", "least squares", "minimum zone"]
    error_um: float | None
    standard_uncertainty_um: float | None
    expanded_uncertainty_um: float | None
    coverage_factor: float | None
    degrees_of_freedom: float | None
    highest_um: float
    highest_at_mm: float
    lowest_um: float
    lowest_at_mm: float


@dataclass(frozen=True, eq=False)
class StraightnessCurve:
    """The slide's form over the travel that was measured, from the end-point line."""

    position_mm: NDArray[np.float64]
    """slide coordinate x"""
    deviation_um: NDArray[np.float64]
    expanded_uncertainty_um: NDArray[np.float64]
    """of the deviation"""
    tip_um: NDArray[np.float64]
    """of faces: at the tool tip, with the pitch on its lever"""
    tip_expanded_uncertainty_um: NDArray[np.float64]
    tip_slope_rad: float | None
    """of the line through the ends of the tip's curve"""


@dataclass(frozen=True)
class CurveForm:
    """The process a curve is described by: a Matérn covariance."""

    length_mm: float
    amplitude_um: float
    """its standard deviation"""
    roughness: float
    """its exponent: 1.5 or 2.5"""


@dataclass(frozen=True)
class StraightnessOfPart:
    """E_ZX of one of several forms."""

    profiles: list[str]
    """whose form it is"""
    end_point_um: float | None
    expanded_uncertainty_um: float | None


@dataclass(frozen=True)
class Straightness:
    """Straightness error of the slide, E_ZX, ISO 230-1."""

    end_point_um: float | None
    least_squares_um: float | None
    minimum_zone_um: float | None
    expanded_uncertainty_um: float | None
    """of end_point_um"""
    stations: list[StraightnessStation]
    """of slides"""
    errors: list[StraightnessError]
    """one for each reference line"""
    curve: StraightnessCurve
    form: CurveForm | None
    """of a curve"""
    parts: list[str]
    """effects besides the straightness whose forms are in it"""
    if_no: list[str]
    """effects that have the same columns in these data: it holds if none of them acts"""
    reason: str
    """why there is none"""
    profiles: list[str]
    """of several forms: whose this one is, the worst"""
    each: list[StraightnessOfPart]
    """of several forms: all of them"""


@dataclass(frozen=True)
class Undetermined:
    """A direction in parameter space along which no prediction changes."""

    combination: dict[str, float]
    advice: str
    """what would determine it"""


@dataclass(frozen=True)
class Determined:
    """What the data say of parameters they cannot tell apart."""

    combination: dict[str, float]
    value: float | None
    unit: str
    standard_uncertainty: float | None
    expanded_uncertainty: float | None
    coverage_factor: float | None
    degrees_of_freedom: float | None


@dataclass(frozen=True)
class Identifiability:
    """What the data determine, and what they do not."""

    parameters: int
    rank: int
    condition: float
    """of the scaled columns within the rank"""
    unidentifiable: list[Undetermined]
    determined: list[Determined]


@dataclass(frozen=True)
class Noise:
    """The noise of one profile as the fit has it."""

    profile: str
    scaling: Literal["declared", "estimated", "estimated: the declared uncertainty is too small"]
    correlated: bool
    """texture or long memory, not white"""
    unlike_sisters: float | None
    """size over that of the profiles it shares its memory with, where it differs"""
    standard_deviation_um: float | None
    """of one low-band value"""
    standard_deviation_urad: float | None
    correlation_mm: float
    """integral correlation length"""
    effective_observations: float
    ljung_box_p: float
    """of the whitened residual"""


@dataclass(frozen=True)
class Contribution:
    """An effect's part of a profile's low band."""

    effect: str
    profile: str
    rms_um: float | None
    """of what levelling leaves of it"""
    rms_urad: float | None
    share: float
    """of the sum of mean squares of all effects"""


@dataclass(frozen=True)
class Residual:
    """Residual of one profile in the low band."""

    profile: str
    role: Literal["fit", "holdout"]
    rms_um: float | None
    pv_um: float | None
    rms_urad: float | None
    pv_urad: float | None


@dataclass(frozen=True)
class BudgetLine:
    """What one source contributes to an uncertainty."""

    source: str
    type: Literal["A", "B"]
    """GUM 3.3.4: A by statistics, B otherwise"""
    standard_uncertainty: float


@dataclass(frozen=True)
class Budget:
    """Uncertainty budget of one parameter: squares of the lines add up to u²."""

    parameter: str
    unit: str
    lines: list[BudgetLine]


@dataclass(frozen=True)
class ModelResult:
    """A model and what the data say of it."""

    effects: list[str]
    converged: bool
    message: str
    """the solver's, where it did not converge"""
    rms_um: float | None
    """residual of the fitted height profiles in the low band"""
    rms_urad: float | None
    """and of the slope profiles"""
    observations: int
    effective_observations: float
    chi_square: float
    """of the whitened residual"""
    degrees_of_freedom: float
    parameters: list[Parameter]
    nuisances: list[Parameter]
    """levelling of the traces"""
    straightness: Straightness | None
    """none: the model has none"""
    correlations: list[tuple[str, str, float]]
    """of the estimates, from 0.1 on"""
    identifiability: Identifiability
    noise: list[Noise]
    contributions: list[Contribution]
    residuals: list[Residual]
    uncertainty_budget: list[Budget]
    """empty where it was not asked for"""
    neglected_um: float | None
    """largest second-order term at the fitted values"""
    implausible: str
    """why no slide makes the fitted straightness"""
    notes: list[str]


@dataclass(frozen=True)
class SquarenessCheck:
    """Squareness of the final model against the run-out, Eq. (21)."""

    fit_rad: float | None
    fit_U_rad: float | None
    indirect_rad: float | None
    indirect_U_rad: float | None
    En: float | None
    verdict: Literal["consistent", "inconsistent", "not_available"]
    reason: str
    travel_mm: float | None
    """over which the squareness acts"""
    fit_amplitude_um: float | None
    indirect_amplitude_um: float | None


@dataclass(frozen=True, eq=False)
class ProfileCheck:
    """One quantity from each of several profiles that should agree."""

    profiles: list[str]
    what: str
    En: float | None
    verdict: Literal["consistent", "inconsistent", "not_available"]
    chi2: float | None
    """per degree of freedom, over all effects"""
    p_value: float | None
    value_um: NDArray[np.float64]
    """end-point straightness along the common travel by each profile alone; empty for other effects"""
    U_um: NDArray[np.float64]
    """its expanded uncertainties"""


@dataclass(frozen=True)
class HeldOutCheck:
    """Whether a held-out profile lies where the model predicts it."""

    profile: str
    chi2: float
    """per degree of freedom"""
    p_value: float
    largest_um: float | None
    largest_urad: float | None
    at_mm: float
    verdict: Literal["fits", "does not fit"]


@dataclass(frozen=True)
class PureErrorCheck:
    """What repeats have in common and the model lacks."""

    profiles: list[str]
    F: float
    p_value: float
    common_um: float | None
    """rms of the slow part in common"""
    common_urad: float | None
    apart_um: float | None
    """the same of a reading less what is in common"""
    apart_urad: float | None
    verdict: Literal["fits", "lack of fit"]


@dataclass(frozen=True)
class Crosscheck:
    """The final model against what it was not made of."""

    squareness: SquarenessCheck | None
    profiles: list[ProfileCheck]
    held_out: list[HeldOutCheck]
    repeats: list[PureErrorCheck]


@dataclass(frozen=True)
class Conformity:
    """A value against its limit, with U as guard band (ISO 14253-1)."""

    what: str
    value_um: float | None
    U_um: float | None
    limit_um: float | None
    value_um_per_m: float | None
    U_um_per_m: float | None
    limit_um_per_m: float | None
    with_left_out_um: float | None
    """of flatness, with the values that the fit leaves out, if it is larger"""
    verdict: Literal["conforms", "does not conform", "can not be decided"]
    if_no: list[str]
    """effects that have the same columns in these data: it holds if none of them acts"""


@dataclass(frozen=True)
class Fragile:
    """The smallest change of one gate that would have changed the verdict."""

    gate: str
    value: float
    verdict: Literal["nothing_missing", "explained", "ambiguous", "unnamed", "not_identifiable"]


@dataclass(frozen=True)
class Tried:
    """A candidate of the loop."""

    effect: str
    profiles: list[str]
    """those it acts in; empty: all"""
    delta_bic: float
    p_value: float
    rms_um: float | None
    parameters: list[Parameter]
    refused: str | None
    """why it was not accepted; none: a rival"""


@dataclass(frozen=True)
class Round:
    """One effect that entered the model."""

    accepted: str
    profiles: list[str]
    """those it acts in; empty: all"""
    ambiguous_with: list[str]
    before_rms_um: float | None
    after_rms_um: float | None
    before_rms_urad: float | None
    after_rms_urad: float | None
    before_holdout_rms_um: float | None
    after_holdout_rms_um: float | None
    delta_bic: float
    p_value: float
    stability: float
    """share of resamples that choose the effect"""
    parameters: list[Parameter]
    candidates: list[Tried]


@dataclass(frozen=True)
class UnnamedForm:
    """A short formula that describes what is left: no cause."""

    form: str
    formula: str
    """in um of a height, urad of a slope"""
    profiles: list[str]
    """those it describes; empty: all"""
    instead_of: str
    """the accepted effect it takes the place of; empty: none"""
    parameters: list[Parameter]
    delta_bic: float
    """against the effects as accepted"""
    before_rms_um: float | None
    after_rms_um: float | None
    before_rms_urad: float | None
    after_rms_urad: float | None
    before_holdout_rms_um: float | None
    after_holdout_rms_um: float | None
    candidate: str
    """[[trace.candidate]] of a problem file"""


@dataclass(frozen=True, eq=False)
class UnnamedCurve:
    """What is left without a name, as a curve over its variable."""

    variable: str
    unit: str
    value_unit: Literal["um", "urad"]
    at: NDArray[np.float64]
    residual: NDArray[np.float64]
    expanded_uncertainty: NDArray[np.float64]


@dataclass(frozen=True)
class Unnamed:
    """What is left and has no name: how much, where, on which clock."""

    rms_um: float | None
    pv_um: float | None
    rms_urad: float | None
    pv_urad: float | None
    has_folded_wave: bool
    """a wave is left that the low band may have folded"""
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
    forms: list[UnnamedForm]
    """formulas that describe it, best first"""
    to_confirm: str
    """what to measure before a form is taken for a cause"""
    curve: UnnamedCurve


@dataclass(frozen=True)
class BlockPrediction:
    """A single profile predicted over gaps of one length."""

    block_mm: float
    before_rms_um: float | None
    """declared model"""
    after_rms_um: float | None
    """final model"""
    before_rms_urad: float | None
    after_rms_urad: float | None


@dataclass(frozen=True)
class SharedResidual:
    """What traces of different surfaces by one instrument have in common."""

    profiles: list[str]
    correlation: float
    """of their residuals"""
    rms_um: float | None
    """of what they share"""
    rms_urad: float | None
    p_value: float
    """of as much by chance"""
    significant: bool
    """then it is the instrument's error"""
    lacked_by: list[str]
    """profiles of further surfaces: then it need not be"""


@dataclass(frozen=True)
class Blunder:
    """A slip of the hand that would make one profile agree with the others."""

    profile: str
    what: Literal[
        "wrong sign", "values 25.4 times too small", "values 25.4 times too large", "values 1000 times too small", "values 1000 times too large", "values 4.85 times too small", "values 4.85 times too large", "positions 25.4 times too small", "positions 25.4 times too large", "positions 1000 times too small", "positions 1000 times too large", "wrong cut_direction", "wrong start_s"
    ]
    delta_bic: float
    """against the profile as it is"""


@dataclass(frozen=True)
class NextCut:
    """The cut or trace to make next: the first of slideway plan."""

    name: str
    what: str
    reason: str


@dataclass(frozen=True)
class NotTestable:
    """An effect the data cannot be asked for."""

    effect: str
    needs: str


@dataclass(frozen=True)
class NotSeparable:
    """An effect whose columns are those of another here."""

    effect: str
    same_as: str


@dataclass(frozen=True)
class Left:
    """An effect that was accepted and has left the model again."""

    effect: str
    reason: str


@dataclass(frozen=True)
class LimitAtShape:
    """A detection limit at one shape."""

    shape: float
    value: float | None


@dataclass(frozen=True)
class DetectionLimit:
    """The size an effect must have to be found with 80 % probability."""

    effect: str
    parameter: str
    unit: str
    value: float | None
    """none: found at no size a workpiece has"""
    at: str
    by_shape: list[LimitAtShape]
    squareness_rad: float | None
    """the most that it moves Δβxz at any shape while its gain is just not seen"""
    straightness_um: float | None
    """the most that it moves E_ZX of the end-point line so"""


@dataclass(frozen=True)
class Trace:
    """The closed loop."""

    verdict: Literal["nothing_missing", "explained", "ambiguous", "unnamed", "not_identifiable"]
    unfinished: bool
    """the time limit ended the search: no effect is named"""
    not_looked_at: list[str]
    """what the time limit left out"""
    gates: dict[str, float]
    """the limits that were used"""
    fragile: Fragile | None
    """none: no change of one gate within its range does"""
    rounds: list[Round]
    unnamed: Unnamed | None
    cross_validation: list[BlockPrediction]
    """of a single profile"""
    gain: Literal["prediction", "interpolation"] | None
    """of the accepted effects, by cross_validation"""
    instrument: list[SharedResidual]
    """pairs of one instrument and two surfaces"""
    blunders: list[Blunder]
    """rivals, most likely first; then no effect is named"""
    advice: list[str]
    next_cut: NextCut | None
    """none: nothing is open and nothing unseen moves the squareness by more than its U"""
    not_testable: list[NotTestable]
    not_separable: list[NotSeparable]
    refused: list[Tried]
    """of the last search, best first"""
    left: list[Left]
    detection_limits: list[DetectionLimit]
    lack_of_fit_p: float
    """of the final residual"""
    searches: int
    """sets of effects whose residual was searched"""
    notes: list[str]


@dataclass(frozen=True)
class EffectInModel:
    """An effect of the final model, as the catalogue has it."""

    name: str
    standard_name: str
    formula: str
    source: str
    cause: str
    clock: str
    confounded_with: str
    separated_by: str
    added: bool
    """by the closed loop"""


@dataclass(frozen=True)
class Setup:
    """How one profile was cut and measured."""

    profile: str
    center_mm: float
    spindle_position_mm: float
    z_mm: float
    overhang_mm: float
    base_mm: float | None
    feed_mm_per_min: float | None
    spindle_rpm: float | None
    cut_direction: Literal["inward", "outward"] | None
    cut_radius_mm: float | None
    start_s: float
    traverse_mm_per_s: float | None


@dataclass(frozen=True)
class Body:
    """One body of the lower-body array, Eq. (1)."""

    name: str
    lower: int
    axis: Literal["x", "y", "z"]


@dataclass(frozen=True)
class Prior:
    """A prior of the problem file."""

    parameter: str
    value: float
    standard_uncertainty: float


@dataclass(frozen=True)
class Runout:
    """The run-out measurement of Eq. (21)."""

    r_um: float
    p_um: float
    diameter_mm: float
    standard_uncertainty_um: float


@dataclass(frozen=True)
class Options:
    """What the problem file asked for."""

    lever: Literal["paper", "split"]
    bodies: list[Body]
    priors: list[Prior]
    runout: Runout | None
    candidates: list[str]
    max_effects: int
    significance: float


@dataclass(frozen=True)
class WhatIf:
    """Flatness of a profile, measured or with effects taken out."""

    profile: str
    corrected: str
    """an effect; all; empty: as measured"""
    pv_um: float | None
    rms_um: float | None
    pv_urad: float | None
    rms_urad: float | None


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Amplitude of each frequency."""

    cycles_per_mm: NDArray[np.float64]
    amplitude: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Envelope:
    """Lowest and highest value of each of equal stretches of the trace."""

    low: NDArray[np.float64]
    high: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ProfileCurves:
    """What is drawn of one profile, in `unit`."""

    profile: str
    role: Literal["fit", "holdout"]
    unit: Literal["um", "urad"]
    first_mm: float
    last_mm: float
    position_mm: NDArray[np.float64]
    raw: NDArray[np.float64]
    low_band: NDArray[np.float64]
    model_before: NDArray[np.float64]
    """declared model, with the levelling"""
    residual_before: NDArray[np.float64]
    model_after: NDArray[np.float64]
    """final model; empty where the loop has added nothing"""
    residual_after: NDArray[np.float64]
    contribution_position_mm: NDArray[np.float64]
    effects: list[str]
    """of the final model"""
    contributions: list[NDArray[np.float64]]
    """of each effect"""
    correlation: list[NDArray[np.float64]]
    """of the effects among themselves"""
    lag_mm: float
    white_limit: float
    autocorrelation_before: NDArray[np.float64]
    autocorrelation_after: NDArray[np.float64]
    spectrum_before: Spectrum
    spectrum_after: Spectrum
    approximations: list[Envelope]
    """a_1 ..."""
    details: list[Envelope]
    """d_1 ..."""


@dataclass(frozen=True)
class Curves:
    """What is drawn."""

    profiles: list[ProfileCurves]


@dataclass(frozen=True, repr=False)
class Report(Shown):
    """All that is found in one problem."""

    schema: str
    version: str
    title: str
    about: dict[str, str]
    """[about] of the problem file"""
    assumed: list[Assumption]
    """what the problem file leaves to defaults"""
    inputs: list[Input]
    closure: Closure | None
    travel: Travel | None
    low_band: list[LowBand]
    ranking: list[Ranking]
    candidate_correlations: list[CandidateCorrelation]
    ranking_notes: list[str]
    dominant: Dominant
    declared: ModelResult | None
    """the problem as given"""
    final: ModelResult | None
    """the declared effects and those accepted: what the program stands behind"""
    crosscheck: Crosscheck
    conformity: list[Conformity]
    trace: Trace | None
    """the closed loop; none: it was not run"""
    notes: list[str]
    model: list[EffectInModel]
    setups: list[Setup]
    options: Options | None
    what_if: list[WhatIf]
    curves: Curves | None
    text: str = dataclasses.field(default="", repr=False, compare=False)
    """what the program prints"""
    json: str = dataclasses.field(default="", repr=False, compare=False)
    """what the program writes"""
