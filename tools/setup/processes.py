"""What a command has started ends with it, however it ends.

The command's work runs in a process of its own, which is told when this one is asked to end. What is left of its
descendants then, wherever they have gone, is asked to end and, where it does not, ended.
"""

import ctypes
import os
import signal
import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

PATIENCE = 10.0  # of who is asked to end (unit: seconds)
# <linux/prctl.h>
_PR_SET_PDEATHSIG, _PR_SET_CHILD_SUBREAPER = 1, 36
_ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def kept(work: Callable[[], int]) -> int:
    """The exit code of `work`, which is done in a child of this process; nothing that it has started is left then."""
    if sys.platform != "linux":
        return work()
    _prctl(_PR_SET_CHILD_SUBREAPER, 1)  # whose parent ends becomes a child of this one
    sys.stdout.flush()
    keeper = os.getpid()
    # The child may be at work before this process is scheduled again: no signal may come until it can be passed on.
    signal.pthread_sigmask(signal.SIG_BLOCK, _ENDING)
    child = os.fork()
    if child == 0:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _ENDING)
        _prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
        _prctl(_PR_SET_CHILD_SUBREAPER, 1)
        _leave_with(work if os.getppid() == keeper else lambda: 1)
    for number in _ENDING:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, lambda number, _: _signal(child, number))
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _ENDING)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    for number in _ENDING:
        signal.signal(number, signal.SIG_IGN)
    end_descendants()
    return code if code >= 0 else 128 - code


def _leave_with(work: Callable[[], int]) -> None:
    """Ends this process with the exit code of `work`, whatever threads it has left behind."""
    code = 1
    try:
        code = work()
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 1
    except BaseException:
        traceback.print_exc()
    finally:
        try:
            end_descendants()
            sys.stdout.flush()
            sys.stderr.flush()
        finally:
            os._exit(code)


@contextmanager
def started(command: list, **options) -> Iterator[subprocess.Popen]:
    """A program that is asked to end where the body does not come to its own end, with all that it has started, as a terminal
    does it. Then it has the time to do so: SCons writes down what is built when its compilers have ended."""
    with subprocess.Popen(command, **options) as process:
        try:
            yield process
        except BaseException:
            for pid in descendants():
                _signal(pid, signal.SIGTERM)
            try:
                process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()
            raise


def run(command: list, **options) -> int:
    """The exit code of a program that has the time to end by itself when this one is asked to end."""
    with started(command, **options) as process:
        return process.wait()


def run_to_its_end(command: list) -> int:
    """The same of a program that knows itself when it may be ended: it is asked to, and waited for."""
    with subprocess.Popen(command) as process:
        try:
            return process.wait()
        except BaseException:
            process.terminate()
            process.wait()
            raise


def await_descendants() -> None:
    """Until all have ended that this process has started, or that these have."""
    while descendants():
        time.sleep(0.2)
        _reap()


def end_descendants() -> None:
    """Asks them to end, and ends them where they do not."""
    asked: set[int] = set()
    until = time.monotonic() + PATIENCE
    while (left := descendants()) and time.monotonic() < until + PATIENCE:
        for pid in left:
            if time.monotonic() > until:
                _signal(pid, signal.SIGKILL)
            elif pid not in asked:
                _signal(pid, signal.SIGTERM)
        asked |= set(left)
        time.sleep(0.02)
        _reap()


def descendants() -> list[int]:
    """Processes that this one, or one of them, is the parent of, and that have not ended."""
    parents = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            # PID (NAME) STATE PARENT …, where NAME may hold anything.
            state, parent, *_ = path.read_text(errors="replace").rpartition(")")[2].split()
        except OSError:  # it has ended meanwhile
            continue
        if state not in "ZX":
            parents[int(path.parent.name)] = int(parent)
    found = {os.getpid()}
    while more := {pid for pid, parent in parents.items() if parent in found} - found:
        found |= more
    return sorted(found - {os.getpid()})


def _signal(pid: int, number: int) -> None:
    try:
        os.kill(pid, number)
    except (ProcessLookupError, PermissionError):
        pass  # it has ended, or belongs to another user


def _reap() -> None:
    """Children that have come from others, and have ended."""
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        pass


def _prctl(option: int, value: int) -> None:
    ctypes.CDLL(None).prctl(option, value, 0, 0, 0)
