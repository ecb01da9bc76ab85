"""What the hand feels and what it moves, over time."""

from pathlib import Path

from measuring.records import Record
from plots import style


def _name_axes(axes) -> None:
    """Beside the title, out of the way of the curves."""
    axes.legend(ncols=3, loc="lower right", bbox_to_anchor=(1.0, 0.98), borderaxespad=0.0)


def _whole(record: Record) -> tuple[float, float]:
    return 0.0, record.time[-1] + record.time[1]


def draw_forces(record: Record, title: str, path: Path) -> None:
    drawn, ((parts,), (size,)) = style.figure(2, 1, 9.0, 5.4, sharex=True)
    for number, (axis, colour) in enumerate(style.AXES.items()):
        parts.plot(record.time, record.force[:, number], color=colour, label=axis, linewidth=1.2)
    parts.set(title=title, ylabel="components (N)")
    _name_axes(parts)
    size.fill_between(record.time, record.force_size, color=style.MEASURED, alpha=0.15, linewidth=0)
    size.plot(record.time, record.force_size, color=style.MEASURED)
    size.set(ylabel="size (N)", xlabel="time (s)", xlim=_whole(record), ylim=(0, None))
    style.save(drawn, path)


def draw_object(record: Record, title: str, path: Path) -> None:
    moved = (record.object_position - record.object_position[0]) * 1000.0
    drawn, ((axes,), (force,)) = style.figure(2, 1, 9.0, 5.0, sharex=True, height_ratios=[3, 1])
    for number, (axis, colour) in enumerate(style.AXES.items()):
        axes.plot(record.time, moved[:, number], color=colour, label=axis)
    axes.set(title=title, ylabel="from where it stood (mm)")
    _name_axes(axes)
    force.plot(record.time, record.force_size, color=style.MEASURED, linewidth=1.0)
    force.set(ylabel="force (N)", xlabel="time (s)", xlim=_whole(record), ylim=(0, None))
    style.save(drawn, path)
