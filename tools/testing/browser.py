"""Pages in a real browser, Chromium without a window: what it says about them, and whether they fit.

It is spoken to by the Chrome DevTools Protocol over two pipes, so that nothing listens on the network.
"""

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

NAMES = ("chromium", "chromium-browser", "google-chrome")
# What a page may take to load (unit: seconds).
LONGEST = 60


def program() -> str | None:
    return next((found for name in NAMES if (found := shutil.which(name))), None)


@dataclass
class Seen:
    """Of one page at one width."""

    said: list[str] = field(default_factory=list)  # in its console: errors, warnings, words
    width: int = 0  # that all of it takes (unit: pixels)
    text: str = ""


class Browser:
    def __init__(self, write: int, read: int):
        self._write, self._read = write, read
        self._rest = b""
        self._number = 0
        self._seen = Seen()
        self._loaded = False

    def look(self, page: Path, width: int) -> Seen:
        target = self._call("Target.createTarget", {"url": "about:blank"})["targetId"]
        session = self._call("Target.attachToTarget", {"targetId": target, "flatten": True})["sessionId"]
        for part in ("Page", "Runtime", "Log"):
            self._call(f"{part}.enable", {}, session)
        screen = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
        self._call("Emulation.setDeviceMetricsOverride", screen, session)
        self._seen, self._loaded = Seen(), False
        if problem := self._call("Page.navigate", {"url": page.resolve().as_uri()}, session).get("errorText"):
            self._seen.said.append(problem)
        self._hear(lambda _: self._loaded)
        self._seen.width = self._value("document.documentElement.scrollWidth", session)
        self._seen.text = self._value("document.body.innerText", session)
        self._call("Target.closeTarget", {"targetId": target})
        return self._seen

    def _value(self, expression: str, session: str):
        return self._call("Runtime.evaluate", {"expression": expression, "returnByValue": True}, session)["result"]["value"]

    def _call(self, method: str, parameters: dict, session: str | None = None) -> dict:
        self._number += 1
        number = self._number
        message = {"id": number, "method": method, "params": parameters} | ({"sessionId": session} if session else {})
        os.write(self._write, json.dumps(message).encode() + b"\0")
        answer = self._hear(lambda heard: heard.get("id") == number)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def _hear(self, is_wanted: Callable[[dict], bool]) -> dict:
        while True:
            while b"\0" not in self._rest:
                heard = os.read(self._read, 1 << 16)
                if not heard:
                    raise RuntimeError("the browser has ended")
                self._rest += heard
            line, self._rest = self._rest.split(b"\0", 1)
            message = json.loads(line)
            self._note(message)
            if is_wanted(message):
                return message

    def _note(self, message: dict) -> None:
        parameters = message.get("params", {})
        match message.get("method"):
            case "Page.loadEventFired":
                self._loaded = True
            case "Runtime.consoleAPICalled":
                words = [str(word.get("value", word.get("description", ""))) for word in parameters["args"]]
                self._seen.said.append(f"{parameters['type']}: {' '.join(words)}")
            case "Runtime.exceptionThrown":
                details = parameters["exceptionDetails"]
                self._seen.said.append(details.get("exception", {}).get("description", details["text"]))
            case "Log.entryAdded":
                entry = parameters["entry"]
                self._seen.said.append(f"{entry['level']}: {entry['text']} {entry.get('url', '')}")


@contextmanager
def opened() -> Iterator[Browser]:
    to_browser, write = os.pipe()
    read, from_browser = os.pipe()
    with tempfile.TemporaryDirectory() as profile:
        # It reads at its descriptor 3 and writes to its 4.
        options = "--headless=new --no-sandbox --disable-gpu --no-first-run --disable-extensions --disable-background-networking"
        line = f'exec "$0" {options} --remote-debugging-pipe --user-data-dir="$1" 3<&{to_browser} 4>&{from_browser}'
        running = subprocess.Popen(
            ["bash", "-c", line, str(program()), profile],
            pass_fds=[to_browser, from_browser],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)
        try:
            yield Browser(write, read)
        finally:
            running.terminate()
            try:
                running.wait(LONGEST)
            except subprocess.TimeoutExpired:
                running.kill()
                running.wait()
            os.close(write)
            os.close(read)
