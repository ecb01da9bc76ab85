"""A measure over the factors of a sweep: means with their confidence intervals over the repeats, and every run as a point."""

import math
from pathlib import Path

from plots import style
from sweeps import statistics
from sweeps.description import Sweep
from sweeps.table import Rows

PANEL = (3.6, 2.9)  # (unit: inches)
PANELS_IN_A_ROW = 2


def draw(sweep: Sweep, table: Rows, measure: str, path: Path) -> list[Path]:
    """The files: `path` with the ending of each form."""
    x, lines, panels = (sweep.column(name) if name else "" for name in (*sweep.drawn, "", "", "")[:3])
    shown = levels(table, panels)
    columns = min(len(shown), PANELS_IN_A_ROW)
    rows = math.ceil(len(shown) / columns)
    drawn, axes = style.figure(rows, columns, max(columns, 1.4) * PANEL[0], rows * PANEL[1] + 0.5, sharex=True, sharey=True)
    places = list(axes.flat)
    for panel, place in zip(shown, places):
        _draw_panel(place, sweep, [row for row in table if not panels or row[panels] == panel], measure, x, lines, levels(table, lines))
        if panels:
            place.set_title(f"{sweep.label(sweep.drawn[2])}: {word(panel)}", fontsize=9)
    for place in places[len(shown) :]:
        place.set_visible(False)
    drawn.supxlabel(sweep.label(sweep.drawn[0]) if x else "", fontsize=9)
    drawn.supylabel(measure.replace("_", " "), fontsize=9)
    if lines:
        handles, names = places[0].get_legend_handles_labels()
        drawn.legend(handles, names, loc="outside upper center", ncols=min(len(names), 4), fontsize=8, title=sweep.label(sweep.drawn[1]))
    return style.save_for_paper(drawn, path)


def levels(table: Rows, column: str) -> list:
    """In the order in which they come; one level where nothing is varied."""
    return list(dict.fromkeys(row[column] for row in table)) if column else [""]


def word(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _draw_panel(axes, sweep: Sweep, table: Rows, measure: str, x: str, lines: str, line_levels: list) -> None:
    steps = levels(table, x)
    is_number = bool(x) and sweep.is_number(sweep.drawn[0])
    place_of = {step: step if is_number else number for number, step in enumerate(steps)}
    if is_number:
        steps = sorted(steps)
    looks = style.told_apart(len(line_levels))
    for level, look in zip(line_levels, looks):
        here = [row for row in table if (not lines or row[lines] == level) and measure in row]
        labels = ["run", *map(sweep.column, sweep.varied)]
        at_step = {step: statistics.independent([row for row in here if not x or row[x] == step], labels) for step in steps}
        found = {step: [float(row[measure]) for row in rows] for step, rows in at_step.items()}
        found = {step: values for step, values in found.items() if values}
        if not found:
            continue
        at = [place_of[step] for step in found]
        means, halves = zip(*(statistics.mean_and_interval(values) for values in found.values()))
        bars = [0.0 if math.isnan(half) else half for half in halves]
        axes.errorbar(at, means, yerr=bars, label=word(level) if lines else None, capsize=2.5, elinewidth=0.9, **look)
        for step, values in found.items():
            axes.plot([place_of[step]] * len(values), values, ".", color=look["color"], markersize=2.5, alpha=0.45)
    if not is_number:
        axes.set_xticks(range(len(steps)), [word(step) for step in steps], fontsize=8)
