"""A hand that is pushed back: an arm with mass, damping and stiffness presses, over a network, traditionally and with a
local model (what a scripted path leaves open: thesis 5.3, inference 5).

    ./run experiment closed_loop [--delay=0,25,50,100,200,500] [--two_port=1] [--pictures=1]

In the static scene the arm presses onto the ground and holds; in the dynamic one it pushes a box, whose model is 20 %
too heavy and 30 % too slippery, and holds. Cases are SCENE.local and SCENE.WAY_DELAYms, where WAY is mmt (the default),
or one of measuring/rivals.py; with _right after it, where there is a model, the model is right. In the static scene the model is
right, since the link describes it before it is touched, so that its errors are 0; mmt_wrong and never_corrected_wrong have the
ground 5 mm too high, corrected from the first contact on or never.

energy_created_J is the most that the hand has been given on balance at any moment of a contact, energy_at_hand_most_J the
same since the start, link_energy_created_J that of hand and far side together. settled_contact_share is the share of the
ticks while the hand holds, in which it would touch the environment where it is: a way that has lost the contact has neither
of the next two figures. settled_force_share is what is felt of the force that direct touch would give while the hand holds still (transparency; where direct touch gives less
than 0.05 N then there is no such share), settled_force_error_N how much of it is missing or too much, restless_mm_s how
fast the hand moves then. The others: how deep the hand goes into the environment (penetration), how far beyond where it
then settles (overshoot), by how much deeper than by local touch (over_penetration), and the energy that the device gives
the hand. passive.energy_created_max_J and passive.link_energy_created_max_J are the most of all that is called passive.

With --two_port=1 every scheme that keeps traditional touch passive, with its defaults and tuned, also presses a wall, pushes a box and
leads a robot at each delay, with jitter, with losses and with bursts of them: passivity.two_port_energy_created_over_store_max is the largest
energy that hand and far side together have been given, summed outside, over what the two ends may spend before they have heard of any
(their stores; waves have none: over one millijoule). passivity.CASE is that of each.
"""

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import options, rivals, teleop_runs

FIGURES = ("penetration_max_mm", "settled_depth_mm", "overshoot_mm", "energy_J")
LINKED = ("settled_contact_share", "settled_force_share", "settled_force_error_N", "restless_mm_s", "hand_deviation_rms_mm", *teleop_runs.FIGURES)
SCENES = ("static", "dynamic")
# Direct touch that gives less says nothing about a share (newtons).
LEAST_SHARED = 0.05


# What two ends of a scheme may spend that nothing has paid for yet (PassivitySettings; joules).
STORES: dict[str, dict[str, float]] = {
    "wave_variables": {},
    "time_domain": {"reserve": 1e-3, "far_store": 5e-3},
    "two_layers": {"reserve": 1e-3, "far_store": 5e-3, "tank": 1e-2},
}
LEAST_STORE = 1e-3
LINES: dict[str, teleop_runs.Case] = {"clean": {}, "jitter": {"jitter_ms": 5}, "loss": {"loss": 0.1}, "bursts": {"burst": 0.2}}


@dataclass(frozen=True)
class Settings:
    delay: tuple[int, ...] = options.numbers((0, 25, 50, 100, 200, 500), "ms", 0, options.LONGEST_DELAY_MS, was="delays")
    clock: Literal["virtual", "real"] = "virtual"
    two_port: bool = options.switch(False)
    pictures: bool = options.switch(True)


def name_of(scheme: str) -> str:
    return "mmt" if scheme == rivals.DEFAULT else scheme


def common(description: dict, scene: str) -> teleop_runs.Case:
    place = description[scene]
    keys: teleop_runs.Case = {"seconds": description["seconds"], "arm": 1}
    keys |= {f"arm_{key}": value for key, value in description["arm"].items()}
    keys |= {"settled_from": place["settled"][0], "settled_to": place["settled"][1]}
    return keys | ({"object": place["object"]} if "object" in place else {})


def cases(description: dict, scene: str, delays: list[str], output: Path) -> list[teleop_runs.Case]:
    wrong = teleop_runs.wrong(description[scene].get("wrong", {}))
    ways = {name_of(scheme): rivals.with_model(scheme, wrong) for scheme in rivals.SCHEMES}
    if mistaken := teleop_runs.wrong(description[scene].get("mistaken", {})):
        ways |= {"mmt_wrong": mistaken | {"correct_from_touch": 1}, "never_corrected_wrong": mistaken | rivals.MODELS["never_corrected"]}
    ways |= {f"{name_of(scheme)}_right": keys for scheme, keys in rivals.MODELS.items() if scheme != "never_corrected"}
    return [
        {
            "name": f"{scene}.{way}_{delay}ms", "delay_ms": delay, "rows": output / f"{scene}.{way}_{delay}ms.csv",
            **common(description, scene), **keys,
        }
        for delay in delays
        for way, keys in ways.items()
    ]  # fmt: skip


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("closed_loop")
    delays = list(map(str, settings.delay))
    if settings.clock == "real":
        from measuring import teleop_processes

        return teleop_processes.closed_loop(description, delays, output)
    summary: dict[str, object] = {}
    for scene in SCENES:
        found = teleop_runs.run(description[scene]["scene"], cases(description, scene, delays, output), output)
        local = next(iter(found.values()))
        summary |= {f"{scene}.local.{key}": local[f"local_{key}"] for key in (*FIGURES, "energy_created_J")}
        for name, figures in found.items():
            summary |= {f"{name}.{key}": value for key, value in of_case(figures).items()}
        _write_table(output / f"{scene}.csv", {name: of_case(figures) for name, figures in found.items()})
    summary |= passive(summary)
    if settings.two_port:
        summary |= two_port(description, delays, output)
    if settings.pictures:
        from plots import closed_loop

        closed_loop.draw(output, SCENES, delays, summary)
    return summary


def two_port(description: dict, delays: list[str], output: Path) -> dict[str, object]:
    over_store: dict[str, float] = {}
    at_rest: dict[str, object] = {}
    for place in (*SCENES, "robot"):
        scene = "static" if place == "robot" else place
        stores = {}
        asked = []
        for scheme, store in STORES.items():
            for tuned in (False, True):
                keys = {"traditional": 1, "passivity": scheme} | (rivals.TUNED[scheme] if tuned else {})
                for line, conditions in LINES.items():
                    for delay in delays:
                        name = f"{place}.{scheme}{'.tuned' if tuned else ''}.{line}.{delay}ms"
                        case = {"name": name, "delay_ms": delay, **common(description, scene), **keys, **conditions}
                        asked.append(case | ({"robot": 1} if place == "robot" else {}))
                        stores[name] = max(LEAST_STORE, sum(float(str(keys.get(key, usual))) for key, usual in store.items()))
        found = teleop_runs.run(description[scene]["scene"], asked, output)
        over_store |= {name: figures["link_energy_created_J"] / stores[name] for name, figures in found.items()}
        if place == "static":
            at_rest = {f"passivity.{name}.settled_force_share": one["settled_force_share"] for name, one in found.items()}
    worst = max(over_store, key=lambda name: over_store[name])
    return {
        "passivity.two_port_energy_created_over_store_max": over_store[worst],
        "passivity.two_port_worst_case": worst,
        "passivity.two_port_cases": len(over_store),
    } | {f"passivity.{name}.energy_created_over_store": value for name, value in over_store.items()} | at_rest


def of_case(figures: dict[str, float]) -> dict[str, float]:
    found = {key: figures[key] for key in (*FIGURES, *LINKED)}
    if figures["settled_direct_force_N"] < LEAST_SHARED:
        del found["settled_force_share"]
    if figures["settled_contact_share"] == 0.0:
        del found["settled_force_error_N"]
    found["over_penetration_mm"] = figures["penetration_max_mm"] - figures["local_penetration_max_mm"]
    found["largest_difference_from_local"] = difference(figures)
    return found


def difference(figures: dict[str, float]) -> float:
    """The largest of all figures' differences from local touch, as a share of what local touch has."""
    return max(abs(figures[key] - figures[f"local_{key}"]) / abs(figures[f"local_{key}"]) for key in FIGURES)


def passive(summary: dict[str, object]) -> dict[str, object]:
    found: dict[str, object] = {}
    for figure in ("energy_created", "link_energy_created"):
        created = {
            key: float(value)
            for key, value in summary.items()
            if key.endswith(f".{figure}_J") and any(f".{scheme}_" in key for scheme in rivals.PASSIVE)
        }
        worst = max(created, key=lambda key: created[key])
        found |= {f"passive.{figure}_max_J": created[worst], f"passive.{figure}_max_case": worst.rsplit(".", 1)[0]}
    return found


def _write_table(path: Path, found: dict[str, dict[str, float]]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        keys = (*FIGURES, *LINKED)
        writer.writerow(["way", "delay_ms", *keys])
        for name, figures in found.items():
            way, delay = name.split(".")[1].removesuffix("ms").rsplit("_", 1)
            writer.writerow([way, delay, *(f"{figures[key]:.6g}" if key in figures else "" for key in keys)])
