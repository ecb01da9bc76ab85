"""build/bench/proxy.json as CSV and as a chart: time and error over the size of the mesh, and Jolt and Bullet beside."""

import re
import sys
from pathlib import Path

from bench_plots import cases
from plots import style

SPHERE = re.compile(r"sphere_(\d+)_r([\d.]+)$")
MARKS = {"0.05": "-o", "0.01": "--s"}


def spheres(table: dict[str, dict[str, float]]) -> dict[str, list[tuple[int, dict[str, float]]]]:
    found: dict[str, list[tuple[int, dict[str, float]]]] = {}
    for name, case in table.items():
        if match := SPHERE.match(name):
            found.setdefault(match[2], []).append((int(match[1]), case))
    return found


def line(axes, rows, metric, mark, colour, label):
    points = [(size, case[metric]) for size, case in rows if case.get(metric, 0.0) > 0.0]
    if points:
        axes.plot(*zip(*points), mark, color=colour, label=label, markersize=4)


def draw(table: dict[str, dict[str, float]], path: Path) -> None:
    drawn, ((times, errors, beside),) = style.figure(1, 3, 15.0, 5.4)
    for radius, rows in spheres(table).items():
        mark = MARKS.get(radius, "-")
        line(times, rows, "contact_median_us", mark, style.MEASURED, f"median, radius {radius}")
        line(times, rows, "contact_p99_us", mark, style.REFERENCE, f"p99, radius {radius}")
        line(times, rows, "free_median_us", mark, style.QUIET, f"in the open, radius {radius}")
        line(errors, rows, "error_max", mark, style.MEASURED, f"position, largest, radius {radius} (m)")
        line(errors, rows, "force_direction_max_deg", mark, style.WARNING, f"force direction, radius {radius} (°)")
        line(beside, rows, "jolt_cast_over_tick", mark, style.MEASURED, f"Jolt sphere cast, radius {radius}")
        line(beside, rows, "bullet_sweep_over_tick", mark, style.REFERENCE, f"Bullet convex sweep, radius {radius}")
    times.set(title="A whole tick", ylabel="time (µs)")
    errors.axhline(1e-7, color=style.QUIET, linewidth=1.0, linestyle=":")
    errors.set(title="Error against exact descent", ylabel="largest error")
    beside.axhline(1.0, color=style.QUIET, linewidth=1.0, linestyle=":")
    beside.set(title="One query elsewhere over a whole tick here", ylabel="times as long")
    for axes in (times, errors, beside):
        axes.set(xscale="log", yscale="log", xlabel="triangles of the sphere")
        axes.legend(fontsize=8, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.14))
    style.save(drawn, path)


def main(result: Path) -> None:
    table = cases.read(result)
    cases.write_csv(table, result.with_suffix(".csv"))
    draw(table, result.with_suffix(".png"))
    print(f"   {result.with_suffix('.csv').name}, {result.with_suffix('.png').name} beside it")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
