"""slideway beside PyWavelets, NumPy, SciPy, pandas and lmfit, in one run: peers.py BIN OUT.md
[LARGEST]. Both sides are held against one another before any time is taken. Times are elapsed time,
of several runs the median, so the machine must have nothing else to do; ratios above 1 are ours."""
import json
import os
import pathlib
import platform
import re
import statistics
import subprocess
import sys
import time

import lmfit
import numpy as np
import pandas
import pywt
import scipy
import scipy.optimize

HERE = pathlib.Path(__file__).parent
BIN = pathlib.Path(sys.argv[1])
LARGEST = int(float(sys.argv[3])) if len(sys.argv) > 3 else 10_000_000
SIZES = [n for n in (20_000, 1_000_000, 10_000_000) if n <= LARGEST]
WORK = pathlib.Path("build/peers")
LEVELS = 5
rows = []


def repetitions(n):
    return {20_000: 15, 1_000_000: 5}.get(n, 3)


def timed(n, work):
    """Median time of work(), s"""
    times = []
    for _ in range(repetitions(n)):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def run_timed(n, command):
    """(median time in s, median processor time in s) of a process"""
    processor, wall = [], []
    for _ in range(repetitions(n)):
        start = time.perf_counter()
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        wall.append(time.perf_counter() - start)
        assert status == 0, command
        processor.append(usage.ru_utime + usage.ru_stime)
    return statistics.median(wall), statistics.median(processor)


def ours(program, benchmark):
    """{name: median time in s} of a benchmark program at the sizes of this run"""
    pattern = f"{benchmark}/(.*/)?({'|'.join(map(str, SIZES))})/process_time"
    out = subprocess.run(
        [BIN / program, f"--benchmark_filter={pattern}", "--benchmark_format=json",
         "--benchmark_repetitions=3", "--benchmark_min_time=0.05"],
        check=True, capture_output=True, text=True)  # fmt: skip
    unit = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3}
    return {
        re.sub("/(process_time|real_time)", "", b["run_name"]): b["real_time"] * unit[b["time_unit"]]
        for b in json.loads(out.stdout)["benchmarks"]
        if b.get("aggregate_name") == "median"
    }


def add(stage, n, peer, theirs, mine, wanted):
    ratio = theirs / mine
    rows.append((stage, n, peer, theirs, mine, ratio, wanted))
    print(f"{stage:40} {n:9} {peer:24} {theirs:9.4f} s {mine:9.4f} s {ratio:6.1f} ({wanted})",
          file=sys.stderr)  # fmt: skip


def slideway(*arguments):
    return subprocess.run([BIN / "slideway", *map(str, arguments)], check=True,
                          capture_output=True, text=True).stdout  # fmt: skip


def profile(n):
    """A simulated face of n samples: (problem file, profile file)"""
    folder = WORK / str(n)
    if not (folder / "simulated" / "problem.toml").exists():
        folder.mkdir(parents=True, exist_ok=True)
        step = 600.0 / n
        with open(folder / "positions.csv", "w") as file:
            file.write("x_mm,z_um\n")
            file.writelines(f"{i * step:.6f},0\n" for i in range(n))
        (folder / "truth.toml").write_text((HERE / "truth.toml").read_text())
        slideway("simulate", folder / "truth.toml", "--out", folder / "simulated")
    return folder / "simulated" / "problem.toml", folder / "simulated" / "face.csv"


def bands_of(z, wavelet, mode):
    parts = pywt.wavedec(z, wavelet, mode, LEVELS)
    nothing = [np.zeros_like(p) for p in parts]
    bands = {}
    for i, part in enumerate(parts):
        kept = nothing[:i] + [part] + nothing[i + 1 :]
        bands["a5" if i == 0 else f"d{LEVELS + 1 - i}"] = pywt.waverec(kept, wavelet, mode)[: len(z)]
    for j in range(LEVELS, 1, -1):
        bands[f"a{j - 1}"] = bands[f"a{j}"] + bands[f"d{j}"]
    return bands


def compare_wavelets(z, path):
    for wavelet in ("db1", "db4"):
        for mode in ("symmetric", "periodization"):
            out = WORK / "bands.csv"
            slideway("decompose", path, "--out", out, "--wavelet", wavelet, "--boundary", mode)
            found, theirs = pandas.read_csv(out, float_precision="round_trip"), bands_of(z, wavelet, mode)
            for name, band in theirs.items():
                gap = np.abs(found[name].to_numpy() - band).max() / np.abs(z).max()
                assert gap < 1e-11, (wavelet, mode, name, gap)


def wavelets():
    forward = ours("signal_bench", "BM_DwtForward")
    bands = ours("signal_bench", "BM_Bands")
    for n in SIZES:
        z = np.random.default_rng(1).normal(size=n)
        for wavelet in ("db1", "db4"):
            for mode in ("symmetric", "periodization"):
                name = f"{wavelet}_{mode}/{n}"
                add(f"forward DWT, {wavelet} {mode}", n, "PyWavelets",
                    timed(n, lambda: pywt.wavedec(z, wavelet, mode, LEVELS)),
                    forward[f"BM_DwtForward/{name}"], ">= 3")  # fmt: skip
                if f"BM_Bands/{name}" in bands:
                    add(f"all ten bands, {wavelet} {mode}", n, "PyWavelets",
                        timed(n, lambda: bands_of(z, wavelet, mode)),
                        bands[f"BM_Bands/{name}"], ">= 10")  # fmt: skip


def tables():
    mine = ours("table_bench", "BM_ReadTable")
    size = {n: BENCH_BYTES(n) for n in SIZES}
    for n in SIZES:
        _, path = profile(n)
        share = os.path.getsize(path) / size[n]
        for peer, read in {
            "numpy.loadtxt": lambda: np.loadtxt(path, delimiter=",", skiprows=1),
            "pandas": lambda: pandas.read_csv(path),
            "pandas, round_trip": lambda: pandas.read_csv(path, float_precision="round_trip"),
        }.items():
            add("CSV, two columns (per byte)", n, peer, timed(n, read),
                mine[f"BM_ReadTable/two_threads/{n}"] * share, "faster")  # fmt: skip
    return [(name, {n: size[n] / mine[f"BM_ReadTable/{name}/{n}"] / 1e6 for n in SIZES})
            for name in ("one_thread", "two_threads")]  # fmt: skip


def BENCH_BYTES(n):
    """what bench/table_bench.cpp writes for n rows, by its label"""
    out = subprocess.run([BIN / "table_bench", f"--benchmark_filter=BM_ReadTable/two_threads/{n}/",
                          "--benchmark_format=json", "--benchmark_min_time=0.001"],
                         check=True, capture_output=True, text=True)  # fmt: skip
    bench = json.loads(out.stdout)["benchmarks"][0]
    return bench["bytes"]


def compare_tables():
    values = np.random.default_rng(2).normal(size=(20_000, 2)) * 10.0 ** np.arange(-4, 4)[
        np.random.default_rng(3).integers(0, 8, size=(20_000, 1))]  # fmt: skip
    values[:, 0] = np.sort(values[:, 0])
    path, copy = WORK / "digits.csv", WORK / "copy.csv"
    path.write_text("x_mm,z_um\n" + "".join(f"{x:.17g},{z:.17g}\n" for x, z in values))
    slideway("convert", path, copy, "--position-unit", "mm", "--value-unit", "um")
    assert (np.loadtxt(copy, delimiter=",", skiprows=1) == values).all()


def low_band(signal):
    return pywt.wavedec(signal, "db1", "symmetric", LEVELS)[0]


def fits():
    mine = ours("identify_bench", "BM_FitWithCovariance")
    for n in SIZES:
        problem, path = profile(n)
        x, z = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)
        u = 2 * x / x[-1] - 1
        matrix = np.polynomial.legendre.legvander(u, 5)
        matrix = np.column_stack([matrix, np.cos(u)])
        found = json.loads(slideway("fit", problem, "--json", "-"))["fit"]["rms_um"]
        inside = np.polynomial.legendre.legvander(low_band(u) / 32**0.5, 5)
        low = low_band(z)
        rest = low - inside @ np.linalg.lstsq(inside, low, rcond=None)[0]
        theirs = np.sqrt(rest @ rest / n)
        assert abs(found / theirs - 1) < 1e-4, (n, found, theirs)  # priors move it so much

        def lstsq():
            a = np.column_stack([np.polynomial.legendre.legvander(u, 5), np.cos(u)])
            coefficients, squares, *_ = np.linalg.lstsq(a, z, rcond=None)
            return squares / n * np.linalg.inv(a.T @ a)

        def residual(p):
            return matrix @ (list(p.valuesdict().values()) if hasattr(p, "valuesdict") else p) - z

        def with_lmfit():
            parameters = lmfit.Parameters()
            for k in range(7):
                parameters.add(f"c{k}", 0.0)
            lmfit.minimize(residual, parameters)

        add("fit with covariance", n, "numpy.linalg.lstsq", timed(n, lstsq),
            mine[f"BM_FitWithCovariance/{n}"], ">= 8")  # fmt: skip
        add("fit with covariance", n, "scipy least_squares",
            timed(n, lambda: scipy.optimize.least_squares(residual, np.zeros(7), jac=lambda p: matrix)),
            mine[f"BM_FitWithCovariance/{n}"], ">= 20")  # fmt: skip
        add("fit with covariance", n, "lmfit", timed(n, with_lmfit),
            mine[f"BM_FitWithCovariance/{n}"], ">= 20")  # fmt: skip


def whole_jobs():
    lines = []
    limit = {20_000: ">= 25", 1_000_000: ">= 8", 10_000_000: ">= 8"}
    for n in SIZES:
        problem, path = profile(n)
        command = [BIN / "slideway", "identify", problem, "--no-trace", "--json", WORK / "report.json"]
        mine, processor = run_timed(n, command)
        lines.append((n, mine, processor))
        for peer in ("loadtxt", "pandas", "lmfit"):
            theirs, _ = run_timed(n, [sys.executable, HERE / "job.py", path, peer])
            add("whole identify --no-trace --json", n, f"job.py, {peer}", theirs, mine, limit[n])
    return lines


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    _, path = profile(20_000)
    compare_wavelets(np.loadtxt(path, delimiter=",", skiprows=1, usecols=1), path)
    compare_tables()
    wavelets()
    csv = tables()
    fits()
    whole = whole_jobs()
    versions = (f"Python {platform.python_version()}, NumPy {np.__version__}, SciPy "
                f"{scipy.__version__}, PyWavelets {pywt.__version__}, pandas {pandas.__version__}, "
                f"lmfit {lmfit.__version__}; {os.cpu_count()} cores, load "
                f"{os.getloadavg()[0]:.0f}")  # fmt: skip
    with open(sys.argv[2], "w") as out:
        print(f"{versions}\n", file=out)
        print("| stage | N | peer | peer, s | slideway, s | ratio | wanted |", file=out)
        print("|---|---|---|---|---|---|---|", file=out)
        for stage, n, peer, theirs, mine, ratio, wanted in rows:
            print(f"| {stage} | {n:.0e} | {peer} | {theirs:.3g} | {mine:.3g} | {ratio:.1f} | "
                  f"{wanted} |", file=out)  # fmt: skip
        print("\n| whole job, N | s | processor time, s |\n|---|---|---|", file=out)
        for n, mine, processor in whole:
            print(f"| {n:.0e} | {mine:.3g} | {processor:.3g} |", file=out)
        print("\n| CSV, MB/s |", *(f"{n:.0e} |" for n in SIZES), file=out)
        print("|---|" + "---|" * len(SIZES), file=out)
        for name, rates in csv:
            print(f"| {name} |", *(f"{rates[n]:.0f} |" for n in SIZES), file=out)


main()
