"""Which round of a measurement is reported."""

from pathlib import Path

import pytest

from measuring import rounds
from measuring.scene_run import Case, Run


def played(steal: float, p99: float = 1000.0) -> Run:
    return Run(Case("static", "res://static.tscn"), Path(), {"tick_period_p99_us": p99}, steal)


def measured(steals: list[float], most: int = 3, calm: float = 0.005) -> list[float]:
    return [one.steal_share for one in rounds.measure(most, calm, lambda number: played(steals[number - 1]))]


def test_a_calm_round_is_enough():
    assert measured([0.004, 0.0]) == [0.004]


def test_a_disturbed_round_is_repeated():
    assert measured([0.02, 0.001, 0.0]) == [0.02, 0.001]


def test_there_are_at_most_so_many():
    assert measured([0.02, 0.03, 0.01, 0.0]) == [0.02, 0.03, 0.01]


@pytest.mark.parametrize("steals, number", [([0.1], 1), ([0.1, 0.02, 0.05], 2), ([0.1, 0.05, 0.02], 3)])
def test_the_least_disturbed_round_is_reported(steals, number):
    assert rounds.reported([played(steal) for steal in steals]) == number


def test_a_better_result_does_not_count():
    assert rounds.reported([played(0.02, p99=1001.0), played(0.01, p99=1900.0)]) == 2


def test_of_equals_the_first_is_reported():
    assert rounds.reported([played(0.01), played(0.01)]) == 1
