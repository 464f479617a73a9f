"""A page in Chromium without a display, spoken to over a pipe: what tests of the report ask of it."""

import base64
import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

NAMES = ("chromium", "chromium-browser", "google-chrome")
FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars", "--no-first-run",
         "--remote-debugging-pipe")


def find_browser() -> str | None:
    return next(filter(None, map(shutil.which, NAMES)), None)


class Browser:
    """One tab. Messages of the DevTools protocol are JSON that ends in a zero byte; the browser reads descriptor 3, writes 4."""

    def __init__(self, read: int, write: int):
        self._read, self._write, self._rest, self._count = read, write, b"", 0
        self.complaints: list[str] = []  # errors and exceptions of the console
        self._session = ""
        target = self._call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self._call(f"{domain}.enable")

    def _message(self) -> dict:
        while b"\0" not in self._rest:
            more = os.read(self._read, 1 << 20)
            if not more:
                raise RuntimeError("the browser has ended")
            self._rest += more
        text, _, self._rest = self._rest.partition(b"\0")
        return json.loads(text)

    def _note(self, message: dict) -> None:
        told = message.get("params", {})
        match message.get("method"):
            case "Runtime.exceptionThrown":
                self.complaints.append(str(told["exceptionDetails"].get("exception", {}).get("description", told)))
            case "Runtime.consoleAPICalled" if told["type"] in ("error", "warning", "assert"):
                self.complaints.append(str(told["args"]))
            case "Log.entryAdded" if told["entry"]["level"] in ("error", "warning"):
                self.complaints.append(told["entry"]["text"])

    def _call(self, method: str, **parameters) -> dict:
        self._count += 1
        request = {"id": self._count, "method": method, "params": parameters}
        text = json.dumps(request | ({"sessionId": self._session} if self._session else {})).encode() + b"\0"
        while text:
            text = text[os.write(self._write, text) :]
        while (answer := self._message()).get("id") != self._count:
            self._note(answer)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def open(self, file: Path, width: int, style: str = "light", height: int = 900) -> None:
        """The page at a width in CSS pixels, `style` light or dark; a phone below 600."""
        self._call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self._call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": style}])
        self._call("Page.navigate", url="about:blank")
        self._call("Page.navigate", url=file.resolve().as_uri())
        self.value("new Promise(done => document.readyState === 'complete' ? done(1) : addEventListener('load', () => done(1)))")

    def value(self, expression: str):
        """Of a JavaScript expression, as JSON; a promise is awaited."""
        found = self._call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in found:
            raise RuntimeError(found["exceptionDetails"].get("exception", {}).get("description", "no value"))
        return found["result"].get("value")

    def picture(self, file: Path, top: int = 0, height: int = 900) -> None:
        """Of the page from `top` on."""
        width = self.value("innerWidth")
        shown = self._call("Page.captureScreenshot", format="png", captureBeyondViewport=True,
                           clip={"x": 0, "y": top, "width": width, "height": height, "scale": 1})
        file.write_bytes(base64.b64decode(shown["data"]))


@contextmanager
def browser() -> Iterator[Browser]:
    """Throws FileNotFoundError where there is none."""
    program = find_browser()
    if program is None:
        raise FileNotFoundError("Chromium is not installed")
    to_read, to_write = os.pipe()
    from_read, from_write = os.pipe()

    def descriptors() -> None:
        """Of the browser: 3 and 4, whatever numbers the pipes have here."""
        high = os.dup(to_read) + 100
        os.dup2(to_read, high)
        os.dup2(from_write, high + 1)
        os.dup2(high, 3)
        os.dup2(high + 1, 4)

    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.Popen([program, *FLAGS, f"--user-data-dir={folder}"], preexec_fn=descriptors, close_fds=False,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(from_write)
        try:
            yield Browser(from_read, to_write)
        finally:
            process.kill()
            process.wait()
            os.close(to_write)
            os.close(from_read)
            shutil.rmtree(folder, ignore_errors=True)
