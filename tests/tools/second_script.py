"""The figures of experiments, computed once more from the rows that they leave: by another program, which has nothing of
theirs, no NumPy, and the definitions of extension/core/teleop/errors.hpp alone.
"""

import csv
import math
from pathlib import Path

Vector = tuple[float, ...]
WEBER, LEAST_NOTICEABLE = 0.07, 0.02  # of a force (newtons)


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


def energies(rows: list[dict[str, float]]) -> dict[str, float]:
    """What the force that is held gives on the way to the next row."""
    total = contact = created = most = 0.0
    for before, row in zip(rows, rows[1:]):
        force = vector(before, "force")
        given = sum(a * b for a, b in zip(force, minus(vector(row, "hand"), vector(before, "hand"))))
        total += given
        most = max(most, total)
        contact = contact + given if size(force) > 0.0 else 0.0
        created = max(created, contact)
    return {"energy_at_hand_J": total, "energy_at_hand_most_J": most, "energy_created_J": created}


def linked_touch(path: Path) -> dict[str, float]:
    rows = read(path)
    errors = [size(minus(vector(row, "force"), vector(row, "direct"))) for row in rows]
    found = {f"force_error_{how}_N": value for how, value in spread(errors).items()}
    found["force_error_left_N"] = errors[-1]
    for window in (1, 100):
        for unit, values in zip(("N", "jnd"), excess(rows, window)):
            found |= {f"felt_excess_{window}ms_{unit}_{how}": value for how, value in spread(values).items()}
    found |= energies(rows)
    found["let_go_ticks"] = sum(row["let_go"] for row in rows)
    found["force_jitter_rms_N"] = root_mean_square([size(fast) for fast in high_pass([vector(row, "force") for row in rows], 30.0)])
    masked = sorted(row["jnd_share"] for row in rows if row["jnd_share"] > 0.0)
    found["correction_cost_jnd_p99"] = masked[math.floor(0.99 * (len(masked) - 1))] if masked else 0.0
    touched = next((row["time_us"] for row in rows if row["direct_touches"]), None)
    wrong = max((row["time_us"] for row, error in zip(rows, errors) if error > 0.02), default=0.0)
    found["seconds_until_right"] = 0.0 if touched is None else max(0.0, 1e-6 * (wrong - touched))
    answered = [row for row in rows if not math.isnan(row["box_error_m"])]
    found["hand_position_error_rms_mm"] = 1e3 * root_mean_square([row["far_hand_error_m"] for row in answered])
    return found | of_the_box(answered)


def of_the_box(rows: list[dict[str, float]]) -> dict[str, float]:
    """Of the samples that the teleoperator has answered."""
    off = [1e3 * row["box_error_m"] for row in rows]
    found = {f"box_position_error_{how}_mm": value for how, value in spread(off).items()}
    found |= {"box_position_error_rms_mm": root_mean_square(off), "box_position_error_final_mm": off[-1]}
    found["box_rotation_error_rms_deg"] = math.degrees(root_mean_square([row["box_rotation_error_rad"] for row in rows]))
    return found | {f"{which}_final_{axis}": rows[-1][f"{which}_{axis}"] for which in ("model", "truth") for axis in "xyz"}


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


def scenario4(path: Path) -> dict[str, float]:
    rows = read(path)
    errors = sorted(size(minus(vector(row, "force"), vector(row, "direct"))) for row in rows)
    # Between the two neighbors, as is usual of a percentile.
    place = 0.95 * (len(errors) - 1)
    low = errors[math.floor(place)]
    p95 = low + (errors[math.ceil(place)] - low) * (place - math.floor(place))
    known = [row["box_error_m"] ** 2 for row in rows if not math.isnan(row["box_error_m"])]
    felt = [size(vector(row, "force")) > 0.05 and size(vector(row, "direct")) == 0.0 for row in rows]
    return {
        "force_error_mean_N": math.fsum(errors) / len(errors),
        "force_error_p95_N": p95,
        "force_error_max_N": errors[-1],
        "phantom_force_share": sum(felt) / len(felt),
        "box_position_error_rms_mm": 1e3 * math.sqrt(math.fsum(known) / len(known)),
    }
