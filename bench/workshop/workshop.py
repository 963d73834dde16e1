#!/usr/bin/python3
"""workshop.py: scores `slideway identify` on faces of an ordinary workshop.

A simulator of its own: geometry of the cut, of the stylus and of the noise; it shares no code with
the library.
"""

import argparse
import json
import sys
import zlib
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

import catalogue
import clean
import forms
import table
from score import Record, score
from shop import Case

Maker = Callable[[np.random.Generator, np.random.Generator], Case]

GROUPS: dict[str, Sequence[Maker]] = {
    "clean": clean.CLASSES, "ways": forms.WAYS, "lobes": forms.LOBES, "one cut": forms.ONE_CUT,
    "setup": forms.SETUP, "thermal": forms.THERMAL, "blunders": forms.BLUNDERS,
    "catalogue": catalogue.SINGLE, "two": [catalogue.two_effects],
    "one profile": [catalogue.effect_of_one_profile],
}
CLASSES = {maker.__name__: (group, maker) for group, makers in GROUPS.items() for maker in makers}
STABLE = ["white", "long_memory", "joint", "kink", "worn_zone", "step_in_one", "two_lobes",
          "off_centre", "slide_periodic", "thermal_drift"]
DRAWS = 20


def make(name: str, seed: int, draw: int) -> Case:
    """The case: `seed` draws what is in it, `draw` its noise."""
    number = zlib.crc32(name.encode())  # classes to come change no other
    return CLASSES[name][1](np.random.default_rng([seed, number]),
                            np.random.default_rng([seed, number, 1 + draw]))


def one(program: str, name: str, seed: int, draw: int, group: str,
        keep: Path | None = None) -> Record:
    about = {"class": name, "group": group, "seed": seed, "draw": draw}
    return about | score(make(name, seed, draw), program, f"{name} {seed}", keep)


def plan(names: list[str], cases: int, base: int) -> Iterator[tuple[str, int, int, str]]:
    """Class, seed, draw and group of every case: one of each class, then the next of each."""
    classes = [name for name in names if name in CLASSES]
    for i in range(cases):
        yield from ((name, base + i, 0, CLASSES[name][0]) for name in classes)
    if "stability" in names:
        for stable in STABLE:
            yield from ((stable, base, draw, "stability") for draw in range(DRAWS))


def chosen(text: str) -> list[str]:
    """Classes of a list of classes and groups."""
    names: list[str] = []
    for word in text.split(","):
        if word == "all":
            names += [*CLASSES, "stability"]
        elif word in GROUPS:
            names += [maker.__name__ for maker in GROUPS[word]]
        elif word in CLASSES or word == "stability":
            names.append(word)
        else:
            sys.exit(f"workshop.py: no class or group \"{word}\"; there are: "
                     f"{', '.join([*GROUPS, *CLASSES, 'stability'])}")
    return names


def run(options: argparse.Namespace) -> None:
    """Runs the plan and writes the records in its order, each as soon as those before it are there."""
    jobs = list(plan(chosen(options.classes), options.cases, options.seed_base))
    with ThreadPoolExecutor(options.jobs) as pool, open(options.out, "w", encoding="utf-8") as out:
        for record in pool.map(lambda job: one(options.program, *job), jobs):
            out.write(json.dumps(record, ensure_ascii=False) + "\n")
            out.flush()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawTextHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    running = commands.add_parser("run", help="score the program")
    running.add_argument("--classes", default="all",
                         help="classes and groups, with commas between them")
    running.add_argument("--cases", type=int, default=40, help="of each class")
    running.add_argument("--seed-base", type=int, default=1000,
                         help="first seed; from 1000: may be looked at, from 500000: fresh")
    running.add_argument("--jobs", type=int, default=1)
    running.add_argument("--out", default="build/workshop.jsonl")
    single = commands.add_parser("case", help="one case, its files kept")
    single.add_argument("name", choices=sorted(CLASSES))
    single.add_argument("seed", type=int)
    single.add_argument("--draw", type=int, default=0, help="of the noise")
    single.add_argument("--keep", type=Path, required=True)
    for command in (running, single):
        command.add_argument("--program", default="build/release/bin/slideway")
    tables = commands.add_parser("table", help="Markdown of the records")
    tables.add_argument("records")
    commands.add_parser("classes", help="what each class is")
    options = parser.parse_args()
    if options.command == "run":
        run(options)
    elif options.command == "case":
        group = CLASSES[options.name][0]
        print(json.dumps(one(options.program, options.name, options.seed, options.draw, group,
                             options.keep), indent=1, ensure_ascii=False))
    elif options.command == "table":
        with open(options.records, encoding="utf-8") as file:
            print(table.page([json.loads(line) for line in file]), end="")
    else:
        for name, (group, maker) in CLASSES.items():
            print(f"{group:12} {name:24} {maker.__doc__}")


if __name__ == "__main__":
    main()
