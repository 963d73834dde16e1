"""The HTML report in a real browser: Debian's chromium, driven through chromedriver.

usage: browser_test.py SLIDEWAY SOURCE_DIR; exit code 77 where there is no chromium.
"""

import base64
import csv
import itertools
import json
import math
import pathlib
import re
import subprocess
import sys
import unittest

SKIPPED = 77
PROGRAM, SOURCE = sys.argv[1:3]
sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
from accessibility import breaches  # noqa: E402
from browser import CHROMIUM, DRIVER, BrowserTest  # noqa: E402


def faces(folder):
    """Three cuts of 20 000 samples: a cone, a bow and noise that every machine makes alike."""
    problem = ['title = "Three cuts & <b>one</b> carriage"', '[machine]', 'lever = "paper"']
    state = 1
    for feed in (2, 4, 8):
        with open(folder / f"feed{feed}.csv", "w", encoding="ascii") as file:
            file.write("x_mm,z_um\n")
            for i in range(20000):
                x = 100.0 * i / 19999
                state = (1103515245 * state + 12345) % 2**31
                noise = 0.1 * (state / 2**31 - 0.5)
                spike = 3.0 if i == 7777 else 0.0
                file.write(f"{x:.6f},{-0.02 * x + 2e-4 * x * x + noise + spike:.6f}\n")
        problem += ["[[profile]]", f'name = "feed{feed}"', f'file = "feed{feed}.csv"',
                    'kind = "face"', 'quantity = "height"', 'position_column = "x_mm"',
                    'value_column = "z_um"', 'position_unit = "mm"', 'value_unit = "um"',
                    f"feed_mm_per_min = {feed}.0", "spindle_rpm = 110.0",
                    'cut_direction = "inward"', "cut_radius_mm = 100.0", 'free = ["offset"]']
    problem += ["[[effect]]", 'name = "squareness"', "[[effect]]", 'name = "straightness"',
                'body = "x_carriage"', "degree = 3"]
    path = folder / "problem.toml"
    path.write_text("\n".join(problem) + "\n", encoding="utf-8")
    return path


def middles(position, *curves):
    """A staircase as one point in the middle of each step: (position, value, ...)."""
    rows = list(zip(position, *curves))
    steps = [list(step) for _, step in itertools.groupby(rows, key=lambda row: row[1:])]
    return [[0.5 * (step[0][0] + step[-1][0]), *step[0][1:]] for step in steps]


class Page(BrowserTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.page = cls.folder / "report.html"
        subprocess.run([PROGRAM, "identify", faces(cls.folder), "--no-trace", "--quiet",
                        "--json", cls.folder / "report.json", "--html", cls.page], check=True)
        cls.report = json.loads((cls.folder / "report.json").read_text(encoding="utf-8"))

    def setUp(self):
        self.browser.resize(1280, 900)
        self.browser.tool("Emulation.setEmulatedMedia",
                          features=[{"name": "prefers-color-scheme", "value": "light"}])
        self.browser.open(self.page)

    def range_of(self, chart):
        return self.browser.run(
            "return slideway.charts.find(c => c.id === arguments[0]).chart.xAxisRange()", chart)

    def test_the_same_page_is_made_of_the_json_later(self):
        again = self.folder / "again.html"
        subprocess.run([PROGRAM, "report", self.folder / "report.json", "--html", again],
                       check=True)
        self.assertEqual(again.read_bytes(), self.page.read_bytes())

    def test_three_profiles_of_20000_stay_below_two_megabytes(self):
        self.assertLess(self.page.stat().st_size, 2_000_000)

    def test_nothing_is_asked_of_the_network_and_nothing_fails(self):
        self.assertEqual(set(), self.browser.complaints())
        events = [json.loads(line["message"])["message"]
                  for line in self.browser.log("performance")]
        asked = {event["params"]["request"]["url"] for event in events
                 if event["method"] == "Network.requestWillBeSent"}
        self.assertEqual({self.page.as_uri()}, asked)

    def test_charts_hold_the_curves_of_the_json(self):
        charts = self.browser.run(
            "return slideway.charts.map(c => ({id: c.id, labels: c.chart.getLabels(), rows: "
            "Array.from({length: c.chart.numRows()}, (_, i) => "
            "c.chart.getLabels().map((_, j) => c.chart.getValue(i, j)))}))")
        profiles = self.report["curves"]["profiles"]
        self.assertEqual(3 * len(profiles), len(charts))
        for i, profile in enumerate(profiles):
            form, marks, residual = charts[3 * i:3 * i + 3]
            self.assertEqual(["position", "low band", "model"], form["labels"])
            self.assertEqual(
                middles(profile["position_mm"], profile["low_band"], profile["model_before"]),
                form["rows"])
            left = [raw - low for raw, low in zip(profile["raw"], profile["low_band"])]
            self.assertEqual([list(row) for row in zip(profile["position_mm"], left)],
                             marks["rows"])
            self.assertEqual(middles(profile["position_mm"], profile["residual_before"]),
                             residual["rows"])

    def test_extremes_of_the_file_survive_in_the_chart(self):
        drawn = self.browser.run(
            "return slideway.charts.filter(c => c.id.endsWith('marks')).map(c => "
            "Array.from({length: c.chart.numRows()}, (_, i) => c.chart.getValue(i, 1)))")
        for profile, values in zip(self.report["curves"]["profiles"], drawn):
            values = [left + low for left, low in zip(values, profile["low_band"], strict=True)]
            with open(self.folder / f"{profile['profile']}.csv", encoding="ascii") as file:
                measured = [float(row["z_um"]) for row in csv.DictReader(file)]
            self.assertAlmostEqual(max(measured), max(values), delta=1e-4 * max(measured))
            self.assertAlmostEqual(min(measured), min(values), delta=1e-4 * abs(min(measured)))

    def test_a_drag_zooms_all_charts_of_a_profile_and_the_button_undoes_it(self):
        whole, other = self.range_of("p0-form"), self.range_of("p1-form")
        box = self.browser.run(
            "const plot = document.querySelector('#p0-form .plot'); plot.scrollIntoView("
            "{block: 'center'}); const b = plot.getBoundingClientRect();"
            "return [b.left, b.top, b.width, b.height]")
        at = lambda share: {"x": round(box[0] + share * box[2]), "y": round(box[1] + box[3] / 2)}
        move = lambda share: {"type": "pointerMove", "duration": 50, **at(share)}
        self.browser.send("/actions", {"actions": [{
            "type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
            "actions": [move(0.4), {"type": "pointerDown", "button": 0}, move(0.5), move(0.6),
                        {"type": "pointerUp", "button": 0}]}]})
        zoomed = self.range_of("p0-form")
        self.assertLess(zoomed[1] - zoomed[0], 0.3 * (whole[1] - whole[0]))
        self.assertEqual(zoomed, self.range_of("p0-residual"))
        self.assertEqual(other, self.range_of("p1-form"))
        self.browser.run("document.querySelector('#p0-residual button').click()")
        for chart in ("p0-form", "p0-residual"):
            for now, before in zip(self.range_of(chart), whole):
                self.assertAlmostEqual(now, before, places=6)

    def test_nothing_is_wider_than_the_screen(self):
        for width in (1280, 400):
            self.browser.resize(width, 800)
            self.browser.open(self.page)
            self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"),
                                 width)

    def test_no_label_of_a_picture_is_cut(self):
        cut = self.browser.run("""
          return [...document.querySelectorAll('svg')].flatMap(picture => {
            const frame = picture.getBoundingClientRect();
            return [...picture.querySelectorAll('text')].filter(text => {
              const box = text.getBoundingClientRect();
              return box.width && (box.left < frame.left - 1 || box.right > frame.right + 1 ||
                                   box.top < frame.top - 1 || box.bottom > frame.bottom + 1);
            }).map(text => text.textContent);
          });""")
        self.assertEqual([], cut)

    def test_every_parameter_stands_beside_its_value_on_a_small_screen(self):
        self.browser.resize(400, 800)
        self.browser.open(self.page)
        ends = self.browser.run("""
          const table = [...document.querySelectorAll('table')].find(
            t => t.caption.textContent.startsWith('Parameters'));
          return [...table.querySelectorAll('caption, tbody td:nth-child(2)')].map(
            e => e.getBoundingClientRect().right);""")
        self.assertGreater(len(ends), 4)
        self.assertLessEqual(max(ends), 400)

    def test_dark_mode_is_dark_and_readable(self):
        luminance = ("const of = c => c.match(/[\\d.]+/g).slice(0, 3).map(v => { v /= 255; return v"
                     " <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; });"
                     "const l = c => { const [r, g, b] = of(c); return 0.2126 * r + 0.7152 * g + "
                     "0.0722 * b; }; const s = getComputedStyle(document.body);"
                     "return [l(s.color), l(s.backgroundColor)]")
        for scheme, brighter in (("light", 1), ("dark", 0)):
            self.browser.tool("Emulation.setEmulatedMedia", features=[
                {"name": "prefers-color-scheme", "value": scheme}])
            both = self.browser.run(luminance)
            self.assertGreater(both[brighter], both[1 - brighter])
            self.assertGreater((max(both) + 0.05) / (min(both) + 0.05), 7.0)  # WCAG AAA

    def test_print_fits_on_a4(self):
        pdf = base64.b64decode(self.browser.tool("Page.printToPDF", preferCSSPageSize=True,
                                                 printBackground=True)["data"])
        pages = len(re.findall(rb"/Type\s*/Page\b", pdf))
        self.assertTrue(4 <= pages <= 30, pages)
        for box in re.findall(rb"/MediaBox\s*\[([^]]*)\]", pdf):
            width, height = [float(number) for number in box.split()[2:]]
            self.assertAlmostEqual(width, 210 / 25.4 * 72, delta=1.0)
            self.assertAlmostEqual(height, 297 / 25.4 * 72, delta=1.0)
        # Of each long picture the SVG is printed, and nothing sticks out of the paper.
        self.browser.resize(718, 1000)  # 190 mm between the margins
        self.browser.tool("Emulation.setEmulatedMedia", media="print")
        shown = self.browser.run(
            "return [...document.querySelectorAll('figure.long')].map(f => ["
            "f.querySelector('svg').getBoundingClientRect().width > 0,"
            "f.querySelector('.chart').getBoundingClientRect().width > 0])")
        self.assertEqual([[True, False]] * 9, shown)
        wide = self.browser.run(
            "return [...document.querySelectorAll('body *')].filter(e => "
            "e.getBoundingClientRect().right > innerWidth + 1).map(e => e.outerHTML.slice(0, 80))")
        self.browser.tool("Emulation.setEmulatedMedia", media="")
        self.assertEqual([], wide)

    def test_pages_are_numbered_and_what_is_signed_is_on_one(self):
        rules = self.browser.run(
            "return [...document.styleSheets].flatMap(s => [...s.cssRules]).filter("
            "r => r instanceof CSSPageRule).map(r => r.cssText)")
        self.assertIn("counter(page)", " ".join(rules))
        self.browser.resize(718, 1000)
        self.browser.tool("Emulation.setEmulatedMedia", media="print")
        height = self.browser.run(
            "const from = document.querySelector('#certificate').getBoundingClientRect().top;"
            "return document.querySelector('.sign').getBoundingClientRect().bottom - from")
        self.browser.tool("Emulation.setEmulatedMedia", media="")
        self.assertLess(height, (297 - 30) / 25.4 * 96)

    def test_the_first_screen_has_verdict_numbers_and_picture(self):
        for width, height in ((1280, 1000), (390, 1700)):
            self.browser.resize(width, height)
            self.browser.open(self.page)
            bottoms = self.browser.run(
                "return ['.verdict', '.facts', 'figure.first'].map("
                "s => document.querySelector(s).getBoundingClientRect().bottom)")
            self.assertLess(max(bottoms), height)

    def test_it_can_be_read_without_scripts(self):
        self.browser.tool("Emulation.setScriptExecutionDisabled", value=True)
        try:
            self.browser.open(self.page)
            root = self.browser.tool("DOM.getDocument")["root"]["nodeId"]
            pictures = self.browser.tool("DOM.querySelectorAll", nodeId=root,
                                         selector="figure.long svg")["nodeIds"]
            self.assertEqual(9, len(pictures))
            for picture in pictures:
                model = self.browser.tool("DOM.getBoxModel", nodeId=picture)["model"]
                self.assertGreater(model["width"], 500)
        finally:
            self.browser.tool("Emulation.setScriptExecutionDisabled", value=False)

    def test_everyone_can_use_it(self):
        for width in (1280, 390):
            self.browser.resize(width, 900)
            self.browser.open(self.page)
            self.assertEqual([], breaches(self.browser))
            self.assertEqual([], self.browser.run(
                "return [...document.querySelectorAll('svg')].filter(s => s.getAttribute('role') !== "
                "'img' || !s.getAttribute('aria-labelledby')).map(s => s.outerHTML.slice(0, 90))"))
        self.assertEqual(["en", "Three cuts & <b>one</b> carriage"], self.browser.run(
            "return [document.documentElement.lang, document.title]"))

    def test_squareness_stands_there_in_three_units(self):
        facts = self.browser.run("return document.querySelector('.facts').textContent")
        for parameter in self.report["final"]["parameters"]:
            if parameter["name"] == "squareness.dbeta_xz":
                rad = parameter["value"]
        for value, unit in ((rad * 1e6, "µm/m"), (rad * 648000 / math.pi, "″")):
            written = re.search(r"(−?[\d.]+) ± [\d.]+ " + unit, facts)
            self.assertIsNotNone(written, facts)
            number = float(written[1].replace("−", "-"))
            self.assertAlmostEqual(number, value, delta=0.01 * abs(value))


if __name__ == "__main__":
    if not CHROMIUM or not DRIVER:
        print("SKIPPED: chromium or chromedriver is not installed")
        sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1], verbosity=2)
