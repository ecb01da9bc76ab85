"""How the arms with seven joints of scenario 3 are led, at 1 kHz. With the tip at x, its Jacobian J, the target r and the joints
q, the torques beside those that bear the arm are

    J^T (K (r − x) + D (r' − x')) + N (k (q0 − q) − d q'),     N = 1 − J^T (J J^T)⁻¹ J
"""

import numpy as np

TICK = 1e-3  # (unit: seconds)
RADIUS = 0.01  # of the sphere at the tip (unit: meters)
STIFFNESS, DAMPING, SPEED = 1000.0, 80.0, 1.0  # K, D, of the target (units: newtons per meter, newton seconds per meter, meters per second)
POSTURE_STIFFNESS, POSTURE_DAMPING = 10.0, 2.0  # k, d (units: newton meters per radian, newton meter seconds per radian)
BANDWIDTH = 200.0  # of the sensor's filter (unit: radians per second)
NO_FORCE = 0.05  # less is sent as none (unit: newtons)


def step_towards(target: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """What the target moves by in a tick, no faster than SPEED."""
    step = wanted - target
    length = float(np.linalg.norm(step))
    return step * min(1.0, SPEED * TICK / length) if length > 0.0 else step


def torques(jacobian: np.ndarray, off: np.ndarray, speed: np.ndarray, q: np.ndarray, rate: np.ndarray, posture: np.ndarray) -> np.ndarray:
    """`jacobian`: of the tip's place, 3 rows; `off`: r − x; `speed`: r'; `posture`: q0."""
    force = STIFFNESS * off + DAMPING * (speed - jacobian @ rate)
    held = POSTURE_STIFFNESS * (posture - q) - POSTURE_DAMPING * rate
    return jacobian.T @ force + held - jacobian.T @ np.linalg.solve(jacobian @ jacobian.T, jacobian @ held)


class ForceSensor:
    """Between arm and tool: tared before the arm sets out, and low-passed."""

    def __init__(self) -> None:
        self._felt, self._tare = np.zeros(3), np.zeros(3)

    def tare(self) -> None:
        self._tare, self._felt = self._felt + self._tare, np.zeros(3)

    def contact(self, sensed: np.ndarray) -> np.ndarray:
        """`sensed`: its reading in this tick, as a push on the tool (unit: newtons)."""
        self._felt = self._felt + (1.0 - np.exp(-BANDWIDTH * TICK)) * (sensed - self._tare - self._felt)
        return self._felt.copy() if np.linalg.norm(self._felt) > NO_FORCE else np.zeros(3)
