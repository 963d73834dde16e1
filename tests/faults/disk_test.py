"""A disk that is full at a byte, a file that cannot be read, no descriptors left: an answer or one line, files
under their names whole or as they were, and nothing beside them.

usage: disk_test.py SLIDEWAY LIBRARY [PLACES]

PLACES is at how many bytes of its output the disk is full for each command (3), spread over it with the first and
the last byte of every file; 0: at each byte, and every number of descriptors from 3 to 20 for each command.
"""

import itertools
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "serve"))
from commands import (BAD_DATA, BAD_USAGE, COMMANDS, DONE, FAILED, LIBRARY, PROGRAM, SOME_FAILED,  # noqa: E402
                      given_files, run)
from server import Server  # noqa: E402

PLACES = int(sys.argv[3]) if len(sys.argv) > 3 else 3
LINE_OF_LOADER = 127
OLD = b"what was there before\n"

WRITERS = {
    **{name: arguments for name, arguments in COMMANDS.items() if name not in ("check", "info", "from_x3p", "batch")},
    "init": ["init", "fine.csv", "--yes", "--force", "--quiet", "--out", "out.toml"],
    "plan": ["plan", "problem.toml", "--json", "out.json", "--html", "out.html"],
    "planned": ["plan", "problem.toml", "--out", "out"],
    "to_sdf": ["convert", "fine.csv", "out.sdf", "--position-unit", "mm", "--value-unit", "um"],
    "demo": ["demo", "--quiet", "--out", "out"],
    "merge": ["batch", "merge", "out.jsonl", "made.jsonl"],
}
PAGES_OF_DEMO = ("out/report.html", "out/result.json")  # it refuses to replace another example


def places(sizes):
    """Bytes of the outputs, counted from 1 through all of them."""
    total = sum(sizes)
    if PLACES == 0 or total <= PLACES:
        return range(1, total + 1)
    ends = {end + more for end in itertools.accumulate(sizes, initial=0) for more in (0, 1)}
    spread = {1 + (2 * i + 1) * (total - 1) // (2 * PLACES) for i in range(PLACES)}
    return sorted(at for at in ends | spread if 1 <= at <= total)


class Disk(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.given = given_files()
        cls.batch = run(COMMANDS["batch"], cls.given)
        cls.given["made.jsonl"] = cls.batch.files["out.jsonl"]

    def one_line(self, err):
        lines = err.strip().split("\n")
        self.assertEqual(1, len(lines), err)
        self.assertTrue(lines[0].startswith("slideway: "), err)
        return lines[0].removeprefix("slideway: ")


class DiskFull(Disk):
    def walk(self, name):
        arguments = WRITERS[name]
        usual = run(arguments, self.given, "bytes:0")
        self.assertEqual(DONE, usual.code, usual.err)
        sizes = [len(data) for data in usual.files.values()]
        self.assertEqual(sum(sizes), usual.calls, "bytes go past the library")
        replaced = [file for file in usual.files if name != "demo" or file in PAGES_OF_DEMO]
        old = {**self.given, **{file: OLD for file in replaced}}
        for at in places(sizes):
            given = old if at % 2 else self.given
            with self.subTest(at=at, old=given is old):
                self.judge(usual, run(arguments, given, f"bytes:{at}"))
        self.assertEqual(usual.files, run(arguments, old, f"bytes:{usual.calls + 1}").files)

    def judge(self, usual, now):
        self.assertEqual(FAILED, now.code, now.err)
        named, reason = self.one_line(now.err).split(": ", 1)
        self.assertEqual("cannot be written: No space left on device", reason)
        self.assertIn(named, usual.files)
        self.assertNotIn(named, now.files)
        for file, data in now.files.items():
            self.assertEqual(usual.files.get(file), data, f"{file} is not whole")


for command in WRITERS:
    setattr(DiskFull, f"test_{command}", lambda self, command=command: self.walk(command))


class BatchOnAFullDisk(Disk):
    """Its results grow by lines: whole ones, and one that is torn where the rest cannot be taken back."""

    def walk(self, call):
        arguments = COMMANDS["batch"]
        lines = self.batch.files["out.jsonl"].splitlines(keepends=True)
        for at in places([len(line) for line in lines]):
            with self.subTest(at=at):
                now = run(arguments, self.given, f"{call}:{at}")
                self.assertEqual(FAILED, now.code, now.err)
                self.assertEqual("out.jsonl: cannot be written: No space left on device", self.one_line(now.err))
                self.assertEqual({"out.jsonl"}, now.files.keys())
                *whole, torn = now.files["out.jsonl"].split(b"\n")
                self.assertLess(len(whole), len(lines))
                for line in whole:
                    self.assertIn(line + b"\n", lines)
                self.assertTrue(any(line.startswith(torn) for line in lines))
                if call == "bytes":
                    self.assertEqual(b"", torn)
                again = run([*arguments, "--resume"], {**self.given, **now.files})
                self.assertEqual(DONE, again.code, again.err)
                self.assertEqual(sorted(lines), sorted(again.files["out.jsonl"].splitlines(keepends=True)))

    def test_leaves_whole_lines(self):
        self.walk("bytes")

    def test_goes_on_behind_a_torn_line(self):
        self.walk("torn")


class ServeOnAFullDisk(Disk):
    """It says so to who asks, shows no part of a run, and goes on answering."""

    FILES = ("fine.csv", "coarse.csv", "problem.toml")

    def ask_for_run(self, server):
        """@return what the first request that failed was told, or nothing"""
        status, body, _ = server.ask("POST", "drafts")
        self.assertEqual(200, status)
        draft = f"drafts/{json.loads(body)['id']}"
        requests = ("files?name=fine.csv", "files?name=coarse.csv", "run?name=run")
        for request, data in zip(requests, self.FILES):
            status, body, _ = server.ask("POST", f"{draft}/{request}", self.given[data])
            if status != 200:
                return status, json.loads(body)["error"]
        self.assertEqual("done", server.wait(json.loads(body)["job"])["state"])
        return None

    def test_at_each_byte(self):
        # Each file goes into the draft and from there into the run, the problem into both as well.
        sizes = [len(self.given[name]) for name in self.FILES]
        environment = {**os.environ, "LD_PRELOAD": LIBRARY}
        for at in [*places(sizes * 2), sum(sizes) * 4]:
            with self.subTest(at=at), tempfile.TemporaryDirectory() as name, unittest.mock.patch.dict(
                    os.environ, {**environment, "FAILING_CALL": f"bytes:{at}"}):
                server = Server(PROGRAM, pathlib.Path(name) / "runs")
                try:
                    told = self.ask_for_run(server)
                    if told or at <= sum(sizes):
                        self.assertEqual(500, told[0])
                        self.assertIn("No space left on device", told[1])
                    self.assertEqual([] if told else ["run"],
                                     [each["name"] for each in server.get("runs")["runs"]])
                finally:
                    self.assertEqual(DONE, server.end())
        self.assertIsNone(told)


class Unreadable(Disk):
    """A file system, over a network perhaps, that gives EIO for one file."""

    def walk(self, name):
        arguments = COMMANDS[name]
        usual = run(arguments, self.given)
        reason = "cannot be read: Input/output error"
        read = 0
        for file in self.given:
            with self.subTest(file=file):
                now = run(arguments, self.given, failing_file=file)
                if now.code == DONE:
                    self.assertEqual(usual.out, now.out)
                    self.assertEqual(usual.files.keys(), now.files.keys())
                    continue
                read += 1
                if name == "batch" and now.code == SOME_FAILED:
                    for line in now.files["out.jsonl"].decode().splitlines():
                        self.assertIn(f"{file}: {reason}", line)
                    continue
                self.assertEqual({}, now.files)
                self.assertIn(now.code, (BAD_USAGE, BAD_DATA))
                said = now.out.decode() if name == "check" and now.out else self.one_line(now.err)
                self.assertIn(f"{file}: {reason}", " ".join(said.split()))
        self.assertGreater(read, 0)


for command in COMMANDS:
    setattr(Unreadable, f"test_{command}", lambda self, command=command: self.walk(command))


def limited(count):
    return lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (count, count))


class NoDescriptors(Disk):
    """From none beyond the three standard ones on."""

    COUNTS = (3, 4, 5, 6, 8, 11, 20) if PLACES else range(3, 21)

    def allowed(self, code, err):
        if code == LINE_OF_LOADER:  # it never came to main()
            self.assertIn("error while loading shared libraries", err)
        elif code != DONE:
            self.assertIn(code, (FAILED, BAD_USAGE, BAD_DATA))
            self.one_line(err)

    def walk(self, name):
        arguments = {**COMMANDS, **WRITERS, "refused": ["info", "nothing.csv"]}[name]
        usual = run(arguments, self.given)
        for count in self.COUNTS:
            with self.subTest(count=count):
                now = run(arguments, self.given, preload=False, before=limited(count))
                self.allowed(now.code, now.err)
                for file, data in now.files.items():
                    self.assertEqual(usual.files.get(file), data, f"{file} is not whole")
                if now.code == usual.code:
                    self.assertEqual(usual.files, now.files)

    def test_serve(self):
        for count in self.COUNTS:
            with self.subTest(count=count), tempfile.TemporaryDirectory() as name:
                with subprocess.Popen([PROGRAM, "serve", pathlib.Path(name) / "runs"], preexec_fn=limited(count),
                                      stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as server:
                    said = [server.stdout.readline(), server.stdout.readline()]
                    if said[1]:
                        self.assertIn("http://127.0.0.1:", said[1])
                        server.send_signal(signal.SIGTERM)
                    _, err = server.communicate(timeout=30)
                if not said[1]:
                    self.assertNotEqual(DONE, server.returncode)
                    self.allowed(server.returncode, err)


for command in (*COMMANDS, *WRITERS, "refused"):
    setattr(NoDescriptors, f"test_{command}", lambda self, command=command: self.walk(command))

if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
