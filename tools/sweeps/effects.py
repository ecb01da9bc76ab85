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

DRAWS = 10_000
HEAD = ("factor", "level", "against", "measure", "pairs", "difference", "difference_low", "difference_high", "hedges_g", "hedges_g_low", "hedges_g_high")


@dataclass(frozen=True)
class Effect:
    """Of the second of two samples against the first. Not a number where there are too few pairs, or none differ."""

    pairs: int
    difference: float  # mean, with its 95 % interval by Student's t
    low: float
    high: float
    g: float  # the mean difference over the pooled standard deviation, corrected for few runs (Hedges 1981)
    g_low: float  # 95 % interval, by bootstrap over pairs
    g_high: float


def of_pairs(first: Sequence[float], second: Sequence[float]) -> Effect:
    pairs = np.array(list(zip(first, second)), dtype=float)
    mean, half = statistics.mean_and_interval([float(one) for one in pairs[:, 1] - pairs[:, 0]])
    draws = np.random.default_rng(1).integers(len(pairs), size=(DRAWS, len(pairs)))
    with np.errstate(invalid="ignore", divide="ignore"):
        g = _hedges_g(pairs[np.newaxis])[0]
        # Draws of one pair alone, again and again, have no deviation.
        drawn = _hedges_g(pairs[draws])
    known = drawn[np.isfinite(drawn)]
    low, high = np.quantile(known, [0.025, 0.975]) if math.isfinite(g) and len(known) > 0 else (math.nan, math.nan)
    return Effect(len(pairs), mean, mean - half, mean + half, float(g), float(low), float(high))


def _hedges_g(pairs: np.ndarray) -> np.ndarray:
    """Of samples × pairs × 2."""
    count = pairs.shape[1]
    if count < 2:
        return np.full(len(pairs), math.nan)
    deviation = np.sqrt(pairs.var(axis=1, ddof=1).mean(axis=1))
    few = 1.0 - 3.0 / (4.0 * (2 * count - 2) - 1.0)
    return few * (pairs[:, :, 1] - pairs[:, :, 0]).mean(axis=1) / np.where(deviation > 0.0, deviation, math.nan)


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
