"""How far a step is: rewritten on a screen, said now and then in a log."""

import io

import build
import pytest
from setup import progress


class Screen(io.StringIO):
    def isatty(self):
        return True


def _line(text):
    """What a terminal shows of it."""
    cells, at = [], 0
    for sign in text:
        if sign == "\b":
            at -= 1
        else:
            cells[at : at + 1] = [sign]
            at += 1
    return "".join(cells)


def test_on_a_screen_the_line_is_rewritten_and_left_as_it_was(monkeypatch):
    monkeypatch.setattr(progress, "ON_A_SCREEN", 0.0)
    screen = Screen()
    screen.write("Build … ")
    shown = progress.Progress(screen)
    shown.show("9/10 files")
    shown.show("10/10")
    assert _line(screen.getvalue()).rstrip() == "Build … 10/10"
    shown.end()
    assert _line(screen.getvalue()).rstrip() == "Build …"


def test_a_log_gets_a_word_now_and_then(monkeypatch):
    log = io.StringIO()
    shown = progress.Progress(log)
    shown.show("1/10")
    assert log.getvalue() == "", "too soon"
    monkeypatch.setattr(progress, "IN_A_LOG", 0.0)
    shown.show("2/10")
    shown.show("2/10")
    shown.end()
    assert log.getvalue() == "2/10 … "


def test_what_is_watched_is_shown_while_it_lasts(monkeypatch):
    shown = []
    monkeypatch.setattr(progress.Progress, "show", lambda self, text: shown.append(text))
    with progress.watching(lambda: "1 MB", interval=0.001):
        while not shown:
            pass
    assert set(shown) == {"1 MB"}


def test_what_is_left_is_told_from_the_last_ones():
    now = [0.0]
    pace = progress.Pace(lambda: now[0])

    def after(seconds, done):
        now[0] += seconds
        return pace.left(done, 100)

    assert after(1.0, 1) is None  # too early to tell
    assert after(9.0, 2) is None  # the first ones are no measure: a build begins with its largest files
    assert after(10.0, 5) == pytest.approx(4.0 * 95)  # five in 20 s
    for done in range(6, 40):
        left = after(1.0, done)
    assert left == pytest.approx(1.0 * 61)  # what was slow before is forgotten
    assert after(0.0, 100) == 0.0


def test_a_step_says_how_many_files_and_how_long():
    now = [0.0]
    pace = progress.Pace(lambda: now[0])
    assert build._shown("@ 1/240\n", pace) == "1/240 files"
    now[0] = 60.0
    assert build._shown("@ 12/240\n", pace) == "12/240 files, 19 min left"
