"""Scenario 3 with a robot that speaks the Franka arm's own protocol (./run experiment scenario3 --robot=franka)."""

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

from experiments import scenario3
from measuring import robot_runs, teleop_runs
from setup import python_tools

ENVIRONMENTS = robot_runs.KINDS["franka"].environments
pytestmark = pytest.mark.skipif(
    not all(map(python_tools.is_done, ENVIRONMENTS)), reason="./run experiment scenario3 --robot=franka fetches libfranka and its simulator"
)


def test_arms_follow_press_and_feel():
    """By themselves, by turns: one is led, the other stays; the sensor has the force of the spring that leads the tip."""
    library, simulator = map(python_tools.python, ENVIRONMENTS)
    hosts = [f"127.251.{os.getpid() % 250}.{arm}" for arm in (1, 2)]
    script = Path(__file__).parent / "played_franka.py"
    done = subprocess.run([library, script, simulator, *hosts], text=True, capture_output=True, check=True)
    found = json.loads(done.stdout)
    led, other = ({name: rows[arm] for name, rows in found.items()} for arm in (0, 1))
    assert np.linalg.norm(np.array(led["start"]["tip"]) - [0.02, 0.03, 0.0]) < 2e-3
    assert np.linalg.norm(np.array(led["free"]["tip"]) - [0.05, 0.03, -0.04]) < 3e-3
    assert not led["free"]["touches"] and np.linalg.norm(led["free"]["contact"]) == 0.0
    assert led["pressed"]["touches"] and led["pressed"]["tip"][1] == pytest.approx(0.01, abs=1e-4)
    # K times the way into the ground, but for the friction of the joints and weights that differ.
    assert led["pressed"]["contact"][1] == pytest.approx(10.0, abs=3.0)
    assert not other["pressed"]["touches"] and np.linalg.norm(np.array(other["pressed"]["tip"]) - other["start"]["tip"]) < 1e-3


def test_operator_feels_what_the_arm_runs_into():
    """With its delay; passivity control keeps both ports together from making more than a store's energy."""
    settings = scenario3.Settings(seconds=2.0, delay=(100,), robot="franka")
    found = robot_runs.run("franka", scenario3.simulated_cases(teleop_runs.description("scenario3"), settings))
    free, controlled = found["franka_robot.100ms"], found["franka_robot_time_domain.100ms"]
    assert free["contact_share"] > 0.01 and controlled["contact_share"] > 0.01
    assert free["force_error_mean_N"] > 0.2
    assert free["position_error_rms_mm"] < 20.0
    assert controlled["link_energy_created_J"] < 0.03
    assert controlled["energy_J"] < 1e-3
