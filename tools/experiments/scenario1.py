"""Scenario 1: a hand and a virtual world, no network. Both testbeds, one turn of the thesis's path each.

    ./run experiment scenario1 [--seconds=10] [--warmup=1] [--clock=real|stepped] [--rounds=3] [--calm=0.005]
                               [--pictures=1]

--seconds    measured time; the path turns once in 10 s
--warmup     recorded time before that, which does not count in the figures
--clock      real: the haptic thread, with every figure of time. stepped: virtual time; every run gives the same rows
--rounds     how often a case is played at most, see measuring/rounds.py
--calm       the share of its processor time that the machine's host may take in a round that is not repeated
--pictures   0: no plots and no screenshots
"""

import csv
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import host, options, records, rounds
from measuring.scene_run import Case, Run, play, screenshot

CASES = [Case("static", "res://gallery/static_testbed/static_testbed.tscn"), Case("dynamic", "res://gallery/dynamic_testbed/dynamic_testbed.tscn")]


@dataclass(frozen=True)
class Settings:
    seconds: float = options.seconds(10.0, least=0.1)
    warmup: float = options.option(1.0, "s", 0, 3600)
    clock: Literal["real", "stepped"] = "real"
    rounds: int = options.option(3, "count", 1, 1000)
    calm: float = options.option(0.005, "share", 0, 1)
    pictures: bool = options.switch(True)


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    summary: dict[str, object] = {f"machine.{name}": value for name, value in host.description().items()}
    for case in CASES:
        print(f"{case.name}: {case.scene} for {settings.seconds + settings.warmup:g} s", flush=True)
        played = _rounds(case, settings, output / "rounds")
        number = rounds.reported(played)
        best = _promoted(played[number - 1], output)
        record = records.last_seconds(records.read(best.rows), settings.seconds)
        figures = {**best.statistics, **records.figures(record)}
        _write_rounds(output / "rounds.csv", case, played)
        if settings.clock == "real":
            figures |= {"steal_share": best.steal_share, "rounds": len(played), "round_reported": number}
            _write_periods(output / f"{case.name}_periods.csv", best)
        summary |= {f"{case.name}.{name}": value for name, value in figures.items()}
        if settings.pictures:
            _draw(case, best, record, settings, output)
    shutil.rmtree(output / "rounds")
    if settings.pictures and settings.clock == "real":
        _draw_periods(output)
    return summary


def _rounds(case: Case, settings: Settings, folder: Path) -> list[Run]:
    if settings.clock == "stepped":
        return [play(case, folder / "1", settings.seconds + settings.warmup, "stepped")]

    def once(number: int) -> Run:
        played = play(case, folder / str(number), settings.seconds, "real", settings.warmup, baseline=True)
        print(f"  round {number}: {_in_short(played)}", flush=True)
        return played

    return rounds.measure(settings.rounds, settings.calm, once)


def _in_short(played: Run) -> str:
    figures = played.statistics
    return (
        f"period p90 {figures['tick_period_p90_us']:.1f} µs, p99 {figures['tick_period_p99_us']:.1f} µs"
        f" (bare loop {figures['baseline_period_p99_us']:.1f} µs),"
        f" work p99 {figures['tick_compute_p99_us']:.1f} µs, the host took {played.steal_share:.1%}"
    )


def _promoted(played: Run, output: Path) -> Run:
    """The run with its files in `output`."""
    for path in played.folder.glob(f"{played.case.name}*"):
        shutil.move(path, output / path.name)
    return Run(played.case, output, played.statistics, played.steal_share)


def _write_rounds(path: Path, case: Case, played: list[Run]) -> None:
    """One line a round: what decided which one is reported, and every figure of time."""
    is_new = not path.is_file()
    with path.open("a", newline="") as file:
        writer = csv.writer(file)
        names = [name for name, value in played[0].statistics.items() if not isinstance(value, str)]
        if is_new:
            writer.writerow(["case", "round", "steal_share", *names])
        for number, one in enumerate(played, 1):
            writer.writerow([case.name, number, one.steal_share, *(one.statistics[name] for name in names)])


def _write_periods(path: Path, played: Run) -> None:
    """The cumulative distributions as a table, in place of the runner's JSON."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["loop", "period_us", "share"])
        for loop, steps in played.periods().items():
            writer.writerows(
                [loop, f"{period:.3f}", f"{share:.9f}"] for period, share in zip(steps["period_us"], steps["share"])
            )
    played.file("_periods.json").unlink()


def _draw(case: Case, played: Run, record: records.Record, settings: Settings, output: Path) -> None:
    from plots import motion

    motion.draw_forces(record, f"Force on the hand, {case.name} scene", output / f"{case.name}_force.png")
    if records.figures(record)["object_travel_m"] > 0.0:
        motion.draw_object(record, "Where the box goes", output / f"{case.name}_object.png")
    # While the touch is firmest there is most to see: the proxy stays on the surface, the hand is inside.
    whole = records.read(played.rows)
    picture = screenshot(case, output / "screenshot", at=float(whole.time[whole.force_size.argmax()]))
    shutil.move(picture, output / f"{case.name}_scene.png")
    shutil.rmtree(output / "screenshot")


def _draw_periods(output: Path) -> None:
    from plots import periods

    distributions = {f"{case.name.capitalize()} scene": periods.read(output / f"{case.name}_periods.csv") for case in CASES}
    periods.draw(distributions, output / "periods.png")
