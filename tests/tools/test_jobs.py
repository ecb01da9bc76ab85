"""The order in which ./run test begins what it has to run."""

import threading

import pytest
from testing import jobs, python_suite
from testing.jobs import Job
from testing.results import Result


def job(suite: str, name: str, run=lambda: []) -> Job:
    return Job(suite, name, run)


def order_of(asked: list[Job], known: dict[str, float], monkeypatch) -> list[str]:
    """As they begin where one runs at a time."""
    begun = []
    monkeypatch.setattr(jobs, "ALL_AT_A_TIME", 1)
    noted = [job(one.suite, one.name, lambda one=one: begun.append(one.name) or []) for one in asked]
    jobs.carry_out(noted, known)
    return begun


def test_what_takes_longest_begins_first_and_what_is_new_before_it(monkeypatch):
    asked = [job("cpp", "short"), job("godot", "long"), job("python", "new"), job("python", "middle")]
    assert order_of(asked, {"short": 1.0, "middle": 5.0, "long": 60.0, "gone": 99.0}, monkeypatch) == ["new", "long", "middle", "short"]


def test_a_suite_that_is_full_lets_another_one_pass():
    waiting = [job("format", "second"), job("cpp", "other")]
    assert jobs.next_of(waiting, []) is waiting[0]
    assert jobs.next_of(waiting, [job("format", "first")]) is waiting[1]
    assert jobs.next_of(waiting, [job("python", "one")] * jobs.ALL_AT_A_TIME) is None
    assert jobs.next_of([], []) is None


def test_a_suite_is_told_when_its_last_job_has_ended():
    told = []
    other_has_begun = threading.Event()
    asked = [
        job("cpp", "one", lambda: [Result("one")]),
        job("python", "slow", lambda: other_has_begun.wait(60.0) and [Result("slow")]),
        job("cpp", "two", lambda: other_has_begun.set() or [Result("two", "broken")]),
    ]
    done = jobs.carry_out(asked, {}, lambda suite, found: told.append((suite, sorted(result.name for result in found))))
    assert sorted(told) == [("cpp", ["one", "two"]), ("python", ["slow"])]
    assert sorted(result.name for result in done.results if result.passed) == ["one", "slow"]
    assert set(done.times) == {"one", "slow", "two"}


def test_times_of_the_last_run_are_read_and_a_damaged_file_says_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(jobs, "_TIMES", tmp_path / "build/test_times.json")
    assert jobs.known_times() == {}
    jobs.keep_times({"godot.touch_test": 3.0})
    assert jobs.known_times() == {"godot.touch_test": 3.0}
    (tmp_path / "build/test_times.json").write_text('{"godot')
    assert jobs.known_times() == {}


def test_short_files_of_python_share_one_start():
    names = {path.stem for path in (python_suite.cache.clone() / "tests/tools").glob("test_*.py")}
    known = {"tools.test_jobs": 0.1, "tools.test_words": 0.2, "tools.test_sweeps": 60.0}
    found = {one.name for one in python_suite.jobs("", None, known)}
    assert found == {f"tools.{name}" for name in names - {"test_jobs", "test_words"}} | {"tools.short"}
    results = [Result("tools.test_jobs.test_a", seconds=0.1), Result("tools.test_jobs.test_b[1.5]", seconds=0.2), Result("cpp.core.A.B", seconds=9.0)]
    assert python_suite.times_of_files(results) == {"tools.test_jobs": pytest.approx(0.3)}
