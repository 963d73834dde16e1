"""Instruction counts on fixed inputs beside those kept in bench/baselines: check.py BIN [--update].

Times of a shared machine say little; instructions counted by valgrind --tool=callgrind on one
processor repeat to 0.1 %. Fails if one has grown by more than the margin. Counts hold for one set of
tools only: where compiler, libraries, valgrind or the processor's AVX2 are others than those the
baselines were counted with, it says so and ends with exit code 77."""
import math
import os
import pathlib
import random
import re
import subprocess
import sys

MARGIN = 0.05
BASELINE = pathlib.Path(__file__).parent / "baselines" / "instructions.txt"
SOURCE = pathlib.Path(__file__).resolve().parent.parent
WORK = pathlib.Path("build/check")
FACE = SOURCE / "problems/paper-face-10mm/problem.toml"
PACKAGES = ("g++", "libstdc++6", "libc6", "libceres-dev", "libeigen3-dev", "valgrind")
SKIPPED = 77
RADIUS = 20.0  # mm
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
feed_mm_per_min = {feed}
spindle_rpm = 400
cut_direction = "{direction}"
cut_radius_mm = 20
free = ["offset", "tilt"]
"""
MODEL = """
[[effect]]
name = "squareness"
[[effect]]
name = "straightness"
body = "x_carriage"
degree = 3
"""


def thermal(minutes):
    """A named effect, in um."""
    return 0.3 * (1.0 - math.exp(-minutes / 2.0))


def chirp(minutes):
    """A shape of no catalogue, in um."""
    return 0.15 * math.sin(2.0 * math.pi * (0.3 * minutes + 0.04 * minutes**2))


THREE = (("slow", 2, "inward"), ("fast", 8, "inward"), ("out", 2, "outward"))
MANY = [(f"cut{i}", 2 + 0.01 * i, "inward") for i in range(60)]


def faces(folder, hidden, cuts=THREE, samples=1000, level=4):
    """The problem file of some cuts, a drift hidden in them."""
    folder.mkdir(parents=True, exist_ok=True)
    draw = random.Random(21)
    text = f'title = "{folder.name}"\n[machine]\nlever = "paper"\n[low_band]\nlevel = {level}\n'
    for name, feed, direction in cuts:
        rows = "x_mm,z_um\n"
        for i in range(samples):
            x = RADIUS * (2.0 * i / (samples - 1) - 1.0)
            r = abs(x)
            minutes = (RADIUS - r if direction == "inward" else r) / feed
            z = 2e-5 * (r - 10.0) ** 3 + 0.02 * r + hidden(minutes) + draw.gauss(0.0, 0.02)
            rows += f"{x:.6f},{z:.5f}\n"
        (folder / f"{name}.csv").write_text(rows)
        text += PROFILE.format(name=name, feed=feed, direction=direction)
    path = folder / "problem.toml"
    path.write_text(text + MODEL)
    return path


def cases():
    """{name: arguments}, on files made here"""
    WORK.mkdir(parents=True, exist_ok=True)
    table = WORK / "table.csv"
    # Two incommensurable waves: digits like a profile's, the same everywhere.
    table.write_text("x_mm,z_um\n" + "".join(
        f"{i * 5e-4:.4f},{((i * 7919) % 100_003 - 50_001) / 65_536:.12f}\n" for i in range(50_000)))  # fmt: skip
    loop = {"loop_clean": faces(WORK / "loop_clean", lambda _: 0.0),
            "loop_named": faces(WORK / "loop_named", thermal),
            "loop_open": faces(WORK / "loop_open", chirp),
            "loop_many": faces(WORK / "loop_many", lambda _: 0.0, MANY, samples=256, level=2)}
    return {
        "start": ["--version"],
        "identify": ["identify", FACE, "--no-trace", "--quiet"],
        "decompose_db4": ["decompose", table, "--out", "/dev/null"],
        "rank": ["rank", table, "--signal", "2", "--candidates", "1", "--quiet"],
        "read": ["info", table],
        **{name: ["identify", problem, "--quiet", "--json", WORK / f"{name}.json"]
           for name, problem in loop.items()},
    }


def tools():
    """{what a count depends on, besides the program: its version}"""
    def installed(package):
        command = ["dpkg-query", "-W", "-f=${Version}", package]
        try:
            return subprocess.run(command, capture_output=True, text=True).stdout or "-"
        except FileNotFoundError:
            return "-"

    flags = pathlib.Path("/proc/cpuinfo").read_text().split()
    return {**{package: installed(package) for package in PACKAGES},
            "avx2": "yes" if "avx2" in flags else "no"}


def count(program, arguments):
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program,
               *map(str, arguments)]  # fmt: skip
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {run.returncode}\n{run.stderr}")
    return int(re.search(r"Collected\s*:\s*(\d+)", run.stderr)[1])


def read_baseline():
    """The tools and the counts that are kept."""
    lines = BASELINE.read_text().splitlines()
    kept = [line[2:].split(" ", 1) for line in lines if line.startswith("# ")]
    return dict(kept), dict(line.split() for line in lines if not line.startswith("#"))


def main():
    program, here = sys.argv[1], tools()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    known_tools, known = read_baseline()
    differing = [f"{name} {here[name]} instead of {known_tools.get(name, '-')}"
                 for name in here if here[name] != known_tools.get(name)]
    if differing and "--update" not in sys.argv:
        print(f"skipped, the baselines are of other tools: {', '.join(differing)}")
        sys.exit(SKIPPED)
    found = {name: count(program, arguments) for name, arguments in cases().items()}
    if "--update" in sys.argv:
        BASELINE.write_text("".join(f"# {name} {version}\n" for name, version in here.items()) +
                            "".join(f"{name} {number}\n" for name, number in found.items()))
        return
    grown = [name for name in known if found[name] > int(known[name]) * (1 + MARGIN)]
    for name, number in found.items():
        change = number / int(known[name]) - 1
        print(f"{name:16} {number:14,} instructions {change:+7.1%} {'GROWN' if name in grown else ''}")
    if grown:
        sys.exit(f"more than {MARGIN:.0%} above bench/baselines: {', '.join(grown)}")


if __name__ == "__main__":
    main()
