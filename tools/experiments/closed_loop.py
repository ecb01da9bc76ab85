"""A hand that is pushed back: an arm with mass, damping and stiffness presses, over a network, traditionally and with a
local model (what a scripted path leaves open: thesis 5.3, inference 5).

    ./run experiment closed_loop [--delays=0,25,50,100,200] [--pictures=1]

In the static scene the arm presses onto the ground and holds; in the dynamic one it pushes a box, whose model is 20 %
too heavy and 30 % too slippery, and holds. Cases are SCENE.local, SCENE.traditional_DELAYms and SCENE.mmt_DELAYms. The
figures: how deep the hand goes into the environment (penetration), how far beyond where it then settles (overshoot), by
how much deeper than by local touch (over_penetration), and the energy that the device gives the hand: a wall takes some.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import options, teleop_runs

FIGURES = ("penetration_max_mm", "settled_depth_mm", "overshoot_mm", "energy_J")
SCENES = ("static", "dynamic")


@dataclass(frozen=True)
class Settings:
    delays: str = "0,25,50,100,200"
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
        ways = {"traditional": {"traditional": 1}, "mmt": teleop_runs.wrong(place.get("wrong", {}))}
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
            summary |= {f"{name}.{key}": figures[key] for key in FIGURES}
            over = figures["penetration_max_mm"] - figures["local_penetration_max_mm"]
            summary[f"{name}.over_penetration_mm"] = over
            summary[f"{name}.hand_deviation_rms_mm"] = figures["hand_deviation_rms_mm"]
            summary[f"{name}.largest_difference_from_local"] = difference(figures)
    if settings.pictures:
        from plots import closed_loop

        closed_loop.draw(output, SCENES, delays, summary)
    return summary


def difference(figures: dict[str, float]) -> float:
    """The largest of all figures' differences from local touch, as a share of what local touch has."""
    return max(abs(figures[key] - figures[f"local_{key}"]) / abs(figures[f"local_{key}"]) for key in FIGURES)
