"""Scenario 3 with Franka arms over the arm's own network protocol: the vendor's libfranka leads what franky-sim plays
(franka_simulator.py). Runs in the library's virtual environment (tools/franka/requirements.txt).

libfranka gives state and Jacobian, and takes torques; arm and library bear the weight by themselves, of masses that are not those of
the simulated links. Both sides tick by turns, so that no load of the machine changes a figure. A force sensor at the tool, which no
Franka has, is read beside the protocol.
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pylibfranka

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from measuring import arm_control, robot_place

_SETTLING = 1000  # ticks
_JOINTS = 7
_COLLISION = 100.0  # torques and forces of a contact up to which the arm does not stop (units: newton meters, newtons)


class Arm:
    """One of the two, as libfranka has it, in the frame of the place."""

    def __init__(self, host: str, frame: dict, at: np.ndarray):
        self._origin, self._up = np.array(frame["origin"]), np.array(frame["up"])
        self._robot = pylibfranka.Robot(host, pylibfranka.RealtimeConfig.kIgnore)
        self._model = self._robot.load_model()
        tool = np.eye(4)
        tool[2, 3] = frame["reach"]
        self._robot.set_EE(tool.flatten(order="F").tolist())
        self._robot.set_collision_behavior(*([_COLLISION] * count for count in (_JOINTS, _JOINTS, 6, 6)))
        self._posture = np.array(self._robot.read_once().q)
        self._target, self._speed = at.copy(), np.zeros(3)
        self._sensor = arm_control.ForceSensor()
        self.tip, self.contact, self.touches = at.copy(), np.zeros(3), False

    def begin(self) -> None:
        """From here on the arm follows torques alone."""
        self._control = self._robot.start_torque_control()

    def lead(self, wanted: np.ndarray | None) -> None:
        step = np.zeros(3) if wanted is None else arm_control.step_towards(self._target, wanted)
        self._target, self._speed = self._target + step, step / arm_control.TICK
        q, rate = np.array(self._state.q), np.array(self._state.dq)
        jacobian = self._up.T @ np.array(self._model.zero_jacobian(self._state)).reshape(_JOINTS, 6).T[:3]
        led = arm_control.torques(jacobian, self._target - self.tip, self._speed, q, rate, self._posture)
        self._control.writeOnce(pylibfranka.Torques((led + np.array(self._model.coriolis(self._state))).tolist()))

    def read(self, reading: dict) -> None:
        self._state, _ = self._control.readOnce()
        self.tip = self._up.T @ (np.array(self._state.O_T_EE)[12:15] - self._origin)
        self.contact = self._sensor.contact(self._up.T @ reading["sensor"])
        self.touches = bool(np.any(reading["touching"]))

    def tare(self) -> None:
        self._sensor.tare()
        self.contact = np.zeros(3)

    def stop(self) -> None:
        self._robot.stop()


class Pair(robot_place.Pair):
    def __init__(self, case: dict, at: np.ndarray):
        command = [case["simulator"], str(Path(__file__).with_name("franka_simulator.py"))]
        self._process = subprocess.Popen(command, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        frame = self._tell(json.dumps({"hosts": case["hosts"], "bodies": case["bodies"], "start": at.tolist()}))
        self.robot, self.direct = (Arm(host, frame, at) for host in case["hosts"])
        self._arms = (self.robot, self.direct)
        for arm in self._arms:
            arm.begin()
        self._tell("hold")
        self._step()
        for _ in range(_SETTLING):
            self.go(at, at)
        for arm in self._arms:
            arm.tare()

    def go(self, robot: np.ndarray | None, direct: np.ndarray) -> None:
        self.robot.lead(robot)
        self.direct.lead(direct)
        self._step()

    def close(self) -> None:
        self._tell("free")
        for arm in self._arms:
            arm.stop()
        self._process.communicate("quit\n", timeout=20)

    def _step(self) -> None:
        for arm, reading in zip(self._arms, self._tell("step"), strict=True):
            arm.read(reading)

    def _tell(self, line: str):
        """The answer is a line of JSON; what else the simulator says is left out."""
        assert self._process.stdin and self._process.stdout
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()
        for answer in self._process.stdout:
            if answer.startswith(("{", "[", '"')):
                return json.loads(answer)
        raise RuntimeError(f"franky-sim has ended with {self._process.wait()}")


if __name__ == "__main__":
    robot_place.main(Pair)
