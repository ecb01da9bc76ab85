"""Means over repeats, and how sure they are."""

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import cache

CONFIDENCE = 0.95
NODES = 400


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


def noncentrality(share: float, t: float, freedom: int) -> tuple[float, float]:
    """The interval of the noncentralities under which `t` is not among the rarest 1 - `share` of values, by bisection."""
    return tuple(_noncentrality_with(t, freedom, below) for below in (0.5 + 0.5 * share, 0.5 - 0.5 * share))  # type: ignore[return-value]


def _noncentrality_with(t: float, freedom: int, share: float) -> float:
    """With which `share` of the distribution is below t: the more the noncentrality, the less."""
    step = 1.0
    while _below(t, freedom, t - step) < share or _below(t, freedom, t + step) > share:
        step *= 2.0
    low, high = t - step, t + step
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _below(t, freedom, middle) > share else (low, middle)
    return 0.5 * (low + high)


def _below(t: float, freedom: int, noncentrality: float) -> float:
    """P(Z + noncentrality < t S) for a normal Z, and S = sqrt(chi² / ν), over whose distribution the sum goes."""
    nodes, weights = _deviations(freedom)
    return math.fsum(weight * 0.5 * math.erfc((noncentrality - t * node) / math.sqrt(2.0)) for node, weight in zip(nodes, weights))


@cache
def _deviations(freedom: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """S and its share, in NODES steps as far as it counts: its density is s^(ν - 1) exp(-ν s² / 2) over a constant."""
    reach = 1.0 + 8.0 / math.sqrt(2.0 * freedom)
    nodes = tuple(reach * (i + 0.5) / NODES for i in range(NODES))
    heights = [math.exp((freedom - 1) * math.log(s) - 0.5 * freedom * (s * s - 1.0)) for s in nodes]
    total = math.fsum(heights)
    return nodes, tuple(height / total for height in heights)
