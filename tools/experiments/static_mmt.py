"""Touch of what does not move, over a network: traditional touch and a local model, right and wrong (thesis 5.3).

    ./run experiment static_mmt [--seconds=10] [--clock=virtual|real] [--pictures=1]
        [--mass=1.2 --friction=0.7 --tilt=10 --moved=0.01 --pose_noise=0.001 --phase=500 --late=50 --jitter=3]

--clock   virtual: one process, the same figures on every run. real: two Godot processes over UDP
--mass and the others make every model worse, the right one, too; see Imperfections in measuring/teleop_runs.py
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import options, teleop_runs

FIGURES = ("force_error_mean_N", "force_error_p95_N", "force_error_max_N", "force_error_shifted_mean_N")
CORRECTED = "mmt_wrong_corrected_100ms"


@dataclass(frozen=True)
class Settings(teleop_runs.Imperfections):
    seconds: float = 10.0
    clock: Literal["virtual", "real"] = "virtual"
    pictures: int = 1


def cases(description: dict, settings: Settings, output: Path) -> list[teleop_runs.Case]:
    wrong = teleop_runs.wrong(description["wrong"])
    found: list[teleop_runs.Case] = [
        {"name": f"traditional_{delay}ms", "traditional": 1, "delay_ms": delay} for delay in (0, 100)
    ]
    for delay in (0, 100, 500):
        found.append({"name": f"mmt_right_{delay}ms", "delay_ms": delay})
    for delay in (0, 100, 500):
        found.append({"name": f"mmt_wrong_{delay}ms", "delay_ms": delay, "correction": "none", **wrong})
    found.append({"name": CORRECTED, "delay_ms": 100, "correct_from_touch": 1, **wrong})
    for case in found:
        worse = settings.keys(description["scene"])
        case |= worse | {"seconds": settings.seconds, "rows": output / f"{case['name']}.csv"}
    return found


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("static_mmt")
    if settings.clock == "real":
        from measuring import teleop_processes

        return teleop_processes.static_mmt(description, settings.seconds, output)
    found = teleop_runs.run(description["scene"], cases(description, settings, output), output)
    summary: dict[str, object] = {}
    for name, figures in found.items():
        wanted = (*FIGURES, "seconds_until_right", "correction_force_step_max_N") if name == CORRECTED else FIGURES
        summary |= {f"{name}.{key}": figures[key] for key in wanted}
    for case in ("mmt_wrong_0ms", "mmt_wrong_100ms", "mmt_wrong_500ms"):
        ratio = found[case]["force_error_mean_N"] / found["traditional_100ms"]["force_error_mean_N"]
        summary[f"{case}.over_traditional_100ms"] = ratio
    if settings.pictures:
        from plots import teleop

        teleop.draw_static(output)
    return summary
