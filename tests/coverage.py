"""Lines and branches that the tests reach, by room, as a table; and the largest functions they never enter.

usage: coverage.py COVERAGE.json [FUNCTIONS]

COVERAGE.json is gcovr's; FUNCTIONS is how many are listed (25).
"""

import collections
import json
import pathlib
import sys
from typing import Any

ROOMS = ["base", "format", "machine", "signal", "profile", "effects", "identify", "trace", "report", "batch", "serve",
         "cli", "python"]
Reached = tuple[int, int]


def room_of(file: str) -> str:
    parts = pathlib.PurePath(file).parts
    return parts[1] if parts[0] == "src" else parts[2]  # include/slideway/ROOM


def plus(a: Reached, b: Reached) -> Reached:
    return a[0] + b[0], a[1] + b[1]


def share(reached: Reached) -> str:
    return f"{100 * reached[0] / reached[1]:.1f}" if reached[1] else "-"


def lines_of(file: dict[str, Any]) -> list[dict[str, Any]]:
    return [line for line in file["lines"] if not line.get("gcovr/noncode")]


def never_entered(file: dict[str, Any]) -> list[tuple[int, str]]:
    """How many lines of each function do not run, of those that are never called."""
    starts = sorted({function["lineno"] for function in file["functions"]})
    called = {function["lineno"] for function in file["functions"] if function["execution_count"] > 0}
    out = []
    for start, end in zip(starts, starts[1:] + [sys.maxsize]):
        if start in called:
            continue
        name = next(function["name"] for function in file["functions"] if function["lineno"] == start)
        missed = sum(start <= line["line_number"] < end and line["count"] == 0 for line in lines_of(file))
        short = name.replace("(anonymous namespace)::", "").split("(")[0].replace("slideway::", "")
        out.append((missed, f"{file['file']}:{start} {short}"))
    return out


def main(path: str, most: int) -> None:
    files = json.loads(pathlib.Path(path).read_text())["files"]
    lines: dict[str, Reached] = collections.defaultdict(lambda: (0, 0))
    branches: dict[str, Reached] = collections.defaultdict(lambda: (0, 0))
    for file in files:
        room = room_of(file["file"])
        for line in lines_of(file):
            lines[room] = plus(lines[room], (line["count"] > 0, 1))
            for branch in line["branches"]:
                branches[room] = plus(branches[room], (branch["count"] > 0, 1))
    print("| room | lines | reached, % | branches | reached, % |\n|---|---|---|---|---|")
    inner = [room for room in ROOMS if room in lines and room not in ("cli", "python")]
    sums = {"all but `cli` and `python`": inner, "all": [room for room in ROOMS if room in lines]}
    for name, rooms in {**{f"`{room}`": [room] for room in sums["all"]}, **sums}.items():
        of_lines: Reached = (0, 0)
        of_branches: Reached = (0, 0)
        for room in rooms:
            of_lines, of_branches = plus(of_lines, lines[room]), plus(of_branches, branches[room])
        print(f"| {name} | {of_lines[1]} | {share(of_lines)} | {of_branches[1]} | {share(of_branches)} |")
    print("\nNever entered, with the lines of each:")
    for missed, where in sorted((each for file in files for each in never_entered(file)), reverse=True)[:most]:
        print(f"{missed:4} {where}")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 25)
