"""Rows of a HapticRecorder and the figures made from them."""

import numpy as np
import pytest

from measuring import records

HEADER = (
    "time_us,force_x,force_y,force_z,object_x,object_y,object_z,hand_x,hand_y,hand_z,proxy_x,proxy_y,proxy_z,"
    "object_qx,object_qy,object_qz,object_qw,proxy_status,contacts\n"
)


def row(milliseconds: int, force=(0, 0, 0), at=(0, 0, 0), contacts=0) -> str:
    values = [1_700_000_000_000_000 + 1000 * milliseconds, *force, *at, *[0] * 6, 0, 0, 0, 1, 0, contacts]
    return ",".join(map(str, values)) + "\n"


@pytest.fixture
def three_ticks(tmp_path):
    path = tmp_path / "rows.csv"
    path.write_text(HEADER + row(0) + row(1, (0, 3, 4), (1, 0, 0), 1) + row(2, (0, 0, 1), (3, 4, 0), 2))
    return records.read(path)


def test_time_starts_at_zero_and_is_in_seconds(three_ticks):
    assert three_ticks.time == pytest.approx([0.0, 0.001, 0.002])


def test_figures(three_ticks):
    found = records.figures(three_ticks)
    assert found["force_mean_n"] == pytest.approx(2.0)
    assert found["force_mean_while_touching_n"] == pytest.approx(3.0)
    assert found["force_max_n"] == pytest.approx(5.0)
    assert found["contact_time_share"] == pytest.approx(2 / 3)
    assert found["object_travel_m"] == pytest.approx(5.0)


def test_the_last_seconds_have_a_clock_of_their_own(three_ticks):
    end = records.last_seconds(three_ticks, 0.002)
    assert end.time == pytest.approx([0.0, 0.001])
    assert np.array_equal(end.contacts, [1, 2])


def test_a_file_without_rows_is_refused(tmp_path):
    path = tmp_path / "rows.csv"
    path.write_text(HEADER)
    with pytest.warns(UserWarning), pytest.raises(RuntimeError, match="has no rows"):
        records.read(path)


def test_the_last_seconds_have_as_many_rows(tmp_path):
    path = tmp_path / "rows.csv"
    path.write_text(HEADER + "".join(row(number) for number in range(5001)))
    for seconds in (1.0, 3.0, 4.0, 4.7):
        assert len(records.last_seconds(records.read(path), seconds).time) == round(1000 * seconds)


def test_periods_are_of_ticks_as_they_ran_and_not_as_they_were_due(tmp_path):
    path = tmp_path / "rows.csv"
    ran = np.cumsum([0, 900, 1000, 1100, 1300, 700]) + 1_700_000_000_000_000
    path.write_text("time_us,ran_us,contacts\n" + "".join(f"{ran[0] + 1000 * number},{one},0\n" for number, one in enumerate(ran)))
    assert records.periods(path, 0.004) == pytest.approx([1000, 1100, 1300, 700])
