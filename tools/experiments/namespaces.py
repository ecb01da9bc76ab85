"""Two machines, as near as one can have them: two network namespaces joined by a pair of interfaces, a Godot process in
each, and what happens when one of them or the way between them goes.

    ./run experiment namespaces [--down=30] [--settle=8]

--down    how long the way is cut in the longest case (unit: seconds)
--settle  how long a case is watched after what was done to it (unit: seconds)

Needs the right to make network namespaces (root). Keys are CASE.FIGURE, CASE one of

without_key          another machine is not talked to, and the link says what to do
with_key             the two meet
killed_operator      the operator's process is killed (-9) while the hand presses, and started again
killed_teleoperator  the far side's process is
down                 the way is cut for --down seconds while the hand presses
far_side_first, operator_first   the order in which the two are started

and FIGURE: connected (1 or 0), seconds_to_connect, seconds_to_touch (after what was done, until the hand feels the box
again), force_largest_N, box_moved_mm (of the far side's box, from before to after).
"""

import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from threading import Thread

from measuring import options
from project import FOLDER
from setup import godot

OPERATOR, FAR = 0, 1
CONNECTED = 5  # MMTLink.STATE_CONNECTED
FAILED = 2  # MMTLink.STATE_FAILED
ADDRESSES = ("10.87.0.1", "10.87.0.2")
PORTS = (47001, 47002)
NAMES = ("tactus-operator", "tactus-far")
PATIENCE = 90.0  # to start Godot and to meet (unit: seconds)
FELT = 0.5  # the hand presses with some newtons


@dataclass(frozen=True)
class Settings:
    down: float = options.option(30.0, "s", 0, 3600)
    settle: float = options.option(8.0, "s", 0.1, 3600)


def ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


def refusal() -> str:
    """Why there can be no namespaces here; empty where there can."""
    if shutil.which("ip") is None:
        return "the program 'ip' is missing: install iproute2"
    made = subprocess.run(["ip", "netns", "add", "tactus-probe"], capture_output=True, text=True)
    if made.returncode != 0:
        return f"network namespaces are not permitted here: {made.stderr.strip()}"
    ip("netns", "delete", "tactus-probe")
    return ""


class Machines:
    """Two namespaces and the way between them."""

    def __enter__(self) -> "Machines":
        self._remove()
        ip("link", "add", "tactus0", "type", "veth", "peer", "name", "tactus1")
        for side, name in enumerate(NAMES):
            ip("netns", "add", name)
            ip("link", "set", f"tactus{side}", "netns", name)
            ip("-n", name, "address", "add", f"{ADDRESSES[side]}/24", "dev", f"tactus{side}")
            ip("-n", name, "link", "set", "lo", "up")
            ip("-n", name, "link", "set", f"tactus{side}", "up")
        return self

    def __exit__(self, *_: object) -> None:
        self._remove()

    def cut(self) -> None:
        ip("-n", NAMES[FAR], "link", "set", "tactus1", "down")

    def mend(self) -> None:
        ip("-n", NAMES[FAR], "link", "set", "tactus1", "up")

    @staticmethod
    def _remove() -> None:
        for name in NAMES:
            subprocess.run(["ip", "netns", "delete", name], capture_output=True)
        subprocess.run(["ip", "link", "delete", "tactus0"], capture_output=True)


@dataclass
class Side:
    """A Godot process in a namespace, and what it has said."""

    number: int
    key_file: Path | None
    said: list[dict] = field(default_factory=list)
    process: subprocess.Popen | None = None

    def start(self) -> None:
        other = 1 - self.number
        words = {
            "side": self.number, "remote_address": ADDRESSES[other],
            "local_port": PORTS[self.number], "remote_port": PORTS[other],
        }  # fmt: skip
        if self.key_file:
            words["key_file"] = self.key_file
        self.process = subprocess.Popen(
            ["ip", "netns", "exec", NAMES[self.number], str(godot.command()), "--headless", "--path", str(FOLDER),
             "--script", "res://experiments/networked_side.gd", "--",
             *(f"--{key}={value}" for key, value in words.items())],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
        )  # fmt: skip
        Thread(target=self._listen, args=(self.process,), daemon=True).start()

    def kill(self) -> None:
        if self.process and self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()

    def since(self, begin: float) -> list[dict]:
        return [line for line in self.said if line["time"] >= begin]

    def _listen(self, process: subprocess.Popen) -> None:
        for text in process.stdout or []:
            if text.startswith("{"):
                self.said.append(json.loads(text))


def is_connected(line: dict) -> bool:
    return line["state"] == CONNECTED


def presses(line: dict) -> bool:
    return is_connected(line) and line["touches"] and size(line["force"]) > FELT


def size(vector: list[float]) -> float:
    return sum(part * part for part in vector) ** 0.5


def wait_for(side: Side, begin: float, what: Callable[[dict], bool], patience: float = PATIENCE) -> float:
    """Seconds from `begin` until the side says so, or a number above all patience."""
    while time.time() < begin + patience:
        for line in side.since(begin):
            if what(line):
                return line["time"] - begin
        time.sleep(0.05)
    return 1e9


def start_both(machines: Machines, key: Path | None, first: int = FAR) -> tuple[Side, Side]:
    sides = (Side(OPERATOR, key), Side(FAR, key))
    sides[first].start()
    time.sleep(1.0)
    sides[1 - first].start()
    return sides


def moved(before: list[float], after: list[float]) -> float:
    return 1e3 * size([a - b for a, b in zip(after, before, strict=True)])


def met(operator: Side, begin: float) -> dict[str, float]:
    connected = wait_for(operator, begin, is_connected)
    return {"connected": float(connected < PATIENCE), "seconds_to_connect": connected}


def disturbed(operator: Side, far: Side, settle: float, act: Callable[[], None]) -> dict[str, float]:
    """Presses, then does it, then looks."""
    wait_for(operator, time.time(), presses)
    time.sleep(2.0)
    before = far.said[-1]["box"]
    begin = time.time()
    act()
    done = time.time()
    felt = wait_for(operator, done, presses)
    time.sleep(settle)
    after = operator.since(begin)
    return {
        "connected": float(is_connected(operator.said[-1])), "seconds_to_touch": felt,
        "force_largest_N": max(size(line["force"]) for line in after),
        "box_moved_mm": moved(before, far.said[-1]["box"]),
    }  # fmt: skip


Look = Callable[[Side, Side], dict[str, float]]


def restart(side: Side) -> None:
    side.kill()
    time.sleep(1.0)
    side.start()


def cut_for(machines: Machines, seconds: float) -> None:
    machines.cut()
    time.sleep(seconds)
    machines.mend()


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    if why := refusal():
        print(f"skipped: {why}", flush=True)
        return {"skipped": 1.0}
    summary: dict[str, object] = {"skipped": 0.0}
    with Machines() as machines, tempfile.TemporaryDirectory() as folder:
        key = Path(folder) / "key"
        key.write_text("a key that both sides know\n")
        key.chmod(0o600)
        settle = settings.settle
        cases: dict[str, tuple[Path | None, int, Look]] = {
            "without_key": (None, FAR, lambda operator, _: refused(operator)),
            "with_key": (key, FAR, lambda operator, _: met(operator, time.time())),
            "operator_first": (key, OPERATOR, lambda operator, _: met(operator, time.time())),
            "killed_operator": (key, FAR, lambda *both: disturbed(*both, settle, lambda: restart(both[OPERATOR]))),
            "killed_teleoperator": (key, FAR, lambda *both: disturbed(*both, settle, lambda: restart(both[FAR]))),
            "down": (key, FAR, lambda *both: disturbed(*both, settle, lambda: cut_for(machines, settings.down))),
        }
        for name, (key_file, first, look) in cases.items():
            print(name, flush=True)
            sides = start_both(machines, key_file, first)
            try:
                figures = look(*sides)
            finally:
                for side in sides:
                    side.kill()
            lines = [json.dumps(line) + "\n" for side in sides for line in side.said]
            (output / f"{name}.jsonl").write_text("".join(lines))
            print("  " + ", ".join(f"{key} {value:g}" for key, value in figures.items()), flush=True)
            summary |= {f"{name}.{key}": value for key, value in figures.items()}
    return summary


def refused(operator: Side) -> dict[str, float]:
    begin = time.time()
    said = wait_for(operator, begin, lambda line: line["state"] == FAILED and "without a key" in line["text"])
    return {"connected": float(any(map(is_connected, operator.said))), "seconds_until_it_says_so": said}
