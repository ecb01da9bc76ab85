"""Leads the arm of scenario 3 in MuJoCo by itself, above a ground and into it, and prints the result. Runs in MuJoCo's
virtual environment (test_mujoco_robot.py).
"""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from measuring import mujoco_arm

GROUND = {"kind": "box", "size": [0.5, 0.05, 0.5], "at": [0.0, -0.05, 0.0], "friction": 0.2}


def row(arm: mujoco_arm.Arm, wanted: np.ndarray) -> dict:
    return {
        "tip": arm.tip.tolist(), "wanted": wanted.tolist(), "contact": arm.contact.tolist(), "touching": arm.touching.tolist(),
        "torques": arm.torques.tolist(),
    }  # fmt: skip


def main() -> None:
    start = np.array([0.02, 0.03, 0.0])
    arm = mujoco_arm.Arm([GROUND], start)
    found = {"free": row(arm, start)}
    for name, wanted in {"pressed": np.array([0.02, 0.0, 0.0]), "far": np.array([0.02, -0.5, 0.0])}.items():
        for _ in range(1500):
            arm.go(wanted)
        found[name] = row(arm, wanted)
    json.dump(found, sys.stdout)


if __name__ == "__main__":
    main()
