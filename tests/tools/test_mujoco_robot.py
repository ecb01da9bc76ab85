"""Scenario 3 with a robot in a place that MuJoCo simulates (./run experiment scenario3 --robot=mujoco)."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from experiments import scenario3
from measuring import robot_runs, teleop_runs
from measuring.teleop_scene import Scene
from setup import fetching, python_tools


def test_static_bodies_of_a_scene_are_those_of_the_place():
    ground, sphere = robot_runs.bodies_of(Scene("res://gallery/static_testbed/static_testbed.tscn"))
    assert ground == {"kind": "box", "size": [0.5, 0.05, 0.5], "at": [0.0, -0.05, 0.0], "friction": 0.2}
    assert sphere == {"kind": "sphere", "size": [0.06], "at": [-0.106, 0.03, 0.1575], "friction": 0.2}
    with pytest.raises(ValueError, match="Box: only static bodies"):
        robot_runs.bodies_of(Scene("res://gallery/dynamic_testbed/dynamic_testbed.tscn"))


@pytest.mark.parametrize("robot", ["mujoco", "franka"])
def test_without_the_package_it_is_skipped_with_advice(monkeypatch, capsys, tmp_path, robot):
    def unreachable(_: str) -> None:
        raise fetching.Unreachable("pip cannot reach its server. Connect this machine.")

    monkeypatch.setattr(python_tools, "is_done", lambda _: False)
    monkeypatch.setattr(python_tools, "install", unreachable)
    summary = scenario3.run({"robot": robot}, tmp_path)
    assert list(summary) == ["skipped"]
    assert "skipped: pip cannot reach its server. Connect this machine." in capsys.readouterr().out


needs_mujoco = pytest.mark.skipif(not python_tools.is_done("mujoco"), reason="./run experiment scenario3 --robot=mujoco fetches MuJoCo")


@needs_mujoco
def test_arm_follows_presses_and_feels():
    """By itself, in its own time: wrong masses let it sag, its sensor has the contact's force, its drives have limits."""
    script = Path(__file__).parent / "played_arm.py"
    done = subprocess.run([python_tools.python("mujoco"), script], text=True, capture_output=True, check=True)
    rows = json.loads(done.stdout)
    free, pressed, far = ({key: np.array(value) for key, value in rows[name].items()} for name in ("free", "pressed", "far"))
    assert 1e-4 < np.linalg.norm(free["tip"] - free["wanted"]) < 3e-3
    assert not free["contact"].any() and not free["touching"].any()
    assert pressed["tip"][1] == pytest.approx(0.01, abs=1e-4)
    assert pressed["contact"] == pytest.approx(pressed["touching"], rel=0.02, abs=0.05)
    # K times the way into the ground, but for the friction of the joints and the wrong weight.
    assert pressed["contact"][1] == pytest.approx(10.0, abs=3.0)
    assert max(abs(far["torques"])) == pytest.approx(87.0)
    assert 30.0 < far["contact"][1] < 500.0


@needs_mujoco
def test_operator_feels_what_mujoco_does():
    """The arm's momentum throws the hand off the ground, also without a delay; the controller keeps the link passive and contact."""
    settings = scenario3.Settings(seconds=3.0, delay=(0, 100), robot="mujoco")
    found = robot_runs.run("mujoco", scenario3.simulated_cases(teleop_runs.description("scenario3"), settings))
    names = (".0", ".100", "_time_domain.0", "_time_domain.100")
    at_once, late, controlled_at_once, controlled = (found[f"mujoco_robot{name}ms"] for name in names)
    assert 0.01 < at_once["contact_share"] == pytest.approx(at_once["direct_contact_share"], abs=0.02)
    assert at_once["contact_share"] < 0.5 * controlled_at_once["contact_share"]
    assert controlled_at_once["contact_share"] == pytest.approx(controlled_at_once["direct_contact_share"], abs=0.02)
    assert controlled_at_once["force_error_mean_N"] < 0.7
    assert late["force_error_mean_N"] > 2 * at_once["force_error_mean_N"]
    assert at_once["position_error_rms_mm"] < 5.0 < late["position_error_rms_mm"]
    assert late["energy_J"] > 0.1 > 1e-6 > controlled["energy_J"]
    assert late["link_energy_created_J"] > 0.3 > 0.02 > controlled["link_energy_created_J"]
