"""Touch of what stands still, and what a correction costs."""

from pathlib import Path

from measuring.rivals import LABELS
from plots import style
from plots.teleop import WAYS, force_error, legend, read


def draw(folder: Path, path: str, until: float) -> None:
    """The thesis's figure 5.4, of the first `until` seconds: the force's vertical part, and the size of its error."""
    traditional = read(folder / f"{path}.traditional_100ms.csv")
    right, wrong = read(folder / f"{path}.mmt_right_100ms.csv"), read(folder / f"{path}.mmt_wrong_100ms.csv")
    drawn, ((force,), (error,)) = style.figure(2, 1, 9.0, 6.0, sharex=True)
    force.plot(right["time"], right["direct_y"], color=style.QUIET, linewidth=3.0, alpha=0.5, label="direct touch")
    force.plot(right["time"], traditional["force_y"], color=style.WARNING, linewidth=1.1, label="direct, 100 ms")
    force.plot(right["time"], wrong["force_y"], color=style.REFERENCE, linewidth=1.1, label="wrong model")
    force.plot(right["time"], right["force_y"], color=style.MEASURED, linewidth=1.1, label="right model")
    force.set(ylabel="force, vertical (N)", xlim=(0.0, until))
    force.set_title(f"Touch of what stands still, 100 ms away: {path.replace('_', ' ')}", pad=24)
    legend(force)
    for rows, colour in ((traditional, style.WARNING), (wrong, style.REFERENCE), (right, style.MEASURED)):
        error.plot(rows["time"], force_error(rows), color=colour, linewidth=1.2)
    error.set(ylabel="force error (N)", xlabel="time (s)", ylim=(0, None))
    style.save(drawn, folder / f"{path}_forces.png")
    _draw_correction(folder, path, until)


def _draw_correction(folder: Path, path: str, until: float) -> None:
    rows, wrong = read(folder / f"{path}.mmt_wrong_corrected_100ms.csv"), read(folder / f"{path}.mmt_wrong_100ms.csv")
    drawn, ((error,), (excess,)) = style.figure(2, 1, 9.0, 4.6, sharex=True, height_ratios=[2, 1])
    error.plot(wrong["time"], force_error(wrong), color=style.REFERENCE, linewidth=1.1, label="left wrong")
    error.plot(rows["time"], force_error(rows), color=style.MEASURED, label="corrected from the first touch on")
    error.set(ylabel="force error (N)", xlim=(0.0, until), ylim=(0, None))
    error.set_title("A wrong model becomes right", pad=24)
    legend(error)
    for one, colour in ((wrong, style.REFERENCE), (rows, style.MEASURED)):
        excess.plot(one["time"], one["felt_excess_100ms_jnd"], color=colour, linewidth=1.2)
    excess.set(ylabel="excess force\n(JND in 100 ms)", xlabel="time (s)", ylim=(0, None))
    style.save(drawn, folder / f"{path}_correction.png")


def draw_trade(summary: dict[str, object], name: str, shares: tuple[str, ...], ways: tuple[str, ...], path: Path) -> None:
    """Excess force against time to truth: the same correction from careful to careless, and other ways."""
    drawn, ((one,),) = style.figure(1, 1, 8.0, 5.0)

    def point(case: str) -> tuple[float, float]:
        keys = ("seconds_from_told_until_right", "felt_excess_once_told_100ms_jnd_max")
        return tuple(float(summary[f"{name}.trade.{case}.{key}"]) for key in keys)

    points = [point(share) for share in shares]
    one.plot(*zip(*points), color=style.MEASURED, marker="o", markersize=4, linewidth=1.2, label="so much of a JND in 100 ms")
    for share, place in zip(shares, points):
        one.annotate(share, place, textcoords="offset points", xytext=(9, 4), fontsize=8, color=style.MEASURED)
    for way, marker in zip(ways, "sX^D"):
        one.plot(
            *point(way), color=WAYS[way][0], marker=marker, markersize=9, fillstyle="none", linestyle="", label=LABELS[way]
        )  # fmt: skip
    one.axhline(1.0, color=style.INK, linewidth=0.8, linestyle=":")
    one.set(xlabel="seconds from being told until right", xlim=(0, None), ylim=(0, None))
    one.set_ylabel("excess force over 100 ms, largest (JND)")
    one.set_title("A wrong ground is corrected under a hand that presses and slides", pad=10)
    one.legend(fontsize=9)
    style.save(drawn, path)
