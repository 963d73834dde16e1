import numpy as np
import pytest

import slideway

TRUE_SQUARENESS = 2.8e-6
PROBLEM = {
    "machine": {"lever": "paper"},
    "profile": [
        {
            "name": "feed2",
            "kind": "face",
            "quantity": "height",
            "position_unit": "mm",
            "value_unit": "um",
            "cut_radius_mm": 100.0,
            "feed_mm_per_min": 2.0,
            "cut_direction": "inward",
            "free": ["offset"],
        },
        {
            "name": "level",
            "kind": "slide",
            "quantity": "slope",
            "position_unit": "mm",
            "value_unit": "urad",
            "window": [0.0, 100.0],
            "free": ["offset"],
        },
    ],
    "effect": [{"name": "squareness"}, {"name": "straightness", "degree": 3}],
    "truth": {
        "seed": 7,
        "samples": 4000,
        "noise_um": 0.01,
        "parameters": {"squareness.dbeta_xz": TRUE_SQUARENESS, "straightness.b2": 2.29e-8},
    },
}
FILE = """
[machine]
lever = "paper"
[[profile]]
name = "feed2"
file = "feed2.csv"
kind = "face"
quantity = "height"
position_unit = "mm"
value_unit = "um"
cut_radius_mm = 100.0
feed_mm_per_min = 2.0
cut_direction = "inward"
free = ["offset"]
[[profile]]
name = "level"
file = "level.csv"
kind = "slide"
quantity = "slope"
position_unit = "mm"
value_unit = "urad"
window = [0.0, 100.0]
free = ["offset"]
[[effect]]
name = "squareness"
[[effect]]
name = "straightness"
degree = 3
[truth]
seed = 7
samples = 4000
noise_um = 0.01
parameters = { "squareness.dbeta_xz" = 2.8e-6, "straightness.b2" = 2.29e-8 }
"""


@pytest.mark.parametrize("seed", [None, 8, 2**64 - 1])
def test_numbers_are_those_of_the_program_s_files(seed, tmp_path, program):
    problem = tmp_path / "truth.toml"
    problem.write_text(FILE)
    seeds = [] if seed is None else ["--seed", seed]
    program("simulate", problem, "--out", tmp_path / "out", *seeds)
    for given in (problem, PROBLEM):
        profiles = slideway.simulate(given, seed=seed)
        assert list(profiles) == ["feed2", "level"]
        for name, profile in profiles.items():
            written = np.loadtxt(tmp_path / "out" / f"{name}.csv", delimiter=",", skiprows=1)
            np.testing.assert_array_equal(profile.position, written[:, 0])
            # the files have twelve digits
            np.testing.assert_allclose(profile.value, written[:, 1], rtol=1e-11)
    assert profiles["level"].unit == "urad" and profiles["feed2"].unit == "um"


def test_what_was_simulated_is_identified():
    profiles = slideway.simulate(PROBLEM)
    problem = {key: value for key, value in PROBLEM.items() if key != "truth"}
    report = slideway.identify(
        problem, {name: (p.position, p.value) for name, p in profiles.items()}, trace=False
    )
    (squareness,) = (p for p in report.final.parameters if p.name == "squareness.dbeta_xz")
    # four standard uncertainties: 6 in 100 000 seeds, and this one is fixed
    assert abs(squareness.value - TRUE_SQUARENESS) < 4 * squareness.standard_uncertainty


def test_a_seed_makes_the_noise():
    first = slideway.simulate(PROBLEM, seed=1)["feed2"].value
    np.testing.assert_array_equal(first, slideway.simulate(PROBLEM, seed=1)["feed2"].value)
    difference = first - slideway.simulate(PROBLEM, seed=2)["feed2"].value
    # of 4000 values the standard deviation is known to 1.1 %; four times that
    assert np.std(difference) == pytest.approx(0.01 * np.sqrt(2), rel=0.045)


def test_what_can_not_be_simulated_is_refused():
    problem = {key: value for key, value in PROBLEM.items() if key != "truth"}
    with pytest.raises(slideway.UsageError, match=r"problem: no \[truth\]"):
        slideway.simulate(problem)
    for seed in (-1, 2**64):
        with pytest.raises(slideway.UsageError, match="seed: .* out of range; accepted: 0 to"):
            slideway.simulate(PROBLEM, seed=seed)
