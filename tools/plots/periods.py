"""How evenly the loop ticks: the cumulative distribution of its periods beside that of a bare sleeping loop."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from plots import style

DUE = 1000.0  # (unit: microseconds)
THESIS = (1050.0, 0.9)  # nine of ten periods of the thesis's loop were shorter
NEAR = (900.0, 1100.0)  # (unit: microseconds)
LOOPS = {"loop": ("haptic loop in Godot", style.MEASURED, "-"), "baseline": ("bare loop beside it", style.REFERENCE, "--")}


@dataclass(frozen=True)
class Distribution:
    period: np.ndarray  # rising (unit: microseconds)
    share: np.ndarray  # of all periods, that are not longer: 0 … 1


def read(path: Path) -> dict[str, Distribution]:
    """By the loop's name: "loop", "baseline"."""
    steps: dict[str, list[tuple[float, float]]] = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            steps.setdefault(row["loop"], []).append((float(row["period_us"]), float(row["share"])))
    return {loop: Distribution(*np.array(pairs).T) for loop, pairs in steps.items()}


def tail(distribution: Distribution) -> tuple[np.ndarray, np.ndarray]:
    """Deviations from the due period, rising, and the share of periods that deviate by at least as much."""
    weights = np.diff(distribution.share, prepend=0.0)
    deviation = np.abs(distribution.period - DUE)
    order = np.argsort(deviation)
    return deviation[order], np.cumsum(weights[order][::-1])[::-1]


def draw(cases: dict[str, dict[str, Distribution]], path: Path) -> None:
    drawn, axes = style.figure(2, len(cases), 5.2 * len(cases), 7.2)
    for column, (case, loops) in enumerate(cases.items()):
        _draw_cumulative(axes[0, column], f"{case.capitalize()} scene", loops)
        _draw_tail(axes[1, column], loops)
    style.save(drawn, path)


def _draw_cumulative(axes, title: str, loops: dict[str, Distribution]) -> None:
    for loop, distribution in loops.items():
        label, colour, line = LOOPS[loop]
        period = np.concatenate([[NEAR[0]], distribution.period, [NEAR[1]]])
        share = np.concatenate([[0.0], distribution.share, [1.0]])
        axes.step(period, share * 100.0, where="post", label=label, color=colour, linestyle=line)
    limit, share = THESIS
    axes.plot([limit, limit, NEAR[1]], [0.0, share * 100.0, share * 100.0], color=style.QUIET, linewidth=1.0)
    axes.annotate(
        "thesis: 90 % below 1.05 ms", (limit, share * 100.0), xytext=(3, -12), textcoords="offset points",
        fontsize=8, color=style.QUIET,
    )  # fmt: skip
    axes.set(title=title, xlim=NEAR, ylim=(0, 102), xlabel="period (µs)", ylabel="periods not longer (%)")
    axes.legend(loc="center left")


def _draw_tail(axes, loops: dict[str, Distribution]) -> None:
    for loop, distribution in loops.items():
        label, colour, line = LOOPS[loop]
        deviation, share = tail(distribution)
        axes.step(np.maximum(deviation, 0.1), share, where="post", label=label, color=colour, linestyle=line)
    axes.set(
        title="How far from 1 ms, and how often", xscale="log", yscale="log", xlim=(1, None), ylim=(None, 1.3),
        xlabel="period off by more than (µs)", ylabel="share of periods",
    )  # fmt: skip
