"""The page of `slideway serve` in a real browser: the whole way of a user.

usage: browser_test.py SLIDEWAY SOURCE_DIR [SCREENSHOTS]; exit code 77 where there is no chromium.
"""

import base64
import json
import pathlib
import shutil
import subprocess
import sys
import time
import unittest

PROGRAM, SOURCE = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
SCREENSHOTS = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
sys.path[:0] = [str(pathlib.Path(SOURCE) / "tests/support"), str(pathlib.Path(SOURCE) / "tests/serve")]
from accessibility import breaches  # noqa: E402
from browser import CHROMIUM, DRIVER, BrowserTest  # noqa: E402
from server import Server  # noqa: E402

SKIPPED = 77
EXAMPLE = pathlib.Path(SOURCE) / "problems/demo"
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
TAB, ENTER = "\ue004", "\ue007"
# What only the workshop knows of the example (problems/demo/problem.toml).
ANSWERS = {"fine": {"feed": "40", "speed": "1000", "direction": "inward"},
           "coarse": {"feed": "100", "speed": "1000", "direction": "inward"}}
ALIVE = "return document.querySelector('%s') !== null"


class Page(BrowserTest):
    def setUp(self):
        self.runs = self.folder / self.id().split(".")[-1]
        self.server = Server(PROGRAM, self.runs)
        self.addCleanup(self.server.end)
        self.browser.resize(1280, 900)
        self.browser.open(self.server.address)
        self.addCleanup(self.nothing_fails)

    def nothing_fails(self):
        self.assertEqual(set(), self.browser.complaints())

    def shot(self, name):
        if not SCREENSHOTS:
            return
        height = self.js("return document.documentElement.scrollHeight")
        width = self.js("return innerWidth")
        for i, top in enumerate(range(0, height, 1400)):
            data = self.browser.tool(
                "Page.captureScreenshot", captureBeyondViewport=True,
                clip={"x": 0, "y": top, "width": width, "height": min(1400, height - top), "scale": 1})
            (SCREENSHOTS / f"{name}-{i}.png").write_bytes(base64.b64decode(data["data"]))

    def js(self, script, *arguments):
        return self.browser.run(script, *arguments)

    def until(self, script, *arguments, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if found := self.js(script, *arguments):
                return found
            time.sleep(0.05)
        self.fail(f"not within {seconds} s: {script}; {self.js('return document.body.innerText')}")

    def element(self, selector):
        found = self.browser.send("/element", {"using": "css selector", "value": selector})
        return found[ELEMENT]

    def type(self, selector, text):
        self.browser.send(f"/element/{self.element(selector)}/value", {"text": text})

    def click(self, selector):
        self.browser.send(f"/element/{self.element(selector)}/click", {})

    def keys(self, text):
        self.browser.keys(text)

    def add_files(self, *names):
        self.type("#files", "\n".join(str(EXAMPLE / f"{name}.csv") for name in names))
        self.until("return document.querySelectorAll('.card .plot canvas').length >= 2 * arguments[0]",
                   len(names))

    def answer(self, *names):
        for i, name in enumerate(names):
            for key, value in ANSWERS[name].items():
                self.type(f"#{key}-{i}", value)
                self.keys(TAB)
                self.until("return document.getElementById(arguments[0]).value === arguments[1] && "
                           "!document.getElementById(arguments[0]).closest('.open')", f"{key}-{i}", value)
        self.type("#lever-0", "paper")
        self.keys(TAB)
        self.until("return document.getElementById('problem').value.includes('lever = \"paper\"')")

    def ready(self):
        self.until("return !document.getElementById('run').disabled && "
                   "document.querySelector('#check .good') !== null")

    def run_to_the_end(self):
        self.ready()
        before = self.js("return document.getElementById('page').src")
        self.click("#run")
        self.until("return document.getElementById('page').src !== arguments[0] && "
                   "document.getElementById('working').hidden", before)

    def report_text(self):
        self.browser.send("/frame", {"id": {ELEMENT: self.element("#page")}})
        try:
            return self.until("return document.querySelector('main') && document.body.innerText")
        finally:
            self.browser.send("/frame", {"id": None})

    def nothing_is_wider_than_the_screen(self):
        wide = self.js("return document.documentElement.scrollWidth - innerWidth")
        self.assertLessEqual(wide, 0)

    def everyone_can_use_it(self):
        self.assertEqual([], breaches(self.browser))

    def steeper_faces(self):
        """The example with a cone of 500 µm/m about its axis, at 80 mm, added: a problem file."""
        folder = self.folder / "odd"
        shutil.copytree(EXAMPLE, folder)
        for path in folder.glob("*.csv"):
            head, *rows = path.read_text(encoding="utf-8").splitlines()
            cells = [row.split(",") for row in rows]
            path.write_text("\n".join([head, *(f"{x},{float(z) + 0.5 * abs(float(x) - 80.0):.4f}" for x, z in cells)]) + "\n",
                            encoding="utf-8")
        return folder / "problem.toml"

    def click_point(self, title, index):
        """A point of a trend, with the mouse."""
        x, y = self.js("""
          const chart = Plots.charts.get(arguments[0]), i = arguments[1];
          const box = chart.graphDiv.getBoundingClientRect();
          const at = chart.toDomCoords(chart.getValue(i, 0), chart.getValue(i, 1));
          return [box.left + at[0], box.top + at[1]].map(Math.round);""", title, index)
        moves = [{"type": "pointerMove", "duration": 50, "x": x, "y": y - 2},
                 {"type": "pointerMove", "duration": 50, "x": x, "y": y},
                 {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}]
        self.browser.send("/actions", {"actions": [{"type": "pointer", "id": "mouse",
                                                    "parameters": {"pointerType": "mouse"}, "actions": moves}]})

    def drag_over_plot(self, first, last):
        box = self.js("const plot = document.querySelector('.card .plot'); plot.scrollIntoView("
                      "{block: 'center'}); const b = plot.getBoundingClientRect();"
                      "return [b.left, b.top, b.width, b.height]")
        at = lambda share: {"x": round(box[0] + share * box[2]), "y": round(box[1] + box[3] / 2)}
        move = lambda share: {"type": "pointerMove", "duration": 50, **at(share)}
        self.browser.send("/actions", {"actions": [{
            "type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
            "actions": [move(first), {"type": "pointerDown", "button": 0},
                        move((first + last) / 2), move(last), {"type": "pointerUp", "button": 0}]}]})

    def whole_way(self, name):
        self.everyone_can_use_it()
        self.shot(f"{name}-1-start")
        self.add_files("fine", "coarse")
        self.everyone_can_use_it()
        self.nothing_is_wider_than_the_screen()
        self.shot(f"{name}-2-questions")
        self.answer("fine", "coarse")
        self.ready()
        self.everyone_can_use_it()
        self.nothing_is_wider_than_the_screen()
        self.shot(f"{name}-3-problem")
        self.run_to_the_end()
        self.assertIn("thermal drift", self.report_text())
        self.nothing_is_wider_than_the_screen()
        self.shot(f"{name}-4-report")

    def test_from_files_to_two_runs_side_by_side(self):
        self.whole_way("wide")
        self.drag_over_plot(0.5, 0.6)
        self.until("return document.querySelector('.card .bar input').value !== ''")
        self.js("[...document.querySelectorAll('.card .bar button')].find("
                "b => b.textContent === 'Leave this out').click()")
        mask = self.until("return Toml.profile(document.getElementById('problem').value, 'fine', 'mask')")
        self.assertEqual(1, len(mask))
        self.assertTrue(60 < mask[0][0] < mask[0][1] < 110, mask)
        self.js("document.getElementById('spikes-box').open = true")
        self.click("#spikes-0")
        self.js("document.getElementById('model').open = true")
        self.click("#effect-thermal_drift")
        self.assertIn('[[effect]]\nname = "thermal_drift"', self.js("return document.getElementById('problem').value"))
        self.js("document.getElementById('formula-box').open = true")
        for key, text in (("as", "coolant"), ("formula", "a * (1 - exp(-t / tau))"),
                          ("parameters", "a um, tau s 1 600")):
            self.type(f"#formula [name={key}]", text)
        self.click("#formula button")
        self.run_to_the_end()
        rows = self.until("return [...document.querySelectorAll('#diff tbody tr')].map(r => r.innerText)")
        self.assertTrue(any(row.startswith("A: fine\t") for row in rows), rows)
        self.assertTrue(any(row.startswith("B: fine-2\t") for row in rows), rows)
        self.assertTrue(any("squareness.dbeta_xz" in row for row in rows), rows)
        self.everyone_can_use_it()
        self.shot("wide-5-diff")
        self.assertEqual({"fine", "fine-2"}, {path.name for path in self.runs.iterdir()
                                              if not path.name.startswith(".")})
        for run in ("fine", "fine-2"):
            self.assertEqual({"problem.toml", "result.json", "report.html", "fine.csv", "coarse.csv"},
                             {path.name for path in (self.runs / run).iterdir()})
        json.loads((self.runs / "fine-2/result.json").read_text(encoding="utf-8"))

    def test_the_same_on_a_telephone(self):
        self.browser.resize(390, 800)
        self.browser.open(self.server.address)
        self.whole_way("narrow")

    def test_by_keyboard_alone(self):
        def go_to(id_):
            for _ in range(80):
                if self.js("return document.activeElement.id") == id_:
                    return
                self.keys(TAB)
            self.fail("no way to " + id_)

        self.add_files("fine", "coarse")  # the system's dialogue is not the page's
        self.js("document.activeElement.blur()")
        for i, answers in enumerate(ANSWERS.values()):
            for key, value in answers.items():
                go_to(f"{key}-{i}")
                self.keys(value)
                self.keys(TAB)
                self.until("return !document.getElementById(arguments[0]).closest('.open')", f"{key}-{i}")
        go_to("lever-0")
        self.keys("paper" + TAB)
        self.ready()
        go_to("run")
        self.keys(ENTER)
        self.until("return document.activeElement.id === 'result-h'")
        self.assertEqual(1, len(self.server.get("runs")["runs"]))

    def test_what_the_commands_made_opens_and_batches_are_tables(self):
        subprocess.run([PROGRAM, "demo", "--quiet", "--out", self.runs / "made"], check=True)
        odd = self.steeper_faces()
        manifest = self.folder / "manifest.csv"
        manifest.write_text("id,problem,machine,time\n" + "".join(
            f"face {i},{EXAMPLE / 'problem.toml'},lathe {i % 2},2026-11-{i + 10}\n"
            for i in range(10)) + f"odd,{odd},lathe 1,2026-11-21\ngone,none.toml,lathe 1,\n")
        subprocess.run([PROGRAM, "batch", manifest, "--quiet", "--no-trace", "--out",
                        self.runs / "all.jsonl"], stderr=subprocess.DEVNULL)
        self.browser.open(self.server.address)
        self.until(ALIVE % "#runs tbody tr")
        self.click("button[aria-label='Change made']")
        self.until("return document.querySelectorAll('.card .plot canvas').length >= 6")
        self.ready()
        self.click("button[aria-label='Report made']")
        self.assertIn("Explained", self.report_text())
        self.click("#batches p button")
        self.until("return document.querySelectorAll('#batch tbody tr').length === 12")
        self.everyone_can_use_it()
        self.shot("batch")
        # Squareness and E_ZX of both lathes; of the second one item is apart (pooling.hpp).
        self.until("return document.querySelectorAll('#batch .trends canvas').length >= 8")
        self.assertEqual(["odd"], self.js("return [...document.querySelectorAll('#batch tr.far th')].map(h => h.textContent)"))
        said = self.js("return [...document.querySelectorAll('#batch > p')].map(p => p.innerText)")
        self.assertIn("lathe 0: 5 of 5 items fit together", said[0])
        self.assertIn("lathe 1: 5 of 6 items fit together; odd (E", said[1])
        self.js("document.querySelector('#batch .trends').scrollIntoView({block: 'center'})")
        self.click_point("lathe 1: squareness", 5)
        self.until("return document.getElementById('page').src.includes('id=odd')")
        self.click("button[aria-label='Report face 1']")
        self.until("return document.getElementById('page').src.includes('face%201')")
        self.assertIn("Example: a disc", self.report_text())

    def test_faults_are_shown_where_they_stand_and_nothing_runs(self):
        self.add_files("fine")
        self.answer("fine")
        self.ready()
        self.type("#problem", "\nfeed = 3\n[trace]\nmax = 1\n")
        faults = self.until("const all = [...document.querySelectorAll('#check li.bad pre')];"
                            "return all.length === 2 && all.map(e => e.textContent)")
        self.assertIn("feed = 3", faults[0])
        self.assertTrue(self.js("return document.getElementById('run').disabled"))
        self.shot("faults")

    def test_a_run_is_cancelled_by_its_button(self):
        self.add_files("fine")
        self.answer("fine")
        self.ready()
        self.js("const run = document.getElementById('run'); new MutationObserver(() => {"
                "const cancel = document.getElementById('cancel'); if (!cancel.hidden) cancel.click(); })"
                ".observe(document.getElementById('cancel'), {attributes: true}); run.click()")
        self.until("return document.getElementById('status').textContent.includes('cancelled')")
        self.assertEqual([], self.server.get("runs")["runs"])

    def test_what_is_typed_stays_while_the_answer_before_is_read(self):
        self.add_files("fine")
        self.js("document.getElementById('feed-0').focus()")
        self.keys("40" + TAB + "10")
        self.until("return !document.querySelector('#questions > p').textContent.startsWith('4 ')")
        self.keys("00" + TAB)
        self.until("return document.activeElement.id === 'direction-0'")
        self.assertEqual(["40", "1000"], self.js(
            "return ['feed-0', 'speed-0'].map(id => document.getElementById(id).value)"))

    def test_a_file_that_is_none_is_refused_and_the_others_stay(self):
        self.add_files("fine")
        bad = self.folder / "bad.csv"
        bad.write_bytes(bytes(range(256)) * 40)
        self.type("#files", str(bad))
        self.assertIn("bad.csv", self.until("return document.getElementById('alert').textContent"))
        self.add_files("coarse")
        self.until("return document.querySelectorAll('.card').length === 2")
        self.assertEqual(["fine", "coarse"], self.js(
            "return [...document.querySelectorAll('.card h3')].map(h => h.textContent)"))
        self.browser.log("browser")  # where chromium notes the refused request

    def test_a_hostile_name_is_text(self):
        hostile = self.folder / '"><img src=x onerror=document.title=1>\'ü.csv'
        shutil.copy(EXAMPLE / "fine.csv", hostile)
        self.type("#files", str(hostile))
        self.until(ALIVE % ".card .plot canvas")
        self.assertEqual("slideway", self.js("return document.title"))
        self.assertEqual(0, self.js("return document.images.length"))

    def test_two_tabs_do_not_disturb_each_other(self):
        self.add_files("fine")
        first = self.browser.get("/window")
        second = self.browser.send("/window/new", {"type": "tab"})["handle"]
        self.browser.send("/window", {"handle": second})
        self.browser.open(self.server.address)
        self.add_files("coarse", "outward")
        self.browser.send("/window", {"handle": first})
        self.assertEqual(["fine"], self.js("return [...document.querySelectorAll('.card h3')].map(h => h.textContent)"))
        self.browser.send("/window", {"handle": second})
        self.assertEqual(["coarse", "outward"],
                         self.js("return [...document.querySelectorAll('.card h3')].map(h => h.textContent)"))
        self.nothing_fails()
        self.browser.send("/window", {"handle": first})


if __name__ == "__main__":
    if not CHROMIUM or not DRIVER:
        print("SKIPPED: chromium or chromedriver is not installed")
        sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1], verbosity=2)
