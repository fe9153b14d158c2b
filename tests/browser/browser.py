# SPDX-License-Identifier: BSD-3-Clause
"""A headless Chromium by way of Debian's chromedriver, with nothing but the standard library (W3C WebDriver)."""

import base64
import json
import shutil
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

OPTIONS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
)


def missing():
    """What there is no browser test without; nothing when all is there."""
    return [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]


class Browser:
    """One page in one window. A context manager, so that no browser outlives the test."""

    def __init__(self, width=1280, height=800):
        self._profile = tempfile.TemporaryDirectory()
        self._driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        for line in self._driver.stdout:
            if "started successfully on port" in line:
                self._address = f"http://127.0.0.1:{int(line.split()[-1].rstrip('.'))}"
                break
        else:
            raise RuntimeError("chromedriver does not start")
        arguments = [*OPTIONS, f"--user-data-dir={self._profile.name}", f"--window-size={width},{height}"]
        wanted = {"alwaysMatch": {"browserName": "chrome", "goog:chromeOptions": {"args": arguments}}}
        self._session = None
        self._session = self._ask("POST", "/session", {"capabilities": wanted})["sessionId"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._ask("DELETE", "")
        finally:
            self._driver.terminate()
            self._driver.wait(10)
            self._profile.cleanup()

    def _ask(self, method, path, body=None):
        prefix = f"/session/{self._session}" if self._session else ""
        request = urllib.request.Request(
            self._address + prefix + path,
            method=method,
            data=None if method != "POST" else json.dumps(body or {}).encode(),
            headers={"Content-Type": "application/json"},
        )
        try:
            with urllib.request.urlopen(request, timeout=120) as reply:
                return json.load(reply)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from None

    def open(self, url):
        self._ask("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        """The value that a piece of JavaScript returns."""
        return self._ask("POST", "/execute/sync", {"script": script, "args": arguments})

    def text(self, element_id):
        return self.run("return document.getElementById(arguments[0]).textContent", element_id)

    def click(self, element_id):
        element = next(iter(self._ask("POST", "/element", {"using": "css selector", "value": f"#{element_id}"}).values()))
        self._ask("POST", f"/element/{element}/click")

    def drag(self, start, end):
        """A stroke with the mouse; points are (x, y) in pixels of the window."""
        moves = [{"type": "pointerMove", "duration": 50, "x": round(x), "y": round(y)} for x, y in (start, end)]
        steps = [moves[0], {"type": "pointerDown", "button": 0}, moves[1], {"type": "pointerUp", "button": 0}]
        self._ask("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": steps}]})

    def wait_for(self, what, timeout_s=60):
        """The first true value of what(); raises TimeoutError."""
        end = time.monotonic() + timeout_s
        while not (value := what()):
            if time.monotonic() > end:
                raise TimeoutError("the page does not get there")
            time.sleep(0.1)
        return value

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self._ask("GET", "/screenshot")))
