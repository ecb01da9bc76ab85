"""Scenario 3: the operator's hand moves a robot in a real place, and feels what the robot runs into (thesis 4.4.1).

    ./run experiment scenario3 [--seconds=10] [--delay=0,25,50,100,200] [--robot=mujoco|franka] [--seeds=5]

The robot is emulated (extension/devices/emulated_robot.hpp): a delta arm with a Falcon's geometry, encoders and motors,
friction and backlash, in a world of its own. The operator's arm means to follow a path through a ground and is pushed back.
--robot=mujoco: the same operator, a Godot process, leads an arm with seven joints in a place that MuJoCo simulates
(measuring/mujoco_place.py, measuring/mujoco_arm.py), over UDP and in virtual time.
--robot=franka: the same, but the arm is led by its vendor's library over the arm's own network protocol, which a simulator plays
(measuring/franka_place.py, measuring/franka_simulator.py).

--delay     there and back (ms)
--seeds     of the emulated robot: so many controllers take its mass and friction for up to 30 % more or less than they are

traditional_robot.DELAYms.*                   round trip of so much, forces as they come
traditional_robot_CONTROLLER.DELAYms.*        with a passivity controller at both ends
traditional_robot_mistaken.DELAYms.*_median, *_p95, traditional_robot_mistaken_CONTROLLER.…   over the seeds; above, all is known
mujoco_robot.DELAYms.*, mujoco_robot_CONTROLLER.DELAYms.*   the same in MuJoCo
franka_robot.DELAYms.*, franka_robot_CONTROLLER.DELAYms.*   the same over the arm's protocol

position_error_rms_mm   of the robot's tip from the operator's hand that it answers
force_error_mean_N      of what the hand feels from what it would feel there itself
energy_J                that the hand was given beyond what it had put in

With these two besides, where direct contact is the same robot without a link:

energy_at_hand_J, energy_at_robot_J   what the ports were given on balance
link_energy_created_J   the most that both ports were given together
contact_share, contacts               of the ticks in contact, and how often contact began; direct_*: of direct contact
"""

import random
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from measuring import options, rivals, robot_runs, teleop_processes, teleop_runs
from measuring.teleop_scene import Scene

FIGURES = {
    "position_error_rms_mm": "hand_position_error_rms_mm",
    "force_error_mean_N": "force_error_mean_N",
    "energy_J": "energy_created_J",
}


@dataclass(frozen=True)
class Settings:
    seconds: float = options.seconds(10.0)
    delay: tuple[float, ...] = options.numbers((0, 25, 50, 100, 200), "ms", most=options.LONGEST_DELAY_MS)
    seeds: int = options.option(5, "count", 0, 1000)
    robot: Literal["emulated", "mujoco", "franka"] = "emulated"


def cases(description: dict, settings: Settings) -> list[teleop_runs.Case]:
    ways = {"": {}, "_time_domain": rivals.SCHEMES["traditional_time_domain"]}
    controllers = {"": {}} | {f"_mistaken_{seed}": mistaken(seed) for seed in range(1, settings.seeds + 1)}
    return [
        {
            "name": f"traditional_robot{controller}{way}.{delay:g}ms", "robot": 1, "arm": 1, "delay_ms": delay, "seconds": settings.seconds,
            **description["arm"], **keys, **believed,
        }
        for controller, believed in controllers.items()
        for way, keys in ways.items()
        for delay in settings.delay
    ]  # fmt: skip


def mistaken(seed: int) -> teleop_runs.Case:
    """What the robot's controller takes its mass and its friction for, as factors."""
    draw = random.Random(f"scenario3 {seed}")
    return {"robot_mass": round(draw.uniform(0.7, 1.3), 4), "robot_friction": round(draw.uniform(0.7, 1.3), 4)}


def summary_of(found: dict[str, dict[str, float]]) -> dict[str, object]:
    summary: dict[str, object] = {}
    by_seed: dict[str, list[dict[str, float]]] = {}
    for case, one in found.items():
        figures = {name: one[key] for name, key in FIGURES.items()}
        if "_mistaken_" in case:
            by_seed.setdefault(re.sub(r"_mistaken_\d+", "_mistaken", case), []).append(figures)
        else:
            summary |= {f"{case}.{name}": value for name, value in figures.items()}
    for case, seeds in by_seed.items():
        for name in FIGURES:
            values = [figures[name] for figures in seeds]
            summary |= {f"{case}.{name}_median": float(np.median(values)), f"{case}.{name}_p95": float(np.percentile(values, 95))}
    return summary


def simulated_cases(description: dict, settings: Settings) -> list[dict]:
    """Passivity as MMTTuning has it: 0 none, 2 time domain, both sides with its own defaults."""
    arm = {f"device.{name}": value for name, value in description["arm"].items()}
    operator = {"way": description["path"], "device.driver": teleop_processes.SIMULATED_ARM, "device.force_limit": 10, **arm}
    bodies = robot_runs.bodies_of(Scene(description["scene"]))
    return [
        {
            "name": f"{settings.robot}_robot{way}.{delay:g}ms", "passivity": passivity, "delay_ms": delay, "seconds": settings.seconds,
            "bodies": bodies, "operator": operator,
        }
        for way, passivity in (("", 0), ("_time_domain", 2))
        for delay in settings.delay
    ]  # fmt: skip


def simulated(description: dict, settings: Settings) -> dict[str, object]:
    if advice := robot_runs.advice(settings.robot):
        print(advice)
        return {"skipped": advice}
    found = robot_runs.run(settings.robot, simulated_cases(description, settings))
    return {f"{case}.{key}": value for case, one in found.items() for key, value in one.items()}


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("scenario3")
    if settings.robot != "emulated":
        return simulated(description, settings)
    lines = Scene(description["scene"]).along(description["path"])
    found = teleop_runs.run(description["scene"], cases(description, settings), output, lines=lines)
    return summary_of(found)
