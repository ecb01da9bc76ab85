"""Every change of the model that could kick a hand that touches: how much of each is felt (100 ms away).

    ./run experiment kicks [--delay=100] [--kinds=stiffness,restart,…] [--set=KEY=VALUE,KEY=VALUE] [--still=1] [--pictures=1]

The hand presses (2.5 N), slides or pushes; the model is wrong in one thing and at 2 s the far side tells the truth, or the
far side starts anew, or the link dies. Bodies are described over the link, as between two programs. The figures count from
then until the hand is about to leave: KIND.felt_excess_100ms_jnd_max, KIND.felt_excess_100ms_N_max, KIND.felt_excess_1ms_N_max, KIND.force_error_left_N,
what of the mistake is still felt at the end, and KIND.let_go where the pointer has let go and said so. demo_project/experiments/kicks.json says what each KIND is.
KIND.untold.felt_excess_… is what is felt of the same mistake where nothing changes. Of a model that is wrong from the start KIND.bound.felt_excess_… is
what is left to any way: before a word of its mistake can have come.

With --still=1 a hand also presses and holds still while something else changes (tests/shared/unexplained_steps.hpp), at 0, 2, 10, 50
and 200 ms: every step of its force is then unexplained by its own motion. still.CHANGE.step_unexplained_max_N is the largest in a tick over all
delays, scenarios and hands, still.CHANGE.far_step_max_N that of the far hand while a hand of the operator comes or goes, and
still.CHANGE.far_alone_max_N what the far hand presses with, where it presses on for 1 s and the delay while the operator feels nothing.
step_unexplained_max_N is the largest of all.
"""

import csv
import json
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import options, teleop_runs
from measuring.teleop_scene import Scene

STILL = ("step_unexplained_max_N", "far_step_max_N", "far_alone_max_N")
EXCESS = ("felt_excess_100ms_jnd_max", "felt_excess_100ms_N_max", "felt_excess_1ms_N_max")
FIGURES = (*EXCESS, "force_error_left_N", "energy_created_J")


@dataclass(frozen=True)
class Settings:
    delay: float = options.option(100.0, "ms", 0, options.LONGEST_DELAY_MS)
    kinds: tuple[str, ...] = options.names(None, lambda: teleop_runs.description("kicks")["kinds"])
    set: dict[str, str] = options.pairs()
    clock: Literal["virtual"] = "virtual"
    still: bool = options.switch(True)
    pictures: bool = options.switch(True)


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("kicks")
    kinds = description["kinds"]
    chosen = list(settings.kinds)
    found: dict[str, dict] = {}
    for place, lift in dict.fromkeys((kinds[kind]["place"], kinds[kind].get("lift", 0.0)) for kind in chosen):
        here = [kind for kind in chosen if (kinds[kind]["place"], kinds[kind].get("lift", 0.0)) == (place, lift)]
        lines = Scene(description["scene"]).varied(_lifted(description["places"][place], lift))
        cases = [case(description, kind, settings, output) for kind in here]
        cases += [bound(description, kind, settings, output) for kind in here if "event" not in kinds[kind]]
        cases += [untold(description, kind, settings, output) for kind in here if "event" in kinds[kind]]
        found |= teleop_runs.run(description["scene"], cases, output, lines=lines)
    summary: dict[str, object] = {}
    for kind in chosen:
        summary |= {f"{kind}.{key}": found[kind][key] for key in FIGURES}
        summary[f"{kind}.let_go"] = found[kind]["let_go_ticks"] > 0
        summary |= {f"{kind}.bound.{key}": found[_bound(kind)][key] for key in EXCESS if _bound(kind) in found}
        summary |= {f"{kind}.untold.{key}": found[_untold(kind)][key] for key in EXCESS if _untold(kind) in found}
    if settings.still:
        summary |= still(output)
    summary["kicking_kinds"] = sum(not is_quiet(found[kind]) for kind in chosen)
    with (output / "kicks.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["kind", *FIGURES, "let_go"])
        writer.writerows([kind, *(found[kind][key] for key in FIGURES), summary[f"{kind}.let_go"]] for kind in chosen)
    if settings.pictures:
        from plots import kicks

        kicks.draw(output, chosen, summary, description["at"])
    return summary


def still(output: Path) -> dict[str, object]:
    lines = subprocess.run([teleop_runs.program(), "--still=1"], check=True, capture_output=True, text=True).stdout.splitlines()
    cases = [json.loads(line) for line in lines]
    with (output / "still.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, list(cases[0]))
        writer.writeheader()
        writer.writerows(cases)
    summary: dict[str, object] = {}
    for change in dict.fromkeys(case["case"].split(".")[0] for case in cases):
        mine = [case for case in cases if case["case"].split(".")[0] == change]
        summary |= {f"still.{change}.{key}": max(case[key] for case in mine) for key in STILL}
    summary["step_unexplained_max_N"] = max(case["step_unexplained_max_N"] for case in cases)
    summary["still_cases"] = len(cases)
    return summary


def is_quiet(figures: dict[str, float]) -> bool:
    return figures["felt_excess_100ms_jnd_max"] <= 1.0 or figures["let_go_ticks"] > 0


def case(description: dict, kind: str, settings: Settings, output: Path) -> teleop_runs.Case:
    how = dict(description["kinds"][kind])
    keys: teleop_runs.Case = {"name": kind, "rows": output / f"{kind}.csv", "discovers": 1, "delay_ms": settings.delay}
    keys |= {"seconds": description["seconds"], "measured_to": description["measured_to"]}
    keys |= {"measured_from": description["at"]}
    event = how.pop("event", None)
    if event:
        keys["event.0"] = f"{description['at']},{event}"
    keys |= teleop_runs.wrong(how.pop("wrong", {}))
    keys |= {key: value for key, value in how.items() if key not in ("place", "lift")}
    return keys | settings.set


def bound(description: dict, kind: str, settings: Settings, output: Path) -> teleop_runs.Case:
    """Never corrected, and right itself one delay after its first mistake has shown."""
    keys = case(description, kind, settings, output) | {"name": _bound(kind), "correction": "none"}
    del keys["rows"]
    return keys | {"known_after_ms": settings.delay}


def untold(description: dict, kind: str, settings: Settings, output: Path) -> teleop_runs.Case:
    keys = case(description, kind, settings, output) | {"name": _untold(kind)}
    return {key: value for key, value in keys.items() if key not in ("rows", "event.0")}


def _bound(kind: str) -> str:
    return f"{kind}.bound"


def _untold(kind: str) -> str:
    return f"{kind}.untold"


def _lifted(variation: dict, by: float) -> dict:
    """The hand presses what is believed to be higher by as much."""
    return variation | {"path": [[time, x, y + by, z] for time, x, y, z in variation["path"]]}
