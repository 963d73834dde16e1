"""Instruction counts on fixed inputs beside those kept in bench/baselines: check.py BIN [--update].
Times of a shared machine say little; instructions counted by valgrind --tool=callgrind on one
processor repeat to 0.1 %. Fails if one has grown by more than the margin."""
import pathlib
import re
import subprocess
import sys

MARGIN = 0.05
BASELINE = pathlib.Path(__file__).parent / "baselines" / "instructions.txt"
WORK = pathlib.Path("build/check")
FACE = "problems/paper-face-10mm/problem.toml"


def cases():
    """{name: arguments}, on files made here"""
    WORK.mkdir(parents=True, exist_ok=True)
    table = WORK / "table.csv"
    # Two incommensurable waves: digits like a profile's, the same everywhere.
    table.write_text("x_mm,z_um\n" + "".join(
        f"{i * 5e-4:.4f},{((i * 7919) % 100_003 - 50_001) / 65_536:.12f}\n" for i in range(50_000)))  # fmt: skip
    return {
        "start": ["--version"],
        "identify": ["identify", FACE, "--no-trace", "--quiet"],
        "decompose_db4": ["decompose", table, "--out", "/dev/null"],
        "rank": ["rank", table, "--signal", "2", "--candidates", "1", "--quiet"],
        "read": ["info", table],
    }


def count(program, arguments):
    command = ["taskset", "-c", "0", "valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
               program, *map(str, arguments)]  # fmt: skip
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {run.returncode}\n{run.stderr}")
    return int(re.search(r"Collected\s*:\s*(\d+)", run.stderr)[1])


def main():
    program = sys.argv[1]
    found = {name: count(program, arguments) for name, arguments in cases().items()}
    if "--update" in sys.argv:
        BASELINE.write_text("".join(f"{name} {number}\n" for name, number in found.items()))
        return
    known = dict(line.split() for line in BASELINE.read_text().splitlines())
    grown = [name for name in known if found[name] > int(known[name]) * (1 + MARGIN)]
    for name, number in found.items():
        change = number / int(known[name]) - 1
        print(f"{name:16} {number:14,} instructions {change:+7.1%} {'GROWN' if name in grown else ''}")
    if grown:
        sys.exit(f"more than {MARGIN:.0%} above bench/baselines: {', '.join(grown)}")


main()
