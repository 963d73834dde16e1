"""Debian's chromium, driven through chromedriver in WebDriver over HTTP, for the tests of pages."""

import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
import urllib.request

CHROMIUM = shutil.which("chromium")
DRIVER = shutil.which("chromedriver")


class Browser:
    """One page of a headless chromium, spoken to in WebDriver over HTTP."""

    def __init__(self, folder):
        self.driver = subprocess.Popen([DRIVER, "--port=0"], stdout=subprocess.PIPE, text=True)
        for line in self.driver.stdout:
            port = re.search(r"started successfully on port (\d+)", line)
            if port:
                break
        self.address = f"http://127.0.0.1:{port[1]}/session"
        arguments = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
                     "--no-first-run", "--disable-background-networking",
                     "--disable-component-update", "--disable-sync",
                     "--disable-dev-shm-usage", f"--user-data-dir={folder}"]
        options = {"goog:chromeOptions": {"binary": CHROMIUM, "args": arguments},
                   "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}
        session = self.send("", {"capabilities": {"alwaysMatch": options}})
        self.address += "/" + session["sessionId"]
        self.resize(1280, 900)

    def send(self, path, body):
        request = urllib.request.Request(self.address + path, json.dumps(body).encode(),
                                         {"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=300) as answer:
            return json.load(answer)["value"]

    def get(self, path):
        with urllib.request.urlopen(self.address + path, timeout=300) as answer:
            return json.load(answer)["value"]

    def run(self, script, *arguments):
        return self.send("/execute/sync", {"script": script, "args": list(arguments)})

    def tool(self, command, **parameters):
        return self.send("/goog/cdp/execute", {"cmd": command, "params": parameters})

    def resize(self, width, height):
        self.tool("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=False)

    def keys(self, text):
        self.send("/actions", {"actions": [{"type": "key", "id": "keys", "actions": [
            {"type": kind, "value": key} for key in text for kind in ("keyDown", "keyUp")]}]})

    def log(self, kind):
        return self.send("/se/log", {"type": kind})

    def open(self, page):
        self.log("browser"), self.log("performance")
        self.send("/url", {"url": page if isinstance(page, str) else page.as_uri()})

    def close(self):
        try:
            urllib.request.urlopen(urllib.request.Request(self.address, method="DELETE"), timeout=60)
        finally:
            self.driver.terminate()
            self.driver.wait()
            self.driver.stdout.close()

    def complaints(self):
        """What the page has said in the console since it was opened or asked last."""
        return {line["message"] for line in self.log("browser")
                if line["level"] in ("SEVERE", "WARNING")}


class BrowserTest(unittest.TestCase):
    """One browser and one folder for all tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.browser = Browser(cls.folder / "profile")

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.temporary.cleanup()
