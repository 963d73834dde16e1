"""Mutation testing: faults are put into the sources of two rooms, one at a time, and the tests must see each.

usage: mutate.py BUILD COUNT [LONGEST [NUMBER ...]]

BUILD is a build folder with identify_test and trace_test, the rooms compiled file by file. COUNT mutants
are drawn, the same each time; tests that usually take longer than LONGEST seconds are left out. With
NUMBERs only those mutants are run. The sources and what is built stay as they are: a mutant's object is
linked in front of the library that has the original. BUILD/table.md holds the outcome.
"""

import json
import os
import pathlib
import random
import re
import shlex
import subprocess
import sys
import time
from typing import Any, Iterator, NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROOMS = {"identify": ["identify", "trace"], "trace": ["trace"]}  # whose tests can see a mutant, first to last
NO_CODE = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"|(?<![0-9a-f])'(?:\\.|[^'\\\n])'", re.DOTALL)
NO_MUTANT = re.compile(r"\"|^\s*#|static_assert|\bthrow\b|\btemplate\b|\boperator\b")
SWAPS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "&&": "||", "||": "&&", "+": "-", "-": "+", "*": "/", "/": "*"}
SWAPPED = {"comparison": "<=?|>=?", "logic": r"&&|\|\|", "sum": "[+-]", "product": "[*/]"}
NUMBER = re.compile(r"(?<![\w.])(?:\d+\.\d+(?:e[+-]?\d+)?|\d+(?:e[+-]?\d+)?)(?![\w.'])")
STATEMENT = re.compile(r"(?:[^;{}]* [+-]= [^;{}]*|if \([^;{}]*\) (?:return\b[^;{}]*|continue|break)|continue|return);")
# The program is not linked again, and what asks for the time is no judge here.
NOT_RUN = ("SameBytesOfTheProgram", "TimeLimited")
SLACK, CHUNK = 10.0, 10.0  # times the usual time that a test may take; seconds of tests in one process


class Mutant(NamedTuple):
    file: pathlib.Path
    kind: str
    start: int
    end: int
    new: str


def other_number(number: str) -> str:
    swap = {"0": "1", "1": "0", "0.0": "1.0", "1.0": "0.0"}
    if number in swap:
        return swap[number]
    return str(-(-3 * int(number) // 2)) if number.isdigit() else repr(1.5 * float(number))


def mutants_of(file: pathlib.Path) -> Iterator[Mutant]:
    text = file.read_text()
    code = NO_CODE.sub(lambda found: re.sub(r"[^\n]", "~", found.group()), text)
    at, before = 0, ""
    for line, whole in zip(code.splitlines(keepends=True), text.splitlines()):
        if not NO_MUTANT.search(whole):
            for kind, signs in SWAPPED.items():
                for found in re.finditer(rf"(?<= )(?:{signs})(?=\s)", line):
                    yield Mutant(file, kind, at + found.start(), at + found.end(), SWAPS[found.group()])
            for found in NUMBER.finditer(line):
                yield Mutant(file, "constant", at + found.start(), at + found.end(), other_number(found.group()))
            for found in re.finditer(r"\bif (?=\()", line):
                start = end = at + found.end()
                depth = 0
                while end == start or depth:
                    depth += {"(": 1, ")": -1}.get(code[end], 0)
                    end += 1
                if ";" not in code[start:end]:
                    yield Mutant(file, "condition", start, end, f"(!{text[start:end]})")
            own = line.strip()
            if STATEMENT.fullmatch(own) or (before.endswith(")") and re.fullmatch(r"return\b[^;{}]*;", own)):
                start = at + line.index(own)
                yield Mutant(file, "statement", start, start + len(own), ";")
        at, before = at + len(line), line.strip()


def drawn(count: int) -> list[Mutant]:
    """As many of each kind, as long as there are."""
    kinds: dict[str, list[Mutant]] = {}
    for file in sorted(path for room in ROOMS for path in (ROOT / "src" / room).glob("*.cpp")):
        for mutant in mutants_of(file):
            kinds.setdefault(mutant.kind, []).append(mutant)
    for name in sorted(kinds):
        random.Random(name).shuffle(kinds[name])
    turns = (kinds[name][turn] for turn in range(count) for name in sorted(kinds) if turn < len(kinds[name]))
    return [mutant for mutant, _ in zip(turns, range(count))]


class Bench:
    """Builds mutants in a folder beside what is built, and runs the tests."""

    def __init__(self, build: pathlib.Path, longest: float) -> None:
        self.build, self.folder = build, build / "mutant"
        self.folder.mkdir(exist_ok=True)
        commands = json.loads((build / "compile_commands.json").read_text())
        self.compile = {entry["file"]: shlex.split(entry["command"]) for entry in commands}
        self.link = {room: subprocess.run(["ninja", "-C", build, "-t", "commands", "-s", f"bin/{room}_test"], text=True,
                                          check=True, capture_output=True).stdout.splitlines()[-1] for room in ROOMS}
        self.chunks = {room: list(self.chunks_of(room, longest)) for room in ROOMS}

    def chunks_of(self, room: str, longest: float) -> Iterator[tuple[list[str], float]]:
        """The tests with their usual times, the fastest first."""
        times, program = self.build / f"{room}_times.json", self.build / "bin" / f"{room}_test"
        if not times.exists() or times.stat().st_mtime < program.stat().st_mtime:
            print(f"timing the tests of {room}", flush=True)
            subprocess.run([program, f"--gtest_output=json:{times}.new", "--gtest_brief=1",
                            "--gtest_filter=-" + ":".join(f"*{name}*" for name in NOT_RUN)], cwd=self.build, check=True)
            times.with_suffix(".json.new").rename(times)
        usual: list[tuple[float, str]] = sorted(
            (float(test["time"].rstrip("s")), f"{suite['name']}.{test['name']}")
            for suite in json.loads(times.read_text())["testsuites"] for test in suite["testsuite"])
        names: list[str] = []
        seconds = 0.0
        for took, name in usual:
            if took > longest:
                break
            if names and seconds + took > CHUNK:
                yield names, seconds
                names, seconds = [], 0.0
            names, seconds = names + [name], seconds + took
        if names:
            yield names, seconds

    def run(self, room: str, mutant: Mutant, text: str) -> str:
        """"survived", "not compiled", or what killed it."""
        source, compiled = self.folder / mutant.file.name, self.folder / "mutant.o"
        source.write_text(text[:mutant.start] + mutant.new + text[mutant.end:])
        command = self.compile[str(mutant.file)][:]
        command[command.index("-o") + 1], command[-1] = str(compiled), str(source)
        command.insert(-2, f"-I{mutant.file.parent}")
        built = subprocess.run(command, cwd=self.build, capture_output=True)
        source.unlink()
        if built.returncode:
            return "not compiled"
        for tests in ROOMS[room]:
            program = self.folder / f"{tests}_test"
            link = self.link[tests].replace(f" -o bin/{tests}_test", f" {compiled} -o {program}")
            subprocess.run(link, shell=True, cwd=self.build, check=True, capture_output=True)
            for names, seconds in self.chunks[tests]:
                killer = self.killer(program, names, SLACK * seconds + 5.0)
                if killer:
                    return f"killed: {tests}/{killer}"
        return "survived"

    def killer(self, program: pathlib.Path, names: list[str], limit: float) -> str:
        environment = os.environ | {"GLOG_minloglevel": "3"}
        try:
            ran = subprocess.run([program, "--gtest_fail_fast", "--gtest_filter=" + ":".join(names)], text=True,
                                 cwd=self.folder, capture_output=True, timeout=limit, env=environment, errors="replace")
        except subprocess.TimeoutExpired as late:
            return self.last_test((late.stdout or b"").decode(errors="replace")) + ", timeout"
        return "" if ran.returncode == 0 else self.last_test(ran.stdout)

    @staticmethod
    def last_test(output: str) -> str:
        return str(([""] + re.findall(r"(?:\[ RUN      \]|\[  FAILED  \]) ([\w/.]+)", output))[-1])


def line_of(text: str, at: int) -> str:
    return " ".join(text[text.rfind("\n", 0, at) + 1:].split("\n", 1)[0].split())


def main(build: str, count: str, longest: str = "inf", *numbers: str) -> None:
    folder = pathlib.Path(build).resolve()
    bench = Bench(folder, float(longest))
    rows: list[dict[str, Any]] = []
    for number, mutant in enumerate(drawn(int(count)), 1):
        if numbers and str(number) not in numbers:
            continue
        text, began = mutant.file.read_text(), time.monotonic()
        mutated = text[:mutant.start] + mutant.new + text[mutant.end:]
        outcome = bench.run(mutant.file.parent.name, mutant, text)
        place = f"{mutant.file.relative_to(ROOT)}:{text.count(chr(10), 0, mutant.start) + 1}"
        rows.append({"place": place, "kind": mutant.kind, "outcome": outcome})
        print(f"{number} {place} {mutant.kind}: {outcome} ({time.monotonic() - began:.0f} s)\n"
              f"  - {line_of(text, mutant.start)}\n  + {line_of(mutated, mutant.start)}", flush=True)
        table = "| place | kind | outcome |\n|---|---|---|\n" + "".join(
            f"| `{row['place']}` | {row['kind']} | {row['outcome']} |\n" for row in rows)
        (folder / "table.md").write_text(table)
    for outcome in ("not compiled", "killed", "survived"):
        print(f"{outcome}: {sum(row['outcome'].startswith(outcome) for row in rows)}")


if __name__ == "__main__":
    main(*sys.argv[1:])
