"""What the figures of an experiment are held against."""

from dataclasses import dataclass

Summary = dict[str, float | int | bool | str]


@dataclass(frozen=True)
class Verdict:
    case: str
    what: str
    found: str
    wanted: str
    met: bool


def scenario1(summary: Summary, case: str) -> list[Verdict]:
    """Of one case that ran in real time."""

    def value(name: str) -> float:
        return float(summary[f"{case}.{name}"])

    mean, p90, work = value("mean_period_us"), value("tick_period_p90_us"), value("tick_compute_p99_us")
    p99, bare = value("tick_period_p99_us"), value("baseline_period_p99_us")
    return [
        Verdict(case, "Mean period", f"{mean:.3f} µs", "1000 µs ± 0.1 %", abs(mean - 1000.0) <= 1.0),
        Verdict(case, "Nine of ten periods", f"{p90:.1f} µs", "at most 1050 µs (thesis)", p90 <= 1050.0),
        Verdict(case, "Work of a tick, p99", f"{work:.1f} µs", "at most 50 µs", work <= 50.0),
        Verdict(
            case, "Period, p99", f"{p99:.1f} µs", f"at most 1.2 × the bare loop's {bare:.1f} µs", p99 <= 1.2 * bare
        ),
    ]


# Both sides of both kinds of teleoperation (thesis 5.2, figure 5.3; unit: microseconds).
NETWORKED_P90_US = 1150.0


def timing_networked(summary: Summary) -> list[Verdict]:
    """A verdict for each side of each scenario, by ticks as they really ran."""
    ending = ".period_p90_us"
    found = {key.removesuffix(ending): float(value) for key, value in summary.items() if key.endswith(ending)}
    return [
        Verdict(case.replace(".", ", "), "Nine of ten periods", f"{p90:.1f} µs", "at most 1150 µs (thesis)", p90 <= NETWORKED_P90_US)
        for case, p90 in found.items()
    ]
