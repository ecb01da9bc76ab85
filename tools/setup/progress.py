"""How far a long step is: a line that is rewritten on a terminal, a word now and then in a log."""

import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Thread

BAR = 30  # letters
IN_A_LOG = 15.0  # between two words (unit: seconds)
ON_A_SCREEN = 0.2


class Pace:
    """How long what is left will take, as long as each takes what the last few have taken."""

    LAST = 20
    FROM, OF_ALL = 5.0, 0.05  # what is shorter (unit: seconds), or less of all, tells nothing

    def __init__(self, clock: Callable[[], float] = time.monotonic):
        self._clock = clock
        self._ends: deque[tuple[float, int]] = deque([(clock(), 0)], self.LAST)

    def left(self, done: int, wanted: int) -> float | None:
        """After `done` of `wanted`; None where that cannot be told yet (unit: seconds)."""
        self._ends.append((self._clock(), done))
        (began, first), (now, last) = self._ends[0], self._ends[-1]
        if now - began < self.FROM or last <= first or done < self.OF_ALL * wanted:
            return None
        return (now - began) / (last - first) * (wanted - done)


def in_words(seconds: float) -> str:
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


def bar(done: int, wanted: int, seconds_left: float | None, more: str = "") -> str:
    """`seconds_left`: None where that cannot be told yet."""
    filled = BAR * done // max(wanted, 1)
    left = "" if seconds_left is None else f", {in_words(seconds_left)} left"
    return f"{'█' * filled}{'░' * (BAR - filled)} {done} of {wanted}{more}{left}"


class Progress:
    """Shows what `show` is given behind the text that stands on the line already."""

    def __init__(self, stream=None):
        self._stream = stream or sys.stdout
        self._screen = self._stream.isatty()
        self._shown = ""
        self._at = time.monotonic()

    def show(self, text: str) -> None:
        now = time.monotonic()
        if now - self._at < (ON_A_SCREEN if self._screen else IN_A_LOG) or text == self._shown:
            return
        self._erase()
        self._stream.write(text if self._screen else f"{text} … ")
        self._stream.flush()
        self._shown, self._at = text, now

    def end(self) -> None:
        """Leaves the line as it was before; a log keeps its words."""
        self._erase()
        self._shown = ""

    def _erase(self) -> None:
        if self._screen and self._shown:
            back = "\b" * len(self._shown)
            self._stream.write(back + " " * len(self._shown) + back)
            self._stream.flush()


@contextmanager
def watching(measure: Callable[[], str], interval: float = 0.5) -> Iterator[None]:
    """Shows what `measure` says while the body runs."""
    progress, over = Progress(), Event()

    def watch() -> None:
        while not over.wait(interval):
            progress.show(measure())

    thread = Thread(target=watch, daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()
        progress.end()
