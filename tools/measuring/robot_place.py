"""Scenarios 3 and 5 with a robot that a simulator made by others plays: each case with a Godot operator, in virtual time.

The robot is led to where the operator's sample is. In scenario 3 the force of its sensor is sent to the operator, in scenario 5 what
a camera sees. Direct contact is a second copy of the robot that is driven by the operator's device position of the same tick,
without a link.
"""

import contextlib
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from measuring import peer_operator
from measuring.arm_control import TICK
from tactus_peer import Teleoperator, messages

# PassivitySettings: what a teleoperator with passivity control in the time domain spends and how it yields.
FAR_STORE, DRIFT_RATE, LARGEST_YIELD = 0.005, 10.0, 1.0  # (units: joules, 1/seconds, meters per newton second)


class Arm(Protocol):
    tip: np.ndarray  # (unit: meters)
    contact: np.ndarray  # of the surroundings on the tip, as its sensor has it (unit: newtons)
    touches: bool


class Pair:
    """The robot of the link and the one that is touched with directly, each in a place of its own. As it is here, the operator is sent
    the force on the robot.
    """

    robot: Arm
    direct: Arm

    def go(self, robot: np.ndarray | None, direct: np.ndarray) -> None:
        """One tick, led to where the tips are wanted (unit: meters); None: the robot stays where it was led to."""
        raise NotImplementedError

    def describe(self, side: Teleoperator) -> None:
        """What the operator is told before the two sides meet."""

    def answer(self, side: Teleoperator, sample: dict, taken: float) -> None:
        """After go() with this sample. `taken`: the energy that this end has taken in from the environment (unit: joules)."""
        side.send_force(sample, self.robot.contact, self.robot.tip, taken=taken)

    def note(self, row: dict) -> None:
        """The operator's row of the sample that was applied in this tick."""

    def figures(self) -> dict[str, float]:
        return {}

    def close(self) -> None:
        pass


class Yielding:
    """The teleoperator's part of passivity control in the time domain (core/teleop/passivity.hpp)."""

    def __init__(self, at: np.ndarray):
        self._hand, self._own, self._force = at.copy(), at.copy(), np.zeros(3)
        self._in, self._out, self._sequence = 0.0, 0.0, 0
        self.taken = 0.0  # (unit: joules)

    def hand(self, sample: dict, contact: np.ndarray) -> np.ndarray:
        hand = np.array(sample["position"])
        if sample["sequence"] == self._sequence + 1:
            self._in += max(0.0, -float(self._force @ (hand - self._hand)))
        way = hand - self._hand + (self._hand - self._own) * DRIFT_RATE * TICK
        squared, left = float(contact @ contact), self._in + FAR_STORE - self._out
        given = -float(contact @ way)
        if given > left and squared > 1e-12:
            way += min((given - left) / (squared * TICK), LARGEST_YIELD) * TICK * contact
        self._out += max(0.0, -float(contact @ way))
        self._own = self._own + way
        self.taken += max(0.0, float(contact @ way))
        self._hand, self._force, self._sequence = hand, np.array(sample["force"]), sample["sequence"]
        return self._own


class Port:
    """Energy that a port is given: a force is held over the displacement after it."""

    def __init__(self) -> None:
        self.total = self.created = self._contact = 0.0  # (unit: joules)
        self._before: tuple[np.ndarray, np.ndarray] | None = None

    def note(self, force: np.ndarray, at: np.ndarray) -> None:
        if self._before is not None:
            held, before = self._before
            given = float(held @ (at - before))
            self.total += given
            self._contact = self._contact + given if np.any(held) else 0.0
            self.created = max(self.created, self._contact)
        self._before = force, at


def play(case: dict, pair_at: Callable[[dict, np.ndarray], Pair]) -> dict[str, float]:
    """`pair_at`: gives the robots of a case, with their tips at a place (unit: meters)."""
    delay, scenario = round(case["delay_ms"] * 1e6 / 2), case.get("scenario", 3)
    with Teleoperator(0, case["port"], scenario=scenario, passivity=case["passivity"], delay=delay) as side:
        options = {**case["operator"], "scenario": scenario, "local_port": case["port"], "remote_port": side.port}
        with peer_operator.Operator({**options, "tuning.passivity": case["passivity"]}) as operator:
            start = np.array(peer_operator.step_both(operator, side)["hand"])
            with contextlib.closing(pair_at(case, start)) as pair:
                pair.describe(side)
                peer_operator.meet(operator, side)
                return _along(case, operator, side, pair)


def _along(case: dict, operator: peer_operator.Operator, side: Teleoperator, pair: Pair) -> dict[str, float]:
    passive = case["passivity"] == messages.TIME_DOMAIN
    robot, direct = pair.robot, pair.direct
    yielding = Yielding(np.array(operator.rows[-1]["hand"]))
    hand_port, far_port = Port(), Port()
    rows: dict[str, list[float]] = {name: [] for name in ("place", "force", "touches", "direct_touches", "link")}
    operator.set_out()
    for _ in range(round(case["seconds"] / TICK)):
        row = peer_operator.step_both(operator, side)
        displayed, hand = np.array(row["force"]), np.array(row["hand"])
        sample = side.hand()
        wanted = None
        if sample is not None:
            wanted = yielding.hand(sample, robot.contact) if passive else np.array(sample["position"])
        pair.go(wanted, hand)
        if sample is not None:
            pair.answer(side, sample, yielding.taken)
            pair.note(operator.rows[sample["sequence"] - 1])
            peer_operator.deliver(side)
            rows["place"].append(float(np.linalg.norm(robot.tip - np.array(sample["position"]))))
        hand_port.note(displayed, hand)
        far_port.note(-robot.contact, robot.tip)
        rows["force"].append(float(np.linalg.norm(displayed - direct.contact)))
        rows["touches"].append(robot.touches)
        rows["direct_touches"].append(direct.touches)
        rows["link"].append(hand_port.total + far_port.total)
    return {
        "position_error_rms_mm": 1e3 * float(np.sqrt(np.mean(np.square(rows["place"])))),
        "force_error_mean_N": float(np.mean(rows["force"])),
        "energy_J": hand_port.created,
        "energy_at_hand_J": hand_port.total,
        "energy_at_robot_J": far_port.total,
        "link_energy_created_J": max(0.0, max(rows["link"])),
        "contact_share": float(np.mean(rows["touches"])),
        "direct_contact_share": float(np.mean(rows["direct_touches"])),
        "contacts": _begun(rows["touches"]),
        "direct_contacts": _begun(rows["direct_touches"]),
    } | pair.figures()


def _begun(touches: list[float]) -> int:
    return int(np.sum(np.diff(np.array(touches, dtype=int), prepend=0) == 1))


def main(pair_at: Callable[[dict, np.ndarray], Pair]) -> None:
    """Reads cases as JSON from the standard input, and prints a line of JSON with the figures of each."""
    for case in json.load(sys.stdin):
        print(json.dumps({"name": case["name"], **play(case, pair_at)}), flush=True)
