"""A depth camera of a place that another program draws, through Tactus's own recognition: eye.gd as a process, whose images come
from a DepthFile through the driver of OpenNI2. Images and what is seen in them go by turns.
"""

import json
import queue
import subprocess
import threading
import time

import numpy as np

from measuring.depth_file import DepthFile
from project import FOLDER
from setup import godot

WIDTH, HEIGHT, FIELD_OF_VIEW = 320, 240, 1.0123  # (units: pixels, radians across the image)
_PATIENCE = 30.0  # until the camera is open, and has looked (unit: seconds)
_FIRST_IMAGES = 30  # from which the error of its depths is learned


def across_height() -> float:
    """The field of view from top to bottom, of square pixels (unit: radians)."""
    return 2.0 * float(np.arctan(np.tan(0.5 * FIELD_OF_VIEW) * HEIGHT / WIDTH))


class Eye:
    def __init__(self, pose: np.ndarray, options: dict[str, object], seed: int = 1):
        """`pose`: of the camera, 4 x 4, as the sensor believes it. `options`: properties of the HapticDepthSensor."""
        self._file = DepthFile(WIDTH, HEIGHT, FIELD_OF_VIEW, seed=seed)
        numbers = [*pose[:3, 0], *pose[:3, 1], *pose[:3, 2], *pose[:3, 3]]
        words = [f"--pose={json.dumps([float(number) for number in numbers])}"]
        words += [f"--{name}={value}" for name, value in {"source": 0, "camera_id": self._file.uri, "width": WIDTH, **options}.items()]
        script = ["--script", "res://experiments/eye.gd"]
        command = [str(godot.command()), "--headless", "--path", str(FOLDER), *script, "--", *words]
        self._process = subprocess.Popen(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self._said: list[str] = []
        self._lines: queue.Queue[dict] = queue.Queue()
        self._looked = 0
        threading.Thread(target=self._listen, daemon=True).start()

    def show(self, depth: np.ndarray) -> None:
        self._file.show(depth)

    def seen(self, patience: float) -> dict | None:
        """What the sensor says once it has looked at another image; None where that takes longer (unit: seconds)."""
        until = time.monotonic() + patience
        while (left := until - time.monotonic()) > 0.0:
            try:
                line = self._lines.get(timeout=left)
            except queue.Empty:
                return None
            if line["looked"] > self._looked:
                self._looked = line["looked"]
                return line
        return None

    def find(self, depth, names: set[str]) -> dict:
        """Shows what `depth` draws until the support and these objects are known."""
        until, line = time.monotonic() + _PATIENCE, None
        while time.monotonic() < until:
            self.show(depth())
            line = self.seen(0.2) or line
            known = {name for name, one in line["objects"].items() if one["is_known"]} if line else set()
            if line and line["plane"] and line["looked"] >= _FIRST_IMAGES and names <= known:
                return line
        raise RuntimeError(f"the camera has not found {names}: {line or ''.join(self._said)[-2000:]}")

    def close(self) -> None:
        self._process.terminate()
        self._process.wait()
        self._file.close()

    def _listen(self) -> None:
        assert self._process.stdout
        for line in self._process.stdout:
            if line.startswith("{"):
                self._lines.put(json.loads(line))
            else:
                self._said.append(line)


def pose_of(numbers: list[float]) -> tuple[tuple, tuple]:
    """Place and rotation (x, y, z, w) of what eye.gd says."""
    x, y, z, origin = (np.array(numbers[first : first + 3]) for first in range(0, 12, 3))
    return tuple(map(float, origin)), rotation_of(np.column_stack([x, y, z]))


def rotation_of(matrix: np.ndarray) -> tuple:
    """A rotation as a unit quaternion, x, y, z, w."""
    m = matrix / np.linalg.norm(matrix, axis=0)
    # The largest of the four parts is never small (Shepperd 1978).
    squares = np.array([m[0, 0] - m[1, 1] - m[2, 2], m[1, 1] - m[0, 0] - m[2, 2], m[2, 2] - m[0, 0] - m[1, 1], m.trace()])
    at = int(np.argmax(squares))
    q = np.zeros(4)
    q[at] = 1.0 + squares[at]
    if at == 3:
        q[:3] = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    else:
        j, k = (at + 1) % 3, (at + 2) % 3
        q[j], q[k], q[3] = m[j, at] + m[at, j], m[k, at] + m[at, k], m[k, j] - m[j, k]
    return tuple(map(float, q / np.linalg.norm(q)))
