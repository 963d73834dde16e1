"""`slideway serve` for the tests: the real program, asked over HTTP."""

import http.client
import json
import re
import signal
import subprocess
import time
import urllib.parse


class Server:
    def __init__(self, program, folder, *options):
        self.folder = folder
        self.process = subprocess.Popen([program, "serve", folder, *options], text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.process.stdout.readline()
        self.address = self.process.stdout.readline().strip()
        found = re.fullmatch(r"http://(127\.0\.0\.1:(\d+))/([0-9a-f]{32})/", self.address)
        assert found, self.address + self.process.stderr.read()
        self.host, self.port, self.token = found[1], int(found[2]), found[3]

    def end(self, how=signal.SIGTERM):
        """@return the exit code"""
        if self.process.poll() is None:
            self.process.send_signal(how)
        code = self.process.wait(timeout=30)
        self.process.stdout.close()
        self.process.stderr.close()
        return code

    def ask(self, method, path, body=None, headers=None, token=None):
        """@return status, body, headers"""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        try:
            connection.request(method, f"/{token or self.token}/{path}", body, headers or {})
            answer = connection.getresponse()
            return answer.status, answer.read(), {k.lower(): v for k, v in answer.getheaders()}
        finally:
            connection.close()

    def get(self, path):
        status, body, _ = self.ask("GET", path)
        assert status == 200, (path, status, body)
        return json.loads(body)

    def post(self, path, body=b""):
        status, answer, _ = self.ask("POST", path, body)
        assert status == 200, (path, status, answer)
        return json.loads(answer)

    def draft(self, *files):
        """Opens a draft with files, each a path or (name, bytes). @return its id"""
        draft = self.post("drafts")["id"]
        for file in files:
            name, data = file if isinstance(file, tuple) else (file.name, file.read_bytes())
            self.post(f"drafts/{draft}/files?name={urllib.parse.quote(name, safe='')}", data)
        return draft

    def wait(self, job, seconds=120):
        """@return the job's last state"""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            state = self.get(f"jobs/{job}")
            if state["state"] != "running":
                return state
            time.sleep(0.05)
        raise AssertionError("the run does not end")
