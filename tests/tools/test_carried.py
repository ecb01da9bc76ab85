"""Carried or masked: what the recommendation of docs/teleoperation.md rests on, in one scene."""

from experiments import carried
from measuring import rivals, teleop_runs


def test_the_default_is_the_scheme_that_wins(tmp_path):
    found = carried.run({"turns": "10", "scenes": "struck", "pictures": "0"}, tmp_path)

    def figure(scheme: str, key: str) -> float:
        assert found[f"struck.{scheme}.10deg.{key}"] == found[f"{scheme}.10deg.{key}"]
        return found[f"{scheme}.10deg.{key}"]

    for scheme in carried.CARRIED:
        assert figure(scheme, "force_error_over_never_corrected") > figure("stealthy_direction", "force_error_over_never_corrected")
        assert figure(scheme, "felt_excess_100ms_jnd_p99") > figure("stealthy_direction", "felt_excess_100ms_jnd_p99")
    assert figure("stealthy_direction", "force_error_over_never_corrected") < 1.0


def test_each_model_is_turned_to_both_sides_and_told_while_the_hand_presses():
    description = teleop_runs.description("carried")
    for how in description["scenes"].values():
        asked = carried.runs(how, description["wrong"], (0, 20))
        cases = {one.name: carried.case(description, how, one, 100.0) for one in asked}
        assert len(cases) == len(asked) == 3 * len(how["told_at"]) * len(description["wrong"]) * (1 + len(carried.SCHEMES))
        assert all(("event.0" in case) == (case["correction"] != carried.NEVER) for case in cases.values())
        assert {str(case[f"wrong.Box.{how['turned_by']}"]).split(",")[-1] for case in cases.values()} == {"0", "20", "-20"}


def test_both_ways_of_carrying_are_compared_everywhere():
    assert {"carried_translate", "carried_turn"} <= set(rivals.MODELS)
    assert {rivals.MODELS[way]["correction"] for way in ("carried_translate", "carried_turn")} == set(carried.CARRIED)
