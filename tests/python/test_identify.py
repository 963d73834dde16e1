import copy
import dataclasses
import json
import threading
import time

import numpy as np
import pytest
from conftest import ROOT, problem_dict, problem_file

import slideway


def as_json(report):
    """The report as the program would write it: arrays as lists, no text."""
    document = json.loads(
        json.dumps(dataclasses.asdict(report), default=lambda array: array.tolist())
    )
    del document["text"], document["json"]
    return document


@pytest.mark.parametrize("name", ["three-levels/problem.toml", "paper-face-10mm/problem.toml"])
def test_identify_is_the_program_s_report(name, program_json, program):
    report = slideway.identify(problem_file(name))
    assert as_json(report) == program_json("identify", problem_file(name))
    assert report.trace is not None
    said = program("identify", problem_file(name))
    assert report.text == said
    assert str(report) == said[: said.index("\n\n")]


def test_rank_is_the_program_s_report(program_json):
    path = problem_file("paper-600mm/problem.toml")
    report = slideway.rank(path)
    assert as_json(report) == program_json("rank", path)
    assert report.declared is None and report.final is None and report.trace is None


def test_slopes_give_the_same_report(program_json):
    path = problem_file("milling-machine-way/problem.toml")
    assert as_json(slideway.identify(path)) == program_json("identify", path)


def test_types_are_those_the_dataclasses_declare():
    report = slideway.identify(problem_file("three-levels/problem.toml"), trace=False)
    running = report.ranking[0].running
    assert running.samples.dtype == np.int64
    assert running.raw.dtype == running.low_band.dtype == np.float64
    assert running.samples.shape == running.raw.shape
    assert 0 < len(running.low_band) <= len(running.raw)
    assert running.raw[-1] == report.ranking[0].raw
    assert running.low_band[-1] == pytest.approx(report.ranking[0].low_band, rel=1e-12)
    assert report.trace is None and report.declared.parameters == report.final.parameters
    for name, first, coefficient in report.final.correlations:
        assert isinstance(name, str) and isinstance(first, str)
        assert -1 <= coefficient <= 1


def without_origin(report):
    """All but where the numbers came from."""
    document = as_json(report)
    for entry in document["inputs"]:
        for key in ("file", "format", "sha256", "notes"):
            del entry[key]
    return document


@pytest.mark.parametrize("name", ["three-levels/problem.toml", "milling-machine-way/problem.toml"])
def test_dict_and_arrays_give_what_the_files_give(name):
    problem, profiles = problem_dict(name)
    untouched = copy.deepcopy(problem)
    report = slideway.identify(problem, profiles, trace=False)
    assert without_origin(report) == without_origin(
        slideway.identify(problem_file(name), trace=False)
    )
    assert problem == untouched
    assert {entry.file for entry in report.inputs} == {"arrays"}


def test_arrays_take_the_place_of_the_problem_file_s_files():
    path = problem_file("three-levels/problem.toml")
    _, profiles = problem_dict("three-levels/problem.toml")
    position, value = profiles["z50"]
    report = slideway.rank(path, {"z50": (position, 2 * value)})
    before = slideway.rank(path)
    files = {entry.name: entry.file for entry in report.inputs}
    assert files["z50"] == "arrays" and files["z0"] != "arrays"
    rms = {entry.name: entry.rms_um for entry in report.inputs}
    for entry in before.inputs:
        factor = 2 if entry.name == "z50" else 1
        assert rms[entry.name] == pytest.approx(factor * entry.rms_um, rel=1e-14)


def test_units_of_arrays_are_those_of_the_profile():
    problem, profiles = problem_dict("three-levels/problem.toml")
    expected = slideway.rank(problem, profiles)
    for profile in problem["profile"]:
        profile.update(position_unit="m", value_unit="nm")
    metres = {name: (x / 1e3, z * 1e3) for name, (x, z) in profiles.items()}
    ranking = slideway.rank(problem, metres).ranking
    for ours, theirs in zip(ranking, expected.ranking, strict=True):
        assert ours.low_band == pytest.approx(theirs.low_band, rel=1e-9)


def test_anything_that_is_an_array_is_taken():
    problem, profiles = problem_dict("milling-machine-way/problem.toml")
    expected = as_json(slideway.rank(problem, profiles))
    lists = {name: (x.tolist(), z.tolist()) for name, (x, z) in profiles.items()}
    assert as_json(slideway.rank(problem, lists)) == expected
    strided = {name: (np.repeat(x, 2)[::2], np.repeat(z, 3)[::3]) for name, (x, z) in profiles.items()}
    assert as_json(slideway.rank(problem, strided)) == expected
    problem["low_band"] = {key: np.array(value)[()] for key, value in problem["low_band"].items()}
    assert as_json(slideway.rank(problem, profiles)) == expected


def test_nan_is_a_missing_point():
    problem, profiles = problem_dict("three-levels/problem.toml")
    profiles["z0"][1][100:103] = np.nan
    report = slideway.rank(problem, profiles)
    assert report.inputs[0].missing == 3


BAD_PROBLEMS = [
    (lambda p: p["machine"].pop("lever"), r"^problem: machine\.lever: missing; a face needs it"),
    (lambda p: p.update(efect=[]), r"^problem: efect: unknown key \(did you mean 'effect'\?\)"),
    (
        lambda p: p["profile"][1].update(feed_mm_per_min="2"),
        r"^problem: profile\[1\]\.feed_mm_per_min: must be a number, without quotes",
    ),
    (
        lambda p: p["profile"][0].pop("value_unit"),
        r"^problem: profile\[0\]\.value_unit: missing; accepted: m mm um nm inch",
    ),
    (lambda p: p["effect"][0].update(degree=2.5), r"^problem: effect\[0\]\.degree: must be a whole"),
    (lambda p: p.update(title=None), r"^problem\.title: NoneType is nothing a problem holds"),
    (lambda p: p.update({1: 2}), r"^problem: key 1 is no str"),
    (lambda p: p.update(title=b"x"), r"^problem\.title: bytes is nothing"),
    (lambda p: p["effect"][0].update(degree=2**64), r"^problem\.effect\[0\]\.degree: .* 64 bits"),
    (lambda p: p["effect"][0].update(degree=True), r"^problem: effect\[0\]\.degree: must be a"),
]


@pytest.mark.parametrize(("spoil", "message"), BAD_PROBLEMS)
def test_a_bad_dict_is_refused_by_key(spoil, message):
    problem, profiles = problem_dict("three-levels/problem.toml")
    spoil(problem)
    with pytest.raises(slideway.UsageError, match=message):
        slideway.identify(problem, profiles)


def with_array(name, position, value):
    problem, profiles = problem_dict("three-levels/problem.toml")
    return slideway.identify(problem, profiles | {name: (position, value)})


X = np.linspace(0, 50, 1000)
BAD_ARRAYS = [
    ("z1", X, X, slideway.UsageError, r"numbers for 'z1', which is no .*; accepted: z0 z50 z100"),
    ("z0", X, X[1:], slideway.DataError, r"profile 'z0': 1000 positions and 999 values"),
    ("z0", X * np.nan, X, slideway.DataError, r"profile 'z0': data row 1: the position is"),
    ("z0", X, X + np.inf, slideway.DataError, r"data row 1: too large"),
    ("z0", X, X * np.nan, slideway.DataError, r"no sample, at least 2 are needed"),
    ("z0", 0 * X, X, slideway.DataError, r"data row 2: position 0 follows 0"),
    ("z0", [], [], slideway.DataError, r"no sample"),
    ("z0", X[:, None], X, slideway.UsageError, r"positions of 'z0': an array of 2 dimensions"),
    ("z0", X, 1.0, slideway.UsageError, r"values of 'z0': an array of 0 dimensions"),
    ("z0", X, ["a"] * 1000, ValueError, r"could not convert"),
]


@pytest.mark.parametrize(("name", "position", "value", "error", "message"), BAD_ARRAYS)
def test_bad_arrays_are_refused_by_name(name, position, value, error, message):
    with pytest.raises(error, match=message):
        with_array(name, position, value)


def test_errors_are_the_program_s():
    with pytest.raises(slideway.UsageError, match="nothing.toml"):
        slideway.identify("nothing.toml")
    with pytest.raises(slideway.UsageError, match="int; accepted: path of a problem file, dict, or Problem"):
        slideway.identify(3)
    problem, _ = problem_dict("three-levels/problem.toml")
    with pytest.raises(slideway.UsageError, match="profile 'z0': no numbers; accepted: arrays, or"):
        slideway.identify(problem)
    problem["profile"][0]["file"] = "nothing.csv"
    with pytest.raises(slideway.DataError, match="profile 'z0': nothing.csv"):
        slideway.identify(problem)
    assert issubclass(slideway.UsageError, ValueError)
    assert issubclass(slideway.DataError, ValueError)


def test_files_of_a_dict_may_be_paths_relative_to_the_working_directory(monkeypatch):
    monkeypatch.chdir(ROOT / "problems" / "three-levels")
    problem, _ = problem_dict("three-levels/problem.toml")
    for profile in problem["profile"]:
        profile["file"] = ROOT / "data" / f"three-levels-{profile['name']}.csv"
    absolute = slideway.rank(problem)
    for profile in problem["profile"]:
        profile["file"] = f"../../data/three-levels-{profile['name']}.csv"
    assert slideway.rank(problem).ranking[0].raw == absolute.ranking[0].raw


def test_other_threads_run_meanwhile():
    ticks = []
    done = threading.Event()

    def tick():
        while not done.wait(0.01):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.monotonic()
    slideway.identify(problem_file("three-levels/problem.toml"))
    end = time.monotonic()
    done.set()
    thread.join()
    meanwhile = [start, *(t for t in ticks if start < t < end), end]
    # with the lock held, one gap would be all of it
    assert max(np.diff(meanwhile)) < 0.5 * (end - start)
