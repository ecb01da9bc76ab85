"""Figures of experiments, recomputed from their rows by a second script (second_script.py)."""

import csv
import json
from pathlib import Path

import experiment
import pytest
import second_script

from experiments import linked_touch, scenario1, scenario4, timing_networked
from measuring import columns


def agree(found: dict, again: dict) -> None:
    """As it is printed, to the last digit, and none is left out."""
    assert set(found) == set(again)
    wrong = {key: (found[key], again[key]) for key in found if experiment.printed(found[key]) != experiment.printed(again[key])}
    assert not wrong


@pytest.mark.parametrize(
    "options",
    [{"way": "default", "mass": "1.2", "friction": "0.7"}, {"way": "pose_only", "mass": "1.2"}, {"way": "traditional", "jitter": "3", "loss": "0.1"},
     {"way": "passive_updates", "scene": "static", "moved": "0.005"}],
)  # fmt: skip
def test_linked_touch(options, tmp_path):
    found = linked_touch.run(options | {"seconds": "4", "rows": "1"}, tmp_path)
    again = second_script.linked_touch(tmp_path / "linked_touch.csv", 4.0, 100.0, options["way"] == "traditional")
    if options.get("scene") == "static":  # no body is followed there
        again = {key: value for key, value in again.items() if not key.startswith(("box_", "model_final", "truth_final"))}
    # The runner prints nine digits.
    agree(found, {key: float(f"{value:.9g}") for key, value in again.items()})
    assert [key for key in found if not columns.meaning(key)] == [], "a sweep's table has them as columns"
    columns.write(tmp_path)
    assert [column for column, meaning in dictionary(tmp_path)["linked_touch.csv"].items() if not meaning] == []


@pytest.mark.parametrize("clock", ["stepped", "real"])
def test_scenario1(clock, tmp_path):
    found = scenario1.run({"clock": clock, "seconds": "4", "warmup": "0.5", "rounds": "1", "pictures": "0"}, tmp_path)
    again = {}
    for case in ("static", "dynamic"):
        of_case = second_script.scenario1(tmp_path / f"{case}.csv", 4.0) | second_script.of_the_loop(tmp_path / "rounds.csv", case, 1)
        of_case |= {"rounds": 1, "round_reported": 1}
        again |= {f"{case}.{key}": value for key, value in of_case.items()}
    if clock == "stepped":
        again = {key: value for key, value in again.items() if not key.endswith((".steal_share", ".rounds", ".round_reported"))}
    agree(figures_of(found), again)


def test_scenario4(tmp_path):
    """Of rows as two processes leave them: what is written is what is counted."""
    found = scenario4.run({"seconds": "2.5", "pictures": "0"}, tmp_path)
    again = {}
    for case in ("static.traditional", "static.mmt", "dynamic.traditional", "dynamic.mmt"):
        of_case = second_script.scenario4(tmp_path / f"{case}.csv") | second_script.of_the_operators_link(tmp_path / "links.csv", case)
        again |= {f"{case}.{key}": value for key, value in of_case.items() if case.startswith("dynamic") or not key.startswith("box_")}
    agree(figures_of(found), again)
    columns.write(tmp_path)
    assert [(table, column) for table, meanings in dictionary(tmp_path).items() for column, meaning in meanings.items() if not meaning] == []


def figures_of(summary: dict) -> dict[str, float]:
    """Without the words that describe the machine."""
    return {key: value for key, value in summary.items() if not key.startswith("machine.") and not isinstance(value, str)}


def dictionary(folder: Path) -> dict[str, dict[str, str]]:
    return json.loads((folder / columns.FILE).read_text())


def test_timing_networked(tmp_path):
    """What is drawn is what is told: each figure again from the table of the distributions."""
    found = timing_networked.run({"seconds": "1", "warmup": "0.5", "rounds": "1"}, tmp_path)
    with (tmp_path / "both_sides_periods.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    for scenario in ("scenario2", "scenario4"):
        for side in ("operator", "teleoperator"):
            of_loop = [row for row in rows if (row["scenario"], row["loop"]) == (scenario, side)]
            p90 = next(float(row["period_us"]) for row in of_loop if float(row["share"]) >= 0.9)
            assert found[f"{scenario}.{side}.period_p90_us"] == pytest.approx(p90, abs=1.0)
            assert [row for row in rows if (row["scenario"], row["loop"]) == (scenario, f"{side}_baseline")]
    assert (tmp_path / "both_sides_periods.png").is_file()
