"""A page in headless Chromium, spoken to by its DevTools protocol over two pipes."""
import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

LIMIT = 60  # seconds, of any one answer
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--hide-scrollbars", "--force-color-profile=srgb", "--remote-debugging-pipe"]


def find():
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class Browser:
    """`requests`: addresses that the page asked for; `complaints`: what it wrote to the console."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="roil-browser-")
        ours, theirs_out = os.pipe()
        theirs_in, self.out = os.pipe()
        theirs = {3: theirs_in, 4: theirs_out}

        def arrange():  # in the child: its commands come at 3, its answers go to 4
            spare = {to: os.dup(fd) for to, fd in theirs.items()}
            for to, fd in spare.items():
                os.dup2(fd, to)
        environment = {**os.environ, "HOME": self.folder}
        self.process = subprocess.Popen(
            [find(), *FLAGS, f"--user-data-dir={self.folder}/profile", "about:blank"], preexec_fn=arrange,
            pass_fds=(3, 4, theirs_in, theirs_out), env=environment, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(theirs_in)
        os.close(theirs_out)
        self.input, self.rest, self.last = ours, b"", 0
        self.session, self.events, self.requests, self.complaints = None, [], [], []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Runtime", "Log"):
            self.call(domain + ".enable")

    def close(self):
        os.close(self.out)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.input)
        shutil.rmtree(self.folder, ignore_errors=True)

    # ---- protocol -----------------------------------------------------------------------------

    def _receive(self, until):
        while b"\0" not in self.rest:
            if not select.select([self.input], [], [], max(until - time.monotonic(), 0))[0]:
                raise TimeoutError("the browser does not answer")
            data = os.read(self.input, 1 << 20)
            if not data:
                raise EOFError("the browser has ended")
            self.rest += data
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def _note(self, event):
        method, told = event.get("method"), event.get("params", {})
        self.events.append(method)
        if method == "Network.requestWillBeSent":
            address = told["request"]["url"]
            if not address.startswith("data:"):
                self.requests.append(address)
        elif method == "Log.entryAdded":
            self.complaints.append(told["entry"]["text"])
        elif method == "Runtime.consoleAPICalled":
            self.complaints.append(str(told["args"]))
        elif method == "Runtime.exceptionThrown":
            self.complaints.append(told["exceptionDetails"]["text"])

    def call(self, method, **params):
        self.last += 1
        message = {"id": self.last, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.out, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + LIMIT
        while (answer := self._receive(until)).get("id") != self.last:
            self._note(answer)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    # ---- pages --------------------------------------------------------------------------------

    def open(self, path, width, height=900, dark=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                  mobile=width < 600)
        self.call("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.events, self.requests, self.complaints = [], [], []
        self.call("Page.navigate", url="file://" + os.path.abspath(path))
        until = time.monotonic() + LIMIT
        while "Page.loadEventFired" not in self.events:
            self._note(self._receive(until))

    def value(self, expression):
        told = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        if "exceptionDetails" in told:
            raise RuntimeError(str(told["exceptionDetails"]))
        return told["result"].get("value")

    def picture(self):
        """PNG of the whole page, however long."""
        told = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=True)
        return base64.b64decode(told["data"])

    def printed(self):
        told = self.call("Page.printToPDF", preferCSSPageSize=True)
        return base64.b64decode(told["data"])
