"""How evenly both sides of a teleoperation tick: two Godot processes over UDP (thesis 5.2: nine of ten periods below
1.15 ms).

    ./run experiment timing_networked [--seconds=10] [--warmup=1] [--delay=0.1] [--rounds=3] [--calm=0.005]

--seconds  measured time, in which the hand pushes the box of the dynamic scene
--warmup   of the statistics, from when the two have met
--delay    there and back (unit: seconds)
--rounds, --calm   see measuring/rounds.py

Keys are SCENARIO.SIDE.FIGURE: SCENARIO is `scenario2` (traditional) or `scenario4` (model-mediated), SIDE `operator` or
`teleoperator`, and FIGURE one of HapticWorld.get_statistics(), with its unit. SCENARIO.round_trip_ms and
SCENARIO.steal_share belong to both sides, machine.NAME to the machine.
"""

import csv
import shutil
from dataclasses import dataclass
from pathlib import Path

from measuring import host, options, records, rounds, teleop_processes
from measuring.teleop_processes import FAR, MODEL_MEDIATED, OPERATOR, TRADITIONAL

SCENE = "res://gallery/dynamic_testbed/dynamic_testbed.tscn"
SCENARIOS = {"scenario2": TRADITIONAL, "scenario4": MODEL_MEDIATED}
SIDES = {"operator": OPERATOR, "teleoperator": FAR}


@dataclass(frozen=True)
class Settings:
    seconds: float = options.seconds(10.0, least=0.5)
    warmup: float = options.option(1.0, "s", 0, 3600)
    delay: float = options.option(0.1, "s", 0, 10)
    rounds: int = options.option(3, "count", 1, 1000)
    calm: float = options.option(0.005, "share", 0, 1)


@dataclass(frozen=True)
class Round:
    run: teleop_processes.Run
    steal_share: float  # 0 … 1


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    whole = settings.seconds + settings.warmup
    summary: dict[str, object] = {f"machine.{name}": value for name, value in host.description().items()}
    direct = teleop_processes.direct_touch(teleop_processes.Case("direct", SCENE, whole), output / "rounds")
    for name, scenario in SCENARIOS.items():
        print(f"{name}: two processes for {whole:g} s", flush=True)
        case = teleop_processes.Case(name, SCENE, whole, scenario, settings.delay, warmup=settings.warmup)
        played = rounds.measure(settings.rounds, settings.calm, lambda number: _once(case, output / "rounds", direct, number))
        best = played[rounds.reported(played) - 1]
        _write_rounds(output / "rounds.csv", name, played)
        link = best.run.statistics[OPERATOR]["link"]
        summary[f"{name}.round_trip_ms"] = 1e3 * link["round_trip_s"]
        summary[f"{name}.steal_share"] = best.steal_share
        for side, number in SIDES.items():
            figures = {key: value for key, value in best.run.statistics[number].items() if key != "link"}
            summary |= {f"{name}.{side}.{key}": value for key, value in figures.items()}
    shutil.rmtree(output / "rounds")
    return summary


def _once(case: teleop_processes.Case, folder: Path, direct: records.Record, number: int) -> Round:
    before = host.processor_times()
    played = Round(teleop_processes.play(case, folder, direct), host.steal_share(before, host.processor_times()))
    p90 = {name: played.run.statistics[side]["tick_period_p90_us"] for name, side in SIDES.items()}
    periods = ", ".join(f"{name} {value:.1f} µs" for name, value in p90.items())
    print(f"  round {number}: period p90 {periods}, the host took {played.steal_share:.1%}", flush=True)
    return played


def _write_rounds(path: Path, name: str, played: list[Round]) -> None:
    is_new = not path.is_file()
    with path.open("a", newline="") as file:
        writer = csv.writer(file)
        numbers = [key for key, value in played[0].run.statistics[OPERATOR].items() if isinstance(value, (int, float))]
        if is_new:
            writer.writerow(["scenario", "side", "round", "steal_share", *numbers])
        for number, one in enumerate(played, 1):
            for side, which in SIDES.items():
                figures = one.run.statistics[which]
                writer.writerow([name, side, number, one.steal_share, *(figures[key] for key in numbers)])
