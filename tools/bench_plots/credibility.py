"""build/bench/credibility.json: asks MuJoCo the same cases, adds CASE.mujoco and the deviations, and writes the table.

CASE is the deviation in percent: from the closed form where there is one, else from MuJoCo; CASE.from_mujoco is always
the second.
"""

import json
import subprocess
import sys
from pathlib import Path

from setup import cache, python_tools
from sweeps.results import write_whole

UNITS = {
    "push_off_center.turn": "rad",
    "rod.force": "N",
    "slide_spin.way": "m",
    "slide_spin.spin_time": "s",
    "disc.stop": "s",
    "square.stop": "s",
    "slide.way": "m",
    "free_rotation.flip": "s",
    "top.precession": "rad/s",
    "top.precession_100": "rad/s",
    "turntable.rate": "rad/s",
    "rocking.period": "s",
    "rocking.swing_20s": "rad",
    "damping.way_10": "m",
    "damping.way_100": "m",
    "cradle.speed": "m/s",
    "soft_plate.period_100kPa": "s",
    "soft_plate.period_1MPa": "s",
    "soft_plate.period_100kPa_damped": "s",
    "soft_plate.period_1MPa_damped": "s",
    "soft_roll.acceleration": "m/s²",
    "soft_beam.sag": "m",
    "soft_beam.period_100kPa": "s",
    "soft_beam.period_1MPa": "s",
    "soft_beam.period_10MPa": "s",
}
FIGURES = {
    "free_rotation.momentum_drift_60s": ("angular momentum of a free box, largest change in 60 s", "%"),
    "free_rotation.energy_drift_60s": ("its energy", "%"),
    "fast_rotation.momentum_drift_60s": ("the same at 707 rad/s: angular momentum", "%"),
    "fast_rotation.energy_drift_60s": ("its energy", "%"),
    "roll.way_ratio": ("ball rolled under a finger of 2, 10, 20 mm: its way over half the finger's, worst", "%"),
    "wheel.energy_over_stored": ("energy that a braked wheel gives a hand, over what it had", ""),
    "closed_path_energy_created_max_J": ("most work that one of 40 closed paths round a block gave", "J"),
    "closed_path_energy_created_2khz_max_J": ("… with ticks of 0.5 ms", "J"),
    "closed_path_energy_damped_max_J": ("… with a surface damping of k dt / 2", "J"),
    "closed_path_energy_between_ticks_max_J": ("… with the mean force of two ticks", "J"),
    "closed_path_energy_at_handle_max_J": ("… at the handle of a device with motors", "J"),
    "light.impulse_1g": ("impulse that a free body of 1 g got, against what the hand gave", "%"),
    "light.impulse_10g": ("of 10 g", "%"),
    "light.impulse_1kg": ("of 1 kg", "%"),
    "light.impulse_damped_1g": ("surface damping of 3 N s/m: of 1 g", "%"),
    "light.impulse_damped_10g": ("of 10 g", "%"),
    "light.impulse_damped_1kg": ("of 1 kg", "%"),
    "push.force": ("impulse of a hand that pushes a sliding box, against m v + mu m g t", "%"),
    "slowed.fallen_through": ("bodies of 1,000 that fell through a floor of 20 mm", ""),
    "slowed.bounce": ("a bounce among 300 bodies against the same alone, worst", "%"),
    "slowed.way": ("a slide among 300 bodies against the same alone, worst", "%"),
    "door.energy_10s_5rad_s": ("energy of a free door after 10 s, 5 rad/s", "%"),
    "door.energy_10s_20rad_s": ("20 rad/s", "%"),
    "pendulum90.energy_60s": ("energy of a pendulum of 90 degrees after 60 s", "%"),
    "stack20.stands_s": ("20 boxes stand (of 120 s)", "s"),
    "cans10.stands_s": ("10 cans of 60 × 100 mm stand (of 60 s)", "s"),
    "heavy_top.stands_s": ("five boxes, the top of 100 times the mass, stand (of 20 s)", "s"),
}
TITLES = {
    "push_off_center.turn": "cube of 100 mm pushed 40 mm off its middle by a frictionless finger: turn",
    "rod.force": "rod of 0.3 m pushed 10 mm from its end: force",
    "slide_spin.way": "cube that slides at 1 m/s and spins at 20 rad/s: way",
    "slide_spin.spin_time": "… its spin ends",
    "disc.stop": "disc of 100 mm that spins on the floor stops",
    "square.stop": "square of 100 mm",
    "slide.way": "cube that slides at 1.5 m/s: way",
    "free_rotation.flip": "box about its middle axis: from one flip to the next",
    "top.precession": "top at 200 rad/s: precession",
    "top.precession_100": "top at 100 rad/s: precession",
    "turntable.rate": "ball that rolls on a table turning at 5 rad/s: rate of its circle",
    "rocking.period": "box of 200 × 100 mm that rocks on a still cylinder of 100 mm radius by 0.05 rad: period",
    "rocking.swing_20s": "… its swing after 20 s",
    "damping.way_10": "way of a body damped by 10/s",
    "damping.way_100": "way of a body damped by 100/s",
    "cradle.speed": "Newton's cradle of five: speed of the last",
    "soft_plate.period_100kPa": "soft plate of 0.1 MPa that swings by an edge, as a rigid one: period",
    "soft_plate.period_1MPa": "of 1 MPa",
    "soft_plate.period_100kPa_damped": "of 0.1 MPa, damping of 20 ms",
    "soft_plate.period_1MPa_damped": "of 1 MPa, damping of 20 ms",
    "soft_roll.acceleration": "soft ball of 30 kPa down a slope of 0.15 rad, as a rigid one",
    "soft_beam.sag": "soft cantilever of 200 × 20 × 20 mm, 8 cells: sag",
    "soft_beam.period_100kPa": "first period at 0.1 MPa",
    "soft_beam.period_1MPa": "at 1 MPa",
    "soft_beam.period_10MPa": "at 10 MPa",
    "soft_press.8_cells": "soft block of 80 mm and 10 kPa under a proxy of 10 mm, 10 mm deep: stiffness, 8 cells",
    **{f"soft_press.{cells}_cells": f"of {cells} cells" for cells in (2, 4, 6, 10, 12)},
    "soft_press.shallow_8_cells": "4 mm deep, 8 cells",
    "soft_press.shallow_12_cells": "of 12 cells",
    "soft_press.wide_8_cells": "by a proxy of 20 mm, 10 mm deep, 8 cells",
    "soft_press.wide_12_cells": "of 12 cells",
    "soft_press.narrow_8_cells": "by a proxy of 5 mm, 5 mm deep, 8 cells",
    "soft_press.narrow_12_cells": "of 12 cells",
}
UNITS |= {case: "N/m" for case in TITLES if case.startswith("soft_press.")}


def of_mujoco() -> dict[str, float]:
    if not python_tools.is_done("mujoco"):
        print("Fetching MuJoCo, once …", flush=True)
        python_tools.install("mujoco")
    script = cache.clone() / "tools/credibility/mujoco_cases.py"
    answer = subprocess.run([python_tools.python("mujoco"), script], check=True, text=True, capture_output=True)
    return json.loads(answer.stdout)


def compared(ours: dict[str, float], mujoco: dict[str, float]) -> dict[str, float]:
    result = dict(ours)
    for case, value in mujoco.items():
        if f"{case}.ours" not in ours:
            if case in ours:
                result[f"{case}.mujoco"] = value
            continue
        deviation = abs(ours[f"{case}.ours"] / value - 1.0) * 100.0
        result[f"{case}.mujoco"] = value
        result[f"{case}.from_mujoco"] = deviation
        result.setdefault(case, deviation)
    return result


def table(values: dict[str, float]) -> str:
    rows = ["| Case | right | here | MuJoCo | off by |", "|---|---|---|---|---|"]

    def cell(key: str, unit: str) -> str:
        return f"{values[key]:.4g} {unit}".strip() if key in values else "–"

    for case, title in TITLES.items():
        if f"{case}.ours" in values:
            cells = [cell(f"{case}.{of}", UNITS[case]) for of in ("right", "ours", "mujoco")]
            rows.append(f"| {title} | {' | '.join(cells)} | {values[case]:.2g} % |")
    for key, (title, unit) in FIGURES.items():
        if key in values:
            rows.append(f"| {title} | – | {cell(key, unit)} | {cell(f'{key}.mujoco', unit)} | – |")
    return "\n".join(rows) + "\n"


def main(result: Path) -> None:
    values = compared(json.loads(result.read_text()), of_mujoco())
    write_whole(result, json.dumps(values, indent=1) + "\n")
    write_whole(result.with_suffix(".md"), table(values))
    print(f"   {result.with_suffix('.md').name} beside it")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
