"""The folder of results of a run: what was there before stays until what is new is whole.

A run writes into NAME.partial, which becomes NAME when all of it is there. A run that fails or is killed leaves its
NAME.partial, and NAME as it was; one that is refused leaves nothing. Each run locks its NAME; one that finds it locked
is called NAME_2, NAME_3, …
"""

import fcntl
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path

from measuring.options import Refused


class Output:
    """`folder` is where to write; `keep` makes it the results, and returns where they are."""

    def __init__(self, place: Path, name: str):
        self.name = name
        self.folder = place / f"{name}.partial"
        self._whole = place / name
        self._former = place / f"{name}.former"

    def begin(self) -> None:
        if self._former.is_dir() and not self._whole.exists():  # killed while the one took the place of the other
            self._former.rename(self._whole)
        for left in (self._former, self.folder):
            if left.exists():
                shutil.rmtree(left)
        self.folder.mkdir(parents=True)

    def keep(self) -> Path:
        _to_disk(self.folder)
        if self._whole.exists():
            self._whole.rename(self._former)
        self.folder.rename(self._whole)
        shutil.rmtree(self._former, ignore_errors=True)
        return self._whole


@contextmanager
def output(place: Path, name: str) -> Iterator[Output]:
    """Of a run called `name` in the folder `place`, where it is alone with its name until it ends."""
    locks = place / ".locks"
    try:
        locks.mkdir(parents=True, exist_ok=True)
        for number in count(1):
            called = name if number == 1 else f"{name}_{number}"
            with open(locks / called, "w") as file:
                if not _lock(file.fileno()):
                    continue
                if number > 1:
                    print(f"{name} is being played already: this run is called {called}", flush=True)
                found = Output(place, called)
                found.begin()
                try:
                    yield found
                except Refused:
                    shutil.rmtree(found.folder, ignore_errors=True)
                    raise
                return
    except PermissionError as error:
        raise RuntimeError(f"{error.filename or place} may not be written to: results go to {place}") from None


def _lock(file: int) -> bool:
    """The system lets go when its holder dies."""
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _to_disk(folder: Path) -> None:
    """What a disk has refused only now is an OSError here."""
    for path in folder.rglob("*"):
        if path.is_file():
            with open(path, "rb") as file:
                os.fsync(file.fileno())
