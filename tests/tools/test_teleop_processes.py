"""Two sides of a teleoperation and direct touch, brought together by what the hand did."""

import numpy as np
import pytest

from measuring import gain, records, teleop_processes

ROWS = 400


def hand(rows: int, rests: int = 0) -> np.ndarray:
    """Rests, then goes along x."""
    way = np.maximum(np.arange(rows) - rests, 0)
    return np.stack([way * 1e-4, np.zeros(rows), np.zeros(rows)], axis=1)


def record(hands: np.ndarray, force: np.ndarray, contacts: np.ndarray | None = None) -> records.Record:
    count = len(hands)
    forces = np.stack([np.zeros(count), force, np.zeros(count)], axis=1)
    touching = (force > 0).astype(float) if contacts is None else contacts
    return records.Record(np.arange(count) * 1e-3, forces, np.zeros((count, 3)), hands, hands, touching)


def touch(begin: int, end: int, rows: int = ROWS) -> np.ndarray:
    force = np.zeros(rows)
    force[begin:end] = 2.0
    return force


def aligned(delay_rows: int, scenario: int = teleop_processes.MODEL_MEDIATED) -> teleop_processes.Run:
    """An operator who rests for 77 ticks before he sets out, and feels everything so many ticks late."""
    rests = 77
    here = record(hand(ROWS + rests, rests), touch(200 + rests + delay_rows, 300 + rests + delay_rows, ROWS + rests))
    there = record(hand(ROWS, 31), touch(231, 331))
    direct = record(hand(ROWS), touch(200, 300))
    case = teleop_processes.Case("case", "res://scene.tscn", ROWS * 1e-3, scenario, delay_rows * 1e-3)
    link = {"correction_force_step_max_n": 0.0, "round_trip_s": 0.1, "packets_sent_per_s": 0, "packets_received_per_s": 0}
    return teleop_processes._aligned(case, here, there, direct, {teleop_processes.OPERATOR: {"link": link}})


def test_rows_are_brought_together_by_the_hand():
    run = aligned(0)
    assert np.array_equal(run.here.hand, run.direct.hand)
    assert np.array_equal(run.here.force, run.direct.force)
    known = ~np.isnan(run.there.force[:, 0])
    assert known.sum() > 300
    assert np.array_equal(run.there.force[known], run.direct.force[known])


def test_what_is_felt_at_once_has_no_error():
    figures = teleop_processes.figures(aligned(0))
    assert figures["force_error_max_N"] == 0.0
    assert figures["contact_delay_ms"] == 0.0
    assert figures["phantom_force_share"] == 0.0


def test_what_is_felt_late_has():
    figures = teleop_processes.figures(aligned(40, teleop_processes.TRADITIONAL))
    assert figures["contact_delay_ms"] == pytest.approx(40.0)
    assert figures["phantom_force_share"] == pytest.approx(40 / 399)
    assert figures["force_error_mean_N"] == pytest.approx(2.0 * 80 / 399)


def test_another_way_of_the_hand_is_no_comparison():
    direct = record(hand(ROWS) * 1.01, touch(200, 300))
    there = record(hand(ROWS), touch(200, 300))
    case = teleop_processes.Case("case", "res://scene.tscn", ROWS * 1e-3)
    with pytest.raises(RuntimeError, match="did not take the way"):
        teleop_processes._aligned(case, there, there, direct, {})


def test_gains_in_words():
    assert gain.gained(1.0, 0.1) == "10.0 × less"
    assert gain.gained(1.0, 0.0) == "no error left"
    assert gain.gained(1.0, 5.0) == "5.0 × more"
    assert gain.gained(1.0, 1.0) == "nothing"
    assert gain.gained(0.0, 0.0) == "–"
    assert gain.gained(0.0, 1.0) == "worse"


def test_a_touch_that_is_never_felt_has_no_delay():
    direct = record(hand(ROWS), touch(200, 300))
    silent = record(hand(ROWS), np.zeros(ROWS))
    case = teleop_processes.Case("case", "res://scene.tscn", ROWS * 1e-3)
    run = teleop_processes._aligned(case, silent, silent, direct, {})
    assert teleop_processes.contact_delay(run) is None
    summary = {
        f"{scene}.{scenario}.{key}": None if key == "contact_delay_ms" and scenario == "traditional" else 1.0
        for scene in gain.SCENES for scenario in ("traditional", "mmt") for key, *_ in gain._ROWS
    }  # fmt: skip
    assert "never" in gain.text(summary)
