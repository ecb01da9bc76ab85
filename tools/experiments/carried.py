"""A model that has an object turned the wrong way is corrected under a hand that presses it: pointers that are carried along with
the object, by translating or by turning (thesis 3.1.4), beside corrections that mask what they change.

    ./run experiment carried [--turns=0,5,10,15,20] [--delay=100] [--scenes=gate,struck,hinge] [--pictures=1]

--turns   orientation error of the model about the vertical (unit: degrees), each to both sides
--delay   there and back (unit: milliseconds)

Scenes (demo_project/experiments/carried.json): a box that is pushed through a gate, a box that is pushed beside its center, and a
box on a damped hinge. The truth comes while the hand presses, at three moments each; until then the model is left wrong. Models
are wrong in orientation alone, and with another mass and friction as well.

Keys are SCHEME.TURNdeg.FIGURE over all scenes, SCENE.SCHEME.TURNdeg.FIGURE of one; SCHEME is stealthy_translate or stealthy_turn
(carried), stealthy_magnitude or stealthy_direction (masked), or pose_velocity (neither). FIGURE is one of
    felt_excess_100ms_jnd_p99, felt_excess_100ms_N_p99, felt_excess_1ms_N_max   from when the truth is told, in all ticks
    force_error_over_never_corrected, force_error_mean_N   geometric and arithmetic mean over the runs, of the whole run
    energy_created_J            most of any run
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from measuring import options, teleop_grid, teleop_runs
from measuring.teleop_scene import Scene

CARRIED = ("stealthy_translate", "stealthy_turn")
MASKED = ("stealthy_magnitude", "stealthy_direction")
SCHEMES = (*CARRIED, *MASKED, "pose_velocity")
NEVER = "none"
# A model whose mean force error is less does not need correcting (newtons): it says nothing about a ratio.
NEEDS_NONE = 1e-3


def _scenes() -> Iterable[str]:
    return teleop_runs.description("carried")["scenes"]


@dataclass(frozen=True)
class Settings:
    turns: tuple[int, ...] = options.numbers((0, 5, 10, 15, 20), "deg", 0, 90)
    delay: float = options.option(100.0, "ms", 0, options.LONGEST_DELAY_MS)
    scenes: tuple[str, ...] = options.names(None, _scenes)
    pictures: bool = options.switch(True)


@dataclass(frozen=True)
class Run:
    scheme: str
    turn: int  # degrees, to either side
    sign: int
    wrong: str
    told_at: float  # seconds

    @property
    def name(self) -> str:
        return f"{self.scheme}.{self.sign * self.turn}.{self.wrong}.{self.told_at:g}"

    @property
    def never(self) -> str:
        return Run(NEVER, self.turn, self.sign, self.wrong, self.told_at).name


def runs(how: dict, wrongs: Iterable[str], turns: Iterable[int]) -> list[Run]:
    return [
        Run(scheme, turn, sign, wrong, told_at)
        for turn in turns
        for sign in ((1, -1) if turn else (1,))
        for wrong in wrongs
        for told_at in how["told_at"]
        for scheme in (NEVER, *SCHEMES)
    ]


def case(description: dict, how: dict, one: Run, delay: float) -> teleop_runs.Case:
    body = description["object"]
    angle = one.sign * one.turn
    found: teleop_runs.Case = {
        "name": one.name, "correction": one.scheme, "delay_ms": delay, "seconds": how["seconds"], "object": body,
        "measured_from": one.told_at, f"wrong.{body}.{how['turned_by']}": angle if how["turned_by"] == "swing" else f"0,1,0,{angle}",
    }  # fmt: skip
    if one.scheme != NEVER:
        found["event.0"] = f"{one.told_at},correct"
    wrong = description["wrong"][one.wrong]
    if "mass" in wrong:
        found[f"wrong.{body}.mass"] = wrong["mass"]
    if "friction" in wrong:
        found |= {f"wrong.{touched}.friction": wrong["friction"] for touched in (body, "Ground")}
    return found


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("carried")
    by_scene: dict[str, list[tuple[Run, dict, dict]]] = {}
    for name in settings.scenes:
        how = description["scenes"][name]
        asked = runs(how, description["wrong"], settings.turns)
        lines = Scene(how["scene"]).varied(how.get("variation", {}))
        found = teleop_runs.run(how["scene"], [case(description, how, one, settings.delay) for one in asked], output, bins=True, lines=lines)
        by_scene[name] = [(one, found[one.name], found[one.never]) for one in asked]
    summary: dict[str, object] = {}
    everything = [one for found in by_scene.values() for one in found]
    for prefix, found in {"": everything, **{f"{name}.": found for name, found in by_scene.items()}}.items():
        for scheme in SCHEMES:
            for turn in settings.turns:
                chosen = [(these, never) for one, these, never in found if (one.scheme, one.turn) == (scheme, turn)]
                summary |= {f"{prefix}{scheme}.{turn}deg.{key}": value for key, value in figures(chosen).items()}
    if settings.pictures:
        from plots import carried

        carried.draw(summary, settings.turns, output / "carried.png")
    return summary


def figures(chosen: list[tuple[dict, dict]]) -> dict[str, float]:
    """Of runs, each with the one of the same model that is never corrected; none where no model needs correcting."""
    needed = [(these, never) for these, never in chosen if never["force_error_mean_N"] > NEEDS_NONE]
    if not needed:
        return {}
    found: dict[str, float] = {}
    for key in ("felt_excess_100ms_jnd", "felt_excess_100ms_N"):
        found[f"{key}_p99"] = teleop_grid.pooled_percentile(teleop_grid.pool(these["bins"][key] for these, _ in needed), 0.99)
    logs = [math.log(max(these["force_error_mean_N"], 1e-9) / never["force_error_mean_N"]) for these, never in needed]
    return found | {
        "felt_excess_1ms_N_max": max(these["felt_excess_1ms_N_max"] for these, _ in needed),
        "force_error_over_never_corrected": math.exp(sum(logs) / len(logs)),
        "force_error_mean_N": sum(these["force_error_mean_N"] for these, _ in needed) / len(needed),
        "energy_created_J": max(these["energy_created_J"] for these, _ in needed),
    }
