"""An effect that is a function of arrays."""

import numpy as np
import pytest

import slideway

RADIUS, FEED = 10.0, 2.0
SIZE, START, RATE = 0.4, 40.0, 60.0  # um, s, s


def coolant(t, a, t0, tau):
    return a * (1.0 - np.exp(-np.maximum(t - t0, 0.0) / tau))


EFFECT = slideway.Effect(
    coolant,
    {"a": "um", "t0": ("s", 0.0, 100.0), "tau": ("s", 5.0, 600.0)},
    cause="coolant switched on",
)


def face(feed, seed):
    """A cone of 20 urad, the coolant and 0.01 um of white noise; cut inward."""
    r = np.linspace(0.0, RADIUS, 4000)
    t = (RADIUS - r) / feed * 60.0
    noise = np.random.default_rng(seed).normal(0.0, 0.01, r.size)
    return r, -20.0e-3 * r + coolant(t, SIZE, START, RATE) + noise


def problem():
    profile = {
        "kind": "face",
        "position_unit": "mm",
        "value_unit": "um",
        "cut_radius_mm": RADIUS,
        "spindle_rpm": 110.0,
        "cut_direction": "inward",
        "free": ["offset"],
    }
    return {
        "machine": {"lever": "paper"},
        "low_band": {"level": 4},
        "profile": [
            profile | {"name": "slow", "feed_mm_per_min": FEED},
            profile | {"name": "fast", "feed_mm_per_min": 4.0 * FEED},
        ],
        "effect": [{"name": "squareness"}],
        "trace": {"candidates": ["linear_drift", "thermal_drift", "tool_wear", "cup"]},
    }


def test_the_loop_names_it_with_its_parameters():
    report = slideway.identify(
        problem(), {"slow": face(FEED, 1), "fast": face(4.0 * FEED, 2)}, effects={"coolant": EFFECT}
    )
    assert [each.accepted for each in report.trace.rounds] == ["coolant"]
    found = {each.name: each for each in report.trace.rounds[0].parameters}
    for name, truth in [("a", SIZE), ("t0", START), ("tau", RATE)]:
        each = found[f"coolant.{name}"]
        # 6e-5 of right results are farther off, and the seeds are fixed.
        assert abs(each.value - truth) <= 4.0 * each.standard_uncertainty


def test_what_does_not_fit_is_refused():
    faces = {"slow": face(FEED, 1), "fast": face(4.0 * FEED, 2)}

    def refused(function, parameters):
        with pytest.raises(slideway.UsageError) as error:
            slideway.identify(
                problem(), faces, effects={"own": slideway.Effect(function, parameters)}
            )
        return str(error.value)

    assert "'own'" in refused(lambda T, a: a * T, {"a": "um"})
    assert "no argument 'b'" in refused(lambda t, a: a * t, {"a": "um", "b": "um"})
    assert "tau" in refused(lambda t, a, tau: a * np.exp(-t / tau), {"a": "um", "tau": "s"})
    for name in ("step", "formula"):
        with pytest.raises(slideway.UsageError, match="name of another effect"):
            slideway.identify(problem(), faces, effects={name: EFFECT})
    assert "not finite" in refused(lambda r, a: a / np.where(r > 5, r - r, r + 1), {"a": "um"})


def test_an_error_of_the_function_is_the_callers():
    with pytest.raises(ZeroDivisionError):
        slideway.identify(
            problem(),
            {"slow": face(FEED, 1), "fast": face(4.0 * FEED, 2)},
            effects={"own": slideway.Effect(lambda t, a: a * t * (1 // 0), {"a": "um"})},
        )
