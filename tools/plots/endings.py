"""How many runs end alike on both sides, for each C' and for every other way."""

from pathlib import Path

import numpy as np

from measuring.rivals import LABELS as WAYS
from plots import style

LABELS = {
    "spring": "spring", "position": "1: position", "position_force": "2: position and force",
    "position_force_relative": "3: position, force, relative position",
    "position_force_free": "2, the force free", "relative_free": "3, the force free",
}  # fmt: skip
ALONE = "_alone"


def label_of(case: str) -> str:
    if case.removesuffix(ALONE) in LABELS:
        return LABELS[case.removesuffix(ALONE)] + (", never corrected" if case.endswith(ALONE) else "")
    return WAYS[case.removeprefix("spring_")]


def colour_of(case: str) -> str:
    if case.removesuffix(ALONE) not in LABELS:
        return style.REFERENCE
    return style.QUIET if case.endswith(ALONE) else style.MEASURED


def number(value: float, form: str) -> str:
    return f"{value:.0f}" if value >= 100.0 else format(value, form)


def draw(summary: dict[str, object], cases: tuple[str, ...], title: str, path: Path) -> None:
    drawn, axes = style.figure(1, 3, 13.0, 0.34 * len(cases) + 1.4, sharey=True)
    places = np.arange(len(cases))
    panels = (
        ("ends_alike_share", "runs that end alike (%)", 100.0, ".1f"),
        ("apart_median_mm", "boxes apart at the end, median (mm)", 1.0, ".2g"),
        ("force_error_mean_N", "force error, mean (N)", 1.0, ".2g"),
    )
    for (key, name, factor, form), one in zip(panels, axes[0]):
        values = [factor * float(summary[f"{case}.{key}"]) for case in cases]
        bars = one.barh(places, values, 0.7, color=[colour_of(case) for case in cases])
        one.bar_label(bars, [number(value, form) for value in values], fontsize=8, padding=6)
        one.set_title(name, fontsize=9.5)
        one.margins(x=0.15)
    axes[0][0].axvline(95.0, color=style.INK, linewidth=0.8, linestyle=":")
    axes[0][0].set_yticks(places, [label_of(case) for case in cases], fontsize=8.5)
    axes[0][0].invert_yaxis()
    drawn.suptitle(f"{title} (blue: corrected, grey: never corrected, orange: the others)", fontsize=11)
    style.save(drawn, path)
