"""The best settings of every way that experiments compare, each with as many rounds.

    ./run experiment tuning [--rounds=24] [--seed=1] [--ways=all]

A round is one choice of a way's settings, drawn at random from its ranges; the first is what the settings are now. It is
played in cases that no other experiment has: an arm that presses onto the ground and against a box, and the scripted push
of the box, 40 and 150 ms away, the model 15 % too light and 40 % too rough. WAY.ROUND.score is the geometric mean, over the
cases, of the mean force error over that of never correcting (of the model) or of traditional touch as it is; a choice that
is called passive and makes more than a millionth of a joule in a contact is out of the question. tuning.csv has a line for
each round; WAY.best.NAME are the settings that won.
"""

import csv
import math
import random
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from experiments import closed_loop
from measuring import options, rivals, teleop_runs

DELAYS = ("40", "150")
WRONG: dict[str, dict[str, object]] = {"Box": {"mass": 0.85, "friction": 1.4}, "Ground": {"friction": 1.4}}
MOST_CREATED_J = 1e-6
# Errors below this are equal (newtons).
LEAST_ERROR = 1e-3
# From … to, drawn evenly in their logarithms: keys of tests/shared/teleop_words.cpp.
RANGES: dict[str, dict[str, tuple[float, float]]] = {
    "default": {"share": (0.1, 4.0), "fade_window": (0.05, 0.4), "estimate": (0.25, 1.0)},
    "pose_only": {"states_every": (1, 50)},
    "velocities": {"states_every": (1, 50)},
    "passive_updates": {"update_bring_in": (0.02, 1.0), "update_take_out": (0.02, 1.0), "update_tank": (0.005, 0.2)},
    "traditional_compensation_spring": {"softening_ms": (5.0, 2000.0)},
    "traditional_wave_variables": {"wave_impedance": (1.0, 60.0), "wave_cutoff": (3.0, 200.0), "drift_rate": (0.5, 50.0)},
    "traditional_time_domain": {
        "reserve": (1e-4, 1e-2), "lightest_hand": (0.02, 0.5), "largest_damping": (3.0, 100.0), "far_store": (1e-3, 0.1),
        "drift_rate": (0.5, 50.0),
    },
    "traditional_two_layers": {
        "reserve": (1e-4, 1e-2), "lightest_hand": (0.02, 0.5), "tank": (1e-3, 0.1), "refill": (10.0, 2000.0),
        "tank_share": (0.1, 0.9), "far_store": (1e-3, 0.1),
    },
}  # fmt: skip
WHOLE = ("states_every",)


@dataclass(frozen=True)
class Settings:
    rounds: int = options.option(24, "count", 1, 10_000)
    seed: int = options.seed()
    ways: tuple[str, ...] = options.names(None, RANGES)
    clock: Literal["virtual"] = "virtual"


def choices(way: str, rounds: int, seed: int) -> list[teleop_runs.Case]:
    draw = random.Random(f"{way} {seed}")
    found: list[teleop_runs.Case] = [{}]
    while len(found) < rounds:
        one: teleop_runs.Case = {}
        for key, (low, high) in RANGES[way].items():
            value = math.exp(draw.uniform(math.log(low), math.log(high)))
            one[key] = round(value) if key in WHOLE else float(f"{value:.3g}")
        found.append(one)
    return found


def places() -> dict[str, tuple[str, teleop_runs.Case]]:
    """The scene of each place and what is played there."""
    loop, push = teleop_runs.description("closed_loop"), teleop_runs.description("dynamic_mmt")
    found = {
        f"{scene}_arm": (loop[scene]["scene"], closed_loop.common(loop, scene)) for scene in closed_loop.SCENES
    }
    return found | {"push": (push["scene"], {"seconds": 5, "object": push["object"]})}


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    ways = settings.ways
    asked = {way: choices(way, settings.rounds, settings.seed) for way in ways}
    found: dict[str, dict] = {}
    for place, (scene, common) in places().items():
        wrong = teleop_runs.wrong({"Ground": {"move": [0, 0.002, 0]}} if place == "static_arm" else WRONG)
        cases = [
            {"name": f"{way}.{number}.{place}.{delay}", "delay_ms": delay, **common, **rivals.with_model(way, wrong), **choice}
            for delay in DELAYS
            for way, number, choice in [
                *((way, number, choice) for way in ways for number, choice in enumerate(asked[way])),
                ("never_corrected", 0, {}), ("traditional", 0, {}),
            ]
        ]  # fmt: skip
        found |= teleop_runs.run(scene, cases, output)
    summary: dict[str, object] = {}
    with (output / "tuning.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["way", "round", "score", "energy_created_J", "settings"])
        for way in ways:
            scores = [score(found, way, number) for number in range(len(asked[way]))]
            for number, (value, created) in enumerate(scores):
                writer.writerow([way, number, f"{value:.5g}", f"{created:.3g}", asked[way][number]])
                summary[f"{way}.{number}.score"] = value
            best = min(range(len(scores)), key=lambda number: _rank(way, scores[number]))
            summary[f"{way}.best.round"] = best
            summary[f"{way}.best.score"] = scores[best][0]
            summary |= {f"{way}.best.{key}": value for key, value in asked[way][best].items()}
    return summary


def score(found: dict[str, dict], way: str, number: int) -> tuple[float, float]:
    """The score, and the most energy made in a contact (joules)."""
    against = "never_corrected" if way in rivals.MODELS else "traditional"
    logs, created = [], 0.0
    for place in places():
        for delay in DELAYS:
            one = found[f"{way}.{number}.{place}.{delay}"]
            other = found[f"{against}.0.{place}.{delay}"]
            ratio = max(one["force_error_mean_N"], LEAST_ERROR) / max(other["force_error_mean_N"], LEAST_ERROR)
            logs.append(math.log(ratio))
            created = max(created, one["energy_created_J"])
    return math.exp(sum(logs) / len(logs)), created


def _rank(way: str, scored: tuple[float, float]) -> tuple[bool, float]:
    value, created = scored
    return way in rivals.PASSIVE and created > MOST_CREATED_J, value
