"""A Godot operator that is played in steps beside a teleoperator of tactus_peer, in virtual time over UDP within this machine.

Both tick by turns: of the operator's step its sample is waited for, so that no load of the machine changes which sample is
answered. The answer has arrived when the operator goes on, in all but rare steps of a loaded machine.
"""

import json
import subprocess
import time
from dataclasses import dataclass, field

from project import FOLDER
from setup import godot
from tactus_peer import Teleoperator

TICK = 1_000_000  # (unit: nanoseconds)
_ARRIVAL = 0.2  # that is waited for on this machine (unit: seconds)
_DELIVERY = 0.0004  # of an answer, from this process to the other one (unit: seconds)
_MEETING = 20_000  # ticks


@dataclass
class Operator:
    """peer_operator.gd as a process; `options`: its command line, by name."""

    options: dict[str, object]
    rows: list[dict] = field(default_factory=list)  # that step() has returned

    def __enter__(self) -> "Operator":
        words = [f"--{name}={value}" for name, value in self.options.items()]
        script = ["--script", "res://experiments/peer_operator.gd"]
        command = [str(godot.command()), "--headless", "--path", str(FOLDER), *script, "--", *words]
        self._process = subprocess.Popen(command, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self._said: list[str] = []
        return self

    def __exit__(self, *_: object) -> None:
        self._tell("quit")
        try:
            self._process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.communicate()

    def set_out(self) -> None:
        """The hand follows its path from now on."""
        self._tell("go")

    def step(self) -> dict:
        """One tick of the operator."""
        self._tell("step")
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if line.startswith("{"):
                self.rows.append(json.loads(line))
                return self.rows[-1]
            self._said.append(line)
        raise RuntimeError("the operator has ended:\n" + "".join(self._said)[-3000:])

    def _tell(self, command: str) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(command + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            pass  # step() says why


def step_both(operator: Operator, side: Teleoperator) -> dict:
    """One tick of both. Returns the operator's row; what the caller sends after it is there for the next step."""
    row = operator.step()
    ticks = len(operator.rows)
    until = time.monotonic() + _ARRIVAL
    side.fetch(ticks * TICK)
    while side.newest_arrived < ticks and time.monotonic() < until:
        side.wait(until - time.monotonic())
        side.fetch(ticks * TICK)
    side.tick(ticks * TICK)
    return row


def deliver(side: Teleoperator) -> None:
    """What has been sent in this step reaches the operator's process."""
    side.flush()
    time.sleep(_DELIVERY)


def meet(operator: Operator, side: Teleoperator) -> None:
    """Until both hear each other, agree, and the operator has every body that `side` tells of."""
    for _ in range(_MEETING):
        row = step_both(operator, side)
        deliver(side)
        if not side.problem and side.all_known and row["connected"]:
            return
    raise RuntimeError(f"the two sides do not meet: {side.problem or row['text'] or 'a body is not acknowledged'}")
