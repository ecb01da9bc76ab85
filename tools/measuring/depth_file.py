"""A file with depth images of another renderer, which the driver of Tactus's synthetic camera shows to OpenNI2 as a camera's
(extension/sensing/synthetic_camera/scene_memory.hpp has the layout). The camera adds a Kinect's noise and an error of scale.
"""

import mmap
import os
import struct
import tempfile
import time

import numpy as np

SCHEME = "tactus-scene:"
_MAGIC = 0x32656E6563537354
_MOST_BODIES = 64
_SEQUENCE, _SHOWN, _PLUG, _TIME, _HEADER = 72, 76, 80, 88, 152 + 64 * _MOST_BODIES  # offsets
_GONE = 2


class DepthFile:
    def __init__(self, width: int, height: int, field_of_view: float, noise: float = 1.0, depth_error: float = 0.01, seed: int = 1):
        """`field_of_view`: across the image (unit: radians). `noise`: factor of a Kinect's. `depth_error`: share of the depth."""
        self._pixels = (height, width)
        size = _HEADER + (4 * width * height + 7) // 8 * 8
        handle, self._path = tempfile.mkstemp(prefix="tactus_scene_")
        os.ftruncate(handle, size)
        self._memory = mmap.mmap(handle, size)
        os.close(handle)
        self._memory[:_SEQUENCE] = struct.pack("<QQii4dQII", _MAGIC, size, width, height, field_of_view, 0.0, depth_error, noise, seed, 0, 1)
        self.shown = 0

    @property
    def uri(self) -> str:
        """As HapticDepthSensor.camera_id has it."""
        return SCHEME + self._path

    def show(self, depth: np.ndarray) -> None:
        """`depth`: along the camera's axis, by rows from the top (unit: meters); what is not above 0 is nothing."""
        assert depth.shape == self._pixels
        self.shown += 1
        self._set(_SEQUENCE, 2 * self.shown - 1)
        self._memory[_HEADER : _HEADER + 4 * depth.size] = np.ascontiguousarray(depth, dtype="<f4").tobytes()
        self._set(_SHOWN, self.shown)
        self._memory[_TIME : _TIME + 8] = struct.pack("<Q", time.monotonic_ns() // 1000)
        self._set(_SEQUENCE, 2 * self.shown)

    def close(self) -> None:
        self._set(_PLUG, _GONE)
        self._memory.close()
        os.unlink(self._path)

    def _set(self, offset: int, value: int) -> None:
        self._memory[offset : offset + 4] = struct.pack("<I", value)
