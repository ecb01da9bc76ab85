"""Scenario 5: a camera makes the operator's model, and a robot follows the hand in a place of its own (thesis 4.4.1).

    ./run experiment scenario5 [--seconds=16] [--seeds=20] [--seed=1] [--scenes=static,dynamic]
    ./run experiment scenario5 --robot=mujoco [--seconds=16] [--delay=0,25,50,100,200]

--seconds  of the hand's way, from when the model has all that is there
--seeds    so many runs beside it in which nothing helps (drawn()): the model begins with another surface than the true one, the
           camera stands off by millimeters and tenths of a degree, with a clock that is off, above a table of unknown height, and the
           robot's controller takes its mass and friction for up to 30 % more or less
--seed     of the first of them

Two Godot processes over UDP in real time: the operator; and the far side with an emulated robot, a synthetic camera and the
place that both are in, whose masses and friction are not the library's. A third one touches that place directly, along the
same way. SCENE is `static`, or `dynamic`, where the cube is pushed back and forth:

SCENE.discovered_s                      until the operator has all that is there
SCENE.place_error_median_mm, _p95_mm    of the model from the true place, of all bodies, while the hand is on its way
SCENE.force_error_mean_N                of what the hand feels from what it feels there directly
SCENE.force_explained_N                 what the error of place alone makes of it: stiffness times that error, while either touches
SCENE.force_error_over_pose_explained   the one over the other
SCENE.robot_touches_share               of the time in which the hand touches, in which the robot does, too
SCENE.frame_ms_median                   of the camera's images, from arrival to objects
SCENE.stiffness_over_true_first, _last  what is displayed of the true stiffness, in the first and in the last quarter of the touches

SCENE.FIGURE_median, SCENE.FIGURE_p95   with --seeds: over the runs in which nothing helps; SCENE.seed_N.FIGURE is one of them
SCENE.not_discovered_seeds              runs in which the model never had all that is there
unknown.seed_N.PROPERTY                 what was drawn

--robot=mujoco  the same scenario in a place that MuJoCo simulates, with an arm of seven joints, in virtual time: its depth images
           come through OpenNI2's driver and make the local model (measuring/mujoco_seen_place.py). The operator's arm presses a cube and a
           table. mujoco_model.DELAYms.*; beside it direct teleoperation in that place (scenario 3), mujoco_direct.DELAYms.* and, with
           passivity control at both ends, mujoco_direct_time_domain.DELAYms.*. Figures as of scenario3 --robot=mujoco, and
           model_place_error_median_mm, _p95_mm of the cube.
"""

import json
import math
import os
import random
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from measuring import options, robot_runs, teleop_processes, teleop_runs
from project import FOLDER
from setup import godot

PATIENCE = 60.0  # until the model has all that is there (unit: seconds)
FELT = 0.05  # (unit: newtons)
STIFFNESS = 220.0  # of all surfaces there (unit: newtons per meter): depth_camera.tscn
BODIES = ("cube", "bracket")
_PORT = 32000 + os.getpid() % 6000 * 2

Lines = list[dict]

MOVES = {"static": 0, "dynamic": 1}  # scenes: whether the cube is pushed


class NotDiscovered(RuntimeError):
    pass


@dataclass(frozen=True)
class Settings:
    seconds: float = options.seconds(16.0, least=1.0, most=3600)
    robot: Literal["emulated", "mujoco"] = "emulated"
    delay: tuple[float, ...] = options.numbers((0, 25, 50, 100, 200), "ms", most=options.LONGEST_DELAY_MS)
    seeds: int = options.option(0, "count", 0, 10_000)
    seed: int = options.seed()
    scenes: tuple[str, ...] = options.names(None, lambda: MOVES)


def drawn(seed: int) -> dict[str, object]:
    """What the far side does not know of itself in the run with this seed, as camera_side.gd takes it."""
    draw = random.Random(f"scenario5 {seed}")
    place, turn = ([round(draw.gauss(0.0, size), 6) for _ in range(3)] for size in (2e-3, math.radians(0.3)))
    friction = round(draw.uniform(0.1, 0.6), 3)
    return {
        "surface.stiffness": round(STIFFNESS * 2.0 ** draw.uniform(-1, 1), 1),
        "surface.dynamic_friction": friction, "surface.static_friction": round(friction * 1.2, 3),
        "sensor.synthetic_place_error": place, "sensor.synthetic_rotation_error": turn,
        "sensor.synthetic_clock_error": round(draw.uniform(-0.02, 0.02), 4), "sensor.knows_support": False, "sensor.synthetic_seed": seed,
        "robot.robot_mass_error": round(draw.uniform(-0.3, 0.3), 3), "robot.robot_friction_error": round(draw.uniform(-0.3, 0.3), 3),
    }  # fmt: skip


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    if settings.robot == "mujoco":
        return in_mujoco(settings)
    output.mkdir(parents=True, exist_ok=True)
    summary: dict[str, object] = {}
    for name in settings.scenes:
        said = play(settings, MOVES[name], {}, output)
        (output / f"{name}.json").write_text(json.dumps(said))
        draw(said, settings.seconds, name, output)
        summary |= {f"{name}.{key}": value for key, value in figures(said, settings.seconds).items()}
    unknown = {number: drawn(number) for number in range(settings.seed, settings.seed + settings.seeds)}
    summary |= {f"unknown.seed_{number}.{key}": str(value) for number, one in unknown.items() for key, value in one.items()}
    for name in settings.scenes if unknown else ():
        summary |= {f"{name}.{key}": value for key, value in _without_help(settings, MOVES[name], unknown, output).items()}
    return summary


# The place in MuJoCo: a cube on a table, whose mass and friction are not the library's.
TABLE = {"kind": "box", "size": [0.5, 0.01, 0.4], "at": [0.0, -0.01, 0.0], "friction": 0.3}
CUBE = {"kind": "box", "name": "cube", "size": [0.05] * 3, "at": [-0.1, 0.05, 0.0], "turn": 0.4, "mass": 0.8, "friction": 0.3}
WAY = "res://paths/seen_path.tres"


def mujoco_cases(settings: Settings) -> dict[str, list[dict]]:
    """By the kind of the robot. Passivity as MMTTuning has it: 0 none, 2 time domain."""
    arm = {f"device.{name}": value for name, value in teleop_runs.description("scenario3")["arm"].items()}
    operator = {"way": WAY, "device.driver": teleop_processes.SIMULATED_ARM, "device.force_limit": 10, **arm}
    common = {"seconds": settings.seconds, "bodies": [TABLE, CUBE | {"on": TABLE["size"]}], "operator": operator}
    ways = {"mujoco_direct": ("mujoco", 3, 0), "mujoco_direct_time_domain": ("mujoco", 3, 2), "mujoco_model": ("mujoco_seen", 5, 0)}
    found: dict[str, list[dict]] = {}
    for way, (kind, scenario, passivity) in ways.items():
        found.setdefault(kind, []).extend(
            {"name": f"{way}.{delay:g}ms", "scenario": scenario, "passivity": passivity, "delay_ms": delay, **common} for delay in settings.delay
        )
    return found


def in_mujoco(settings: Settings) -> dict[str, object]:
    if advice := robot_runs.advice("mujoco"):
        print(advice)
        return {"skipped": advice}
    summary: dict[str, object] = {}
    for kind, cases in mujoco_cases(settings).items():
        for case, one in robot_runs.run(kind, cases).items():
            summary |= {f"{case}.{key}": value for key, value in one.items()}
    return summary


def _without_help(settings: Settings, moves: int, unknown: dict[int, dict[str, object]], output: Path) -> dict[str, object]:
    found: dict[int, dict[str, float]] = {}
    for number, one in unknown.items():
        try:
            found[number] = figures(play(settings, moves, one, output), settings.seconds)
            print(f"  seed {number}: force error {found[number]['force_error_mean_N']:.3f} N", flush=True)
        except NotDiscovered as error:
            print(f"  seed {number}: {error}", flush=True)
    summary: dict[str, object] = {f"seed_{number}.{key}": value for number, one in found.items() for key, value in one.items()}
    summary["not_discovered_seeds"] = len(unknown) - len(found)
    for key in next(iter(found.values()), {}):
        values = [one[key] for one in found.values()]
        summary |= {f"{key}_median": float(np.median(values)), f"{key}_p95": float(np.percentile(values, 95))}
    return summary


def play(settings: Settings, moves: int, unknown: dict[str, object], output: Path) -> dict[str, Lines]:
    files = {part: output / f"{part}.jsonl" for part in ("far", "operator", "direct")}
    words = {key: json.dumps(value) for key, value in unknown.items()}
    processes = [
        _start("far", files["far"], moves=moves, local_port=_PORT, remote_port=_PORT + 1, **words),
        _start("operator", files["operator"], local_port=_PORT + 1, remote_port=_PORT),
        _start("direct", files["direct"], moves=moves),
    ]
    try:
        for part in ("operator", "direct"):
            _wait(files[part], settings.seconds)
    finally:
        for process in processes:
            process.kill()
            process.wait()
    said = {part: _lines(file) for part, file in files.items()}
    for file in files.values():
        file.unlink()
    return said


def _start(part: str, file: Path, **settings: object) -> subprocess.Popen:
    words = [f"--{name}={value}" for name, value in {"part": part, **settings}.items()]
    script = ["--script", "res://experiments/camera_side.gd"]
    command = [str(godot.command()), "--headless", "--path", str(FOLDER), *script, "--", *words]
    with file.open("w") as stdout:
        return subprocess.Popen(command, stdout=stdout, stderr=subprocess.DEVNULL)


def _lines(file: Path) -> Lines:
    """What has been said so far; the last line may not be whole yet."""
    return [json.loads(line) for line in file.read_text().split("\n")[:-1] if line.startswith("{")]


def _wait(file: Path, seconds: float) -> None:
    """Until the hand has gone its way."""
    began = time.monotonic()
    while True:
        time.sleep(0.5)
        newest = (_lines(file) or [{"since": -1.0}])[-1]
        if newest["since"] > seconds:
            return
        if newest["since"] < 0 and time.monotonic() - began > PATIENCE:
            raise NotDiscovered(f"the operator has not got all that is there: {newest.get('text', 'nothing was said')}")
        if time.monotonic() - began > PATIENCE + 3 * seconds:
            raise RuntimeError(f"{file.name} has stopped at {newest['since']} s")


def _felt(said: dict[str, Lines], seconds: float) -> tuple[Lines, np.ndarray, np.ndarray, np.ndarray]:
    """What the operator said on the way, and the forces then: on its hand, on one that touches directly, on the robot."""
    here = [line for line in said["operator"] if 0.0 <= line["since"] <= seconds]
    since = np.array([line["since"] for line in here])
    time = np.array([line["time"] for line in here])
    felt = np.array([line["force"] for line in here])
    aside = _apart_in_time(here, since, said["direct"])
    directly = _between(said["direct"], "since", since + aside, lambda line: line["force"])
    there = _between(said["far"], "time", time, lambda line: line["tip_force"])
    return here, felt, directly, there


def draw(said: dict[str, Lines], seconds: float, name: str, output: Path) -> None:
    from plots import seen

    here, felt, directly, there = _felt(said, seconds)
    since = np.array([line["since"] for line in here])
    forces = {"direct touch": directly, "on the hand": felt, "on the robot": there}
    seen.draw_forces(since, forces, f"Scenario 5, {name} scene", output / f"{name}_forces.png")
    if looks := [line["seen"] for line in said["far"] if "seen" in line]:
        seen.draw_seen(looks[0], output / f"{name}_seen.png")


def figures(said: dict[str, Lines], seconds: float) -> dict[str, float]:
    here, felt, directly, there = _felt(said, seconds)
    time = np.array([line["time"] for line in here])
    places = np.array([_place_errors(name, here, time, said["far"]) for name in BODIES]).T
    error = np.linalg.norm(felt - directly, axis=1)
    touches = np.linalg.norm(felt, axis=1) > FELT
    either = touches | (np.linalg.norm(directly, axis=1) > FELT)
    explained = float(np.mean(np.where(either, STIFFNESS * places.max(axis=1), 0.0)))
    return {
        "discovered_s": here[0]["time"] - said["operator"][0]["time"],
        "place_error_median_mm": 1e3 * float(np.median(places)),
        "place_error_p95_mm": 1e3 * float(np.percentile(places, 95)),
        "force_error_mean_N": float(np.mean(error)),
        "force_explained_N": explained,
        "force_error_over_pose_explained": float(np.mean(error)) / explained if explained > 0.0 else float("inf"),
        "robot_touches_share": float(np.mean(np.linalg.norm(there, axis=1)[touches] > FELT)) if touches.any() else 0.0,
        **_displayed_stiffness(here, felt),
        "frame_ms_median": float(np.median([line["frame_ms"] for line in said["far"] if line["frame_ms"] > 0.0])),
    }


def _displayed_stiffness(here: Lines, felt: np.ndarray) -> dict[str, float]:
    """Of the true one, which all surfaces there have: the force over the depth of the device position below its proxy."""
    size = np.linalg.norm(felt, axis=1)
    depth = np.array([line["depth"] for line in here])
    presses = size > 5 * FELT
    ratio = size[presses] / np.maximum(depth[presses], 1e-6) / STIFFNESS
    quarter = max(1, len(ratio) // 4)
    if not len(ratio):
        return {}
    return {
        "stiffness_over_true_first": float(np.median(ratio[:quarter])), "stiffness_over_true_last": float(np.median(ratio[-quarter:])),
    }  # fmt: skip


def _apart_in_time(here: Lines, since: np.ndarray, direct: Lines) -> float:
    """Both hands go the same way; each has set out within some frames of when its program says so."""
    hand = np.array([line["hand"] for line in here])
    tried = np.arange(-0.1, 0.1, 0.001)
    off = [np.mean(np.abs(_between(direct, "since", since + aside, lambda line: line["hand"]) - hand)) for aside in tried]
    return float(tried[np.argmin(off)])


def _between(lines: Lines, clock: str, when: np.ndarray, values: Callable[[dict], list[float]]) -> np.ndarray:
    """What was said just before and just after each of these times, in between."""
    at = np.array([line[clock] for line in lines])
    said = np.array([values(line) for line in lines])
    return np.array([np.interp(when, at, column) for column in said.T]).T


def _place_errors(name: str, here: Lines, time: np.ndarray, far: Lines) -> np.ndarray:
    modelled = np.array([line["bodies"][name][:3] for line in here])
    return np.linalg.norm(modelled - _between(far, "time", time, lambda line: line["bodies"][name][:3]), axis=1)
