"""Means over repeats, and how sure they are."""

import math
from collections.abc import Iterable, Mapping, Sequence

CONFIDENCE = 0.95


def independent(rows: Iterable[Mapping[str, object]], labels: Iterable[str]) -> list[Mapping[str, object]]:
    """Of runs that differ in nothing but their `labels` only the first: the same run again makes nothing surer."""
    left_out = set(labels)
    found: dict[tuple, Mapping[str, object]] = {}
    for row in rows:
        found.setdefault(figures(row, left_out), row)
    return list(found.values())


def figures(row: Mapping[str, object], labels: Iterable[str]) -> tuple[tuple[str, str], ...]:
    """All that is in a row but its labels: the same for the same run."""
    left_out = set(labels)
    return tuple(sorted((key, str(value)) for key, value in row.items() if key not in left_out))


def mean_and_interval(values: Sequence[float]) -> tuple[float, float]:
    """The mean, and the half width of its confidence interval by Student's t; of a single value that is not a number."""
    mean = math.fsum(values) / len(values)
    freedom = len(values) - 1
    if freedom < 1:
        return mean, math.nan
    deviation = math.sqrt(math.fsum((value - mean) ** 2 for value in values) / freedom)
    return mean, student_t(CONFIDENCE, freedom) * deviation / math.sqrt(len(values))


def student_t(share: float, freedom: int) -> float:
    """The t within which `share` of Student's distribution lies, by bisection."""
    low, high = 0.0, 1.0
    while _within(high, freedom) < share:
        high *= 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _within(middle, freedom) < share else (low, middle)
    return 0.5 * (low + high)


def _within(t: float, freedom: int) -> float:
    """The share between -t and t (Abramowitz and Stegun 26.7.3, 26.7.4): a finite series in cos², cos² = ν / (ν + t²)."""
    angle = math.atan(t / math.sqrt(freedom))
    cosine, sine = math.cos(angle), math.sin(angle)
    term = cosine if freedom % 2 else 1.0
    total = term if freedom > 1 else 0.0
    for k in range(2 if freedom % 2 else 1, freedom - 2, 2):
        # Odd ν: factors 2/3, 4/5, …; even ν: 1/2, 3/4, …
        term *= k / (k + 1) * cosine**2
        total += term
    return 2.0 / math.pi * (angle + sine * total) if freedom % 2 else sine * total
