"""Two sides that differ in what both must agree on: no force on either side, and both say what differs.

    ./run experiment agreement

Every property of extension/network/terms.hpp, unequal both ways, from the start and from 1.5 s in play on, while the hand
presses; in virtual time, so that two runs give the same bits. CASE.near_force_N and CASE.far_force_N are the largest forces
from 0.3 s after the sides differ on. obeyed_cases: a hand presses or feels something all the same; silent_cases: a side does
not say what differs; idle_cases: sides that are alike and yet do not press.
"""

import csv
import json
import subprocess
from dataclasses import dataclass
from pathlib import Path

from measuring import options, teleop_runs


@dataclass(frozen=True)
class Settings:
    pass


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    options.parse(Settings, given)
    lines = subprocess.run(
        [teleop_runs.program(), "--agreement=1"], check=True, capture_output=True, text=True
    ).stdout.splitlines()
    cases = [json.loads(line) for line in lines]
    differing = [case for case in cases if not case["alike"]]
    with (output / "agreement.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, list(cases[0]))
        writer.writeheader()
        writer.writerows(cases)
    forces = {
        f"{case['case']}.{side}_force_N": case[f"{side}_force_N"] for case in cases for side in ("near", "far")
    }
    return {
        "cases": len(differing),
        "obeyed_cases": sum(case["near_force_N"] > 0.0 or case["far_force_N"] > 0.0 for case in differing),
        "silent_cases": sum(not (case["near_says"] and case["far_says"]) for case in differing),
        "idle_cases": sum(
            min(case["near_force_N"], case["far_force_N"]) <= 1.0 for case in cases if case["alike"]
        ),
    } | forces
