"""What a HapticRecorder wrote: one row a tick."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class Record:
    time: np.ndarray  # since the first row (unit: seconds)
    force: np.ndarray  # on the hand, rows × 3 (unit: newtons)
    object_position: np.ndarray  # rows × 3 (unit: meters)
    hand: np.ndarray  # rows × 3 (unit: meters)
    proxy: np.ndarray  # rows × 3 (unit: meters)
    contacts: np.ndarray  # planes that hold the proxy back

    @property
    def force_size(self) -> np.ndarray:
        return np.linalg.norm(self.force, axis=1)


def read(path: Path) -> Record:
    with path.open(newline="") as file:
        header = next(csv.reader(file))
        rows = np.loadtxt(file, delimiter=",", ndmin=2)
    if rows.size == 0:
        raise RuntimeError(f"{path} has no rows")
    column = {name: index for index, name in enumerate(header)}

    def vector(name: str) -> np.ndarray:
        return rows[:, [column[f"{name}_{axis}"] for axis in "xyz"]]

    time = (rows[:, column["time_us"]] - rows[0, column["time_us"]]) * 1e-6
    return Record(
        time, vector("force"), vector("object"), vector("hand"), vector("proxy"), rows[:, column["contacts"]]
    )


def periods(path: Path, seconds: float) -> np.ndarray:
    """Of the last seconds: from each tick that really ran to the next one, which is not when they were due (unit: microseconds)."""
    with path.open(newline="") as file:
        column = next(csv.reader(file)).index("ran_us")
        ran = np.loadtxt(file, delimiter=",", usecols=column, ndmin=1)
    return np.diff(ran[-round(seconds * 1e3) - 1 :])


def last_seconds(record: Record, seconds: float) -> Record:
    """The end of it, with a clock that starts there."""
    # Times are whole microseconds: half of one keeps rounding from adding a row.
    rows = record.time > record.time[-1] - seconds + 0.5e-6
    start = record.time[rows][0]
    return Record(
        record.time[rows] - start, record.force[rows], record.object_position[rows], record.hand[rows],
        record.proxy[rows], record.contacts[rows],
    )  # fmt: skip


def figures(record: Record) -> dict[str, float]:
    touching = record.contacts > 0
    return {
        "force_mean_n": float(record.force_size.mean()),
        "force_mean_while_touching_n": float(record.force_size[touching].mean()) if touching.any() else 0.0,
        "force_max_n": float(record.force_size.max()),
        "contact_time_share": float(touching.mean()),
        "object_travel_m": float(np.linalg.norm(record.object_position[-1] - record.object_position[0])),
    }
