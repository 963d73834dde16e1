#!/usr/bin/env python3
"""plan.py PROGRAM [COUNT]: whether a planned cut reaches the U that `slideway plan` promises.

Each problem is one simulated face, or three like it, and, as [[plan.cut]], another one at another
feed, direction or level. That is then simulated, too, and U of the fit of all is held against the
promise. The noise is white in a third of the problems, else it has a memory.
"""

import json
import pathlib
import random
import subprocess
import sys
import tempfile

FACE = """[[profile]]
name = "{name}"
file = "{name}.csv"
position_unit = "mm"
value_unit = "um"
window = [0.0, {diameter}]
center_mm = {radius}
cut_radius_mm = {radius}
feed_mm_per_min = {feed}
spindle_rpm = {rpm}
cut_direction = "{direction}"
z_mm = {z}
"""
REST = """[[effect]]
name = "squareness"
[[effect]]
name = "straightness"
degree = {degree}
[trace]
candidates = ["linear_drift", "cup"]
"""
TRUTH = """[truth]
seed = {seed}
samples = 8000
noise_um = {noise}
noise_correlation_mm = {memory}
parameters = {{ "squareness.dbeta_xz" = 1e-5, "straightness.b2" = 2e-7 }}
"""
MACHINE = '[machine]\nlever = "paper"\n[low_band]\nlevel = 4\n'
KEPT = 0.15


def drawn(seed):
    """The face, the planned one, and what all are made of."""
    rng = random.Random(seed)
    radius = rng.choice([10.0, 40.0, 150.0])
    first = {
        "name": "first",
        "diameter": 2 * radius,
        "radius": radius,
        "feed": rng.choice([2.0, 8.0, 20.0]),
        "rpm": rng.choice([110.0, 500.0]),
        "direction": rng.choice(["inward", "outward"]),
        "z": 0.0,
    }
    planned = dict(first, name="planned")
    what = rng.choice(["feed", "direction", "z"])
    if what == "feed":
        planned["feed"] = first["feed"] * rng.choice([0.25, 4.0])
    elif what == "direction":
        planned["direction"] = "outward" if first["direction"] == "inward" else "inward"
    else:
        planned["z"] = radius
    truth = {
        "seed": seed,
        "noise": rng.choice([0.01, 0.05]),
        "memory": rng.choice([0.0, radius / 100.0, radius / 20.0]),
    }
    return first, planned, REST.format(degree=rng.choice([2, 3, 4])), TRUTH.format(**truth)


def result_of(program, *arguments):
    done = subprocess.run([program, *arguments, "--json", "-"], capture_output=True, check=True)
    return json.loads(done.stdout)


def ratios(program, seed, faces, folder):
    """U with the planned cut over the promised U, by parameter."""
    first, planned, rest, truth = drawn(seed)
    present = [dict(first, name=f"face{i + 1}") for i in range(faces)]
    text = MACHINE + "".join(FACE.format(**face) for face in present)
    every = folder / "every.toml"
    every.write_text(text + FACE.format(**planned) + rest + truth)
    subprocess.run([program, "simulate", every, "--out", folder, "--quiet"], check=True)
    cut = (
        f'[[plan.cut]]\nname = "planned"\ncut_direction = "{planned["direction"]}"\n'
        f'feed_mm_per_min = {planned["feed"]}\nz_mm = {planned["z"]}\n'
    )
    before = folder / "before.toml"
    before.write_text(text + rest + cut)
    plan = result_of(program, "plan", before)
    fitted = result_of(program, "identify", folder / "problem.toml")["final"]
    reached = {p["name"]: p["expanded_uncertainty"] for p in fitted["parameters"]}
    if fitted.get("straightness"):
        reached["E_ZX"] = fitted["straightness"]["expanded_uncertainty_um"]
    for quantity in plan["alone"][0]["quantities"]:
        promised = quantity["U_planned"]
        if promised and reached.get(quantity["name"]):
            yield quantity["name"], reached[quantity["name"]] / promised


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 50
    for faces in (1, 3):
        kept = 0
        for seed in range(1, count + 1):
            with tempfile.TemporaryDirectory() as folder:
                found = list(ratios(program, seed, faces, pathlib.Path(folder)))
            worst = max((abs(ratio - 1.0), name, ratio) for name, ratio in found)
            kept += worst[0] <= KEPT
            print(f"{seed:3d}  {worst[1]:24s} {worst[2]:.3f}", flush=True)
        print(f"{faces} faces: {kept} of {count} keep every promised U within {KEPT:.0%}")


if __name__ == "__main__":
    main()
