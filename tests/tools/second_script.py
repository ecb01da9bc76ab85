"""The figures of experiments, computed once more from the rows that they leave: by another program, which has nothing of
theirs, no NumPy, and the definitions of extension/core/teleop/errors.hpp alone.
"""

import csv
import math
from pathlib import Path

Vector = tuple[float, ...]
WEBER, LEAST_NOTICEABLE = 0.07, 0.02  # of a force (newtons)
FELT = 0.05  # of a force (newtons)


def read(path: Path) -> list[dict[str, float]]:
    with path.open(newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def vector(row: dict[str, float], name: str) -> Vector:
    return tuple(row[f"{name}_{axis}"] for axis in "xyz")


def minus(one: Vector, other: Vector) -> Vector:
    return tuple(a - b for a, b in zip(one, other))


def plus(one: Vector, other: Vector) -> Vector:
    return tuple(a + b for a, b in zip(one, other))


def size(one: Vector) -> float:
    return math.sqrt(sum(part * part for part in one))


def spread(values: list[float]) -> dict[str, float]:
    ordered = sorted(values)
    found = {"mean": math.fsum(values) / len(values), "max": ordered[-1]}
    return found | {f"p{share}": ordered[math.floor(share / 100 * (len(ordered) - 1))] for share in (95, 99)}


def excess(rows: list[dict[str, float]], window: int) -> tuple[list[float], list[float]]:
    """In newtons, and in just-noticeable differences."""
    newtons, noticeable = [], []
    for i, row in enumerate(rows):
        before = rows[max(i - window, 0)]
        expected = plus(vector(before, "force"), minus(vector(row, "direct"), vector(before, "direct")))
        off = size(minus(vector(row, "force"), expected))
        newtons.append(off)
        noticeable.append(off / max(WEBER * size(expected), LEAST_NOTICEABLE))
    return newtons, noticeable


def given(before: dict[str, float], row: dict[str, float], force: str, hand: str) -> float:
    """By the force that is held on the way to the next row."""
    return math.fsum(a * b for a, b in zip(vector(before, force), minus(vector(row, hand), vector(before, hand))))


def energies(rows: list[dict[str, float]]) -> dict[str, float]:
    total = far = contact = created = most = both = 0.0
    for before, row in zip(rows, rows[1:]):
        at_hand = given(before, row, "force", "hand")
        total += at_hand
        far -= given(before, row, "there_force", "there_hand")
        most = max(most, total)
        both = max(both, total + far)
        contact = contact + at_hand if size(vector(before, "force")) > 0.0 else 0.0
        created = max(created, contact)
    return {
        "energy_at_hand_J": total, "energy_at_hand_most_J": most, "energy_created_J": created,
        "energy_at_far_side_J": far, "link_energy_created_J": both,
    }  # fmt: skip


def once_told(rows: list[dict[str, float]]) -> dict[str, float]:
    """The most felt excess of 100 ms whose window begins no earlier than the row before the first correction."""
    first = next((i for i, row in enumerate(rows) if row["corrections"] > 0), len(rows))
    newtons, noticeable = excess(rows[max(first - 1, 0) :], 100)
    return {f"felt_excess_once_told_100ms_{unit}_max": max(values[1:], default=0.0) for unit, values in (("N", newtons), ("jnd", noticeable))}


def of_the_link(last: dict[str, float], seconds: float) -> dict[str, float]:
    """28 bytes of headers a packet: 20 of IPv4 and 8 of UDP."""
    found = {f"packets_{way}_per_s": last[f"packets_{way}"] / seconds for way in ("forth", "back")}
    found |= {f"bits_{way}_per_s": 8.0 * (last[f"bytes_{way}"] + 28.0 * last[f"packets_{way}"]) / seconds for way in ("forth", "back")}
    for what in ("packets", "bits"):
        found[f"{what}_per_s"] = found[f"{what}_forth_per_s"] + found[f"{what}_back_per_s"]
    found["bytes_per_s"] = (last["bytes_forth"] + last["bytes_back"]) / seconds
    found["round_trip_ms"] = 1e3 * last["round_trip_s"]
    return found | {key: last[key] for key in ("corrections", "replays", "states_beyond_history", "samples_held", "samples_filled")}


def force_error_shifted(rows: list[dict[str, float]], ticks: int) -> float:
    """Against the force at the teleoperator so many ticks before."""
    off = [
        size(minus(vector(row, "force"), vector(before, "far")))
        for before, row in zip(rows, rows[ticks:]) if not math.isnan(before["box_error_m"])
    ]  # fmt: skip
    return math.fsum(off) / len(off) if off else 0.0


def right_after_letting_go(rows: list[dict[str, float]]) -> float:
    """The longest time from a release, 250 ms at least without contact after it, to the last error above 0.1 mm before the
    next contact.
    """
    longest, begin = 0, None
    for i, row in enumerate([*rows, {"touches": 1.0}]):
        if row["touches"] and begin is not None:
            if i - begin >= 250:
                wrong = [j for j in range(begin, i) if rows[j]["box_error_m"] > 1e-4]
                longest = max(longest, wrong[-1] - begin if wrong else 0)
            begin = None
        elif not row["touches"] and begin is None and i > 0:
            # A contact that has ended too late for anything to be seen of it.
            begin = i if rows[i - 1]["touches"] and i + 250 < len(rows) else None
    return longest * 1e-3


def linked_touch(path: Path, seconds: float, delay_ms: float, traditional: bool) -> dict[str, float]:
    """`delay_ms`: there and back."""
    rows = read(path)
    errors = [size(minus(vector(row, "force"), vector(row, "direct"))) for row in rows]
    found = {f"force_error_{how}_N": value for how, value in spread(errors).items()}
    found["force_error_left_N"] = errors[-1]
    for window in (1, 100):
        for unit, values in zip(("N", "jnd"), excess(rows, window)):
            found |= {f"felt_excess_{window}ms_{unit}_{how}": value for how, value in spread(values).items()}
    found |= energies(rows) | once_told(rows) | of_the_link(rows[-1], seconds)
    found["force_error_shifted_mean_N"] = force_error_shifted(rows, round(delay_ms) + 1 if traditional else 0)
    found["correction_force_step_max_N"] = max(row["correction_force_step_N"] for row in rows)
    touching = [key for key in rows[0] if key.startswith("direct_touches_")]
    found |= {f"{key.removeprefix('direct_touches_')}_contact_share": math.fsum(row[key] for row in rows) / len(rows) for key in touching}
    found["box_right_after_letting_go_s"] = right_after_letting_go(rows)
    found["let_go_ticks"] = sum(row["let_go"] for row in rows)
    found["force_jitter_rms_N"] = root_mean_square([size(fast) for fast in high_pass([vector(row, "force") for row in rows], 30.0)])
    masked = sorted(row["jnd_share"] for row in rows if row["jnd_share"] > 0.0)
    found["correction_cost_jnd_p99"] = masked[math.floor(0.99 * (len(masked) - 1))] if masked else 0.0
    touched = next((row["time_us"] for row in rows if row["direct_touches"]), None)
    wrong = max((row["time_us"] for row, error in zip(rows, errors) if error > 0.02), default=0.0)
    found["seconds_until_right"] = 0.0 if touched is None else max(0.0, 1e-6 * (wrong - touched))
    answered = [row for row in rows if not math.isnan(row["box_error_m"])]
    found["hand_position_error_rms_mm"] = 1e3 * root_mean_square([row["far_hand_error_m"] for row in answered])
    return found | of_the_box(answered) | {"box_lost_longest_s": 1e-3 * longest_above(0.15, [row["box_error_m"] for row in answered])}


def of_the_box(rows: list[dict[str, float]]) -> dict[str, float]:
    """Of the samples that the teleoperator has answered."""
    off = [1e3 * row["box_error_m"] for row in rows]
    found = {f"box_position_error_{how}_mm": value for how, value in spread(off).items()}
    found |= {"box_position_error_rms_mm": root_mean_square(off), "box_position_error_final_mm": off[-1]}
    found["box_rotation_error_rms_deg"] = math.degrees(root_mean_square([row["box_rotation_error_rad"] for row in rows]))
    return found | {f"{which}_final_{axis}": rows[-1][f"{which}_{axis}"] for which in ("model", "truth") for axis in "xyz"}


def longest_above(limit: float, values: list[float]) -> int:
    longest = now = 0
    for value in values:
        now = now + 1 if value > limit else 0
        longest = max(longest, now)
    return longest


def root_mean_square(values: list[float]) -> float:
    return math.sqrt(math.fsum(value * value for value in values) / len(values)) if values else 0.0


def high_pass(values: list[Vector], hertz: float) -> list[Vector]:
    """Butterworth's filter of second order, by the bilinear transform, of one value a millisecond, from rest."""
    tangent = math.tan(math.pi * hertz * 1e-3)
    scale = 1.0 + math.sqrt(2.0) * tangent + tangent**2
    one_back, two_back = 2.0 * (tangent**2 - 1.0) / scale, (1.0 - math.sqrt(2.0) * tangent + tangent**2) / scale
    rest = (0.0, 0.0, 0.0)
    given, found = [rest, rest, *values], [rest, rest]
    for i in range(2, len(given)):
        found.append(
            tuple(
                (given[i][axis] - 2.0 * given[i - 1][axis] + given[i - 2][axis]) / scale - one_back * found[-1][axis] - two_back * found[-2][axis]
                for axis in range(3)
            )
        )
    return found[2:]


def scenario1(path: Path, seconds: float) -> dict[str, float]:
    rows = read(path)
    rows = [row for row in rows if row["time_us"] > rows[-1]["time_us"] - 1e6 * seconds]
    forces = [size(vector(row, "force")) for row in rows]
    touching = [force for force, row in zip(forces, rows) if row["contacts"] > 0]
    return {
        "force_mean_n": math.fsum(forces) / len(forces),
        "force_mean_while_touching_n": math.fsum(touching) / len(touching) if touching else 0.0,
        "force_max_n": max(forces),
        "contact_time_share": len(touching) / len(rows),
        "object_travel_m": size(minus(vector(rows[-1], "object"), vector(rows[0], "object"))),
    }


def scenario4(path: Path) -> dict[str, float | None]:
    rows = read(path)
    errors = sorted(size(minus(vector(row, "force"), vector(row, "direct"))) for row in rows)
    # Between the two neighbors, as is usual of a percentile.
    place = 0.95 * (len(errors) - 1)
    low = errors[math.floor(place)]
    p95 = low + (errors[math.ceil(place)] - low) * (place - math.floor(place))
    felt = [size(vector(row, "force")) > FELT and size(vector(row, "direct")) == 0.0 for row in rows]
    found = {
        "force_error_mean_N": math.fsum(errors) / len(errors),
        "force_error_p95_N": p95,
        "force_error_max_N": errors[-1],
        "phantom_force_share": sum(felt) / len(felt),
        "contact_delay_ms": contact_delay(rows),
    }
    boxes = [(vector(row, "model"), vector(row, "truth")) for row in rows if not math.isnan(row["truth_x"])]
    return found | {"box_position_error_rms_mm": 1e3 * root_mean_square([size(minus(*both)) for both in boxes])}


def contact_delay(rows: list[dict[str, float]]) -> float | None:
    """The median over the contacts of 50 ms at least that come after 50 ms without one: from the tick in which direct
    touch gives a force to that in which the hand feels one.
    """
    delays = []
    for begin in range(50, len(rows) - 50):
        if any(row["direct_contacts"] for row in rows[begin - 50 : begin]) or not all(row["direct_contacts"] for row in rows[begin : begin + 50]):
            continue
        felt, should = (next((i for i in range(begin, len(rows)) if size(vector(rows[i], name)) > FELT), None) for name in ("force", "direct"))
        if felt is not None and should is not None:
            delays.append(felt - should)
    delays.sort()
    return 0.5 * (delays[(len(delays) - 1) // 2] + delays[len(delays) // 2]) if delays else None


def of_the_operators_link(path: Path, case: str) -> dict[str, float]:
    """Of a table with a row for each case and side."""
    with path.open(newline="") as file:
        (row,) = (row for row in csv.DictReader(file) if (row["case"], row["side"]) == (case, "operator"))
    sent, received = float(row["packets_sent_per_s"]), float(row["packets_received_per_s"])
    return {"round_trip_ms": 1e3 * float(row["round_trip_s"]), "packets_per_s": sent + received}


def of_the_loop(path: Path, case: str, number: int) -> dict[str, float]:
    """Of a table with a row for each case and round."""
    with path.open(newline="") as file:
        (row,) = (row for row in csv.DictReader(file) if (row["case"], row["round"]) == (case, str(number)))
    words = {"True": "1", "False": "0"}
    return {key: float(words.get(value, value)) for key, value in row.items() if key not in ("case", "round")}
