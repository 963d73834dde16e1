"""One result, one number: the parameters of every problem that ships as the terminal, the page, the
JSON, the export, the comparison and Python give them.

usage: agreement_test.py PROGRAM SOURCE [PYTHON_MODULE_DIR]
"""

import html
import html.parser
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
MODULE = sys.argv[3] if len(sys.argv) > 3 else None
MEASURED = os.environ.get("SLIDEWAY_DATA")
NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
PAIR = re.compile(rf"\(({NUMBER}) ± ({NUMBER})\)e([-+]\d+)|({NUMBER}) ± ({NUMBER})")
LONG = {"test-bar.toml"}  # half a minute a run: text and page of one, nothing run again


def pair(text):
    """Value and U of the first "v ± U" of a text and the last place of U; None: there is none."""
    found = PAIR.search(text)
    if not found:
        return None
    value, U = (found[1], found[2]) if found[1] else (found[4], found[5])
    power = 10.0 ** int(found[3] or 0)
    place = 10.0 ** -len(U.partition(".")[2]) if "." in U else 10.0 ** (len(U) - 2)
    return float(value) * power, float(U) * power, place * power


class Page(html.parser.HTMLParser):
    """The tables of a page: caption, then rows of cells; powers of ten as e-06, a true minus as -."""

    def __init__(self, text):
        super().__init__()
        self.tables, self.facts, self.open = {}, "", ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag == "table":
            self.rows = []
        elif tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th", "caption"):
            self.open = ""
        elif tag == "sup":
            self.open += "^"

    def handle_endtag(self, tag):
        if tag == "caption":
            self.caption = self.open
        elif tag in ("td", "th"):
            cell = self.open.replace("−", "-").replace("\u00a0", "")
            self.rows[-1].append(re.sub(r"×10\^(-?\d+)", r"e\1", cell))
        elif tag == "table":
            self.tables.setdefault(self.caption, self.rows)

    def handle_data(self, data):
        self.open += data

    def table(self, start):
        return next((rows[1:] for caption, rows in self.tables.items()
                     if caption.startswith(start)), [])


def run(*arguments, accepted=(0,)):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode in accepted, f"{arguments}: {done.stderr}"
    return done


def parameter_rows(text):
    """Cells of the table of parameters of a text report."""
    lines = iter(text.splitlines())
    heading = next((line for line in lines if line.startswith("  parameter ")), "")
    rows = []
    for line in lines:
        if not line.startswith("  ") or line.startswith("  - ") or "more parameter" in line:
            break
        cells = re.split(r" {2,}", line.strip())
        if not line.startswith("   "):
            rows.append(cells)
        elif rows:  # what does not fit goes on below
            rows[-1] += cells
        else:
            heading += line
    return heading, rows


class Agreement(unittest.TestCase):
    def same(self, text, known, unit=1.0):
        """A text says a number of the JSON, with two digits of U."""
        if known["value"] is None:
            self.assertIn("not determined", text)
            return
        said = pair(text)
        self.assertIsNotNone(said, f"{text!r} has no value ± U")
        value, U, place = said
        half = 0.500001 * place
        self.assertAlmostEqual(value, known["value"] / unit, delta=half)
        self.assertAlmostEqual(U, known["expanded_uncertainty"] / unit, delta=half)

    def check_text(self, text, report):
        known, declared = report["final"]["parameters"], report["declared"]["parameters"]
        heading, rows = parameter_rows(text)
        for row, parameter in zip(rows, known):
            self.assertIn(parameter["symbol"] or parameter["name"].rpartition(".")[2], row[0])
            self.same(row[1], parameter)
        by_name = {parameter["name"]: parameter for parameter in declared}
        for row, parameter in zip(rows, known):
            before = by_name.get(parameter["name"])
            pairs = [cell for cell in row[2:] if PAIR.search(cell)]
            if before and pairs:
                self.assertIn("declared model", heading)
                self.same(pairs[-1], before)
        return rows

    def check_box(self, text, report):
        box = [line for line in text.splitlines()[:7] if line.startswith("│")]
        self.assertLessEqual(len(box), 6)
        entries = "\n".join(box).replace("\n│          ", " ").splitlines()
        line = next(line for line in entries if line.startswith("│ Result"))
        form = report["final"]["straightness"]
        if form and form["end_point_um"] is not None:
            self.same(line.split(";")[0], {"value": form["end_point_um"],
                                           "expanded_uncertainty": form["expanded_uncertainty_um"]})
        for parameter in report["final"]["parameters"]:
            if parameter["name"].startswith("squareness.") and parameter["value"] is not None:
                self.same(line.split("squareness")[-1], parameter, unit=1e-6)

    def check_page(self, text, report):
        page = Page(text)
        final = report["final"]
        rows = page.table("Parameters of the final model")
        self.assertEqual(len(rows), len(final["parameters"]))
        for row, parameter in zip(rows, final["parameters"]):
            self.assertTrue(row[0].endswith(parameter["name"]), row[0])
            self.same(row[1], parameter)
        for row, budget in zip(page.table("Uncertainty budget"), final["uncertainty_budget"]):
            parameter = next(p for p in final["parameters"] if p["name"] == budget["parameter"])
            u = parameter["standard_uncertainty"]
            self.assertAlmostEqual(float(row[-1]), u, delta=0.06 * u)
            squares = sum(line["standard_uncertainty"] ** 2 for line in budget["lines"])
            self.assertAlmostEqual(squares / u**2, 1.0, delta=1e-9, msg=budget["parameter"])
        for row, known in zip(page.table("What the data determine instead"),
                              final["identifiability"]["determined"]):
            self.same(row[1], known)
        for row, error in zip(page.table("Straightness error"),
                              (final["straightness"] or {}).get("errors", [])):
            self.same(row[1], {"value": error["error_um"],
                               "expanded_uncertainty": error["expanded_uncertainty_um"]})
        return rows

    def check_export(self, text, report):
        final = report["final"]
        for parameter in final["parameters"]:
            if "dbeta_xz = " in text and parameter["name"].startswith("squareness."):
                line = text[text.index("dbeta_xz = "):].replace("+-", "±")
                self.same(line, parameter)
        if "X\tEZX\n" not in text:
            return
        curve = final["straightness"]["curve"]
        points = [tuple(map(float, line.split("\t")))
                  for line in text[text.index("X\tEZX\n") + 6:].splitlines()]
        self.assertAlmostEqual(points[0][0], curve["position_mm"][0], delta=1e-3)
        self.assertAlmostEqual(points[-1][0], curve["position_mm"][-1], delta=1e-3)
        if not curve["tip_um"]:  # the slide itself was read: the report's own error, in mm
            heights = [1e3 * height for _, height in points]
            error = final["straightness"]["end_point_um"]
            # A table of stations may miss the ends of a curve's bows, and a kink between two.
            self.assertAlmostEqual(max(heights) - min(heights), error, delta=0.03 * error)

    def test_every_problem(self):
        problems = sorted(SOURCE.glob("problems/*/*.toml"))
        self.assertGreater(len(problems), 8)
        for problem in problems:
            text = problem.read_text(encoding="utf-8")
            if "[[profile]]" not in text or "${SLIDEWAY_DATA}" in text and not MEASURED:
                continue
            with self.subTest(str(problem.relative_to(SOURCE))), \
                    tempfile.TemporaryDirectory() as folder:
                self.agree(problem, pathlib.Path(folder))

    def agree(self, problem, folder):
        result, page = folder / "a.json", folder / "a.html"
        data = ["--data", MEASURED] if MEASURED else []
        if "\n[truth" in problem.read_text(encoding="utf-8"):
            run("simulate", problem, "--out", folder / "simulated")
            problem = folder / "simulated" / "problem.toml"
        text = run("identify", problem, *data, "--json", result, "--html", page).stdout
        self.assertLessEqual(len(text.splitlines()), 40)
        report = json.loads(result.read_text(encoding="utf-8"))
        short = self.check_text(text, report)
        if problem.name in LONG:
            self.check_page(page.read_text(encoding="utf-8"), report)
            return
        full = self.check_text(run("identify", problem, *data, "--full").stdout, report)
        self.assertEqual(len(full), len(report["final"]["parameters"]))
        self.assertEqual([row[1] for row in full[:len(short)]], [row[1] for row in short])
        self.check_box(text, report)
        drawn = page.read_text(encoding="utf-8")
        rows = self.check_page(drawn, report)
        for said, shown in zip(full, rows):  # the same digits, too
            self.assertEqual(pair(said[1]), pair(shown[1]))
        again = folder / "b.html"
        run("report", result, "--html", again)
        self.assertEqual(drawn, again.read_text(encoding="utf-8"))
        same = json.loads(run("diff", result, result, "--json", "-").stdout)["parameters"]
        for known, compared in zip(report["final"]["parameters"], same):
            self.assertEqual((known["value"], known["value"]), (compared["a"], compared["b"]))
        exported = run("export", result, "--to", "isg", accepted=(0, 3))
        if exported.returncode == 0:
            self.check_export(exported.stdout, report)
        if MODULE:
            self.check_python(problem, run("identify", problem, *data).stdout, report)

    def check_python(self, problem, text, report):
        sys.path.insert(0, MODULE)
        import slideway
        found = slideway.identify(str(problem), data=MEASURED)
        for known, parameter in zip(report["final"]["parameters"], found.final.parameters):
            self.assertEqual(known["value"], parameter.value)
            self.assertEqual(known["expanded_uncertainty"], parameter.expanded_uncertainty)
        self.assertEqual(found.text.splitlines(), text.splitlines())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
