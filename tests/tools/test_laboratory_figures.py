"""Figures of experiments, recomputed from their rows by a second script (second_script.py)."""

import csv
from pathlib import Path

import pytest
import second_script

from experiments import linked_touch, scenario1, scenario4, timing_networked
from measuring import columns, teleop_processes


def agree(found: dict, again: dict[str, float]) -> None:
    """Rows have nine digits: of forces of some newtons, changes are known to a tenth of a millionth."""
    assert again
    for key, value in again.items():
        assert found[key] == pytest.approx(value, rel=1e-5, abs=1e-7 if "jnd" not in key else 1e-5), key


@pytest.mark.parametrize(
    "options",
    [{"way": "default", "mass": "1.2", "friction": "0.7"}, {"way": "pose_only", "mass": "1.2"}, {"way": "traditional", "jitter": "3", "loss": "0.1"},
     {"way": "passive_updates", "scene": "static", "moved": "0.005"}],
)  # fmt: skip
def test_linked_touch(options, tmp_path):
    found = linked_touch.run(options | {"seconds": "4", "rows": "1"}, tmp_path)
    again = second_script.linked_touch(tmp_path / "linked_touch.csv")
    if options.get("scene") == "static":  # no body is followed there
        again = {key: value for key, value in again.items() if key in found}
    agree(found, again)
    assert [key for key in found if not columns.meaning(key)] == [], "a sweep's table has them as columns"
    # The others are of the link and of the teleoperator's own state, which the rows have not.
    of_rows = ("force_", "felt_excess_1", "box_", "hand_position_", "model_final", "truth_final", "energy_at_hand", "energy_created", "let_go")
    assert {key for key in found if key.startswith(of_rows)} - set(again) == {"force_error_shifted_mean_N"} | (
        {"box_right_after_letting_go_s"} if options.get("scene") != "static" else set()
    )


def test_scenario1(tmp_path):
    found = scenario1.run({"clock": "stepped", "seconds": "4", "pictures": "0"}, tmp_path)
    for case in ("static", "dynamic"):
        agree({key.removeprefix(f"{case}."): value for key, value in found.items()}, second_script.scenario1(tmp_path / f"{case}.csv", 4.0))


def test_scenario4(tmp_path):
    """Of rows as two processes leave them: what is written is what is counted."""
    settings = scenario4.Settings(seconds=3.0)
    case = scenario4.cases(settings)[3]  # the box, by a model
    runs = teleop_processes.play_all([case], tmp_path)
    found = teleop_processes.figures(runs[case.name])
    agree(found, second_script.scenario4(Path(tmp_path / f"{case.name}.csv")))


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
