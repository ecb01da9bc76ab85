"""What the hand gains by a local model: scenario 4 against scenario 2, the same delay, two Godot processes over UDP.

    ./run experiment scenario4 [--seconds=6] [--delay=100] [--pictures=1]

--seconds   of each of the four runs, from when the two sides have met
--delay     there and back (unit: milliseconds)
--pictures  0: no plots

In the static scene the model is what the far side has described; in the dynamic one it is wrong as well (its box 20 % too
heavy, its surfaces 30 % too slippery) and is corrected all the time. Keys are SCENE.SCENARIO.FIGURE: SCENE is `static` or
`dynamic`, SCENARIO `traditional` or `mmt`, and FIGURE one of
    force_error_mean_N, force_error_p95_N, force_error_max_N   against direct touch with the same hand
    contact_delay_ms           until a touch is felt, in the middle of all touches
    phantom_force_share        of the time in which something is felt where there is nothing, 0 … 1
    box_position_error_rms_mm  box in the model against box in the environment (dynamic only)
    round_trip_ms, packets_per_s
Each follows from the rows of SCENE.SCENARIO.csv, the last two from links.csv.
"""

from dataclasses import dataclass
from pathlib import Path

from measuring import gain, host, options, teleop_processes, teleop_runs
from measuring.teleop_processes import MODEL_MEDIATED, TRADITIONAL, Case

SCENARIOS = {"traditional": TRADITIONAL, "mmt": MODEL_MEDIATED}
FIGURES = (
    "force_error_mean_N", "force_error_p95_N", "force_error_max_N", "contact_delay_ms", "phantom_force_share",
    "round_trip_ms", "packets_per_s",
)  # fmt: skip


@dataclass(frozen=True)
class Settings:
    seconds: float = options.seconds(6.0, least=0.5)
    # From 1 on: a fraction is a delay in seconds, as it was once counted here.
    delay: float = options.option(100.0, "ms", 1, options.LONGEST_DELAY_MS)
    pictures: bool = options.switch(True)


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    runs = teleop_processes.play_all(cases(settings), output)
    teleop_processes.write_links(runs, output / "links.csv")
    found = {name: teleop_processes.figures(one) for name, one in runs.items()}
    summary: dict[str, object] = {f"machine.{name}": value for name, value in host.description().items()}
    for name, figures in found.items():
        wanted = (*FIGURES, "box_position_error_rms_mm") if name.startswith("dynamic") else FIGURES
        summary |= {f"{name}.{key}": figures[key] for key in wanted}
    if settings.pictures:
        from plots import teleop

        for scene in ("static", "dynamic"):
            teleop.draw_gain(output, scene, settings.delay / 1e3)
    print(gain.text(summary), flush=True)
    return summary


def cases(settings: Settings) -> list[Case]:
    dynamic = teleop_runs.description("dynamic_mmt")
    thesis_path = teleop_runs.description("static_mmt")["paths"]["thesis_path"]
    scenes = {"static": (thesis_path["scene"], None), "dynamic": (dynamic["scene"], dynamic["wrong"])}
    return [
        Case(f"{name}.{scenario}", scene, settings.seconds, number, settings.delay / 1e3, wrong=wrong)
        for name, (scene, wrong) in scenes.items()
        for scenario, number in SCENARIOS.items()
    ]
