"""How much a factor changes a figure: each of its levels against the first one, run by run.

Runs that differ in nothing but that factor are a pair. Pairs in which all figures of both runs are those of another pair
are the same touch again, and count once.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from sweeps import statistics
from sweeps.description import Sweep
from sweeps.table import Rows

Row = dict[str, object]

HEAD = ("factor", "level", "against", "measure", "pairs", "difference", "difference_low", "difference_high", "hedges_g", "hedges_g_low", "hedges_g_high")


@dataclass(frozen=True)
class Effect:
    """Of the second of two samples against the first. Not a number where there are too few pairs, or none differ."""

    pairs: int
    difference: float  # mean, with its 95 % interval by Student's t
    low: float
    high: float
    g: float  # the mean difference over the pooled standard deviation, corrected for few runs (Hedges 1981)
    g_low: float  # 95 % interval, by the noncentral t distribution
    g_high: float


def of_pairs(first: Sequence[float], second: Sequence[float]) -> Effect:
    pairs = np.array(list(zip(first, second)), dtype=float)
    mean, half = statistics.mean_and_interval([float(one) for one in pairs[:, 1] - pairs[:, 0]])
    return Effect(len(pairs), mean, mean - half, mean + half, *_hedges_g(pairs))


def _hedges_g(pairs: np.ndarray) -> tuple[float, float, float]:
    """Of pairs × 2, with its interval.

    t = mean / (s / sqrt n) of the n differences, whose deviation is s, has a noncentral t distribution. Its noncentrality
    times s / sqrt n over the pooled deviation is the effect (Algina and Keselman 2003).
    """
    count = len(pairs)
    pooled = math.sqrt(pairs.var(axis=0, ddof=1).mean()) if count > 1 else 0.0
    if not pooled > 0.0:
        return math.nan, math.nan, math.nan
    differences = pairs[:, 1] - pairs[:, 0]
    few = 1.0 - 3.0 / (4.0 * (2 * count - 2) - 1.0)
    g = few * float(differences.mean()) / pooled
    error = float(differences.std(ddof=1)) / math.sqrt(count)
    if not error > 0.0:  # each pair differs by the same
        return g, g, g
    low, high = statistics.noncentrality(statistics.CONFIDENCE, float(differences.mean()) / error, count - 1)
    return g, low * error / pooled, high * error / pooled


def rows(sweep: Sweep, table: Rows) -> list[tuple]:
    """Under HEAD: for each factor, each of its levels but the first, and each measure."""
    found = []
    for factor in sweep.factors:
        column = sweep.column(factor)
        others = [sweep.column(name) for name in sweep.varied if name != factor]
        levels = list(dict.fromkeys(row[column] for row in table))
        for level in levels[1:]:
            pairs = _independent(_pairs(table, column, (levels[0], level), others), ["run", *map(sweep.column, sweep.varied)])
            for measure in sweep.measures:
                both = [[float(row[measure]) for row in pair] for pair in pairs if all(_is_number(row.get(measure)) for row in pair)]  # type: ignore[arg-type]
                if both:
                    effect = of_pairs(*zip(*both))
                    found.append((column, level, levels[0], measure, effect.pairs, effect.difference, effect.low, effect.high,
                                  effect.g, effect.g_low, effect.g_high))  # fmt: skip
    return found


def _pairs(table: Rows, column: str, levels: tuple[object, object], others: Sequence[str]) -> list[tuple[Row, Row]]:
    """Rows of the two levels that are the same in the others."""
    first, second = ({tuple(row[name] for name in others): row for row in table if row[column] == level} for level in levels)
    return [(first[key], second[key]) for key in first if key in second]


def _independent(pairs: Iterable[tuple[Row, Row]], labels: Sequence[str]) -> list[tuple[Row, Row]]:
    """Those that differ in more than their labels from each one before."""
    found: dict[tuple, tuple[Row, Row]] = {}
    for pair in pairs:
        found.setdefault(tuple(statistics.figures(row, labels) for row in pair), pair)
    return list(found.values())


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and math.isfinite(value)
