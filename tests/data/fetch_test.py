"""data/fetch.py against a server of the test's own on the loopback interface."""

import functools
import hashlib
import http.server
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

FETCH = Path(__file__).parents[2] / "data" / "fetch.py"


class Quiet(http.server.SimpleHTTPRequestHandler):
    asked: list[str] = []

    def log_message(self, *_):
        self.asked.append(self.path)


def sha(content):
    return hashlib.sha256(content).hexdigest()


class Fetch(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.origin, self.folder = Path(scratch.name, "origin"), Path(scratch.name, "data")
        self.origin.mkdir()
        self.list = Path(scratch.name, "sources.tsv")
        Quiet.asked.clear()
        server = http.server.ThreadingHTTPServer(
            ("127.0.0.1", 0), functools.partial(Quiet, directory=str(self.origin)))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        self.address = f"http://127.0.0.1:{server.server_port}/"

    def fetch(self, *entries):
        self.list.write_text("# comment\n" + "".join("\t".join(entry) + "\n" for entry in entries))
        return subprocess.run([sys.executable, "-B", FETCH, self.folder, "--list", self.list],
                              capture_output=True, text=True)

    def test_file_is_fetched_and_the_second_time_left_alone(self):
        (self.origin / "a.dat").write_bytes(b"1 2\n")
        entry = ("set/a.dat", sha(b"1 2\n"), "copy", self.address + "a.dat")
        for _ in range(2):
            done = self.fetch(entry)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("1 of 1 files", done.stdout)
        self.assertEqual((self.folder / "set/a.dat").read_bytes(), b"1 2\n")
        self.assertEqual(Quiet.asked, ["/a.dat"])

    def test_wrong_checksum_is_told_and_the_file_not_written(self):
        (self.origin / "a.dat").write_bytes(b"1 3\n")
        done = self.fetch(("a.dat", sha(b"1 2\n"), "copy", self.address + "a.dat"))
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"a.dat: SHA-256 {sha(b'1 3' + bytes([10]))} is not {sha(b'1 2' + bytes([10]))}", done.stderr)
        self.assertFalse((self.folder / "a.dat").exists())

    def test_file_that_is_not_there_is_told_and_the_next_one_fetched(self):
        (self.origin / "b.dat").write_bytes(b"b")
        done = self.fetch(("a.dat", sha(b"a"), "copy", self.address + "a.dat"),
                          ("b.dat", sha(b"b"), "copy", self.address + "b.dat"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("could not be had: a.dat: " + self.address + "a.dat: HTTP Error 404", done.stderr)
        self.assertTrue((self.folder / "b.dat").exists())

    def test_damaged_file_is_fetched_again(self):
        (self.origin / "a.dat").write_bytes(b"right")
        self.folder.mkdir()
        (self.folder / "a.dat").write_bytes(b"wrong")
        self.fetch(("a.dat", sha(b"right"), "copy", self.address + "a.dat"))
        self.assertEqual((self.folder / "a.dat").read_bytes(), b"right")

    def test_server_that_does_not_answer_is_told(self):
        done = self.fetch(("a.dat", sha(b"a"), "copy", "http://127.0.0.1:9/a.dat"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("could not be had: a.dat", done.stderr)

    def test_answer_that_breaks_off_or_is_none_is_told_and_the_next_file_fetched(self):
        (self.origin / "b.dat").write_bytes(b"b")
        answers = [b"HTTP/1.0 200 OK\r\nContent-Length: 9\r\n\r\nhalf", b"\x00 what\r\n\r\n"]
        with socket.create_server(("127.0.0.1", 0)) as server:
            def answer():
                for each in answers:
                    connection, _ = server.accept()
                    with connection:
                        connection.recv(4096)
                        connection.sendall(each)
            threading.Thread(target=answer, daemon=True).start()
            broken = f"http://127.0.0.1:{server.getsockname()[1]}/"
            done = self.fetch(("a.dat", sha(b"a"), "copy", broken + "a.dat"),
                              ("c.dat", sha(b"c"), "copy", broken + "c.dat"),
                              ("b.dat", sha(b"b"), "copy", self.address + "b.dat"))
        self.assertEqual(done.returncode, 1)
        self.assertNotIn("Traceback", done.stderr)
        self.assertIn("could not be had: a.dat: ", done.stderr)
        self.assertIn("could not be had: c.dat: ", done.stderr)
        self.assertTrue((self.folder / "b.dat").exists())

    def test_hand_made_table_is_right_whatever_its_comments_say_and_never_fetched(self):
        self.folder.mkdir()
        (self.folder / "t.csv").write_bytes(b"# typed by me\nx\n1\n")
        there = ("t.csv", sha(b"x\n1\n"), "by_hand", self.address + "page")
        self.assertEqual(self.fetch(there).returncode, 0)
        done = self.fetch(there, ("u.csv", sha(b""), "by_hand", self.address + "page"))
        self.assertIn(f"could not be had: u.csv: made by hand from {self.address}page", done.stderr)
        self.assertEqual(Quiet.asked, [])

    def test_rows_of_the_test_bar_are_made_from_both_logs(self):
        (self.origin / "bar.log").write_bytes(struct.pack("<4d", 1000.0, 0.338, 1000.25, 0.3375))
        (self.origin / "feed.log").write_bytes(struct.pack("<4d", 999.976, 10.269, 1000.226, 10.2695))
        rows = (b"index,t712_s,bar_mm,t710_s,zind_mm\n0,0.0000,0.3380,-0.0240,10.2690\n"
                b"1,0.2500,0.3375,0.2260,10.2695\n")
        done = self.fetch(("bar.csv", sha(rows), "test_bar", self.address + "bar.log", self.address + "feed.log"))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertTrue((self.folder / "bar.csv").read_bytes().endswith(rows))

    def test_stations_of_the_level_are_the_triggered_records(self):
        # 28-bit angles in units of 2^-28 / 16 rad, bit 0 unused: -0.25 and 0.5 rad/1000, third record pressed
        def word(mm_per_m):
            return (round(mm_per_m / 1000 * 2**28) >> 4) & 0xFFFFFFE
        records = [(100.0, 0.0, 0.0, 0), (100.5, 1.0, 1.0, 0), (101.25, -0.25, 0.5, 1)]
        log = b"".join(struct.pack("<dIIB", t, word(x), word(y), pressed) for t, x, y, pressed in records)
        (self.origin / "level.log").write_bytes(log)
        rows = (b"station,t_s,x_origin_mm,raw_x_mm_per_m,raw_y_mm_per_m\n"
                b"1,1.250,1000.0,-0.25010,0.49996\n")  # whole steps of 32 / 2^28 rad, downwards
        done = self.fetch(("run.csv", sha(rows), "level", self.address + "level.log"))
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
