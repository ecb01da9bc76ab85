"""One scene of the demo project, played by Godot for a time, with its files."""

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path

from measuring import host
from project import FOLDER
from setup import display, godot

RUNNER = "res://experiments/run_experiment.gd"
START_AND_END = 120.0  # what Godot may need beside the duration (unit: seconds)


@dataclass(frozen=True)
class Case:
    name: str
    scene: str


@dataclass(frozen=True)
class Run:
    case: Case
    folder: Path
    statistics: dict[str, float | int | bool | str]  # HapticWorld.get_statistics()
    steal_share: float  # 0 … 1

    def file(self, ending: str) -> Path:
        return self.folder / f"{self.case.name}{ending}"

    @property
    def rows(self) -> Path:
        return self.file(".csv")

    @property
    def trace(self) -> Path:
        return self.file("_trace.json")

    def periods(self) -> dict[str, dict[str, list[float]]]:
        """{"loop" | "baseline": {"period_us", "share"}}: how large a share of the periods is not longer."""
        return json.loads(self.file("_periods.json").read_text())


def play(case: Case, folder: Path, seconds: float, clock: str, warmup: float = 0.0, baseline: bool = False) -> Run:
    """`seconds` count after the warm-up, which is recorded too."""
    folder.mkdir(parents=True, exist_ok=True)
    options = {"clock": clock, "duration": seconds + warmup, "warmup": warmup, "baseline": int(baseline)}
    before = host.processor_times()
    _godot(["--headless"], case, folder, options)
    steal = host.steal_share(before, host.processor_times())
    return Run(case, folder, json.loads((folder / f"{case.name}_statistics.json").read_text()), steal)


def screenshot(case: Case, folder: Path, at: float) -> Path:
    """A picture of the scene at a time of its own clock, which is stepped here: drawing may take as long as it needs."""
    folder.mkdir(parents=True, exist_ok=True)
    with display.environment() as environment:
        options = {"clock": "stepped", "duration": at + 0.1, "screenshots": at}
        _godot(["--rendering-method", "gl_compatibility"], case, folder, options, environment)
    (picture,) = folder.glob(f"{case.name}_*.png")
    return picture


def _godot(arguments: list[str], case: Case, folder: Path, options: dict, environment: dict | None = None) -> None:
    chosen = {"scene": case.scene, "case": case.name, "output": folder, **options}
    command = [
        str(godot.command()), *arguments, "--path", str(FOLDER), "--script", RUNNER, "--",
        *(f"--{key}={value}" for key, value in chosen.items()),
    ]  # fmt: skip
    done = subprocess.run(
        command,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=options["duration"] * 3 + START_AND_END,
    )
    if done.returncode != 0:
        raise RuntimeError(f"Godot could not play {case.scene}:\n{done.stdout[-3000:]}")
