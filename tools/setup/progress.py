"""How far a long step is: a line that is rewritten on a terminal, a word now and then in a log."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Thread

IN_A_LOG = 15.0  # between two words (unit: seconds)
ON_A_SCREEN = 0.2


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
