"""build/bench/physics.json: the table and chart of tick time over the number of awake bodies (physics_awake)."""

import json
import re
import sys
from pathlib import Path

from bench_plots import cases
from matplotlib.ticker import LogLocator, NullLocator
from plots import style

ROW = re.compile(r"(awake|thrown)_(\d+)_(.+)$")
TICK = 1000.0  # (unit: microseconds)
LINES = {
    "awake_tick_p50_us": ("a tick, bodies awake but at rest: median", style.MEASURED, "-o"),
    "awake_tick_p99_us": ("the same: p99", style.MEASURED, ":o"),
    "thrown_tick_p50_us": ("a tick, bodies thrown about: median", style.REFERENCE, "-s"),
    "thrown_tick_p99_us": ("the same: p99", style.REFERENCE, ":s"),
    "awake_jolt_step_p50_us": ("Jolt's bare step of all of them, at rest: median", style.QUIET, "-^"),
}


def by_number(result: Path) -> dict[int, dict[str, float]]:
    """One row for each number of awake bodies."""
    rows: dict[int, dict[str, float]] = {}
    for key, value in json.loads(result.read_text()).items():
        if match := ROW.match(key):
            rows.setdefault(int(match[2]), {})[f"{match[1]}_{match[3]}"] = value
    return dict(sorted(rows.items()))


def draw(rows: dict[int, dict[str, float]], path: Path) -> None:
    drawn, ((axes,),) = style.figure(1, 1, 8.0, 5.8)
    for metric, (label, colour, line) in LINES.items():
        points = [(number, row[metric]) for number, row in rows.items() if metric in row]
        if points:
            axes.plot(*zip(*points), line, color=colour, label=label, markersize=4)
    axes.axhline(TICK, color=style.WARNING, linewidth=1.0, linestyle="--", label="the tick's length")
    for number, row in rows.items():
        if slowed := row.get("awake_slowed"):
            axes.annotate(
                f"{slowed:g}\nslowed",
                (number, 0.0),
                xycoords=("data", "axes fraction"),
                textcoords="offset points",
                xytext=(0, 4),
                fontsize=8,
                color=style.QUIET,
                ha="center",
            )
    axes.set(
        xscale="log",
        yscale="log",
        title="Tick time over the number of awake bodies",
        xlabel="awake bodies, one of them rubbed by a finger",
        ylabel="time (µs)",
    )
    axes.xaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
    axes.legend(fontsize=8, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.12))
    style.save(drawn, path)


def main(result: Path) -> None:
    rows = by_number(result)
    if not rows:
        return
    path = result.with_stem(f"{result.stem}_awake")
    cases.write_csv({f"{number} awake": row for number, row in rows.items()}, path.with_suffix(".csv"))
    draw(rows, path.with_suffix(".png"))
    print(f"   {path.with_suffix('.csv').name}, {path.with_suffix('.png').name} beside it")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
