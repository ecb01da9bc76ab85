"""How evenly the loop ticks: the cumulative distribution of its periods beside that of a bare sleeping loop."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from plots import style

DUE = 1000.0  # (unit: microseconds)
LOOPS = {"loop": ("haptic loop in Godot", style.MEASURED, "-"), "baseline": ("bare loop beside it", style.REFERENCE, "--")}
# Both sides of a link, with a bare loop beside each.
SIDES = {
    "operator": ("operator", style.MEASURED, "-"), "operator_baseline": ("bare loop beside it", style.MEASURED, ":"),
    "teleoperator": ("teleoperator", style.WARNING, "-"), "teleoperator_baseline": ("bare loop beside it", style.WARNING, ":"),
}  # fmt: skip
Lines = dict[str, tuple[str, str, str]]  # label, color and dash by the loop's name


@dataclass(frozen=True)
class Bound:
    """Nine of ten periods of the thesis's loop were shorter, and what is drawn about it (unit: microseconds)."""

    period: float
    near: tuple[float, float]


ALONE, NETWORKED = Bound(1050.0, (900.0, 1100.0)), Bound(1150.0, (850.0, 1250.0))


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


def of(periods: np.ndarray) -> Distribution:
    """Of periods as they were measured (unit: microseconds)."""
    period, counts = np.unique(periods, return_counts=True)
    return Distribution(period, np.cumsum(counts) / len(periods))


def draw(cases: dict[str, dict[str, Distribution]], path: Path, lines: Lines = LOOPS, bound: Bound = ALONE) -> None:
    """By the title of its column."""
    drawn, axes = style.figure(2, len(cases), 5.2 * len(cases), 7.2)
    for column, (title, loops) in enumerate(cases.items()):
        _draw_cumulative(axes[0, column], title, loops, lines, bound)
        _draw_tail(axes[1, column], loops, lines)
    style.save(drawn, path)


def _draw_cumulative(axes, title: str, loops: dict[str, Distribution], lines: Lines, bound: Bound) -> None:
    for loop, (label, colour, line) in lines.items():
        distribution = loops[loop]
        period = np.concatenate([[bound.near[0]], distribution.period, [bound.near[1]]])
        share = np.concatenate([[0.0], distribution.share, [1.0]])
        axes.step(period, share * 100.0, where="post", label=label, color=colour, linestyle=line)
    axes.plot([bound.period, bound.period, bound.near[1]], [0.0, 90.0, 90.0], color=style.QUIET, linewidth=1.0)
    axes.annotate(
        f"thesis: 90 %\nbelow {bound.period / 1e3:.2f} ms", (bound.period, 90.0), xytext=(5, -5), textcoords="offset points",
        fontsize=8, color=style.QUIET, va="top",
    )  # fmt: skip
    axes.set(title=title, xlim=bound.near, ylim=(0, 102), xlabel="period (µs)", ylabel="periods not longer (%)")
    axes.legend(loc="center left", fontsize=9)


def _draw_tail(axes, loops: dict[str, Distribution], lines: Lines) -> None:
    for loop, (label, colour, line) in lines.items():
        deviation, share = tail(loops[loop])
        axes.step(np.maximum(deviation, 0.1), share, where="post", label=label, color=colour, linestyle=line)
    axes.set(
        title="How far from 1 ms, and how often", xscale="log", yscale="log", xlim=(1, None), ylim=(None, 1.3),
        xlabel="period off by more than (µs)", ylabel="share of periods",
    )  # fmt: skip
