"""How many runs end alike on both sides, for each C'."""

from pathlib import Path

import numpy as np

from plots import style

LABELS = {
    "spring": "spring", "position": "1: position", "position_force": "2: position\nand force",
    "position_force_relative": "3: position, force,\nrelative position",
}  # fmt: skip


def draw(summary: dict[str, object], schemes: tuple[str, ...], title: str, path: Path) -> None:
    drawn, ((alike, apart),) = style.figure(1, 2, 10.0, 4.2)
    places = np.arange(len(schemes))
    for offset, variant, colour, label in (
        (-0.2, "_alone", style.QUIET, "never corrected"),
        (0.2, "", style.MEASURED, "corrected"),
    ):
        shares = [100.0 * float(summary[f"{scheme}{variant}.ends_alike_share"]) for scheme in schemes]
        bars = alike.bar(places + offset, shares, 0.38, color=colour, label=label)
        alike.bar_label(bars, [f"{share:.1f}" for share in shares], fontsize=8)
        errors = [float(summary[f"{scheme}{variant}.apart_median_mm"]) for scheme in schemes]
        apart.bar(places + offset, np.maximum(errors, 1e-4), 0.38, color=colour)
    alike.axhline(95.0, color=style.INK, linewidth=0.8, linestyle=":")
    alike.set(ylabel="runs that end alike (%)", ylim=(0, 110))
    alike.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, borderaxespad=0.2, fontsize=8)
    apart.set(ylabel="boxes apart at the end, median (mm)", yscale="log")
    for axes in (alike, apart):
        axes.set_xticks(places, [LABELS[scheme] for scheme in schemes], fontsize=8)
    drawn.suptitle(title, fontsize=11)
    style.save(drawn, path)
