"""How much of its processor time the machine's host took."""

import pytest

from measuring import host


def test_the_first_line_counts_all_processors():
    times = host.processor_times("cpu  100 0 50 800 10 0 5 35 20 0\ncpu0 1 1 1 1 1 1 1 1 1 1\n")
    assert times == host.ProcessorTimes(total=1000, steal=35)


def test_an_old_kernel_counts_no_steal():
    assert host.processor_times("cpu  100 0 50 800 10 0 5\n").steal == 0


def test_share_is_of_the_time_between():
    before, after = host.ProcessorTimes(1000, 10), host.ProcessorTimes(1200, 12)
    assert host.steal_share(before, after) == pytest.approx(0.01)


def test_no_time_between_is_no_share():
    assert host.steal_share(host.ProcessorTimes(5, 1), host.ProcessorTimes(5, 1)) == 0.0


def test_this_machine_describes_itself():
    assert host.description()["processors"] >= 1
