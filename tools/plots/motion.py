"""What the hand feels and what it moves, over time."""

from pathlib import Path

import numpy as np

from measuring.records import Record
from plots import style


def draw_forces(record: Record, title: str, path: Path) -> None:
    drawn, ((parts,), (size,)) = style.figure(2, 1, 9.0, 5.4, sharex=True)
    for number, (axis, colour) in enumerate(style.AXES.items()):
        parts.plot(record.time, record.force[:, number], color=colour, label=axis, linewidth=1.2)
    parts.set(title=title, ylabel="components (N)")
    parts.legend(ncols=3, loc="upper right")
    size.fill_between(record.time, record.force_size, color=style.MEASURED, alpha=0.15, linewidth=0)
    size.plot(record.time, record.force_size, color=style.MEASURED)
    size.set(ylabel="size (N)", xlabel="time (s)", xlim=(0, record.time[-1]), ylim=(0, None))
    style.save(drawn, path)


def draw_object(record: Record, title: str, path: Path) -> None:
    moved = (record.object_position - record.object_position[0]) * 1000.0
    drawn, ((axes,), (force,)) = style.figure(2, 1, 9.0, 5.0, sharex=True, height_ratios=[3, 1])
    for number, (axis, colour) in enumerate(style.AXES.items()):
        axes.plot(record.time, moved[:, number], color=colour, label=axis)
    reach = max(1.0, float(np.abs(moved).max()))
    axes.set(title=title, ylabel="from where it stood (mm)", ylim=(-1.1 * reach, 1.1 * reach))
    axes.legend(ncols=3, loc="upper right")
    force.plot(record.time, record.force_size, color=style.MEASURED, linewidth=1.0)
    force.set(ylabel="force (N)", xlabel="time (s)", xlim=(0, record.time[-1]), ylim=(0, None))
    style.save(drawn, path)
