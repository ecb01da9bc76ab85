"""Scenario 3: the operator's hand moves a robot in a real place, and feels what the robot runs into (thesis 4.4.1).

    ./run experiment scenario3 [--seconds=10]

The robot is emulated (extension/devices/emulated_robot.hpp): a delta arm with a Falcon's geometry, encoders and motors,
friction and backlash, in a world of its own. The operator's arm means to follow a path through a ground and is pushed back.

traditional_robot.DELAYms.*                   round trip of so much, forces as they come
traditional_robot_CONTROLLER.DELAYms.*        with a passivity controller at both ends

position_error_rms_mm   of the robot's tip from the operator's hand that it answers
force_error_mean_N      of what the hand feels from what it would feel there itself
energy_J                that the hand was given beyond what it had put in
"""

from dataclasses import dataclass
from pathlib import Path

from measuring import options, rivals, teleop_runs
from measuring.teleop_scene import Scene

DELAYS = (0, 25, 50, 100, 200)  # there and back (milliseconds)
FIGURES = {
    "position_error_rms_mm": "hand_position_error_rms_mm",
    "force_error_mean_N": "force_error_mean_N",
    "energy_J": "energy_created_J",
}


@dataclass(frozen=True)
class Settings:
    seconds: float = options.seconds(10.0)


def cases(description: dict, settings: Settings) -> list[teleop_runs.Case]:
    ways = {"traditional_robot": {}} | {f"traditional_robot_{way}": rivals.SCHEMES[f"traditional_{way}"] for way in ("time_domain",)}
    return [
        {
            "name": f"{name}.{delay}ms", "robot": 1, "arm": 1, "delay_ms": delay, "seconds": settings.seconds,
            **description["arm"], **keys,
        }
        for name, keys in ways.items()
        for delay in DELAYS
    ]  # fmt: skip


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("scenario3")
    lines = Scene(description["scene"]).along(description["path"])
    found = teleop_runs.run(description["scene"], cases(description, settings), output, lines=lines)
    return {f"{case}.{name}": one[key] for case, one in found.items() for name, key in FIGURES.items()}
