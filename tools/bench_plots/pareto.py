"""build/bench/pareto.json as CSV and as a chart: run time against error, the default marked."""

import sys
from pathlib import Path

from bench_plots import cases
from plots import style

DEFAULT = "steps_64"
GROUPS = {
    "steps_": ("steps a tick", style.MEASURED, "o"),
    "triangles_": ("triangles of the mesh", style.REFERENCE, "s"),
    "at_": ("distance from the origin (tolerances grow with it)", style.WARNING, "^"),
    "float": ("single precision", style.INK, "D"),
    "closed_form": ("closed form", style.AXES["y"], "P"),
}


def group_of(name: str) -> str:
    return next(group for group in GROUPS if name.startswith(group))


def scatter(axes, table, metric: str) -> None:
    told = set()
    for number, (name, case) in enumerate(table.items()):
        if case.get(metric, 0.0) <= 0.0:
            continue
        group = group_of(name)
        label, colour, mark = GROUPS[group]
        point = (case["contact_median_us"], case[metric])
        axes.plot(*point, mark, color=colour, markersize=6, label=None if group in told else label)
        told.add(group)
        text = name.removeprefix(group).strip("_") or name
        # Points lie close together: their names stand at changing heights.
        place = (6, 4 + 9 * (number % 4))
        axes.annotate(text, point, textcoords="offset points", xytext=place, fontsize=7, color=colour)
        if name == DEFAULT:
            axes.plot(*point, "o", markersize=15, fillstyle="none", color=style.MEASURED, label="the default")
    axes.set(yscale="log", xlabel="median of a tick in contact (µs)")


def draw(table: dict[str, dict[str, float]], path: Path) -> None:
    drawn, ((facets, sphere),) = style.figure(1, 2, 13.0, 5.8)
    scatter(facets, table, "facets_error_max")
    facets.set(title="Against exact descent on the same facets", ylabel="largest error (m)")
    scatter(sphere, table, "sphere_error_max")
    sphere.set(title="Against the smooth sphere", ylabel="largest error (m)")
    for axes in (facets, sphere):
        axes.legend(fontsize=8, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.12))
    style.save(drawn, path)


def main(result: Path) -> None:
    table = cases.read(result)
    cases.write_csv(table, result.with_suffix(".csv"))
    draw(table, result.with_suffix(".png"))
    print(f"   {result.with_suffix('.csv').name}, {result.with_suffix('.png').name} beside it")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
