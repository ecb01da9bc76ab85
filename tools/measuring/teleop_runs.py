"""Cases of teleoperation in virtual time: both sides and a hand that touches directly tick in one thread of
tests/bench/teleop.cpp, faster than real time, and the same case gives the same figures to the bit.
"""

import json
import os
import subprocess
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache as once
from pathlib import Path
from threading import Lock

import build
from measuring.options import Refused, option
from measuring.teleop_scene import Scene
from project import FOLDER
from setup import cache
from setup.progress import Progress, bar

Case = dict[str, object]  # its keys are those of tests/bench/teleop.cpp, and "name"

REFUSED = 2  # the exit code of the runner where it does not understand a case
# What keeps traditional touch from making energy (core/teleop/passivity.hpp).
PASSIVITY = ("wave_variables", "time_domain", "two_layers")

SPREAD = ("mean", "p95", "p99", "max")
# What every experiment publishes of every case; core/teleop/errors.hpp says what it is.
FIGURES = (
    *(f"force_error_{how}_N" for how in SPREAD),
    *(f"felt_excess_{window}_{unit}_{how}" for window in ("1ms", "100ms") for unit in ("N", "jnd") for how in SPREAD),
    "energy_at_hand_J", "energy_at_far_side_J", "energy_at_hand_most_J", "energy_created_J", "link_energy_created_J",
    "bits_per_s",
)  # fmt: skip
# And of a body that is followed.
PLACES = (
    *(f"box_position_error_{how}_mm" for how in ("rms", *SPREAD, "final")),
    "box_rotation_error_rms_deg", "box_right_after_letting_go_s",
)  # fmt: skip


@dataclass(frozen=True)
class Imperfections:
    """What else is wrong than the description of the experiment says: options of every experiment with a model."""

    mass: float = option(1.0, "factor", 0.001, 1000)  # of the followed body as the model has it
    friction: float = option(1.0, "factor", 0, 1000)  # of all bodies on each other
    tilt: float = option(0.0, "deg", -180, 180)  # of static bodies about x
    moved: float = option(0.0, "m", -10, 10)  # of all bodies along x
    pose_noise: float = option(0.0, "m", 0, 1)  # of what the far side says of places, standard deviation
    phase: float = option(0.0, "us", 0, 999)  # of the far side's ticks after the operator's, 0 … 999
    late: float = option(0.0, "ms", 0, 10_000)  # start of the far side after the operator's
    jitter: float = option(0.0, "ms", 0, 10_000)  # of the link, each way

    def keys(self, scene: str, followed: str | None = None) -> Case:
        """As keys of a case, for those that are not perfect."""
        return self.model(scene, followed) | self.link()

    def model(self, scene: str, followed: str | None = None) -> Case:
        keys: Case = {}
        bodies = Scene(scene).bodies()
        for body in bodies:
            if self.friction != 1.0:
                keys[f"wrong.{body}.friction"] = self.friction
            if self.moved != 0.0:
                keys[f"wrong.{body}.move"] = f"{self.moved},0,0"
            if self.tilt != 0.0 and body != followed:
                keys[f"wrong.{body}.turn"] = f"1,0,0,{self.tilt}"
        if self.mass != 1.0 and followed:
            keys[f"wrong.{followed}.mass"] = self.mass
        return keys

    def link(self) -> Case:
        keys = {"pose_noise": self.pose_noise, "phase_us": self.phase, "late_ms": self.late, "jitter_ms": self.jitter}
        return {key: value for key, value in keys.items() if value != 0.0}


def description(name: str) -> dict:
    """demo_project/experiments/NAME.json: which scene, which body is followed, what the model gets wrong."""
    return json.loads((FOLDER / "experiments" / f"{name}.json").read_text())


def wrong(given: dict[str, dict[str, object]]) -> Case:
    """{"Box": {"mass": 1.2, "turn": [1, 0, 0, 10]}} as keys of a case."""
    keys: Case = {}
    for body, properties in given.items():
        for what, value in properties.items():
            keys[f"wrong.{body}.{what}"] = ",".join(map(str, value)) if isinstance(value, list) else value
    return keys


def run(scene: str, cases: list[Case], folder: Path, bins: bool = False, lines: str = "") -> dict[str, dict]:
    """The figures of each case by its name; with `bins`, how the ticks spread is among them. `folder` gets the rows of
    those that ask for them by "rows". `lines`: what is run in place of the scene as it is.
    """
    binary = program()
    folder.mkdir(parents=True, exist_ok=True)
    scene_file = folder / "scene.txt"
    scene_file.write_text(lines or Scene(scene).lines())
    workers = os.cpu_count() or 1
    shares = [cases[number::workers] for number in range(workers) if cases[number::workers]]

    def work(numbered: tuple[int, list[Case]]) -> list[dict]:
        number, share = numbered
        cases_file = folder / f"cases_{number}.txt"
        cases_file.write_text("".join(_line(case) for case in share))
        command = [binary, f"--scene={scene_file}", f"--cases={cases_file}", f"--bins={int(bins)}"]
        return [json.loads(line) for line in _lines(command, cases_file, arrived.one_more)]

    arrived = _Arrivals(len(cases))
    try:
        with ThreadPoolExecutor(workers) as pool:
            results = [result for share in pool.map(work, enumerate(shares)) for result in share]
    finally:
        arrived.end()
    by_name = {result.pop("case"): result for result in results}
    for leftover in (scene_file, *folder.glob("cases_*.txt")):
        leftover.unlink()
    return {str(case["name"]): by_name[str(case["name"])] for case in cases}


class _Arrivals:
    """A bar of how many cases are done, and how long the others will take."""

    def __init__(self, wanted: int):
        self._wanted, self._done = wanted, 0
        self._progress, self._lock, self._began = Progress(), Lock(), time.monotonic()

    def one_more(self) -> None:
        with self._lock:
            self._done += 1
            # Cases end too fast for the last few of them to tell.
            left = (time.monotonic() - self._began) / self._done * (self._wanted - self._done)
            self._progress.show(bar(self._done, self._wanted, left))

    def end(self) -> None:
        self._progress.end()


def _lines(command: list, cases_file: Path, arrived: Callable[[], None]) -> list[str]:
    """What the program says, a line a case; `arrived` is called for each as it comes."""
    lines = []
    with tempfile.TemporaryFile("w+") as errors:
        with subprocess.Popen(command, text=True, stdout=subprocess.PIPE, stderr=errors) as program:
            for line in program.stdout or ():
                lines.append(line)
                arrived()
        errors.seek(0)
        said = errors.read()
    if program.returncode == REFUSED:
        raise Refused(said.strip())
    if program.returncode != 0:
        raise RuntimeError(f"{cases_file} could not be run:\n{said[-2000:]}")
    return lines


@once
def program() -> Path:
    """Built when a process first asks for it; one process at a time, for SCons knows of no other."""
    with cache.lock(cache.clone() / "build", "bench teleop"):
        build.build("template_release", "build/template_release/bench/teleop")
    return cache.clone() / "build/template_release/bench/teleop"


def _line(case: Case) -> str:
    words = [f"{key}={value}" for key, value in case.items() if key != "name"]
    return " ".join(["case", str(case["name"]), *words]) + "\n"
