"""bench/workshop against published formulas: geometry of the cut, of the ball, of the filters."""

import json
import subprocess
import sys
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "bench" / "workshop"))
sys.dont_write_bytecode = True

import noise  # noqa: E402
import score  # noqa: E402
import table  # noqa: E402
import workshop  # noqa: E402
from shop import Case, Hidden, carriage, draw_shop, polynomial_way, write  # noqa: E402
from surface import Cut, Pass, Trace, cut_face, rolled_ball, traced  # noqa: E402


def still(tool):
    return np.zeros_like(tool.r)


def at(r):
    return Pass(r, r * 0, r, r, r)


class Surface(unittest.TestCase):
    CUT = Cut(radius=50.0, feed=0.1, rpm=600.0, inward=True, nose=0.8)

    def test_scallop_of_a_round_nose_is_f_squared_over_8_r(self):
        # e.g. Boothroyd, Knight, Fundamentals of Metal Machining: R_max = f^2 / (8 r); exact to f^2/(16 r^2)
        r = np.linspace(20, 21, 20001)
        height = cut_face(self.CUT, still, r, 0 * r)
        published = 1000 * 0.1**2 / (8 * 0.8)
        self.assertAlmostEqual(height.max() - height.min(), published, delta=published * 0.1**2 / (16 * 0.8**2) * 1.1)

    def test_mean_height_of_the_scallops_is_a_third_of_their_height(self):
        trace = Trace(np.linspace(10, 40, 301))
        mean = traced(self.CUT, still, [], trace).mean()
        self.assertAlmostEqual(mean, 1000 * 0.1**2 / (8 * 0.8) / 3, delta=0.01)  # 24 points a groove: 1/24^2

    def test_groove_lies_half_a_feed_further_on_the_other_side(self):
        r = np.array([50 - 0.1 * 200, 50 - 0.1 * 200.5])
        here = cut_face(self.CUT, still, r, np.zeros(2))
        there = cut_face(self.CUT, still, r, np.full(2, np.pi))
        self.assertTrue(np.allclose([here[0], there[1]], 0, atol=1e-9))
        self.assertGreater(min(here[1], there[0]), 1)

    def test_cutting_distance_is_area_over_feed(self):
        end = self.CUT.at(np.array([500.0]), np.zeros(1))
        self.assertAlmostEqual(float(end.metres[0]), np.pi * 50**2 / 0.1 / 1000, places=9)
        self.assertAlmostEqual(float(end.seconds[0]), 50.0, places=9)  # 500 turns at 600 rpm

    def test_ball_reads_cusps_at_their_height_and_grooves_never_too_low(self):
        step = 0.1 / 64
        r = 20 + step * np.arange(4000)
        height = cut_face(self.CUT, still, r, 0 * r)
        path = rolled_ball(height, step, 0.5)
        self.assertTrue(np.all(path >= height))
        self.assertEqual(path.max(), height.max())

    def test_lever_of_the_paper_gives_one_minus_k_of_each_power(self):
        shop = replace(draw_shop(np.random.default_rng(1)), lever="paper", degree=3, bow=(2.0, 1.0),
                       squareness=5e-6, radius=100.0)
        height = carriage(shop, polynomial_way(shop))(at(np.array([50.0])))
        self.assertAlmostEqual(float(height[0]), -1 * 2.0 / 4 - 2 * 1.0 / 8 - 5e-3 * 50, places=12)


class Noise(unittest.TestCase):
    def test_gaussian_filter_passes_half_at_its_cutoff(self):  # ISO 16610-21
        n = np.arange(4000)
        wave = np.cos(2 * np.pi * n / 50)
        passed = noise.gaussian_filter(wave, 50.0)[500:3500]
        self.assertAlmostEqual(passed.max(), 0.5, delta=0.01)  # kernel cut at one cutoff: 0.76 % (the norm)

    def test_exponential_texture_has_its_correlation_length(self):
        values = noise.exponential(np.random.default_rng(2), 100000, 10.0)
        self.assertAlmostEqual(np.mean(values[10:] * values[:-10]) / values.var(), np.exp(-1), delta=0.05)

    def test_one_over_f_has_the_slope_it_is_asked_for(self):
        for alpha in (0.7, 1.5):
            density = np.zeros(501)
            for seed in range(60):
                values = noise.one_over_f(np.random.default_rng(seed), 1000, alpha) * np.hanning(1000)
                density += np.abs(np.fft.rfft(values)) ** 2
            slope = np.polyfit(np.log(np.arange(5, 400)), np.log(density[5:400]), 1)[0]
            self.assertAlmostEqual(-slope, alpha, delta=0.12)

    def test_every_noise_has_the_standard_deviation_one(self):
        rng = np.random.default_rng(3)
        for make in (noise.white, noise.torn, noise.random_walk, noise.texture):
            self.assertAlmostEqual(np.mean([make(rng, 1400).std() for _ in range(50)]), 1, delta=0.15)


class Classes(unittest.TestCase):
    def test_every_class_makes_profiles_within_the_stated_ranges(self):
        for name in workshop.CLASSES:
            with self.subTest(name):
                case = workshop.make(name, 3, 0)
                self.assertTrue(600 <= case.shop.points <= 1400 and 40 <= case.shop.radius <= 300)
                for one in case.profiles:
                    self.assertTrue(np.isfinite(one.z).all() and len(one.z) == case.shop.points)

    def test_a_seed_gives_the_same_bytes_and_a_draw_another_noise(self):
        with tempfile.TemporaryDirectory() as folder:
            texts = []
            for number, draw in enumerate([0, 0, 1]):
                write(workshop.make("joint", 5, draw), Path(folder, str(number)), "joint")
                texts.append([Path(folder, str(number), f).read_text() for f in ("problem.toml", "cut2.csv")])
        self.assertEqual(texts[0], texts[1])
        self.assertEqual(texts[0][0], texts[2][0])
        self.assertNotEqual(texts[0][1], texts[2][1])


REPORT = {
    "crosscheck": {"profiles": []},
    "final": {"parameters": [
        {"name": "squareness.dbeta_xz", "value": 1.1e-5, "expanded_uncertainty": 2e-6, "identifiable": True},
        {"name": "slide_periodic.amplitude_um", "value": -0.5, "expanded_uncertainty": 0.1, "identifiable": True}]},
    "trace": {
        "verdict": "ambiguous",
        "rounds": [{"accepted": "feed_marks", "ambiguous_with": []},
                   {"accepted": "slide_periodic", "ambiguous_with": ["time_periodic"]},
                   {"accepted": "step", "ambiguous_with": [], "profiles": ["cut2"]}],
        "blunders": [{"profile": "cut2", "what": "wrong sign"}],
        "detection_limits": [{"effect": "slide_periodic", "value": 0.01, "by_shape": [
            {"shape": 1.0, "value": 0.01}, {"shape": 100.0, "value": 0.04}], "squareness_rad": -3e-6},
            {"effect": "step", "value": 0.1, "by_shape": [], "squareness_rad": None}]}}


class Score(unittest.TestCase):
    def test_report_is_held_against_the_truth(self):
        hidden = Hidden(("slide_periodic",), "amplitude_um", 0.52, 10.0)
        shop = replace(draw_shop(np.random.default_rng(1)), squareness=1e-5)
        found = score.judge(REPORT, Case(shop, [], [hidden]))
        self.assertEqual(found["wrong"], ["step", "wrong sign of cut2"])
        self.assertEqual([one["name"] for one in found["names"]],
                         ["slide_periodic", "step", "wrong sign of cut2"])
        self.assertAlmostEqual(found["dbeta"]["error"], 1e-6)
        self.assertEqual(found["dbeta"]["unseen"], 3e-6)
        one = found["hidden"][0]
        self.assertTrue(one["in_set"] and not one["alone"])
        self.assertAlmostEqual(one["limit"], 0.02)  # half way between by logarithms
        self.assertAlmostEqual(one["found"]["error"], -0.02)

    def test_cut_of_an_effect_is_read(self):
        case = Case(draw_shop(np.random.default_rng(1)), [], [Hidden(("step",), cuts=("cut2",))])
        self.assertTrue(score.judge(REPORT, case)["hidden"][0]["with_cut"])

    def test_blunder_is_right_only_in_its_profile(self):
        shop = draw_shop(np.random.default_rng(1))
        for cut, said in (("cut2", True), ("cut1", False)):
            hidden = Hidden((), cuts=(cut,), words=r"\bsign\b")
            self.assertEqual(score.judge(REPORT, Case(shop, [], [hidden]))["hidden"][0]["alone"], said)


def record(name, seed, error, **changes):
    group = workshop.CLASSES[name][0]
    return {"class": name, "group": group, "seed": seed, "draw": 0, "status": "done", "seconds": 1.0,
            "verdict": "nothing_missing", "names": [], "wrong": [], "hidden": [], "apart": [],
            "dbeta": {"error": error, "U": 1.0, "unseen": 1.0}} | changes


class Table(unittest.TestCase):
    def test_rows_count_and_name_the_worst_case(self):
        step = {"name": "step", "rivals": [], "profiles": []}
        named = {"verdict": "explained", "names": [step], "wrong": ["step"]}
        cases = [record("white", 1, 0.5), record("white", 2, 1.5, **named), record("torn", 3, 0.1),
                 record("torn", 4, 2.5, **named), {**record("kink", 5, 0), "status": "failed", "message": "m"}]
        page = table.page([json.loads(json.dumps(case)) for case in cases])
        self.assertIn("| clean: a wrong name alone | ≤ 1 % | 2 of 4 (50.0 %) | `torn 4`, Δβxz 2.5 U off |", page)
        self.assertIn("| `white` | 2 | 1 nothing_missing, 1 explained | 1 | 1 |  |  | 1/2 | 1.0 | 1.0 |", page)
        self.assertIn("unseen effects may move it | never | 1 of 4 (25.0 %) | `torn 4`, Δβxz 2.5 U off |", page)
        self.assertIn("| failed: m | 1 | `kink 5` |", page)

    def test_stability_counts_the_statement_said_most_often(self):
        cases = [record("white", 1, 0, group="stability", verdict=v) for v in ["unnamed"] * 3 + ["ambiguous"]]
        self.assertIn("3 of 4 (75.0 %) | unnamed; 2 statements |", table.page(cases))


PROGRAM = """#!/usr/bin/python3
import pathlib, sys
_, command, problem, quiet, json, out = sys.argv
text = pathlib.Path(problem).read_text()
if "surface" in text:
    sys.exit("slideway: problem.toml:28: profile.surface: unknown key")
pathlib.Path(out).write_text('{report}')
"""


class Run(unittest.TestCase):
    def test_records_of_a_program_become_a_table(self):
        with tempfile.TemporaryDirectory() as folder:
            program, records = Path(folder, "program"), Path(folder, "records.jsonl")
            program.write_text(PROGRAM.replace("{report}", json.dumps(REPORT)))
            program.chmod(0o755)
            command = [sys.executable, "-B", workshop.__file__]
            subprocess.run([*command, "run", "--classes", "white,two_lobes", "--cases", "2", "--jobs", "2",
                            "--program", program, "--out", records], check=True)
            table = subprocess.run([*command, "table", records], check=True, capture_output=True, text=True)
        self.assertIn("| clean: a wrong name alone | ≤ 1 % | 2 of 2 (100.0 %) | `white 100", table.stdout)
        self.assertIn("| failed: slideway: problem.toml:28: profile.surface: unknown key | 2 | `two_lobes 1000` |",
                      table.stdout)


if __name__ == "__main__":
    unittest.main()
