"""How a command of the front door ends: with an exit code, and where it fails with what to do in place of a trace.

0 it is done; 1 it failed; 2 what was asked for cannot be (USAGE), and nothing was changed; 128 + N a signal N ended it.
"""

import errno
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from measuring.options import Refused

USAGE = 2
ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Ended(KeyboardInterrupt):
    """A signal asks the program to end: what is open is closed on the way out."""

    def __init__(self, number: int):
        super().__init__()
        self.code = 128 + number


def leave(main: Callable[[list[str]], int]) -> None:
    sys.exit(ended(lambda: main(sys.argv[1:])))


def ended(work: Callable[[], int]) -> int:
    """The exit code of `work`; where it cannot go on, the reason is on stderr."""
    for number in ENDING:
        # Who starts it with nohup, or in the background, wants it to go on.
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, _end)
    try:
        return work()
    except OSError as error:
        print(in_words(error), file=sys.stderr)
        return 1
    except Refused as error:
        print(error, file=sys.stderr)
        return USAGE
    except (RuntimeError, ValueError, subprocess.SubprocessError) as error:
        print(error, file=sys.stderr)
        return 1
    except Ended as end:
        return end.code


def in_words(error: OSError) -> str:
    """One line: what could not be done, and what to do."""
    if isinstance(error, shutil.Error):
        error = _first_of(error)
    place = error.filename2 or error.filename
    if error.errno == errno.ENOSPC:
        return f"The disk is full{_free(place)}. Make room and start the same command again: it goes on from there."
    if error.errno == errno.EFBIG:
        return f"{place or 'A file'} would be longer than this user may write. Raise ulimit -f and start the same command again."
    if error.errno in (errno.EROFS, errno.EACCES, errno.EPERM) and place:
        return (
            f"{place} cannot be written by this user. Make it writable; where the clone is read-only, copy it; where the cache is,"
            " name another folder in XDG_CACHE_HOME."
        )
    if error.errno == errno.EBUSY and place:
        return f"{place} is in use by the system, perhaps as a mount point: it cannot be replaced. Unmount it."
    return f"{place}: {error.strerror}" if place else str(error)


def _first_of(error: shutil.Error) -> OSError:
    """Of many files that could not be copied: a list of (from, to, the error in words)."""
    _, target, why = error.args[0][0]
    number = re.match(r"\[Errno (\d+)\]", str(why))
    return OSError(int(number[1]), os.strerror(int(number[1])), str(target)) if number else OSError(f"{target}: {why}")


def _free(place: object) -> str:
    if not isinstance(place, (str, os.PathLike)):
        return ""
    folder = Path(place).absolute()
    while not folder.exists():
        folder = folder.parent
    return f": {shutil.disk_usage(folder).free / 1e6:.0f} MB are free where {place} is"


def _end(number: int, _: object) -> None:
    for other in ENDING:
        signal.signal(other, signal.SIG_IGN)  # the way out is not interrupted
    raise Ended(number)
