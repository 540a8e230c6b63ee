# SPDX-License-Identifier: Apache-2.0
"""Headless Chromium for tests: its DevTools protocol over a pipe, so that nothing but Chromium is needed."""

import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

CHROMIUM = "chromium"
SECONDS = 60  # for one answer: the machine may be busy


def missing() -> str | None:
    return None if shutil.which(CHROMIUM) else "chromium is not installed: scripts/install_packages.sh browser"


class BrowserError(Exception):
    pass


class Browser:
    """One tab. What it complains about, and what it asks for, is collected until `complaints` and `requests` are read."""

    def __init__(self) -> None:
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        ours_in, theirs_out = os.pipe()
        theirs_in, ours_out = os.pipe()

        def pipes() -> None:  # Chromium reads commands from descriptor 3 and answers on 4
            first, second = os.dup(theirs_in), os.dup(theirs_out)
            os.dup2(first, 3)
            os.dup2(second, 4)

        command = [CHROMIUM, "--headless=new", "--remote-debugging-pipe", "--disable-gpu", "--no-first-run",
                   "--disable-dev-shm-usage", "--hide-scrollbars", "--disable-background-networking",
                   f"--user-data-dir={self.profile.name}"]
        if os.getuid() == 0:
            command.append("--no-sandbox")  # it does not start as root otherwise
        self.log = tempfile.TemporaryFile()
        self.process = subprocess.Popen(command, close_fds=False, preexec_fn=pipes, stdin=subprocess.DEVNULL,
                                        stdout=self.log, stderr=self.log)
        os.close(theirs_in)
        os.close(theirs_out)
        self.read_end, self.write_end = ours_in, ours_out
        self.buffer = b""
        self.number = 0
        self.session: str | None = None
        self.events: list[dict] = []
        self.complaints: list[str] = []
        self.requests: list[str] = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def __enter__(self) -> "Browser":
        return self

    def __exit__(self, *_exception: object) -> None:
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.read_end)
        os.close(self.write_end)
        self.log.close()
        self.profile.cleanup()

    # ---- Protocol ---------------------------------------------------------------------------------------

    def message(self) -> dict:
        end = time.monotonic() + SECONDS
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.read_end], [], [], max(0.0, end - time.monotonic()))
            data = os.read(self.read_end, 1 << 16) if ready else b""
            if not data:
                self.log.seek(0)
                said = self.log.read().decode(errors="replace")[-2000:]
                raise BrowserError(f"chromium {'ended' if ready else f'said nothing for {SECONDS} s'}: {said}")
            self.buffer += data
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def call(self, method: str, **parameters: object) -> dict:
        self.number += 1
        request = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            request["sessionId"] = self.session
        os.write(self.write_end, json.dumps(request).encode() + b"\0")
        while True:
            answer = self.message()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise BrowserError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.note(answer)

    def note(self, event: dict) -> None:
        self.events.append(event)
        what, details = event.get("method"), event.get("params", {})
        if what == "Runtime.consoleAPICalled" and details["type"] in ("error", "warning", "assert"):
            said = " ".join(str(part.get("value", part.get("description"))) for part in details["args"])
            self.complaints.append(f"console.{details['type']}: {said}")
        elif what == "Runtime.exceptionThrown":
            exception = details["exceptionDetails"]
            self.complaints.append(exception.get("exception", {}).get("description", exception["text"]))
        elif what == "Log.entryAdded" and details["entry"]["level"] in ("error", "warning"):
            self.complaints.append(f"{details['entry']['text']} ({details['entry'].get('url', '')})")
        elif what == "Network.loadingFailed" and not details.get("canceled"):
            self.complaints.append(f"not loaded: {details['errorText']}")
        elif what == "Network.requestWillBeSent":
            self.requests.append(details["request"]["url"])

    # ---- What tests do ----------------------------------------------------------------------------------

    def window(self, width: int, height: int, dark: bool = False) -> None:
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                  mobile=width < 600)
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def open(self, page: Path) -> None:
        """Loads the page and all of its pictures."""
        self.events.clear()
        wrong = self.call("Page.navigate", url=page.resolve().as_uri()).get("errorText")
        if wrong:
            raise BrowserError(f"{page}: {wrong}")
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            self.note(self.message())
        self.evaluate("Promise.all([...document.images].map(i => { i.loading = 'eager';"
                      " return i.complete ? 0 : new Promise(r => { i.onload = i.onerror = r; }); })).then(() => 0)")

    def evaluate(self, script: str) -> Any:
        """The value of the script; of what it promises. Any value of JSON."""
        answer = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise BrowserError(answer["exceptionDetails"]["exception"].get("description", "the script failed"))
        return answer["result"].get("value")

    def screenshot(self, path: Path, whole: bool = True) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
        path.write_bytes(base64.b64decode(data))
