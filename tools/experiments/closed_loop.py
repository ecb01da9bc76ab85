"""A hand that is pushed back: an arm with mass, damping and stiffness presses, over a network, traditionally and with a
local model (what a scripted path leaves open: thesis 5.3, inference 5).

    ./run experiment closed_loop [--delays=0,25,50,100,200,500] [--pictures=1]

In the static scene the arm presses onto the ground and holds; in the dynamic one it pushes a box, whose model is 20 %
too heavy and 30 % too slippery, and holds. Cases are SCENE.local and SCENE.WAY_DELAYms, where WAY is traditional,
traditional with each passive scheme (traditional_wave_variables, traditional_time_domain, traditional_two_layers), mmt
(the default), mmt_right, never_corrected, pose_only and velocities.

energy_created_J is the most that the hand has been given on balance at any moment of a contact, settled_force_share what
is felt of the force that direct touch would give while the hand holds still (transparency), restless_mm_s how fast it
moves then. The others: how deep the hand goes into the environment (penetration), how far beyond where it then settles
(overshoot), by how much deeper than by local touch (over_penetration), and the energy that the device gives the hand.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import options, teleop_grid, teleop_runs

FIGURES = ("penetration_max_mm", "settled_depth_mm", "overshoot_mm", "energy_J")
LINKED = (
    "energy_created_J", "energy_at_hand_J", "energy_at_far_side_J", "settled_force_share", "restless_mm_s",
    "force_error_mean_N", "felt_excess_1ms_N_max", "felt_excess_100ms_N_max", "felt_excess_100ms_jnd_p99",
    "felt_excess_100ms_jnd_max", "bits_per_s",
)  # fmt: skip
PASSIVE = tuple(f"traditional_{scheme}" for scheme in teleop_runs.PASSIVITY)
SCENES = ("static", "dynamic")


@dataclass(frozen=True)
class Settings:
    delays: str = "0,25,50,100,200,500"
    clock: Literal["virtual", "real"] = "virtual"
    pictures: int = 1


def cases(description: dict, scene: str, delays: list[str], output: Path) -> list[teleop_runs.Case]:
    place = description[scene]
    common: teleop_runs.Case = {"seconds": description["seconds"], "arm": 1}
    common |= {f"arm_{key}": value for key, value in description["arm"].items()}
    common |= {"settled_from": place["settled"][0], "settled_to": place["settled"][1]}
    if "object" in place:
        common |= {"object": place["object"]}
    found: list[teleop_runs.Case] = []
    for delay in delays:
        wrong = teleop_runs.wrong(place.get("wrong", {}))
        ways: dict[str, teleop_runs.Case] = {"traditional": {"traditional": 1}, "mmt": wrong, "mmt_right": {}}
        ways |= {f"traditional_{scheme}": {"traditional": 1, "passivity": scheme} for scheme in teleop_runs.PASSIVITY}
        for scheme in ("never_corrected", "pose_only", "velocities"):
            ways[scheme] = teleop_grid.SCHEMES[scheme] | wrong
        for way, keys in ways.items():
            name = f"{scene}.{way}_{delay}ms"
            found.append({"name": name, "delay_ms": delay, "rows": output / f"{name}.csv", **common, **keys})
    return found


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("closed_loop")
    delays = settings.delays.split(",")
    if settings.clock == "real":
        from measuring import teleop_processes

        return teleop_processes.closed_loop(description, delays, output)
    summary: dict[str, object] = {}
    for scene in SCENES:
        found = teleop_runs.run(description[scene]["scene"], cases(description, scene, delays, output), output)
        local = next(iter(found.values()))
        summary |= {f"{scene}.local.{key}": local[f"local_{key}"] for key in FIGURES}
        for name, figures in found.items():
            summary |= {f"{name}.{key}": figures[key] for key in (*FIGURES, *LINKED)}
            over = figures["penetration_max_mm"] - figures["local_penetration_max_mm"]
            summary[f"{name}.over_penetration_mm"] = over
            summary[f"{name}.hand_deviation_rms_mm"] = figures["hand_deviation_rms_mm"]
            summary[f"{name}.largest_difference_from_local"] = difference(figures)
        summary[f"{scene}.local.energy_created_J"] = local["local_energy_created_J"]
    if settings.pictures:
        from plots import closed_loop

        closed_loop.draw(output, SCENES, delays, summary)
    return summary


def difference(figures: dict[str, float]) -> float:
    """The largest of all figures' differences from local touch, as a share of what local touch has."""
    return max(abs(figures[key] - figures[f"local_{key}"]) / abs(figures[f"local_{key}"]) for key in FIGURES)
