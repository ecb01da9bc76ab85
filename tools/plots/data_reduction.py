"""Packets a second, and what saving them costs."""

from pathlib import Path

import numpy as np

from measuring.rivals import LABELS
from plots import style

COLOURS = {"none": style.QUIET, "fixed": style.REFERENCE, "weber": style.MEASURED}


def draw(summary: dict[str, object], ways: tuple[str, ...], bands: tuple[str, ...], path: Path) -> None:
    drawn, axes = style.figure(1, 3, 13.0, 6.2, sharey=True)
    panels = (
        ("packets_forth_per_s", "packets there (1/s)", 1.0, True, ".0f"),
        ("packets_back_per_s", "packets back (1/s)", 1.0, True, ".0f"),
        ("noticeable_share_of_touch", "touching ticks whose force\nis noticeably another (%)", 100.0, False, ".1f"),
    )
    places = np.arange(len(ways))
    for (key, title, factor, logarithmic, form), one in zip(panels, axes[0]):
        for number, band in enumerate(bands):
            values = [factor * float(summary[f"{way}.{band}.{key}"]) for way in ways]
            if band == "none" and not logarithmic:
                continue
            at = places + 0.27 * (number - 1)
            bars = one.barh(at, values, 0.25, color=COLOURS[band], label="everything said" if band == "none" else band)
            one.bar_label(bars, [format(value, form) for value in values], fontsize=7, padding=2)
        one.set_title(title, fontsize=9.5)
        if logarithmic:
            one.set(xscale="log", xlim=(10, 6000))
        one.set_yticks(places, [LABELS["default" if way == "mmt" else way] for way in ways], fontsize=9)
    axes[0][2].margins(x=0.15)
    axes[0][0].invert_yaxis()
    drawn.legend(*axes[0][0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=9)
    style.save(drawn, path)
