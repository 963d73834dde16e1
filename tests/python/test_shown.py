"""How a report shows itself, and how a run is followed and left."""

import json
import os
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree

import pytest
from conftest import problem_dict, problem_file

import slideway


@pytest.fixture(scope="module")
def report():
    return slideway.identify(problem_file("demo/problem.toml"))


def test_print_is_the_box_and_repr_is_short(report):
    assert str(report).startswith("│ Verdict  Explained: ")
    assert len(str(report).splitlines()) <= 6
    assert repr(report) == f"<slideway.Report {report.title!r}, verdict 'explained'>"


def test_a_notebook_shows_a_table_and_a_picture(report):
    shown = report._repr_html_()
    for parameter in report.parameters:
        assert parameter.name in shown
    drift = next(p for p in report.parameters if p.name == "thermal_drift.amplitude_um")
    assert f"{drift.value:.3f} ± {drift.expanded_uncertainty:.3f}" in shown and "not determined" in shown
    xml.etree.ElementTree.fromstring(report._repr_svg_())
    assert report._repr_svg_() in shown


def test_what_it_saves_is_what_the_program_writes(report, program, tmp_path):
    path = problem_file("demo/problem.toml")
    program("identify", path, "--json", tmp_path / "b.json", "--html", tmp_path / "b.html")
    for ending in ("json", "html"):
        report.save(tmp_path / f"a.{ending}")
        written = (tmp_path / f"b.{ending}").read_bytes()
        assert (tmp_path / f"a.{ending}").read_bytes() == written
    report.save(tmp_path / "a.svg")
    program("report", tmp_path / "a.json", "--svg", tmp_path / "b.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    with pytest.raises(slideway.UsageError, match=r"accepted endings: \.json"):
        report.save(tmp_path / "a.pdf")


def test_parameters_become_a_data_frame(report):
    pytest.importorskip("pandas")
    table = report.parameters.to_pandas()
    assert list(table.index) == [each.name for each in report.final.parameters]
    assert table.loc["squareness.dbeta_xz", "unit"] == "rad"


def test_plot_has_two_axes(report):
    pytest.importorskip("matplotlib")
    assert len(report.plot("fine").axes) == 2
    with pytest.raises(slideway.UsageError, match="accepted: fine, coarse, outward"):
        report.plot("rough")


def test_progress_is_told_in_the_calling_thread(report):
    told = []
    slideway.identify(problem_file("demo/problem.toml"), progress=lambda *now: told.append(now))
    assert told and all(stage and 0.0 <= done <= 1.0 for stage, done in told)


def slow(t, a):
    time.sleep(0.02)
    return a * t**2


def slow_problem():
    problem, profiles = problem_dict("three-levels/problem.toml")
    return problem, profiles, {"slow": slideway.Effect(slow, {"a": "um"})}


def test_a_run_ends_at_its_time_limit():
    problem, profiles, effects = slow_problem()
    began = time.monotonic()
    with pytest.raises(TimeoutError, match="identify: not done after 0.1 s"):
        slideway.identify(problem, profiles, effects=effects, timeout=0.1)
    assert time.monotonic() - began < 0.6


WAITS = """
import time
from test_shown import slideway, slow_problem
problem, profiles, effects = slow_problem()
print("started", flush=True)
try:
    slideway.identify(problem, profiles, effects=effects)
    print("done")
except KeyboardInterrupt:
    print(time.time())
"""


def test_an_interrupt_ends_a_run_within_half_a_second():
    folder = os.path.dirname(__file__)
    child = subprocess.Popen([sys.executable, "-B", "-c", WAITS], cwd=folder,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)  # fmt: skip
    assert child.stdout.readline() == "started\n"
    time.sleep(0.2)
    sent = time.time()
    child.send_signal(signal.SIGINT)
    said, errors = child.communicate(timeout=60)
    assert child.returncode == 0, errors
    assert float(said) - sent < 0.5


def test_json_is_the_program_s(report):
    assert json.loads(report.json)["schema"] == "slideway.report/2"
