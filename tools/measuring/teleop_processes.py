"""Cases of teleoperation in real time: two Godot processes over UDP on this machine, and a third run in virtual time
in which the same hand touches the true environment directly.
"""

import csv
import json
import os
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from measuring import records
from measuring.scene_run import START_AND_END
from project import FOLDER
from setup import cache, godot
from setup.progress import Pace, bar

TRADITIONAL, MODEL_MEDIATED = 2, 4
OPERATOR, FAR = 0, 1
SIMULATED_ARM = 2  # HapticDevice.DRIVER_SIMULATED_ARM
# One processor for each haptic thread, where there are two.
PROCESSORS = {OPERATOR: 1, FAR: 0}
# Another measurement on this machine has other ports.
_PORT = 20000 + os.getpid() % 6000 * 2
PORTS = {OPERATOR: _PORT, FAR: _PORT + 1}

CORRECTED = "mmt_wrong_corrected_100ms"
CORRECTIONS = ("none", "pose", "pose_velocity", "stealthy_magnitude", "stealthy_direction")
DERIVATIONS = ("none", "velocity", "acceleration", "averaged", "history", "resimulate")

# A reference of fewer rows, from its first movement on, is found in the other record (unit: rows).
MATCHED = 50
TICK = 1e-3
# What is felt at all (unit: newtons).
FELT = 0.05
# A touch that has lasted so long is waited for; so long before it nothing was touched (unit: rows).
TOUCH = 50


@dataclass(frozen=True)
class Case:
    """What the two sides are told. The delay is there and back, half of it each way (unit: seconds)."""

    name: str
    scene: str
    seconds: float
    scenario: int = MODEL_MEDIATED
    delay: float = 0.0
    correction: str = "stealthy_direction"
    derivation: str = "resimulate"
    wrong: dict[str, dict] | None = None  # of the model, by body
    corrects_from_touch: bool = False
    loss: float = 0.0
    warmup: float = 0.5  # of the statistics (unit: seconds)
    device: dict[str, float] = field(default_factory=dict)  # properties of the HapticDevice
    baseline: bool = False  # a bare loop that only sleeps runs beside each of the two

    def options(self, side: int) -> dict[str, object]:
        options: dict[str, object] = {
            "link.scenario": self.scenario, "link.side": side, "link.conditions.delay": self.delay / 2,
            "link.conditions.loss": self.loss, "link.local_port": PORTS[side], "link.remote_port": PORTS[1 - side],
            "processor": PROCESSORS[side], "clock": "real", "duration": self.seconds, "warmup": self.warmup,
            "baseline": int(self.baseline),
        }  # fmt: skip
        if side == OPERATOR:
            options |= self.device_options()
            options["link.correction_scheme"] = CORRECTIONS.index(self.correction)
            options["link.tuning.derivation"] = DERIVATIONS.index(self.derivation)
            options["link.model_errors"] = json.dumps(self.wrong or {})
            options["corrects"] = "touch" if self.corrects_from_touch else "always"
        return options

    def device_options(self) -> dict[str, object]:
        return {f"device.{name}": value for name, value in self.device.items()}


@dataclass(frozen=True)
class Loops:
    """Of one side: how it ticked after the warm-up, and a bare loop beside it."""

    periods: np.ndarray  # as its ticks really ran (unit: microseconds)
    baseline: dict[str, list[float]]  # {"period_us", "share"}: how large a share of the periods is not longer


@dataclass(frozen=True)
class Run:
    case: Case
    here: records.Record
    there: records.Record
    direct: records.Record
    statistics: dict[int, dict]  # by side: HapticWorld's, with the link's as "link"
    loops: dict[int, Loops] = field(default_factory=dict)  # by side; empty: without a baseline


def play(case: Case, folder: Path, direct: records.Record) -> Run:
    folder.mkdir(parents=True, exist_ok=True)
    far = _start(case.scene, f"{case.name}_far", folder, case.options(FAR))
    try:
        here = _start(case.scene, case.name, folder, case.options(OPERATOR))
        _finish(here, case.seconds)
        _finish(far, case.seconds)
    finally:
        far.kill()
    names = {OPERATOR: case.name, FAR: f"{case.name}_far"}
    statistics = {side: json.loads((folder / f"{name}_statistics.json").read_text()) for side, name in names.items()}
    rows = {side: records.read(folder / f"{name}.csv") for side, name in names.items()}
    loops = {side: _loops(case, folder / name) for side, name in names.items()} if case.baseline else {}
    for name in names.values():
        for ending in ("_statistics.json", "_periods.json", ".csv"):
            (folder / f"{name}{ending}").unlink()
    return replace(_aligned(case, rows[OPERATOR], rows[FAR], direct, statistics), loops=loops)


def _loops(case: Case, stem: Path) -> Loops:
    baseline = json.loads(stem.with_name(f"{stem.name}_periods.json").read_text())["baseline"]
    return Loops(records.periods(stem.with_name(f"{stem.name}.csv"), case.seconds - case.warmup), baseline)


def direct_touch(case: Case, folder: Path) -> records.Record:
    """The same hand in the true environment, in virtual time."""
    folder.mkdir(parents=True, exist_ok=True)
    options = {"clock": "stepped", "duration": case.seconds, **case.device_options()}
    _finish(_start(case.scene, "direct", folder, options), case.seconds)
    record = records.read(folder / "direct.csv")
    for path in folder.glob("direct*"):
        path.unlink()
    return record


def _start(scene: str, name: str, folder: Path, options: dict[str, object]) -> subprocess.Popen:
    chosen = {"scene": scene, "case": name, "output": folder, **options}
    words = [f"--{key}={value}" for key, value in chosen.items()]
    command = [str(godot.command()), "--headless", "--path", str(FOLDER), "--", *words]
    return subprocess.Popen(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def _finish(process: subprocess.Popen, seconds: float) -> None:
    said, _ = process.communicate(timeout=3 * seconds + START_AND_END)
    if process.returncode != 0:
        raise RuntimeError(f"Godot could not play its side:\n{said[-3000:]}")


def _first_movement(hand: np.ndarray) -> int:
    moves = np.flatnonzero((hand[1:] != hand[0]).any(axis=1))
    if moves.size == 0:
        raise RuntimeError("the hand does not move")
    return int(moves[0]) + 1


def _aligned(case: Case, here: records.Record, there: records.Record, direct: records.Record, statistics: dict) -> Run:
    """All three begin where the hand sets out; the far side's rows are those that answer the operator's."""
    first = _first_movement(direct.hand)
    pattern = direct.hand[first : first + MATCHED]
    begins = [
        index for index in np.flatnonzero((here.hand == pattern[0]).all(axis=1))
        if np.array_equal(here.hand[index : index + MATCHED], pattern)
    ]  # fmt: skip
    if not begins:
        raise RuntimeError(f"{case.name}: the operator's hand did not take the way of the direct one")
    count = min(len(here.hand) - begins[0], len(direct.hand) - first, round(case.seconds / TICK) - first)
    return Run(
        case, _part(here, begins[0], count), _answers(here.hand[begins[0] : begins[0] + count], there),
        _part(direct, first, count), statistics,
    )  # fmt: skip


def _part(record: records.Record, first: int, count: int) -> records.Record:
    rows = slice(first, first + count)
    return records.Record(
        record.time[rows] - record.time[first], record.force[rows], record.object_position[rows], record.hand[rows],
        record.proxy[rows], record.contacts[rows],
    )  # fmt: skip


def _answers(hands: np.ndarray, there: records.Record) -> records.Record:
    """For each of the operator's rows the far one in which its hand was applied; NaN where it was lost."""
    by_hand = {hand.tobytes(): index for index, hand in reversed(list(enumerate(there.hand)))}
    found = np.array([by_hand.get(hand.tobytes(), -1) for hand in hands])
    known = (found >= 0)[:, None]
    return records.Record(
        there.time[found], np.where(known, there.force[found], np.nan),
        np.where(known, there.object_position[found], np.nan), hands,
        np.where(known, there.proxy[found], np.nan), there.contacts[found],
    )  # fmt: skip


def figures(run: Run) -> dict[str, float | None]:
    """The errors of extension/core/teleop/errors.hpp; None where there was nothing to measure."""
    error = np.linalg.norm(run.here.force - run.direct.force, axis=1)
    shift = round(run.case.delay / TICK) + 1 if run.case.scenario == TRADITIONAL else 0
    shifted = np.linalg.norm(run.here.force[shift:] - run.there.force[: len(run.there.force) - shift], axis=1)
    box = np.linalg.norm(run.here.object_position - run.there.object_position, axis=1)
    touch = np.flatnonzero(run.direct.contacts > 0)
    wrong = np.flatnonzero(error > 0.02)
    until_right = (wrong[-1] - touch[0]) * TICK if touch.size and wrong.size else 0.0
    link = run.statistics[OPERATOR]["link"]
    return {
        "force_error_mean_N": float(error.mean()),
        "force_error_p95_N": float(np.percentile(error, 95)),
        "force_error_max_N": float(error.max()),
        "force_error_shifted_mean_N": float(np.nanmean(shifted)),
        "box_position_error_rms_mm": 1e3 * float(np.sqrt(np.nanmean(box**2))),
        "contact_delay_ms": None if (delay := contact_delay(run)) is None else 1e3 * delay,
        "phantom_force_share": phantom_share(run),
        "seconds_until_right": max(0.0, float(until_right)),
        "correction_force_step_max_N": float(link["correction_force_step_max_n"]),
        "round_trip_ms": 1e3 * float(link["round_trip_s"]),
        "packets_per_s": float(link["packets_sent_per_s"] + link["packets_received_per_s"]),
    }


def contact_delay(run: Run) -> float | None:
    """From where the hand meets a surface to where it feels that, in the middle of all touches (unit: seconds). None where
    no touch was felt.
    """
    touches = run.direct.contacts > 0
    delays = []
    for begin in np.flatnonzero(touches[TOUCH:-TOUCH]) + TOUCH:
        if not touches[begin - TOUCH : begin].any() and touches[begin : begin + TOUCH].all():
            felt = np.flatnonzero(np.linalg.norm(run.here.force[begin:], axis=1) > FELT)
            should = np.flatnonzero(np.linalg.norm(run.direct.force[begin:], axis=1) > FELT)
            if felt.size and should.size:
                delays.append((felt[0] - should[0]) * TICK)
    return float(np.median(delays)) if delays else None


def phantom_share(run: Run) -> float:
    """The share of time in which the hand feels something where there is nothing."""
    felt = np.linalg.norm(run.here.force, axis=1) > FELT
    return float((felt & (np.linalg.norm(run.direct.force, axis=1) == 0.0)).mean())


def write_rows(run: Run, path: Path) -> None:
    """The columns of tests/bench/teleop.cpp that both have, for the same plots, and so that they are read back bit-exact."""
    box = np.linalg.norm(run.here.object_position - run.there.object_position, axis=1)
    columns = {"time_us": run.here.time[:, None] * 1e6, "hand": run.here.hand, "force": run.here.force}
    columns |= {"direct": run.direct.force, "far": run.there.force, "model": run.here.object_position}
    columns |= {"truth": run.there.object_position, "box_error_m": box[:, None], "direct_contacts": run.direct.contacts[:, None]}
    names = [f"{name}_{axis}" if data.shape[1] == 3 else name for name, data in columns.items() for axis in "xyz"[: data.shape[1]]]
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows(np.hstack(list(columns.values())).tolist())


def write_links(runs: dict[str, Run], path: Path) -> None:
    """What the link of each side has counted: one row a case and side."""
    rows = [
        {"case": name, "side": side, **{key: value for key, value in run.statistics[number]["link"].items() if not isinstance(value, str)}}
        for name, run in runs.items()
        for side, number in (("operator", OPERATOR), ("teleoperator", FAR))
    ]
    with path.open("w", newline="") as file:
        # What one side alone counts is empty at the other one.
        writer = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)))
        writer.writeheader()
        writer.writerows(rows)


def play_all(cases: list[Case], output: Path) -> dict[str, Run]:
    """The runs, whose rows are in `output` then. Cases of a scene have the same hand."""
    rounds = cache.emptied(output / "rounds")
    direct: dict[str, records.Record] = {}
    found = {}
    pace = Pace()
    for number, case in enumerate(cases):
        if case.scene not in direct:
            direct[case.scene] = direct_touch(case, rounds)
        print(bar(number, len(cases), pace.left(number, len(cases))), flush=True)
        print(f"{case.name}: two processes for {case.seconds:g} s", flush=True)
        found[case.name] = play(case, rounds, direct[case.scene])
        error = figures(found[case.name])["force_error_mean_N"]
        print(f"  force error {error:.4f} N on average", flush=True)
        write_rows(found[case.name], output / f"{case.name}.csv")
    rounds.rmdir()
    return found


def _all_figures(cases: list[Case], output: Path) -> dict[str, dict[str, float]]:
    return {name: figures(run) for name, run in play_all(cases, output).items()}


def static_mmt(places: Sequence, delays: Sequence[int], output: Path) -> dict[str, float]:
    """Each place of experiments/static_mmt.py: traditional touch, a right and a wrong model, and one that is corrected."""
    summary = {}
    for place in places:
        found = _all_figures(static_cases(place, delays), output)
        errors = ("force_error_mean_N", "force_error_p95_N", "force_error_max_N", "force_error_shifted_mean_N")
        summary |= {f"{name}.{key}": figures[key] for name, figures in found.items() for key in (*errors, "round_trip_ms")}
        corrected = f"{place.name}.{CORRECTED}"
        summary |= {f"{corrected}.{key}": found[corrected][key] for key in ("seconds_until_right", "correction_force_step_max_N")}
    return summary


def static_cases(place, delays: Sequence[int]) -> list[Case]:
    scene, wrong, seconds = place.scene, place.wrong, place.seconds
    cases = [Case(f"{place.name}.traditional_{ms}ms", scene, seconds, TRADITIONAL, ms / 1000) for ms in (0, 100)]
    cases += [Case(f"{place.name}.mmt_right_{ms}ms", scene, seconds, delay=ms / 1000) for ms in delays]
    cases += [Case(f"{place.name}.mmt_wrong_{ms}ms", scene, seconds, delay=ms / 1000, correction="none", wrong=wrong) for ms in delays]
    return [*cases, Case(f"{place.name}.{CORRECTED}", scene, seconds, delay=0.1, wrong=wrong, corrects_from_touch=True)]


def dynamic_mmt(description: dict, seconds: float, output: Path) -> dict[str, float]:
    """The schemes that say most, at four delays: never corrected, the thesis's, ours; and traditional touch."""
    scene, wrong = description["scene"], description["wrong"]
    cases = []
    for ms in (0, 50, 100, 200):
        delay = ms / 1000
        cases.append(Case(f"traditional.{ms}ms.0pct", scene, seconds, TRADITIONAL, delay))
        for correction, derivation in (("none", "none"), ("pose", "none"), ("stealthy_direction", "resimulate")):
            name = f"{correction}.{derivation}.{ms}ms.0pct"
            cases.append(Case(name, scene, seconds, MODEL_MEDIATED, delay, correction, derivation, wrong))
    found = _all_figures(cases, output)
    keys = (
        "force_error_mean_N", "force_error_p95_N", "box_position_error_rms_mm", "correction_force_step_max_N",
        "packets_per_s", "round_trip_ms",
    )  # fmt: skip
    return {f"{name}.{key}": figures[key] for name, figures in found.items() for key in keys}


def closed_loop(description: dict, delays: list[str], output: Path) -> dict[str, float]:
    """The arm, over a network traditionally and with a local model, beside local touch."""
    arm = {"driver": SIMULATED_ARM} | {f"arm_{name}": value for name, value in description["arm"].items()}
    summary = {}
    for scene in ("static", "dynamic"):
        place = description[scene]
        cases = [
            Case(
                f"{scene}.{way}_{delay}ms", place["scene"], description["seconds"], scenario, float(delay) / 1000,
                wrong=place.get("wrong"), device=arm,
            )
            for delay in delays
            for way, scenario in (("traditional", TRADITIONAL), ("mmt", MODEL_MEDIATED))
        ]  # fmt: skip
        runs = play_all(cases, output)
        direct = next(iter(runs.values())).direct
        local = _pushed(direct, np.linalg.norm(direct.hand - direct.proxy, axis=1), place["settled"])
        summary |= {f"{scene}.local.{key}": value for key, value in local.items()}
        for name, run in runs.items():
            found = _pushed(run.here, _depth_there(run), place["settled"])
            found["over_penetration_mm"] = found["penetration_max_mm"] - local["penetration_max_mm"]
            found["largest_difference_from_local"] = max(abs(found[key] / local[key] - 1.0) for key in local)
            summary |= {f"{name}.{key}": value for key, value in found.items()}
    return summary


def _depth_there(run: Run) -> np.ndarray:
    """Of the far side's hand below the surface there; where a sample was left out, as before (unit: meters)."""
    depth = np.linalg.norm(run.here.hand - run.there.proxy, axis=1)
    known = np.flatnonzero(~np.isnan(depth))
    return depth[known[np.maximum(np.searchsorted(known, np.arange(len(depth)), side="right") - 1, 0)]]


def _pushed(record: records.Record, depth: np.ndarray, settled: list[float]) -> dict[str, float]:
    """The figures of tests/shared/teleop_run.cpp for a hand that is pushed back."""
    rests = (record.time >= settled[0]) & (record.time < settled[1])
    rest, deepest = float(depth[rests].mean()), float(depth.max())
    # The force pushes the hand along the way from this row to the next.
    energy = float((record.force[:-1] * np.diff(record.hand, axis=0)).sum())
    figures = {"penetration_max_mm": deepest, "settled_depth_mm": rest, "overshoot_mm": deepest - rest}
    return {name: 1e3 * value for name, value in figures.items()} | {"energy_J": energy}
