"""Touch of what moves, over a network, with a model that is realistically wrong: how to bring the truth in (thesis 5.4).

    ./run experiment dynamic_mmt [--seconds=10] [--delays=0,25,50,100,200,500] [--losses=0,10,50] [--pictures=1]
        [--mass=0.8 --friction=1.3 --tilt=1 --moved=0.01 --pose_noise=0.001 --phase=500 --late=50 --jitter=3]

Cases are CORRECTION.DERIVATION.DELAYms.LOSSpct: how a correction is brought in, how the present is derived from a state
that is one delay old, the delay there and back, and the share of packets lost. traditional.DELAYms.LOSSpct is beside them.
"""

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import options, teleop_runs

CORRECTIONS = ("none", "pose", "pose_velocity", "stealthy_magnitude", "stealthy_direction")
DERIVATIONS = ("none", "velocity", "acceleration", "averaged", "history", "resimulate")
FIGURES = (
    "box_position_error_rms_mm", "box_position_error_final_mm", "box_rotation_error_rms_deg", "force_error_mean_N",
    "force_jitter_rms_N", "correction_force_step_max_N", "correction_cost_jnd_p99", "packets_per_s",
    "box_right_after_letting_go_s",
)  # fmt: skip
# Shown as curves: the model left alone, the thesis's correction, and ours.
SHOWN = ("none.none.100ms.0pct", "pose.none.100ms.0pct", "stealthy_direction.resimulate.100ms.0pct")


@dataclass(frozen=True)
class Settings(teleop_runs.Imperfections):
    seconds: float = 10.0
    delays: str = "0,25,50,100,200,500"
    losses: str = "0,10,50"
    clock: Literal["virtual", "real"] = "virtual"
    pictures: int = 1


def cases(description: dict, settings: Settings, output: Path) -> list[teleop_runs.Case]:
    wrong = teleop_runs.wrong(description["wrong"]) | settings.keys(description["scene"], description["object"])
    found: list[teleop_runs.Case] = []
    for delay in settings.delays.split(","):
        for loss in settings.losses.split(","):
            common = {"delay_ms": delay, "loss": float(loss) / 100, "seconds": settings.seconds}
            common["object"] = description["object"]
            found.append({"name": f"traditional.{delay}ms.{loss}pct", "traditional": 1, **common})
            for correction in CORRECTIONS:
                for derivation in DERIVATIONS if correction != "none" else ("none",):
                    name = f"{correction}.{derivation}.{delay}ms.{loss}pct"
                    one = {"name": name, "correction": correction, "derivation": derivation, **common, **wrong}
                    found.append(one | ({"rows": output / f"{name}.csv"} if name in SHOWN else {}))
    return found


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("dynamic_mmt")
    if settings.clock == "real":
        from measuring import teleop_processes

        return teleop_processes.dynamic_mmt(description, settings.seconds, output)
    found = teleop_runs.run(description["scene"], cases(description, settings, output), output)
    # A model that is never corrected derives nothing: one run stands for all derivations.
    for name in [name for name in found if name.startswith("none.none.")]:
        found |= {name.replace("none.none.", f"none.{derivation}."): found[name] for derivation in DERIVATIONS}
    _write_table(output / "cases.csv", found)
    summary: dict[str, object] = {f"{name}.{key}": found[name][key] for name in sorted(found) for key in FIGURES}
    summary["best"] = best(found)
    if settings.pictures:
        from plots import teleop

        teleop.draw_dynamic(output, SHOWN)
        teleop.draw_schemes(found, CORRECTIONS[1:], DERIVATIONS, output / "schemes.png")
        teleop.draw_delays(found, output / "delays.png")
    return summary


def best(found: dict[str, dict[str, float]]) -> str:
    """At 100 ms without loss: no step that can be felt, then the least force error."""
    candidates = {name: figures for name, figures in found.items() if name.endswith(".100ms.0pct")}
    candidates = {name: figures for name, figures in candidates.items() if name.split(".")[0] in CORRECTIONS[1:]}
    unfelt = {name: one for name, one in candidates.items() if one["correction_force_step_max_N"] <= 0.02}
    among = unfelt or candidates

    def rank(name: str) -> tuple[float, float]:
        # Force errors that differ by less than a thousandth of a newton are equal.
        return round(among[name]["force_error_mean_N"], 3), among[name]["correction_force_step_max_N"]

    return min(among, key=rank) if among else ""


def _write_table(path: Path, found: dict[str, dict[str, float]]) -> None:
    names = sorted({key for figures in found.values() for key in figures})
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["correction", "derivation", "delay_ms", "loss_pct", *names])
        for name in sorted(found):
            *scheme, delay, loss = name.split(".")
            row = [*scheme, *[""] * (2 - len(scheme)), delay.removesuffix("ms"), loss.removesuffix("pct")]
            writer.writerow([*row, *(f"{found[name][key]:.9g}" if key in found[name] else "" for key in names)])
