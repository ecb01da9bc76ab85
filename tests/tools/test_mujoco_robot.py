"""Scenario 3 with a robot in a place that MuJoCo simulates (./run experiment scenario3 --robot=mujoco)."""

import pytest

from experiments import scenario3
from measuring import mujoco_runs, teleop_runs
from measuring.teleop_scene import Scene
from setup import fetching, python_tools


def test_static_bodies_of_a_scene_are_those_of_the_place():
    ground, sphere = mujoco_runs.bodies_of(Scene("res://gallery/static_testbed/static_testbed.tscn"))
    assert ground == {"kind": "box", "size": [0.5, 0.05, 0.5], "at": [0.0, -0.05, 0.0], "friction": 0.2}
    assert sphere == {"kind": "sphere", "size": [0.06], "at": [-0.106, 0.03, 0.1575], "friction": 0.2}
    with pytest.raises(ValueError, match="Box: only static bodies"):
        mujoco_runs.bodies_of(Scene("res://gallery/dynamic_testbed/dynamic_testbed.tscn"))


def test_without_the_package_it_is_skipped_with_advice(monkeypatch, capsys, tmp_path):
    def unreachable(_: str) -> None:
        raise fetching.Unreachable("pip cannot reach its server. Connect this machine.")

    monkeypatch.setattr(python_tools, "is_done", lambda _: False)
    monkeypatch.setattr(python_tools, "install", unreachable)
    summary = scenario3.run({"robot": "mujoco"}, tmp_path)
    assert list(summary) == ["skipped"]
    assert "skipped: pip cannot reach its server. Connect this machine." in capsys.readouterr().out


@pytest.mark.skipif(not python_tools.is_done("mujoco"), reason="./run bench credibility fetches MuJoCo")
def test_operator_feels_what_mujoco_does():
    """Without a delay nearly what the robot feels without a link; with one, the controller keeps the link passive."""
    settings = scenario3.Settings(seconds=3.0, robot="mujoco")
    cases = scenario3.mujoco_cases(teleop_runs.description("scenario3"), settings)
    chosen = [case for case in cases if case["delay_ms"] in (0, 100)]
    found = mujoco_runs.run(chosen)
    at_once, late, controlled = (found[f"mujoco_robot{name}ms"] for name in (".0", ".100", "_time_domain.100"))
    assert 0.1 < at_once["contact_share"] == pytest.approx(at_once["direct_contact_share"], abs=0.02)
    assert at_once["force_error_mean_N"] < 0.05
    assert late["force_error_mean_N"] > 10 * at_once["force_error_mean_N"]
    assert at_once["position_error_rms_mm"] < 1.5
    assert late["energy_J"] > 0.1 > 1e-6 > controlled["energy_J"]
