"""A teleoperator of one's own: what an operator of scenario 2 touches is the ball and the ground below, and nothing of Tactus runs here.

    python tools/tactus_peer/own_teleoperator.py LOCAL_PORT REMOTE_PORT [SECONDS]

The operator is an MMTLink with scenario 2, side Operator, the two ports the other way round, and a ProxyPointer of 10 mm.
"""

import math
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tactus_peer import Teleoperator

RADIUS = 0.01  # of the proxy (unit: meters)
BALL, BALL_RADIUS = (0.0, 0.03, 0.05), 0.03  # it lies on the ground, y = 0 (unit: meters)
STIFFNESS = 500.0  # (unit: newtons per meter)


def surface(at):
    """How deep the proxy is in the surface that it is deepest in (unit: meters), and that surface's normal."""
    away = [a - b for a, b in zip(at, BALL)]
    distance = math.hypot(*away)
    to_ball = (RADIUS + BALL_RADIUS - distance, [part / distance for part in away])
    return max((RADIUS - at[1], [0.0, 1.0, 0.0]), to_ball)


def answer(hand):
    """The force of a spring that pushes the hand out of the surface (unit: newtons), and where its proxy is (unit: meters)."""
    depth, normal = surface(hand["position"])
    out = max(depth, 0.0)
    proxy = [at + out * part for at, part in zip(hand["position"], normal)]
    return [STIFFNESS * out * part for part in normal], proxy


def main(local_port, remote_port, seconds=math.inf):
    end = time.monotonic() + seconds
    with Teleoperator(local_port, remote_port, scenario=2, radius=RADIUS) as side:
        while time.monotonic() < end:
            side.wait(0.001)
            side.tick(time.monotonic_ns())
            if hand := side.hand():
                side.send_force(hand, *answer(hand))
                side.flush()


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), *map(float, sys.argv[3:]))
