"""How evenly both sides of a teleoperation tick: two Godot processes over UDP (thesis 5.2: nine of ten periods below
1.15 ms).

    ./run experiment timing_networked [--seconds=10] [--warmup=1] [--delay=100] [--rounds=3] [--calm=0.005] [--pictures=1]

--seconds  measured time, in which the hand pushes the box of the dynamic scene
--warmup   of the statistics, from when the two have met
--delay    there and back (unit: milliseconds)
--rounds, --calm   see measuring/rounds.py
--pictures 0: no plot

Keys are SCENARIO.SIDE.FIGURE: SCENARIO is `scenario2` (direct) or `scenario4` (model-mediated), SIDE `operator` or
`teleoperator`, and FIGURE one of HapticWorld.get_statistics(), with its unit. SCENARIO.round_trip_ms and
SCENARIO.steal_share belong to both sides, machine.NAME to the machine.

SCENARIO.SIDE.period_p90_us and _p99_us are made of the recorded rows, as in the thesis: from when a tick really ran (ran_us) to
when the next one did. SCENARIO.SIDE.baseline_period_p90_us is that of a bare loop that sleeps beside it, on the same processor.
both_sides_periods.csv and .png have the distributions (figure 5.3).
"""

import csv
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from measuring import host, options, records, rounds, targets, teleop_processes
from measuring.teleop_processes import FAR, MODEL_MEDIATED, OPERATOR, TRADITIONAL

SCENE = "res://gallery/dynamic_testbed/dynamic_testbed.tscn"
SCENARIOS = {"scenario2": TRADITIONAL, "scenario4": MODEL_MEDIATED}
TITLES = {"scenario2": "Direct (2)", "scenario4": "Model-mediated (4)"}
SIDES = {"operator": OPERATOR, "teleoperator": FAR}


@dataclass(frozen=True)
class Settings:
    seconds: float = options.seconds(10.0, least=0.5)
    warmup: float = options.option(1.0, "s", 0, 3600)
    # From 1 on: a fraction is a delay in seconds, as it was once counted here.
    delay: float = options.option(100.0, "ms", 1, options.LONGEST_DELAY_MS)
    rounds: int = options.option(3, "count", 1, 1000)
    calm: float = options.option(0.005, "share", 0, 1)
    pictures: bool = options.switch(True)


@dataclass(frozen=True)
class Round:
    run: teleop_processes.Run
    steal_share: float  # 0 … 1


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    whole = settings.seconds + settings.warmup
    summary: dict[str, object] = {f"machine.{name}": value for name, value in host.description().items()}
    best: dict[str, Round] = {}
    direct = teleop_processes.direct_touch(teleop_processes.Case("direct", SCENE, whole), output / "rounds")
    for name, scenario in SCENARIOS.items():
        print(f"{name}: two processes for {whole:g} s", flush=True)
        case = teleop_processes.Case(name, SCENE, whole, scenario, settings.delay / 1e3, warmup=settings.warmup, baseline=True)
        played = rounds.measure(settings.rounds, settings.calm, lambda number: _once(case, output / "rounds", direct, number))
        best[name] = played[rounds.reported(played) - 1]
        _write_rounds(output / "rounds.csv", name, played)
        summary |= {f"{name}.{key}": value for key, value in _figures(best[name]).items()}
    shutil.rmtree(output / "rounds")
    _write_periods(output / "both_sides_periods.csv", best)
    if settings.pictures:
        draw(best, summary, output / "both_sides_periods.png")
    return summary


def _figures(played: Round) -> dict[str, object]:
    link = played.run.statistics[OPERATOR]["link"]
    summary: dict[str, object] = {"round_trip_ms": 1e3 * link["round_trip_s"], "steal_share": played.steal_share}
    for side, number in SIDES.items():
        figures = {key: value for key, value in played.run.statistics[number].items() if key != "link"}
        ran = played.run.loops[number].periods
        figures |= {f"period_p{part}_us": float(np.percentile(ran, part)) for part in (90, 99)}
        summary |= {f"{side}.{key}": value for key, value in figures.items()}
    return summary


def distributions(played: Round) -> dict:
    """By the names of plots.periods.SIDES."""
    from plots import periods

    found = {}
    for side, number in SIDES.items():
        loops = played.run.loops[number]
        bare = periods.Distribution(np.array(loops.baseline["period_us"]), np.array(loops.baseline["share"]))
        found |= {side: periods.of(loops.periods), f"{side}_baseline": bare}
    return found


def draw(best: dict[str, Round], summary: dict[str, object], path: Path) -> None:
    from plots import periods

    missed = [verdict.case for verdict in targets.timing_networked(summary) if not verdict.met]

    def title(name: str) -> str:
        verdict = "missed" if any(case.startswith(name) for case in missed) else "met"
        return f"{TITLES[name]}: 1.15 ms {verdict}"

    periods.draw({title(name): distributions(one) for name, one in best.items()}, path, periods.SIDES, periods.NETWORKED)


def _write_periods(path: Path, best: dict[str, Round]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["scenario", "loop", "period_us", "share"])
        for name, played in best.items():
            for loop, one in distributions(played).items():
                writer.writerows([name, loop, f"{period:.3f}", f"{share:.9f}"] for period, share in zip(one.period, one.share))


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
