"""Set-up goes on where it was left, and only whole things count."""

import threading

import pytest
from setup import cache, steps
from setup.steps import Step


def _step(done, **options):
    return Step("thing", lambda: bool(done), lambda: done.append(1), **options)


def test_a_step_is_done_once(tmp_path, capsys):
    done = []
    steps.run([_step(done, place=tmp_path)])
    steps.run([_step(done, place=tmp_path)])
    assert done == [1]
    assert "[1/1] thing … ready" in capsys.readouterr().out


def test_a_failing_step_stops_the_rest(tmp_path):
    def fail():
        raise RuntimeError("no network")

    later = []
    with pytest.raises(SystemExit) as ended:
        steps.run([Step("first", lambda: False, fail, place=tmp_path), _step(later, place=tmp_path)])
    assert ended.value.code == 1 and later == []


def test_a_step_that_stands_alone_runs_beside_the_first(tmp_path):
    begun = threading.Event()
    # The first would wait for ever if the second only came after it.
    first = Step("first", lambda: False, lambda: begun.wait(30) or pytest.fail("not begun"), place=tmp_path)
    steps.run([first, Step("second", lambda: False, begun.set, place=tmp_path, alone=True)])


def test_a_folder_without_its_stamp_does_not_count(tmp_path):
    (tmp_path / "libJolt.a").write_text("half")
    assert not cache.is_done(tmp_path, "key")
    cache.mark_done(tmp_path, "key")
    assert cache.is_done(tmp_path, "key") and not cache.is_done(tmp_path, "another key")
