"""Runs that could end one way or the other: a box is pushed to where little decides, the model is a little wrong in
another way each time, and the question is whether both sides see the same end (thesis figures 3.2 and 3.3).
"""

import csv
import random
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import options, rivals, teleop_grid, teleop_runs

SCHEMES = ("spring", "position", "position_force", "position_force_relative", "position_force_free", "relative_free")
# With a free force, nothing but the force leads the far hand: it may be as far from the operator's place as it likes.
KEYS: dict[str, teleop_runs.Case] = {
    "position_force_free": {"control": "position_force", "leash": 0.03},
    "relative_free": {"control": "position_force_relative", "leash": 0.03},
}
# "_alone": the model is never corrected, so that C' alone keeps the two together.
VARIANTS = {"": "stealthy_direction", "_alone": "none"}
CASES: dict[str, teleop_runs.Case] = {
    f"{scheme}{variant}": {**KEYS.get(scheme, {"control": scheme}), "correction": correction}
    for scheme in SCHEMES
    for variant, correction in VARIANTS.items()
}
# The others, with the spring: what corrects, or what comes back, keeps the two together.
OTHERS = ("pose_only", "velocities", "passive_updates", *rivals.TRADITIONAL)
CASES |= {f"spring_{scheme}" if scheme in rivals.MODELS else scheme: rivals.SCHEMES[scheme] for scheme in OTHERS}
# The terms of C', one at a time: the speed of 1 in free space, how far a force or a relative place leads 2 and 3, how near is near.
TERMS: dict[str, tuple[str, tuple[float, ...]]] = {
    "position": ("stand_in_speed", (0.05, 0.1, 0.2, 0.5)),
    "position_force": ("leash", (0.0001, 0.0005, 0.002, 0.01)),
    "position_force_relative": ("leash", (0.0001, 0.0005, 0.002, 0.01)),
    "position_force_relative_near": ("near", (0.01, 0.03, 0.1)),
}
SWEEP: dict[str, teleop_runs.Case] = {
    f"{scheme}.{term}_{value:g}{variant}": {"control": scheme.removesuffix("_near"), term: value, "correction": correction}
    for scheme, (term, values) in TERMS.items()
    for value in values
    for variant, correction in VARIANTS.items()
}


@dataclass(frozen=True)
class Settings:
    runs: int = options.option(200, "count", 1, 100_000)
    seed: int = options.option(1, "count", 0, 10**9)
    delay: float = options.option(100.0, "ms", 0, options.LONGEST_DELAY_MS)
    sweep: bool = options.switch(False)
    pictures: bool = options.switch(True)
    clock: Literal["virtual"] = "virtual"


def perturbation(description: dict, seed: int) -> teleop_runs.Case:
    """What is different in the run with this seed. The same for every scheme."""
    draw = random.Random(seed)
    ranges = description["perturbed"]

    def within(name: str) -> float:
        return draw.uniform(-ranges[name], ranges[name])

    box = description["object"]
    friction = 1.0 + within("friction")
    case: teleop_runs.Case = {
        "seed": seed,
        "path_shift": f"{within('path_x'):.6f},0,{within('path_z'):.6f}",
        f"wrong.{box}.mass": f"{1.0 + within('mass'):.6f}",
        f"wrong.{box}.move": f"{within('place'):.6f},0,{within('place'):.6f}",
        f"wrong.{box}.turn": f"0,1,0,{within('turn_deg'):.6f}",
        "phase_us": draw.randrange(1000),
        "late_ms": draw.randrange(ranges["late_ms"] + 1),
    }
    return case | {f"wrong.{body}.friction": f"{friction:.6f}" for body in (box, *description["friction_of"])}


def asked(settings: Settings) -> dict[str, teleop_runs.Case]:
    return SWEEP if settings.sweep else CASES


def cases(description: dict, settings: Settings) -> list[teleop_runs.Case]:
    found: list[teleop_runs.Case] = []
    for name, keys in asked(settings).items():
        for run in range(settings.runs):
            case = {"name": f"{name}.{run}", **keys, "delay_ms": settings.delay}
            case |= {"seconds": description["seconds"], "object": description["object"]}
            found.append(case | perturbation(description, settings.seed * 100_000 + run))
    return found


def is_beyond(description: dict, figures: dict[str, float], side: str) -> bool:
    """Whether the box has fallen, or has passed: it is beyond the line on that side at the end."""
    line = description["line"]
    place = figures[f"{side}_final_{line['axis']}"]
    return place < line["below"] if "below" in line else place > line["above"]


def run(name: str, settings: Settings, output: Path) -> dict[str, object]:
    description = teleop_runs.description(name)
    found = teleop_runs.run(description["scene"], cases(description, settings), output, bins=True)
    _write_table(output / "runs.csv", description, found)
    summary: dict[str, object] = {}
    for case in asked(settings):
        runs = [found[f"{case}.{number}"] for number in range(settings.runs)]
        summary |= {f"{case}.{key}": value for key, value in shares(description, runs).items()}
    if settings.pictures and not settings.sweep:
        from plots import endings

        endings.draw(summary, tuple(CASES), description["title"], output / "endings.png")
    return summary


def shares(description: dict, runs: list[dict[str, float]]) -> dict[str, float]:
    model = [is_beyond(description, one, "model") for one in runs]
    truth = [is_beyond(description, one, "truth") for one in runs]
    apart = sorted(_distance(one) for one in runs)
    return {
        "ends_alike_share": sum(a == b for a, b in zip(model, truth)) / len(runs),
        "model_beyond_share": sum(model) / len(runs),
        "environment_beyond_share": sum(truth) / len(runs),
        "apart_median_mm": apart[len(apart) // 2],
        "apart_p95_mm": apart[int(0.95 * (len(apart) - 1))],
        "off_by_10mm_share": _mean(one["box_position_error_max_mm"] > 10.0 for one in runs),
        "box_position_error_rms_mean_mm": _mean(one["box_position_error_rms_mm"] for one in runs),
        **{f"force_error_{how}_N": _mean(one[f"force_error_{how}_N"] for one in runs) for how in ("mean", "p95", "p99")},
        "force_error_max_N": max(one["force_error_max_N"] for one in runs),
        **_felt(runs),
        "felt_excess_100ms_jnd_p99_mean": _mean(one["felt_excess_100ms_jnd_p99"] for one in runs),
        "energy_at_hand_mean_J": _mean(one["energy_at_hand_J"] for one in runs),
        "energy_created_max_J": max(one["energy_created_J"] for one in runs),
        "bits_per_s": _mean(one["bits_per_s"] for one in runs),
    }


def _felt(runs: list[dict]) -> dict[str, float]:
    """In all ticks of all runs."""
    found: dict[str, float] = {}
    for key in ("felt_excess_1ms_N", "felt_excess_1ms_jnd", "felt_excess_100ms_N", "felt_excess_100ms_jnd"):
        pooled = teleop_grid.pool(one["bins"][key] for one in runs)
        found[f"{key}_mean"] = _mean(one[f"{key}_mean"] for one in runs)
        found[f"{key}_p95"] = teleop_grid.pooled_percentile(pooled, 0.95)
        found[f"{key}_p99"] = teleop_grid.pooled_percentile(pooled, 0.99)
        found[f"{key}_max"] = max(one[f"{key}_max"] for one in runs)
    return found


def _mean(values) -> float:
    listed = list(values)
    return sum(listed) / len(listed)


def _distance(one: dict[str, float]) -> float:
    return 1e3 * sum((one[f"model_final_{axis}"] - one[f"truth_final_{axis}"]) ** 2 for axis in "xyz") ** 0.5


def _write_table(path: Path, description: dict, found: dict[str, dict[str, float]]) -> None:
    places = [f"{side}_final_{axis}" for side in ("model", "truth") for axis in "xyz"]
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["case", "run", "model_beyond", "environment_beyond", *places])
        for name, figures in found.items():
            case, number = name.rsplit(".", 1)
            beyond = [int(is_beyond(description, figures, side)) for side in ("model", "truth")]
            writer.writerow([case, number, *beyond, *(f"{figures[key]:.9g}" for key in places)])
