"""What the closed loop costs: loop.py PROGRAM OUT.md [CASES].

Whole processes of `identify --json`, timed one after the other; the machine must have nothing else
to do. The unit is T, the time of `peers/job.py FILE loadtxt` on 2e4 samples in the same run. Faces
are those of bench/workshop, shapes of no catalogue among them.
"""

import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "workshop"))
import shop  # noqa: E402
import workshop  # noqa: E402

SEED = 2000
FACE = """
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
spindle_rpm = {rpm}
cut_direction = "{direction}"
cut_radius_mm = {radius}
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


def run(command: list[str | os.PathLike[str]]) -> tuple[float, float]:
    """Elapsed time in s and largest memory in MB of a process that must succeed."""
    start = time.perf_counter()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    assert child.stderr
    said = child.stderr.read()
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))}: {said.decode()}")
    return time.perf_counter() - start, usage.ru_maxrss / 1024


def write_faces(folder: pathlib.Path, cuts: int, samples: int, level: int) -> pathlib.Path:
    """Cuts of one carriage, each with a drift of its own speed, white noise and a texture."""
    folder.mkdir()
    rng = np.random.default_rng([SEED, cuts])
    radius = 50.0
    x = np.linspace(-radius, radius, samples)
    text = f'title = "{cuts} cuts"\n[machine]\nlever = "paper"\n[low_band]\nlevel = {level}\n'
    for i in range(cuts):
        feed, rpm = 2.0 + i % 7, 300.0 + 100.0 * (i % 5)
        direction = "inward" if i % 2 == 0 else "outward"
        r = np.abs(x)
        minutes = ((radius - r) if direction == "inward" else r) / feed
        way = 3e-6 * (r - 25.0) ** 3 + 0.02 * r
        z = way + 0.01 * minutes + 0.02 * rng.standard_normal(samples)
        rows = "".join(f"{a:.6f},{b:.5f}\n" for a, b in zip(x, z))
        (folder / f"p{i}.csv").write_text("x_mm,z_um\n" + rows)
        text += FACE.format(name=f"p{i}", feed=feed, rpm=rpm, direction=direction, radius=radius)
    path = folder / "problem.toml"
    path.write_text(text + MODEL)
    return path


def cases(folder: pathlib.Path, count: int) -> Iterator[tuple[str, pathlib.Path]]:
    """What is timed: the row it belongs to, and its problem."""
    names = list(workshop.CLASSES)
    for i in range(count):
        name = names[i % len(names)]
        case = workshop.make(name, SEED + i, 0)
        yield "faces of a workshop", shop.write(case, folder / f"case{i}", name)
    data = pathlib.Path(os.environ.get("SLIDEWAY_DATA", ""))
    for path in sorted((HERE.parent / "problems").rglob("*.toml")):
        text = path.read_text()
        if "[[profile]]" in text and "[truth]" not in text and (
                "SLIDEWAY_DATA" not in text or data.is_dir() and data != pathlib.Path()):
            yield "problems that ship", path
    yield "one profile of 1e6 samples", write_faces(folder / "long", 1, 1_000_000, 5)
    for many in (100, 300):
        yield f"{many} profiles of 256 samples", write_faces(folder / f"many{many}", many, 256, 2)


def main() -> None:
    program, out = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 200
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        job = write_faces(folder / "job", 1, 20_000, 5).parent / "p0.csv"
        script: list[str | os.PathLike[str]] = ["/usr/bin/python3", HERE / "peers" / "job.py", job,
                                               "loadtxt"]
        unit = statistics.median(run(script)[0] for _ in range(5))
        rows: dict[str, list[tuple[float, float, str]]] = {}
        for row, path in cases(folder, count):
            took, memory = run([program, "identify", path, "--quiet", "--json", folder / "out.json"])
            what = path.parent.name if path.name == "problem.toml" else path.stem
            rows.setdefault(row, []).append((took / unit, memory, what))
            print(f"{row:28} {what:24} {took / unit:8.1f} T {memory:6.0f} MB", file=sys.stderr)
    lines = [f"T = {unit:.2f} s.", "", "| work | runs | median, T | longest, T | longest | memory, MB |",
             "|---|---|---|---|---|---|"]
    for row, all_runs in rows.items():
        longest = max(all_runs)
        lines.append(f"| {row} | {len(all_runs)} | {statistics.median(r[0] for r in all_runs):.1f} "
                     f"| {longest[0]:.1f} | {longest[2]} | {max(r[1] for r in all_runs):.0f} |")
    out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
