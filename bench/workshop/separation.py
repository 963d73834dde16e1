#!/usr/bin/python3
"""separation.py PROGRAM [COUNT]: are effects told apart that `slideway plan` says a cut tells apart?

One cut of a workshop is there; `plan` is asked about one more, at another feed or outward. Of the
pairs it says that cut tells apart, one is drawn: the first effect is put into both cuts at three
detection limits of today (what the plan means by told apart) and at the shape the plan names. Told
apart: the loop has the effect in its set, and not its rival.
"""

import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from score import run, said
from shop import (Case, Profile, Rng, Shop, Value, carriage, draw_shop, polynomial_way, profile,
                  three_cuts, toml, write)
from surface import Array, Cut, Pass

LIMITS = 3.0
Plan = dict[str, Any]
Shape = Callable[[Shop, float, float, Pass], Array]  # at one shape and phase, for the size 1


def wave(along: Callable[[Shop, float, Pass], Array]) -> Shape:
    return lambda shop, shape, phase, tool: np.cos(2 * np.pi * along(shop, shape, tool) + phase)


SHAPES: dict[str, Shape] = {
    "linear_drift": lambda shop, shape, phase, tool: tool.seconds / 60,
    "thermal_drift": lambda shop, shape, phase, tool: 1 - np.exp(-tool.seconds / shape),
    "tool_wear": lambda shop, shape, phase, tool: tool.metres,
    "tool_running_in": lambda shop, shape, phase, tool: 1 - np.exp(-tool.metres / shape),
    "slide_periodic": wave(lambda shop, shape, tool: tool.r / shape),
    "time_periodic": wave(lambda shop, shape, tool: tool.seconds / shape),
    "revolution_periodic": wave(lambda shop, shape, tool: shape * tool.turns),
    "centre_height": lambda shop, shape, phase, tool: (np.hypot(tool.r, shape) - tool.r) / shape,
    "speed_effect": lambda shop, shape, phase, tool: (
        (np.maximum(tool.r, 0.02) / shop.radius) ** -shape - 1),
    "edge_roll_off": lambda shop, shape, phase, tool: np.exp((tool.r - shop.radius) / shape),
    "step": lambda shop, shape, phase, tool: np.where(tool.r < shape, 1.0, 0.0),
    "cup": lambda shop, shape, phase, tool: (tool.r / shop.radius) ** 2,
}


def cut_to_make(shop: Shop, rng: Rng) -> Cut:
    first, faster, outward = three_cuts(shop)
    slower = replace(first, feed=0.4 * first.feed)
    return [faster, outward, slower][int(rng.integers(3))]


def faces(shop: Shop, rng: Rng, cuts: list[Cut], error: Callable[[Pass], Array] | None) -> list[Profile]:
    motions = [carriage(shop, polynomial_way(shop)), *([error] if error else [])]
    return [profile(shop, rng, f"cut{i + 1}", cut, motions) for i, cut in enumerate(cuts)]


def planned(program: str, problem: Path, cut: Cut) -> Plan:
    """What the plan says of that cut."""
    keys: dict[str, Value] = {"name": "next", "feed_mm_per_min": cut.feed * cut.rpm,
                              "cut_direction": "inward" if cut.inward else "outward"}
    with problem.open("a") as file:
        file.write("\n[[plan.cut]]\n" + "".join(f"{k} = {toml(v)}\n" for k, v in keys.items()))
    done = subprocess.run([program, "plan", str(problem), "--quiet", "--json", "-"],
                          capture_output=True, check=True)
    alone: Plan = json.loads(done.stdout)["alone"][0]
    return alone


def separable(plan: Plan) -> list[tuple[str, str, float, float]]:
    """Effect, rival, size at three detection limits of today and shape of each pair told apart."""
    limits = {one["effect"]: one for one in plan["limits"]}
    out = []
    for pair in plan["pairs"]:
        limit = limits.get(pair["effect"])
        if not pair["told_apart"] or pair["effect"] not in SHAPES or not limit or not limit["now"]:
            continue
        shape = re.search(r" = ([0-9.e+-]+)", limit["at"])
        out.append((pair["effect"], pair["rival"], LIMITS * limit["now"], float(shape[1]) if shape else 0.0))
    return out


def case(program: str, seed: int) -> str:
    rng = np.random.default_rng([seed, 4711])
    shop = draw_shop(rng)
    cuts = [three_cuts(shop)[0], cut_to_make(shop, rng)]
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        present = write(Case(shop, faces(shop, rng, cuts[:1], None)), folder / "now", "now")
        pairs = separable(planned(program, present, cuts[1]))
        if not pairs:
            return "no pair"
        effect, rival, size, shape = pairs[int(rng.integers(len(pairs)))]
        phase = float(rng.uniform(0, 2 * np.pi))
        def error(tool: Pass) -> Array:
            return size * SHAPES[effect](shop, shape, phase, tool)
        both = write(Case(shop, faces(shop, rng, cuts, error)), folder / "both", "both")
        outcome = run(program, both)
    if "report" not in outcome:
        return f"{effect}/{rival}: {outcome['status']}"
    names = [name for one in said(outcome["report"]) for name in [one["name"], *one["rivals"]]]
    told = "told apart" if effect in names and rival not in names else "not told apart"
    return f"{told}: {effect} from {rival}; {outcome['report']['trace']['verdict']} {' '.join(names)}"


def main() -> None:
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 50
    apart = tried = 0
    for seed in range(1, count + 1):
        said_of_it = case(str(Path(sys.argv[1]).resolve()), seed)
        tried += said_of_it != "no pair"
        apart += said_of_it.startswith("told apart")
        print(f"{seed:3d}  {said_of_it}", flush=True)
    print(f"{apart} of {tried} pairs are told apart")


if __name__ == "__main__":
    main()
