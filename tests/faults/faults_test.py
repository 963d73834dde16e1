"""Every call of the system that a command makes fails once: an answer, or one line and no file half
written.

usage: faults_test.py SLIDEWAY LIBRARY [MOST]

LIBRARY is failing_calls.c as a shared library. MOST is how many allocations of each command fail,
spread over the run (all other calls fail each in turn); 0: every one.
"""

import collections
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, LIBRARY = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
MOST = int(sys.argv[3]) if len(sys.argv) > 3 else 25
CALLS = ["malloc", "read", "write", "writev", "open", "fopen", "fopen64", "close", "fstat", "fsync", "rename",
         "linkat", "mkdir", "mmap", "fork", "pipe2", "pthread_create", "clock_gettime"]
DONE, FAILED, BAD_USAGE, BAD_DATA, SOME_FAILED = 0, 1, 2, 3, 5

PROBLEM = """title = "faults"

[machine]
lever = "paper"

[low_band]
wavelet = "db1"
level = 2
"""
PROFILE = """
[[profile]]
name = "{name}"
file = "{name}.csv"
kind = "face"
quantity = "height"
position_column = "x_mm"
value_column = "z_um"
position_unit = "mm"
value_unit = "um"
free = ["offset"]
feed_mm_per_min = {feed}
spindle_rpm = 500
cut_direction = "inward"
"""
EFFECTS = """
[[effect]]
name = "straightness"
degree = 2

[[effect]]
name = "squareness"

[trace]
candidates = ["linear_drift", "step"]
"""


def trace(feed):
    """A cone, a parabola and noise that repeats: heights in µm every 0.25 mm."""
    rows = ["x_mm,z_um"]
    for i in range(80):
        x = 0.25 * i
        noise = math.sin(12.9898 * i + feed) * 43758.5453
        rows.append(f"{x},{0.02 * x + 0.0001 * x * x + 0.01 * (noise - math.floor(noise)):.6f}")
    return "\n".join(rows) + "\n"


def files():
    problem = PROBLEM
    out = {}
    for name, feed in (("fine", 2.0), ("coarse", 5.0)):
        problem += PROFILE.format(name=name, feed=feed)
        out[f"{name}.csv"] = trace(feed)
    out["problem.toml"] = problem + EFFECTS
    out["list.csv"] = "id,problem\na,problem.toml\nb,problem.toml\n"
    return out


COMMANDS = {
    "identify": ["identify", "problem.toml", "--json", "out.json", "--html", "out.html"],
    "check": ["check", "problem.toml"],
    "info": ["info", "fine.csv"],
    "to_x3p": ["convert", "fine.csv", "out.x3p", "--position-unit", "mm", "--value-unit", "um"],
    "from_x3p": ["info", "made.x3p"],
    "decompose": ["decompose", "fine.csv", "--out", "out.csv"],
    "simulate": ["simulate", "truth.toml", "--out", "out", "--seed", "1"],
    "report": ["report", "made.json", "--html", "out.html"],
    "export": ["export", "made.json", "--to", "etalon", "--out", "out.csv"],
    "batch": ["batch", "list.csv", "--out", "out.jsonl", "--jobs", "2"],
}

Outcome = collections.namedtuple("Outcome", "code out err files calls")


def content(folder):
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def run(arguments, given, call="", limit=60):
    """The command in a folder with the given files, and what it left there beside them."""
    with tempfile.TemporaryDirectory() as name, tempfile.NamedTemporaryFile() as count:
        folder = pathlib.Path(name)
        for file, text in given.items():
            (folder / file).write_bytes(text if isinstance(text, bytes) else text.encode())
        environment = {**os.environ, "LD_PRELOAD": LIBRARY, "FAILING_CALL": call,
                       "FAILING_COUNT": count.name, "OMP_NUM_THREADS": "1"}
        done = subprocess.run([PROGRAM, *arguments], cwd=folder, env=environment, timeout=limit,
                              stdin=subprocess.DEVNULL, capture_output=True, check=False)
        left = {file: data for file, data in content(folder).items()
                if file not in given or data != (given[file] if isinstance(given[file], bytes)
                                                 else given[file].encode())}
        counted = pathlib.Path(count.name).read_text().strip()
        return Outcome(done.returncode, done.stdout, done.stderr.decode(errors="replace"), left,
                       int(counted or 0))


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.given = files()
        cls.given["truth.toml"] = cls.given["problem.toml"].split("\n[trace]")[0] + (
            '\n[[truth.effect]]\nname = "squareness"\ndbeta_xz = 1e-5\n')
        for name, command, made in (("made.json", "identify", "out.json"),
                                    ("made.x3p", "to_x3p", "out.x3p")):
            cls.given[name] = run(COMMANDS[command], cls.given).files[made]

    def walk(self, name):
        arguments = COMMANDS[name]
        usual = run(arguments, self.given)
        self.assertEqual(DONE, usual.code, usual.err)
        for call in CALLS:
            most = run(arguments, self.given, f"{call}:0").calls
            numbers = range(1, most + 1)
            if call == "malloc" and MOST and most > MOST:
                numbers = sorted({round(most ** (i / (MOST - 1))) for i in range(MOST)})
            for number in numbers:
                with self.subTest(call=call, number=number):
                    self.judge(name, usual, run(arguments, self.given, f"{call}:{number}"))

    def judge(self, name, usual, now):
        allowed = [DONE, FAILED, BAD_USAGE, BAD_DATA] + [SOME_FAILED] * (name == "batch")
        self.assertIn(now.code, allowed, now.err)
        for file, data in now.files.items():
            self.assertIn(file, usual.files, "a file that does not belong there")
            if name != "batch":
                self.assertEqual(usual.files[file], data, f"{file} is not whole")
        if now.code == DONE and name != "batch":
            self.assertEqual(usual.files.keys(), now.files.keys(), "a file is missing")
            self.assertEqual(usual.out, now.out)
        if now.code in (FAILED, BAD_USAGE, BAD_DATA):
            if name == "check" and now.out:
                return  # it lists the faults of the problem
            lines = now.err.strip().split("\n")
            self.assertEqual(1, len(lines), now.err)
            self.assertTrue(lines[0].startswith("slideway: "), now.err)


for command in COMMANDS:
    setattr(Faults, f"test_{command}", lambda self, command=command: self.walk(command))

if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
