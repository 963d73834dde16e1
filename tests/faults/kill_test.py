"""SIGKILL at random moments: files whole or as they were under their names, no process left behind, and what was
begun can be gone on with.

usage: kill_test.py SLIDEWAY LIBRARY [MOMENTS [SEED]]

MOMENTS is how many of each command (10).
"""

import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "serve"))
from commands import DONE, PROGRAM, content, given_files, run  # noqa: E402
from server import Server  # noqa: E402

MOMENTS = int(sys.argv[3]) if len(sys.argv) > 3 else 10
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 22
OLD = b"what was there before\n"
BATCH = ["batch", "list.csv", "--out", "out.jsonl", "--jobs", "2"]


def processes_in(folder):
    """Those of the program whose working directory is within the folder."""
    found = set()
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if (os.readlink(process / "exe") == PROGRAM
                    and pathlib.Path(os.readlink(process / "cwd")).is_relative_to(folder)):
                found.add(int(process.name))
        except OSError:
            continue
    return found


class Killed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.given = given_files()
        cls.given["long.csv"] = "".join(f"{i / 1000},{(i * 7919) % 1000 / 1000}\n" for i in range(100_000)).encode()
        cls.given["truth.toml"] += b"\n[truth]\nnoise_um = 0.1\nsamples = 20000\n"
        cls.given["list.csv"] = b"id,problem\n" + b"".join(b"%c,problem.toml\n" % i for i in b"abcdef")

    def setUp(self):
        self.random = random.Random(f"{SEED} {self.id()}")
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name).resolve()
        for name, data in self.given.items():
            (self.folder / name).write_bytes(data)

    def whole_run(self, arguments):
        """@return the files of a run that nothing ends, and how long one takes"""
        begin = time.monotonic()
        done = run(arguments, self.given, preload=False)
        self.assertEqual(DONE, done.code, done.err)
        return done.files, time.monotonic() - begin

    def kill(self, arguments, longest):
        """Runs the command and kills it. @return whether it was done before"""
        with subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as process:
            time.sleep(self.random.uniform(0, longest))
            process.kill()
            _, err = process.communicate()
        self.assertIn(process.returncode, (DONE, -signal.SIGKILL), err)
        self.none_left()
        return process.returncode == DONE

    def none_left(self, seconds=10):
        until = time.monotonic() + seconds
        while left := processes_in(self.folder):
            self.assertLess(time.monotonic(), until, f"processes are left: {left}")
            time.sleep(0.005)

    def left(self):
        """What is there beside the given files; a name not yet given counts as none."""
        return {name: data for name, data in content(self.folder).items()
                if data != self.given.get(name) and not pathlib.Path(name).name.startswith(".slideway.")}

    def clear(self, files):
        for name in files:
            (self.folder / name).unlink(missing_ok=True)

    def whole_or_old(self, arguments):
        usual, longest = self.whole_run(arguments)
        for moment in range(MOMENTS):
            before = OLD if moment % 2 else None
            for name in usual:
                (self.folder / name).parent.mkdir(exist_ok=True)
                if before:
                    (self.folder / name).write_bytes(before)
            with self.subTest(moment=moment):
                done = self.kill(arguments, longest)
                left = self.left()
                self.assertLessEqual(left.keys(), usual.keys())
                for name, data in usual.items():
                    self.assertIn(left.get(name), (data,) if done else (before, data), f"{name} is not whole")
            self.clear(usual)

    def test_convert(self):
        self.whole_or_old(["convert", "long.csv", "out.x3p", "--position-unit", "mm", "--value-unit", "um"])

    def test_simulate(self):
        self.whole_or_old(["simulate", "truth.toml", "--out", "out", "--seed", "1"])

    def test_batch_goes_on(self):
        """Every second time what goes on is killed as well."""
        usual, longest = self.whole_run(BATCH)
        lines = usual["out.jsonl"].splitlines(keepends=True)
        for moment in range(MOMENTS):
            with self.subTest(moment=moment):
                self.kill([*BATCH, "--resume"], longest)
                self.check_lines(lines)
                if moment % 2 == 0:
                    continue
                done = subprocess.run([PROGRAM, *BATCH, "--resume"], cwd=self.folder, capture_output=True, check=False)
                self.assertEqual(DONE, done.returncode, done.stderr)
                self.assertEqual(sorted(lines), sorted(self.left()["out.jsonl"].splitlines(keepends=True)))
            if moment % 2:
                self.clear(usual)

    def check_lines(self, lines):
        left = self.left()
        self.assertLessEqual(left.keys(), {"out.jsonl"})
        *whole, torn = left.get("out.jsonl", b"").split(b"\n")
        for line in whole:
            self.assertIn(line + b"\n", lines)
        self.assertEqual(len(set(whole)), len(whole))
        self.assertTrue(any(line.startswith(torn) for line in lines))

    def test_serve(self):
        """A run is there whole or not at all, and the next server goes on with it."""
        runs = self.folder / "runs"
        for name in ("problem.toml", "fine.csv", "coarse.csv"):
            (self.folder / "expected").mkdir(exist_ok=True)
            (self.folder / "expected" / name).write_bytes(self.given[name])
        subprocess.run([PROGRAM, "identify", "problem.toml", "--quiet", "--json", "result.json", "--html",
                        "report.html"], cwd=self.folder / "expected", check=True)
        expected = content(self.folder / "expected")
        server, known = self.start(), set()
        begin = time.monotonic()
        self.assertEqual("done", server.wait(self.begin_run(server))["state"])
        longest = time.monotonic() - begin
        for moment in range(MOMENTS):
            with self.subTest(moment=moment):
                self.begin_run(server)
                time.sleep(self.random.uniform(0, longest))
                server.end(signal.SIGKILL)
                self.none_left()
                server = self.start()
                shown = [each["name"] for each in server.get("runs")["runs"]]
                there = {path.name for path in runs.iterdir() if not path.name.startswith(".")}
                self.assertEqual(there, set(shown))
                self.assertLessEqual(known, there)
                for name in there - known:
                    self.assertEqual(expected, content(runs / name))
                self.assertEqual(expected["report.html"], server.ask("GET", f"runs/{shown[0]}/report.html")[1])
                self.assertEqual({}, content(runs / ".slideway-serve"))
                known = there
        server.end()

    def start(self):
        server = Server(PROGRAM, self.folder / "runs")
        self.addCleanup(server.end)
        return server

    def begin_run(self, server):
        draft = server.draft(*((name, self.given[name]) for name in ("fine.csv", "coarse.csv")))
        return server.post(f"drafts/{draft}/run?name=run", self.given["problem.toml"])["job"]


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[5:])
