"""build/bench/pareto.json as CSV and as charts: run time against error, the defaults marked.

The proxy's rows and, in a chart and table of their own (pareto_physics), those of the bodies that move.
"""

import sys
from pathlib import Path

from bench_plots import cases
from matplotlib.ticker import LogLocator, NullLocator
from plots import style

DEFAULT = "steps_64"
GROUPS = {
    "steps_": ("steps a tick", style.MEASURED, "o"),
    "triangles_": ("triangles of the mesh", style.REFERENCE, "s"),
    "shaded_": ("triangles of the mesh, with force shading", style.AXES["z"], "v"),
    "at_": ("distance from the origin (tolerances grow with it)", style.WARNING, "^"),
    "float": ("single precision", style.INK, "D"),
    "closed_form": ("closed form", style.AXES["y"], "P"),
}

PHYSICS = "physics_"
PHYSICS_DEFAULT = 1.0  # (unit: milliseconds)
NO_ERROR = 2e-3  # what rounding leaves (unit: percent): named, not drawn
PHYSICS_ERRORS = {
    "fall_error_percent": ("way of a falling body", style.MEASURED, "-o"),
    "sliding_error_percent": ("way of a box sliding to rest", style.REFERENCE, "-s"),
    "work_error_percent": ("work of a push over ice, F·s", style.AXES["y"], "-^"),
    "energy_error_percent": ("energy of a push over ice", style.QUIET, "-v"),
    "momentum_error_percent": ("momentum of a push over ice", style.INK, "-D"),
    "spring_energy_loss_percent": ("energy lost by a hand's spring that throws a box", style.WARNING, "-P"),
}


def group_of(name: str) -> str:
    return next(group for group in GROUPS if name.startswith(group))


def scatter(axes, table, metric: str, named: tuple[str, ...]) -> None:
    """Only the groups in `named` have their names beside their points: the others lie on top of each other."""
    told = set()
    for number, (name, case) in enumerate(table.items()):
        if case.get(metric, 0.0) <= 0.0:
            continue
        group = group_of(name)
        label, colour, mark = GROUPS[group]
        point = (case["contact_median_us"], case[metric])
        axes.plot(*point, mark, color=colour, markersize=6, label=None if group in told else label)
        told.add(group)
        if group in named:
            text = name.removeprefix(group).strip("_") or name
            below = group == "shaded_"
            place = (5, -11 if below else 4 + 8 * (number % 2))
            axes.annotate(text, point, textcoords="offset points", xytext=place, fontsize=7, color=colour)
        if name == DEFAULT:
            axes.plot(*point, "o", markersize=15, fillstyle="none", color=style.MEASURED, label="the default, 64 steps")
    axes.set(yscale="log", xlabel="median of a tick in contact (µs)")


def draw(table: dict[str, dict[str, float]], path: Path) -> None:
    drawn, ((facets, sphere, force),) = style.figure(1, 3, 19.0, 5.8)
    motions = {name: case for name, case in table.items() if not name.startswith("shaded_")}
    scatter(facets, motions, "facets_error_max", ("steps_", "at_", "float"))
    facets.set(title="Proxy against exact descent on the same facets", ylabel="largest error (m)")
    scatter(sphere, motions, "sphere_error_max", ("triangles_", "closed_form"))
    sphere.set(title="Proxy against the smooth sphere", ylabel="largest error (m)")
    shading = {name: case for name, case in table.items() if name.startswith(("triangles_", "shaded_"))}
    scatter(force, shading, "force_direction_rms_deg", ("triangles_", "shaded_"))
    force.set(title="Force against that of the smooth sphere", ylabel="angle, RMS (degrees)")
    for axes in (facets, sphere, force):
        axes.legend(fontsize=8, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.12))
    style.save(drawn, path)


def draw_physics(table: dict[str, dict[str, float]], path: Path) -> None:
    drawn, ((axes,),) = style.figure(1, 1, 8.0, 5.6)
    places = [(case["run_ms_per_s"], milliseconds_of(name)) for name, case in table.items()]
    for metric, (label, colour, line) in PHYSICS_ERRORS.items():
        errors = [case[metric] for case in table.values()]
        if max(errors) < NO_ERROR:
            axes.plot([], [], line, color=colour, label=f"{label}: below {NO_ERROR:g} %", markersize=5)
        else:
            axes.plot([run_time for run_time, _ in places], errors, line, color=colour, label=label, markersize=5)
    for run_time, milliseconds in places:
        default = milliseconds == PHYSICS_DEFAULT
        axes.axvline(run_time, color=style.MEASURED if default else style.GRID, linewidth=1.0, linestyle=":", zorder=0)
        axes.annotate(
            f"{milliseconds:g} ms" + (" (default)" if default else ""),
            (run_time, 1.0),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            xytext=(3, -10),
            fontsize=8,
            color=style.INK,
        )
    axes.axhline(0.5, color=style.INK, linewidth=1.0, linestyle="--", label="wanted at the default: 0.5 %")
    axes.set(
        xscale="log",
        yscale="log",
        title="Moving bodies: error over time step",
        xlabel="run time of one second of a sliding box (ms)",
        ylabel="error (% of the exact value)",
    )
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.legend(fontsize=8, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.12))
    style.save(drawn, path)


def milliseconds_of(name: str) -> float:
    return float(name.removeprefix(PHYSICS).removesuffix("_ms"))


def split(table: dict[str, dict[str, float]]) -> tuple[dict, dict]:
    """The proxy's rows and those of physics."""
    physics = {name: case for name, case in table.items() if name.startswith(PHYSICS)}
    return {name: case for name, case in table.items() if name not in physics}, physics


def main(result: Path) -> None:
    proxy, physics = split(cases.read(result))
    for table, drawing, path in (
        (proxy, draw, result),
        (physics, draw_physics, result.with_stem(f"{result.stem}_physics")),
    ):
        if table:
            cases.write_csv(table, path.with_suffix(".csv"))
            drawing(table, path.with_suffix(".png"))
            print(f"   {path.with_suffix('.csv').name}, {path.with_suffix('.png').name} beside it")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
