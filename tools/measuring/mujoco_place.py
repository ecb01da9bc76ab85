"""Scenario 3 in a place that MuJoCo simulates, with an arm that is led here (mujoco_arm.py). Runs in MuJoCo's own virtual environment
(tools/credibility/requirements.txt).
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from measuring import robot_place
from measuring.mujoco_arm import Arm


class Pair(robot_place.Pair):
    def __init__(self, case: dict, at: np.ndarray):
        self.robot, self.direct = Arm(case["bodies"], at), Arm(case["bodies"], at)

    def go(self, robot: np.ndarray | None, direct: np.ndarray) -> None:
        self.direct.go(direct)
        if robot is not None:
            self.robot.go(robot)


if __name__ == "__main__":
    robot_place.main(Pair)
