"""Packets a second, and what saving them costs."""

from pathlib import Path

import numpy as np

from plots import style


def draw(summary: dict[str, object], ways: tuple[str, ...], bands: tuple[str, ...], path: Path) -> None:
    drawn, ((packets, cost),) = style.figure(1, 2, 10.0, 4.0)
    cases = [f"{way}.{band}" for way in ways for band in bands]
    places = np.arange(len(cases))
    for offset, key, colour in ((-0.2, "forth", style.MEASURED), (0.2, "back", style.REFERENCE)):
        values = [float(summary[f"{case}.packets_{key}_per_s"]) for case in cases]
        bars = packets.bar(places + offset, values, 0.38, color=colour, label=f"{key}")
        packets.bar_label(bars, [f"{value:.0f}" for value in values], fontsize=7)
    packets.set(ylabel="packets (1/s)", yscale="log", ylim=(10, 4000))
    packets.legend(fontsize=8)
    cost.bar(places, [100.0 * float(summary[f"{case}.noticeable_share_of_touch"]) for case in cases], 0.5, color=style.MEASURED)
    cost.set(ylabel="touching ticks whose force is noticeably another (%)", ylim=(0, None))
    for axes in (packets, cost):
        axes.set_xticks(places, [case.replace(".", "\n") for case in cases], fontsize=8)
    style.save(drawn, path)
