"""build/bench/proxy.json as CSV and as charts, of what was measured: time and error over the size of a sphere, with Jolt
and Bullet beside, and the late ticks of rough meshes."""

import re
import sys
from pathlib import Path

from bench_plots import cases
from plots import style

SPHERE = re.compile(r"sphere_(\d+)_r([\d.]+)$")
ROUGH = re.compile(r"rough_(\w+?)_(\d+)_r([\d.]+)_(\w+)$")
MARKS = {"0.05": "-o", "0.01": "--s"}
WORST = 12
WANTED = {"p99_us": 60.0, "max_us": 300.0}
SHARES = {
    "mean_us": ("mean", "o", style.QUIET),
    "p95_us": ("p95", "^", style.INK),
    "p99_us": ("p99", "D", style.MEASURED),
    "max_us": ("longest", "s", style.REFERENCE),
}


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


def draw_spheres(found: dict[str, list[tuple[int, dict[str, float]]]], path: Path) -> None:
    drawn, ((times, errors, beside),) = style.figure(1, 3, 15.0, 5.4)
    for radius, rows in found.items():
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


def rough(table: dict[str, dict[str, float]]) -> list[tuple[str, dict[str, float]]]:
    """Cases by the time that all but a hundredth of their ticks take, longest first."""
    found = []
    for name, case in table.items():
        if match := ROUGH.match(name):
            found.append((f"{match[1]}, {int(match[2]):,}, r {float(match[3]):g}, {match[4]}", case))
    return sorted(found, key=lambda one: -one[1]["p99_us"])


def draw_rough(found: list[tuple[str, dict[str, float]]], path: Path) -> None:
    worst = found[:WORST]
    drawn, ((everywhere, late),) = style.figure(1, 2, 13.0, 5.4)
    for metric, (label, mark, colour) in SHARES.items():
        times = [case[metric] for _, case in found]
        everywhere.plot(range(1, len(found) + 1), times, ".", color=colour, label=label, markersize=4)
        late.plot(times[:WORST], range(len(worst)), mark, color=colour, label=label, markersize=5, linestyle="")
    for metric, limit in WANTED.items():
        label, _, colour = SHARES[metric]
        everywhere.axhline(limit, color=colour, linewidth=1.0, linestyle=":", label=f"{label}, wanted")
        late.axvline(limit, color=colour, linewidth=1.0, linestyle=":")
    everywhere.set(title=f"{len(found)} cases of rough meshes", yscale="log", xlabel="cases, by their p99", ylabel="time (µs)")
    everywhere.legend(fontsize=8)
    late.set(title=f"The {len(worst)} latest", xscale="log", xlabel="time (µs)", yticks=range(len(worst)))
    late.set_yticklabels([name for name, _ in worst], fontsize=8)
    late.invert_yaxis()
    style.save(drawn, path)


def main(result: Path) -> None:
    table = cases.read(result)
    made = [result.with_suffix(".csv")]
    cases.write_csv(table, made[0])
    if found := spheres(table):
        made.append(result.with_suffix(".png"))
        draw_spheres(found, made[-1])
    if late := rough(table):
        made.append(result.with_name("proxy_rough.png"))
        draw_rough(late, made[-1])
    print(f"   {', '.join(path.name for path in made)} beside it")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
