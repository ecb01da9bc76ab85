"""Leads the two Franka arms of scenario 3 by themselves, above a ground and into it, and prints the result. Runs in the virtual
environment of libfranka (test_franka_robot.py): played_franka.py PYTHON HOST HOST, with the Python of the simulator.
"""

import contextlib
import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from measuring import franka_place

GROUND = {"kind": "box", "size": [0.5, 0.05, 0.5], "at": [0.0, -0.05, 0.0], "friction": 0.2}


def main() -> None:
    simulator, *hosts = sys.argv[1:]
    start, above = np.array([0.02, 0.03, 0.0]), np.array([0.05, 0.03, -0.04])
    found = {}
    with contextlib.closing(franka_place.Pair({"simulator": simulator, "hosts": hosts, "bodies": [GROUND]}, start)) as pair:
        for name, wanted in {"start": start, "free": above, "pressed": above - [0.0, 0.03, 0.0]}.items():
            for _ in range(1000):
                pair.go(wanted, start)
            found[name] = [
                {"tip": arm.tip.tolist(), "contact": arm.contact.tolist(), "touches": arm.touches} for arm in (pair.robot, pair.direct)
            ]
    json.dump(found, sys.stdout)


if __name__ == "__main__":
    main()
