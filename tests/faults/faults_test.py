"""Every call of the system that a command makes fails once: an answer, or one line and no file half
written.

usage: faults_test.py SLIDEWAY LIBRARY [MOST]

LIBRARY is failing_calls.c as a shared library. MOST is how many allocations of each command fail,
spread over the run (all other calls fail each in turn); 0: every one.
"""

import sys
import unittest

from commands import BAD_DATA, BAD_USAGE, COMMANDS, DONE, FAILED, SOME_FAILED, given_files, run

MOST = int(sys.argv[3]) if len(sys.argv) > 3 else 10
CALLS = ["malloc", "read", "write", "writev", "open", "fopen", "fopen64", "close", "fstat", "fsync", "rename",
         "linkat", "mkdir", "mmap", "fork", "pipe2", "pthread_create", "clock_gettime"]


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.given = given_files()

    def walk(self, name):
        arguments = COMMANDS[name]
        usual = run(arguments, self.given)
        self.assertEqual(DONE, usual.code, usual.err)
        for call in CALLS:
            most = run(arguments, self.given, f"{call}:0").calls
            numbers = range(1, most + 1)
            if call == "malloc" and MOST and most > MOST:
                numbers = sorted({round(most ** (i / (MOST - 1))) for i in range(MOST)})
            for number in numbers:
                with self.subTest(call=call, number=number):
                    self.judge(name, usual, run(arguments, self.given, f"{call}:{number}"))

    def judge(self, name, usual, now):
        allowed = [DONE, FAILED, BAD_USAGE, BAD_DATA] + [SOME_FAILED] * (name == "batch")
        self.assertIn(now.code, allowed, now.err)
        for file, data in now.files.items():
            self.assertIn(file, usual.files, "a file that does not belong there")
            if name != "batch":
                self.assertEqual(usual.files[file], data, f"{file} is not whole")
        if now.code == DONE and name != "batch":
            self.assertEqual(usual.files.keys(), now.files.keys(), "a file is missing")
            self.assertEqual(usual.out, now.out)
        if now.code in (FAILED, BAD_USAGE, BAD_DATA):
            if name == "check" and now.out:
                return  # it lists the faults of the problem
            lines = now.err.strip().split("\n")
            self.assertEqual(1, len(lines), now.err)
            self.assertTrue(lines[0].startswith("slideway: "), now.err)


for command in COMMANDS:
    setattr(Faults, f"test_{command}", lambda self, command=command: self.walk(command))

if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
