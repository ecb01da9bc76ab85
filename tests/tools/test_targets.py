"""The figures of scenario 1 against what is wanted."""

from measuring import targets

GOOD = {
    "static.mean_period_us": 1000.2,
    "static.tick_period_p90_us": 1007.0,
    "static.tick_compute_p99_us": 14.0,
    "static.tick_period_p99_us": 1100.0,
    "static.baseline_period_p99_us": 1000.0,
}


def unmet(**changes: float) -> list[str]:
    summary = GOOD | {f"static.{name}": value for name, value in changes.items()}
    return [verdict.what for verdict in targets.scenario1(summary, "static") if not verdict.met]


def test_good_figures_meet_all():
    assert unmet() == []


def test_a_mean_off_by_more_than_a_thousandth():
    assert unmet(mean_period_us=998.9) == unmet(mean_period_us=1001.1) == ["Mean period"]


def test_one_period_in_ten_longer_than_the_thesis_allows():
    assert unmet(tick_period_p90_us=1050.1) == ["Nine of ten periods"]


def test_too_much_work():
    assert unmet(tick_compute_p99_us=50.1) == ["Work of a tick, p99"]


def test_worse_than_the_machine_itself():
    assert unmet(tick_period_p99_us=1201.0) == ["Period, p99"]


def test_each_side_over_a_network_has_its_verdict():
    sides = {f"{scenario}.{side}.period_p90_us": 1001.0 for scenario in ("scenario2", "scenario4") for side in ("operator", "teleoperator")}
    summary = sides | {"scenario4.operator.tick_period_p90_us": 5000.0, "scenario4.operator.baseline_period_p90_us": 5000.0}
    assert [verdict.met for verdict in targets.timing_networked(summary)] == [True] * 4
    late = targets.timing_networked(summary | {"scenario4.teleoperator.period_p90_us": 1150.1})
    assert [verdict.case for verdict in late if not verdict.met] == ["scenario4, teleoperator"]
