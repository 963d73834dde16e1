"""Commands, the files they need, and a run of one with LIBRARY (failing_calls.c) before the C library.

The tests beside this file are called with SLIDEWAY LIBRARY first.
"""

import collections
import math
import os
import pathlib
import subprocess
import sys
import tempfile

PROGRAM, LIBRARY = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
LIMIT_S = 60
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
    """The files that the commands read and no command makes."""
    problem = PROBLEM
    out = {}
    for name, feed in (("fine", 2.0), ("coarse", 5.0)):
        problem += PROFILE.format(name=name, feed=feed)
        out[f"{name}.csv"] = trace(feed)
    out["problem.toml"] = problem + EFFECTS
    out["truth.toml"] = problem + EFFECTS.split("\n[trace]")[0] + (
        '\n[[truth.effect]]\nname = "squareness"\ndbeta_xz = 1e-5\n')
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


def bytes_of(given):
    return {name: text if isinstance(text, bytes) else text.encode() for name, text in given.items()}


def run(arguments, given, call="", failing_file="", preload=True, before=None):
    """The command in a folder with the given files, and what it left there beside them."""
    given = bytes_of(given)
    with tempfile.TemporaryDirectory() as name, tempfile.NamedTemporaryFile() as count:
        folder = pathlib.Path(name)
        for file, data in given.items():
            (folder / file).parent.mkdir(exist_ok=True)
            (folder / file).write_bytes(data)
        environment = {**os.environ, "FAILING_CALL": call, "FAILING_FILE": failing_file,
                       "FAILING_COUNT": count.name, "OMP_NUM_THREADS": "1"}
        if preload:
            environment["LD_PRELOAD"] = LIBRARY
        done = subprocess.run([PROGRAM, *arguments], cwd=folder, env=environment, timeout=LIMIT_S,
                              preexec_fn=before, stdin=subprocess.DEVNULL, capture_output=True, check=False)
        left = {file: data for file, data in content(folder).items()
                if file not in given or data != given[file]}
        counted = pathlib.Path(count.name).read_text().strip()
        return Outcome(done.returncode, done.stdout, done.stderr.decode(errors="replace"), left,
                       int(counted or 0))


def given_files():
    """The files that the commands read, with the results of some."""
    given = files()
    for name, command, made in (("made.json", "identify", "out.json"), ("made.x3p", "to_x3p", "out.x3p")):
        given[name] = run(COMMANDS[command], given).files[made]
    return bytes_of(given)
