"""The thesis's static experiment, in a scene that its path goes through."""

import re

import pytest

from experiments import scenario4, static_mmt
from measuring import teleop_processes, teleop_runs
from measuring.teleop_scene import Scene
from project import FOLDER

SETTINGS = static_mmt.Settings(turns=2)


def thesis_path() -> static_mmt.Place:
    return next(place for place in static_mmt.places(teleop_runs.description("static_mmt"), SETTINGS) if place.name == "thesis_path")


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> dict:
    place, folder = thesis_path(), tmp_path_factory.mktemp("static")
    chosen = ("mmt_right_0ms", "mmt_right_5000ms", "mmt_wrong_0ms", "mmt_wrong_5000ms", "traditional_100ms", "mmt_wrong_corrected_100ms")
    cases = [case for case in static_mmt.cases(place, SETTINGS, folder) if case["name"] in chosen]
    runs = teleop_runs.run(place.scene, cases, folder, lines=Scene(place.scene).along(place.path))
    return runs | {"growth": static_mmt.growth(runs, place, folder)}


def test_the_hand_touches_the_sphere_and_the_ground(found):
    assert found["mmt_right_0ms"]["Sphere_contact_share"] >= 0.10
    assert found["mmt_right_0ms"]["Ground_contact_share"] >= 0.20


def test_a_right_model_has_no_error_at_five_seconds_of_delay(found):
    assert found["mmt_right_0ms"]["force_error_max_N"] == found["mmt_right_5000ms"]["force_error_max_N"] == 0.0
    assert found["traditional_100ms"]["force_error_mean_N"] > 0.5


def test_a_wrong_model_is_as_wrong_at_any_delay_and_in_any_turn(found):
    """Inferences 4 and 7."""
    wrong = found["mmt_wrong_0ms"]["force_error_mean_N"]
    assert wrong > 0.5
    assert found["mmt_wrong_5000ms"]["force_error_mean_N"] == wrong
    assert found["growth"]["mmt_wrong_5000ms.force_error_last_turn_over_first"] == pytest.approx(1.0, abs=1e-6)


def test_a_wrong_model_is_right_soon_after_the_first_contact(found):
    assert 0.0 < found["mmt_wrong_corrected_100ms"]["seconds_until_right"] < 2.0
    assert found["growth"]["mmt_wrong_corrected_100ms.force_error_last_turn_over_first"] < 1e-9  # what rounding leaves


def test_the_sphere_of_the_wrong_model_is_met_earlier():
    """The hand goes about the circle against the clock, seen from -y: from +x to +z."""
    place = thesis_path()
    x, _, z = Scene(place.scene).place("Sphere")
    right, _, back = place.wrong["Sphere"]["move"]
    assert (z * right - x * back) > 0.0, "against the hand's direction (-z, x)"


def test_two_processes_play_the_same_place_and_path():
    place = thesis_path()
    scene = (FOLDER / place.scene.removeprefix("res://")).read_text()
    assert re.search(r'type="HapticPath" path="([^"]*)"', scene)[1] == place.path
    cases = teleop_processes.static_cases(place, static_mmt.DELAYS)
    assert {case.scene for case in cases} == {place.scene}
    assert {round(1e3 * case.delay) for case in cases} == set(static_mmt.DELAYS)
    assert {case.wrong is not None for case in cases if "wrong" in case.name} == {True}
    assert scenario4.cases(scenario4.Settings())[0].scene == place.scene
