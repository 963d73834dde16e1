"""What `slideway serve` answers over HTTP, and what it refuses.

usage: http_test.py SLIDEWAY SOURCE_DIR
"""

import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock
import urllib.parse

PROGRAM, SOURCE = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
sys.path.insert(0, str(pathlib.Path(SOURCE) / "tests/serve"))
from server import Server  # noqa: E402

EXAMPLE = pathlib.Path(SOURCE) / "problems/demo"
PROBLEM = (EXAMPLE / "problem.toml").read_bytes()
FILES = [EXAMPLE / f"{name}.csv" for name in ("fine", "coarse", "outward")]
TEMPORARY = ".slideway-serve"
OWN_FILES = {"problem.toml", "result.json", "report.html"}
ENDED = ("", "Z")  # states of a process that has none, or that nobody has waited for


def children(pid):
    found = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == pid and fields[0] != "Z":
            found.append(int(stat.parent.name))
    return found


def command(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/cmdline").read_text().split("\0")
    except OSError:
        return []


class Serve(unittest.TestCase):
    options = ()

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.outside = pathlib.Path(temporary.name)
        self.folder = self.outside / "runs"
        self.server = self.start()

    def start(self, *options):
        server = Server(PROGRAM, self.folder, *(options or self.options))
        self.addCleanup(server.end)
        return server

    def refused(self, status, method, path, *rest, **named):
        got, body, headers = self.server.ask(method, path, *rest, **named)
        self.assertEqual(status, got, body)
        self.assertIn("error", json.loads(body))
        return headers

    def run_example(self, name="example"):
        draft = self.server.draft(*FILES)
        job = self.server.post(f"drafts/{draft}/run?name={name}", PROBLEM)["job"]
        return self.server.wait(job)

    def workers(self):
        """Children that are the command by now: one that stands still before is still the server."""
        return [pid for pid in children(self.server.process.pid) if command(pid)[1:2] == ["identify"]]

    def stopped_run(self):
        """A run whose process stands still, so that it is not over before it is looked at."""
        draft = self.server.draft(*FILES)
        job = self.server.post(f"drafts/{draft}/run?name=slow", PROBLEM)["job"]
        end = time.monotonic() + 10
        while not (workers := self.workers()):
            self.assertLess(time.monotonic(), end)
        os.kill(workers[0], signal.SIGSTOP)
        return job, workers[0]

    def names(self, folder=None):
        return {path.name for path in (folder or self.folder).iterdir()}


class Way(Serve):
    def test_a_run_is_what_the_command_writes_byte_for_byte(self):
        state = self.run_example()
        self.assertEqual(("done", "example"), (state["state"], state["run"]), state)
        made = self.folder / "example"
        self.assertEqual(OWN_FILES | {file.name for file in FILES}, self.names(made))
        expected = self.outside / "expected"
        expected.mkdir()
        for file in [EXAMPLE / "problem.toml", *FILES]:
            (expected / file.name).write_bytes(file.read_bytes())
        subprocess.run([PROGRAM, "identify", "problem.toml", "--quiet", "--json", "result.json",
                        "--html", "report.html"], cwd=expected, check=True)
        for name in self.names(made):
            self.assertEqual((expected / name).read_bytes(), (made / name).read_bytes(), name)

    def test_a_second_run_of_a_name_gets_a_folder_of_its_own(self):
        self.assertEqual(["example", "example-2"], [self.run_example()["run"] for _ in range(2)])

    def test_the_questions_are_those_of_init_and_end_in_its_problem(self):
        draft = self.server.draft(FILES[0])
        asked = self.server.post(f"drafts/{draft}/questions", b"[]")
        self.assertIsNone(asked["problem"])
        answers = {"feed": "40", "speed": "1000", "direction": "inward", "lever": "paper"}
        self.assertEqual(set(answers), {q["key"] for q in asked["questions"] if q["open"]})
        answered = self.server.post(f"drafts/{draft}/questions", json.dumps(
            [{"key": key, "file": 0, "value": value} for key, value in answers.items()]))
        options = [word for key, value in answers.items() for word in (f"--{key}", value)]
        init = subprocess.run([PROGRAM, "init", "fine.csv", "--yes", "--out", "-", *options],
                              cwd=EXAMPLE, check=True, capture_output=True)
        self.assertEqual(init.stdout.decode(), answered["problem"])

    def test_an_answer_that_is_none_is_said_at_its_question(self):
        draft = self.server.draft(FILES[0])
        asked = self.server.post(f"drafts/{draft}/questions", json.dumps(
            [{"key": "feed", "file": 0, "value": "fast"}]))
        feed = [q for q in asked["questions"] if q["key"] == "feed"][0]
        self.assertTrue(feed["open"])
        self.assertIn("'fast' is no answer", feed["error"])

    def test_check_says_what_the_command_says(self):
        draft = self.server.draft(*FILES)
        for file in FILES:
            (self.outside / file.name).write_bytes(file.read_bytes())
        for problem in (PROBLEM, PROBLEM.replace(b"degree = 3", b"degree = 3000"), b"[[profile", b""):
            (self.outside / "problem.toml").write_bytes(problem)
            said = subprocess.run([PROGRAM, "check", "problem.toml", "--json", "-"],
                                  cwd=self.outside, capture_output=True)
            self.assertEqual(json.loads(said.stdout),
                             self.server.post(f"drafts/{draft}/check", problem))

    def test_a_run_that_fails_says_why_and_leaves_nothing(self):
        draft = self.server.draft(*FILES)
        job = self.server.post(f"drafts/{draft}/run?name=x", b'title = "no profile"\n')["job"]
        state = self.server.wait(job)
        self.assertEqual("failed", state["state"])
        self.assertIn("problem.toml", state["message"])
        self.assertEqual({TEMPORARY}, self.names())

    def test_a_folder_made_by_the_commands_opens_and_runs_again(self):
        subprocess.run([PROGRAM, "demo", "--quiet", "--out", self.folder / "made"], check=True)
        shown = self.server.get("runs")["runs"]
        self.assertEqual(["made"], [run["name"] for run in shown])
        self.assertEqual("explained", shown[0]["verdict"])
        opened = self.server.post("runs/made/open")
        self.assertEqual(PROBLEM.decode(), opened["problem"])
        traces = self.server.post(f"drafts/{opened['id']}/traces", opened["problem"].encode())
        self.assertEqual(["fine", "coarse", "outward"], [trace["name"] for trace in traces])
        self.assertEqual({"mm"}, {trace["position_unit"] for trace in traces})
        job = self.server.post(f"drafts/{opened['id']}/run?name=again", opened["problem"].encode())
        self.assertEqual("again", self.server.wait(job["job"])["run"])
        made, again = (self.folder / name / "result.json" for name in ("made", "again"))
        self.assertEqual(made.read_bytes(), again.read_bytes())

    def test_a_result_without_a_page_gets_one(self):
        made = self.folder / "made"
        subprocess.run([PROGRAM, "demo", "--quiet", "--out", made], check=True)
        page = (made / "report.html").read_bytes()
        (made / "report.html").unlink()
        self.assertEqual(page, self.server.ask("GET", "runs/made/report.html")[1])

    def test_data_elsewhere_in_the_folder_come_along_and_others_do_not(self):
        (self.folder / "data").mkdir()
        (self.folder / "data/fine.csv").write_bytes(FILES[0].read_bytes())
        (self.outside / "coarse.csv").write_bytes(FILES[1].read_bytes())
        (self.folder / "run").mkdir()
        problem = PROBLEM.replace(b'"fine.csv"', b'"../data/fine.csv"').replace(
            b'"coarse.csv"', b'"../../coarse.csv"')
        (self.folder / "run/problem.toml").write_bytes(problem)
        opened = self.server.post("runs/run/open")
        self.assertIn('file = "fine.csv"', opened["problem"])
        self.refused(400, "POST", f"drafts/{opened['id']}/check", opened["problem"].encode())

    def test_two_runs_are_compared_as_diff_does(self):
        self.run_example("a")
        draft = self.server.draft(*FILES)
        job = self.server.post(f"drafts/{draft}/run?name=b",
                               PROBLEM.replace(b"level = 2 ", b"level = 3 "))["job"]
        self.assertEqual("b", self.server.wait(job)["run"])
        shown = self.server.get("diff?a=a&b=b")["diff"]
        said = subprocess.run([PROGRAM, "diff", "a/result.json", "b/result.json", "--json", "-"],
                              cwd=self.folder, check=True, capture_output=True)
        self.assertEqual(json.loads(said.stdout)["parameters"], shown["parameters"])

    def test_a_compensation_table_is_that_of_export(self):
        self.run_example()
        status, table, headers = self.server.ask("GET", "runs/example/table?to=isg")
        said = subprocess.run([PROGRAM, "export", "example/result.json", "--to", "isg", "--quiet"],
                              cwd=self.folder, check=True, capture_output=True)
        self.assertEqual((200, said.stdout), (status, table))
        self.assertIn('filename="example-isg.txt"', headers["content-disposition"])
        self.refused(400, "GET", "runs/example/table?to=nothing")

    def test_results_of_a_batch_are_a_table_with_pages(self):
        (self.outside / "manifest.csv").write_text(
            f"id,problem\n<b>,{EXAMPLE / 'problem.toml'}\nnone,missing.toml\n", encoding="utf-8")
        subprocess.run([PROGRAM, "batch", self.outside / "manifest.csv", "--quiet", "--no-trace",
                        "--out", self.folder / "all.jsonl"])
        self.assertEqual(["all.jsonl"], self.server.get("runs")["batches"])
        rows = {row["id"]: row for row in self.server.get("batches/all.jsonl")["rows"]}
        self.assertEqual("bad_problem", rows["none"]["status"])
        self.assertEqual("example lathe", rows["<b>"]["machine"])
        self.assertAlmostEqual(12e-6, rows["<b>"]["squareness_rad"], delta=5e-6)
        status, page, headers = self.server.ask("GET", "batches/all.jsonl/report?id=%3Cb%3E")
        self.assertEqual(200, status)
        self.assertTrue(page.startswith(b"<!DOCTYPE html>"))
        self.assertIn("sandbox", headers["content-security-policy"])
        self.refused(404, "GET", "batches/all.jsonl/report?id=none")


class Refusals(Serve):
    def test_another_token_is_refused(self):
        for token in ("0" * 32, self.server.token[:-1], self.server.token + "0", "x", "%00"):
            self.refused(403, "GET", "runs", token=token)
            self.refused(403, "POST", "drafts", b"", token=token)
        self.assertEqual({TEMPORARY}, self.names())

    def test_every_start_has_a_token_of_its_own(self):
        first = self.server.token
        self.server.end()
        self.assertNotEqual(first, self.start().token)

    def test_another_host_is_refused(self):
        for host in ("example.org", f"localhost:{self.server.port}", "127.0.0.1",
                     f"127.0.0.1:{self.server.port + 1}", ""):
            self.refused(403, "GET", "runs", headers={"Host": host})

    def test_a_foreign_origin_is_refused(self):
        for origin in ("http://example.org", "null", f"https://{self.server.host}",
                       f"http://localhost:{self.server.port}"):
            self.refused(403, "POST", "drafts", b"", headers={"Origin": origin})
        status, *_ = self.server.ask("POST", "drafts", b"",
                                     headers={"Origin": f"http://{self.server.host}"})
        self.assertEqual(200, status)

    def test_it_listens_on_the_loopback_alone(self):
        port = f"{self.server.port:04X}"
        bound = [line.split()[1] for table in ("tcp", "tcp6")
                 for line in pathlib.Path(f"/proc/net/{table}").read_text().splitlines()[1:]
                 if line.split()[1].endswith(":" + port) and line.split()[3] == "0A"]
        self.assertEqual([f"0100007F:{port}"], bound)

    def test_every_answer_carries_its_policy(self):
        self.run_example()
        for path in ("", "runs", "runs/example/report.html", "runs/example/result.json", "nothing"):
            _, _, headers = self.server.ask("GET", path)
            self.assertEqual("nosniff", headers["x-content-type-options"], path)
            self.assertEqual("no-store", headers["cache-control"], path)
            self.assertEqual("no-referrer", headers["referrer-policy"], path)
            self.assertIn("default-src 'none'", headers["content-security-policy"], path)
        _, _, headers = self.server.ask("GET", "", token="wrong")
        self.assertIn("default-src 'none'", headers["content-security-policy"])
        policy = self.server.ask("GET", "")[2]["content-security-policy"]
        self.assertRegex(policy, "script-src 'sha256-")
        self.assertNotIn("unsafe", policy)
        self.assertIn("sandbox allow-scripts;",
                      self.server.ask("GET", "runs/example/report.html")[2]["content-security-policy"])

    def test_methods_and_bodies_of_another_kind_are_refused(self):
        for method in ("PUT", "DELETE", "PATCH", "OPTIONS"):
            self.assertEqual(405, self.server.ask(method, "runs")[0], method)
        with socket.create_connection(("127.0.0.1", self.server.port), timeout=10) as line:
            line.sendall(f"POST /{self.server.token}/drafts HTTP/1.1\r\nHost: {self.server.host}\r\n"
                         "Transfer-Encoding: chunked\r\n\r\n".encode())
            self.assertIn(b" 411 ", line.recv(4096))

    def test_hostile_names_become_plain_ones(self):
        for name in ("../../etc/passwd", "..", ".", "", ".ssh", "/abs.csv", "a\\b\\c.csv", "a\0b.csv",
                     "\"><script>alert(1)</script>.csv", "x' OR 1.csv", "ünïcödé ✓.csv", "a" * 300 + ".csv",
                     "problem.toml", "result.json", "report.html", "-rf", "con\r\nSet-Cookie: a"):
            draft = self.server.draft()
            given = urllib.parse.quote(name, safe="")
            kept = self.server.post(f"drafts/{draft}/files?name={given}", b"1 2\n")["name"]
            self.assertRegex(kept, r"^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$", name)
            self.assertNotIn(kept, OWN_FILES)
            if name.endswith(".csv"):
                self.assertTrue(kept.endswith("csv"), kept)
        self.assertEqual({"runs"}, self.names(self.outside))

    def test_a_german_name_stays_readable(self):
        draft = self.server.draft()
        name = urllib.parse.quote("Führungsbahn größer µ.csv")
        self.assertEqual("Fuehrungsbahn_groesser_u.csv",
                         self.server.post(f"drafts/{draft}/files?name={name}", b"1 2\n")["name"])

    def test_hostile_names_of_runs_stay_inside(self):
        for name in ("../../evil", "..", "/tmp/evil", TEMPORARY, "a/b", "\"><script>", "ß" * 300):
            state = self.run_example(urllib.parse.quote(name, safe=""))
            self.assertEqual("done", state["state"], state)
            self.assertRegex(state["run"], r"^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$")
        self.assertEqual({"runs"}, self.names(self.outside))

    def test_no_address_leads_outside(self):
        (self.outside / "secret").mkdir()
        for file in OWN_FILES:
            (self.outside / "secret" / file).write_text("secret")
        (self.folder / "link").symlink_to(self.outside / "secret")
        (self.folder / "run").mkdir()
        (self.folder / "run/problem.toml").write_text("")
        (self.folder / "run/report.html").symlink_to(self.outside / "secret/report.html")
        (self.folder / "results.jsonl").symlink_to(self.outside / "secret/result.json")
        for path in ("runs/../secret/report.html", "runs/..%2Fsecret/report.html",
                     "runs/%2e%2e/secret/report.html", "runs/link/report.html", "runs/run/report.html",
                     "runs/run/..%2F..%2Fsecret%2Freport.html", "batches/results.jsonl",
                     f"runs/{TEMPORARY}/report.html", "runs//report.html", "../secret/report.html",
                     "diff?a=..%2Fsecret&b=link", "runs/run/%00", "runs/run/problem.toml%00.html"):
            status, body, _ = self.server.ask("GET", path)
            self.assertIn(status, (400, 403, 404), path)
            self.assertNotEqual(b"secret", body, path)
        self.assertEqual({"run"}, {run["name"] for run in self.server.get("runs")["runs"]})

    def test_a_problem_names_only_files_of_the_page(self):
        draft = self.server.draft(*FILES)
        named = [PROBLEM.replace(b'"fine.csv"', b'"%s"' % path) for path in (
            b"/etc/passwd", b"../fine.csv", b"${SLIDEWAY_DATA}/x.csv", b"./fine.csv", b"\\u002e\\u002e/x")]
        named.append(b'effects = ["/etc/passwd"]\n' + PROBLEM)
        named.append(PROBLEM + b'\n[[channel]]\nname = "T"\nfile = "/etc/passwd"\n')
        for problem in named:
            for what in ("check", "traces", "run?name=x"):
                self.refused(400, "POST", f"drafts/{draft}/{what}", problem)
        self.assertEqual([], self.server.get("runs")["runs"])

    def test_what_is_too_large_or_too_much_is_refused(self):
        draft = self.server.draft()
        self.refused(413, "POST", f"drafts/{draft}/files?name=a", bytes(65 << 20))
        for what in ("check", "traces", "questions", "run?name=x"):
            self.refused(413, "POST", f"drafts/{draft}/{what}", b" " * (300 << 10))
        for i in range(32):
            self.server.post(f"drafts/{draft}/files?name={i}.csv", b"1 2\n")
        self.refused(413, "POST", f"drafts/{draft}/files?name=b.csv", b"1 2\n")

    def test_of_many_drafts_the_oldest_are_closed(self):
        drafts = [self.server.draft() for _ in range(17)]
        self.refused(404, "POST", f"drafts/{drafts[0]}/files?name=a", b"1 2\n")
        self.assertEqual(16, len(self.names(self.folder / TEMPORARY)))

    def test_what_is_no_json_or_unknown_is_refused(self):
        draft = self.server.draft(FILES[0])
        for body in (b"", b"{", b"{}x", b'[{"key":1}]', b"\xff\xfe"):
            self.refused(400, "POST", f"drafts/{draft}/questions", body)
        for method, path in (("GET", "nothing"), ("POST", "nothing"), ("POST", ""), ("GET", "jobs/x"),
                             ("POST", "jobs/x/cancel"), ("POST", "drafts/x/check"), ("GET", "drafts"),
                             ("GET", "runs/x/report.html"), ("POST", "runs/x/open"), ("GET", "diff")):
            self.refused(404, method, path, b"" if method == "POST" else None)

    def test_bytes_that_are_no_profile_are_refused_by_name(self):
        draft = self.server.draft(("noise.csv", bytes(range(256)) * 40))
        status, body, _ = self.server.ask("POST", f"drafts/{draft}/questions", b"[]")
        self.assertEqual(422, status)
        self.assertRegex(json.loads(body)["error"], "^noise.csv: ")


class Ends(Serve):
    def test_a_cancelled_run_is_gone_within_half_a_second(self):
        job, worker = self.stopped_run()
        begin = time.monotonic()
        self.server.post(f"jobs/{job}/cancel")
        state = self.server.wait(job)
        self.assertLess(time.monotonic() - begin, 0.5)
        self.assertEqual("cancelled", state["state"])
        self.assertFalse(pathlib.Path(f"/proc/{worker}").exists())
        self.assertEqual([], self.server.get("runs")["runs"])

    def test_no_more_than_two_runs_at_a_time(self):
        jobs = [self.stopped_run()[0]]
        jobs.append(self.server.post(f"drafts/{self.server.draft(*FILES)}/run?name=b", PROBLEM)["job"])
        for worker in children(self.server.process.pid):
            os.kill(worker, signal.SIGSTOP)
        self.refused(429, "POST", f"drafts/{self.server.draft(*FILES)}/run?name=c", PROBLEM)
        for job in jobs:
            self.server.post(f"jobs/{job}/cancel")
            self.server.wait(job)
        self.assertEqual("done", self.run_example("c")["state"])

    def test_a_killed_server_takes_its_worker_along_and_loses_no_run(self):
        self.run_example("kept")
        before = {path.name: path.read_bytes() for path in (self.folder / "kept").iterdir()}
        _, worker = self.stopped_run()
        self.server.end(signal.SIGKILL)
        for _ in range(100):
            if self.state_of(worker) in ENDED:
                break
            time.sleep(0.05)
        self.assertIn(self.state_of(worker), ENDED)
        self.assertEqual({"kept", TEMPORARY}, self.names())
        self.server = self.start()
        self.assertEqual(set(), self.names(self.folder / TEMPORARY))
        self.assertEqual(["kept"], [run["name"] for run in self.server.get("runs")["runs"]])
        self.assertEqual(before, {path.name: path.read_bytes()
                                  for path in (self.folder / "kept").iterdir()})

    @staticmethod
    def state_of(pid):
        try:
            return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            return ""

    def test_a_signal_ends_it_cleanly_in_the_midst_of_a_run(self):
        for how in (signal.SIGINT, signal.SIGTERM):
            _, worker = self.stopped_run()
            begin = time.monotonic()
            self.assertEqual(0, self.server.end(how))
            self.assertLess(time.monotonic() - begin, 2.0)
            self.assertFalse(pathlib.Path(f"/proc/{worker}").exists())
            self.assertEqual(set(), self.names())
            self.server = self.start()

    def test_a_second_server_does_not_take_the_folder_or_the_port(self):
        for arguments in ((self.folder,), (self.outside / "other", "--port", str(self.server.port))):
            second = subprocess.run([PROGRAM, "serve", *arguments], capture_output=True, text=True,
                                    timeout=30)
            self.assertEqual(2, second.returncode)
            self.assertRegex(second.stderr, "^slideway: serve: .*; accepted: ")

    def test_options_out_of_range_are_refused(self):
        for option, value in (("--port", "70000"), ("--port", "-1"), ("--timeout", "0"),
                              ("--memory", "1")):
            second = subprocess.run([PROGRAM, "serve", self.folder, option, value],
                                    capture_output=True, text=True, timeout=30)
            self.assertEqual(2, second.returncode, option)


    def test_the_page_is_shown_on_request(self):
        browser = self.outside / "xdg-open"
        browser.write_text('#!/bin/sh\nprintf %s "$1" > "$0.address"\n', encoding="ascii")
        browser.chmod(0o755)
        self.server.end()
        with unittest.mock.patch.dict(os.environ, PATH=f"{self.outside}:{os.environ['PATH']}"):
            server = self.start("--open")
        end = time.monotonic() + 10
        while not (asked := self.outside / "xdg-open.address").exists() or not asked.read_text():
            self.assertLess(time.monotonic(), end)
        self.assertEqual(server.address, asked.read_text(encoding="ascii"))


class Limits(Serve):
    options = ("--timeout", "1", "--memory", "64")

    def test_a_run_that_takes_too_long_is_ended(self):
        job, _ = self.stopped_run()
        state = self.server.wait(job)
        self.assertEqual(("failed", "took longer than 1 s"), (state["state"], state["message"]))
        self.assertEqual({TEMPORARY}, self.names())

    def test_a_run_that_needs_too_much_memory_fails_alone(self):
        rows = "".join(f"{i * 1e-4:.4f} {i % 7}\n" for i in range(1_000_000))
        draft = self.server.draft(("big.csv", rows.encode()))
        problem = (b'[low_band]\nlevel = 0\n[[profile]]\nname = "big"\nfile = "big.csv"\nkind = "slide"\n'
                   b'position_unit = "mm"\nvalue_unit = "um"\n[[effect]]\nname = "straightness"\ndegree = 3\n')
        job = self.server.post(f"drafts/{draft}/run?name=big", problem)["job"]
        self.assertEqual("failed", self.server.wait(job)["state"])
        self.assertEqual([], self.server.get("runs")["runs"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
