"""What a hand feels of each change of the model."""

from pathlib import Path

import numpy as np

from plots import style
from plots.teleop import read


def draw(folder: Path, kinds: list[str], summary: dict[str, object], at: float) -> None:
    columns = 4
    rows = -(-len(kinds) // columns)
    drawn, axes = style.figure(rows, columns, 13.0, 2.1 * rows + 0.4, sharex=True)
    for kind, one in zip(kinds, axes.flat):
        ticks = read(folder / f"{kind}.csv")
        felt, direct = (np.sqrt(sum(ticks[f"{name}_{axis}"] ** 2 for axis in "xyz")) for name in ("force", "direct"))
        one.plot(ticks["time"], direct, color=style.QUIET, linewidth=3.0, alpha=0.5)
        one.plot(ticks["time"], felt, color=style.MEASURED, linewidth=1.1)
        one.axvline(at, color=style.INK, linewidth=0.8, linestyle=":")
        jnd = float(summary[f"{kind}.felt_excess_100ms_jnd_max"])
        let_go = bool(summary[f"{kind}.let_go"])
        quiet = jnd <= 1.0 or let_go
        text = "0 JND" if jnd < 0.005 else f"{jnd:.2g} JND" if jnd < 99.5 else f"{jnd:.0f} JND"
        title = f"{kind.replace('_', ' ')}: {text}" + (", released" if let_go else "")
        one.set_title(title, fontsize=8.5, color=style.INK if quiet else style.WARNING)
        one.set(xlim=(0.5, 4.4), ylim=(0, None))
    for one in axes.flat[len(kinds) :]:
        one.set_visible(False)
    for one in axes[:, 0]:
        one.set_ylabel("force (N)")
    for one in axes[-1]:
        one.set_xlabel("time (s)")
    drawn.suptitle("At 2 s the model changes, 100 ms away: felt (blue), direct touch (grey); in red what can be felt", fontsize=11)
    style.save(drawn, folder / "kicks.png")
