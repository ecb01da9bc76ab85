"""One queue of what the suites have to run: what takes longest begins first, so that both processors have work until the end.

How long each job took in the last run of all tests is in build/test_times.json. One that has never run begins first.
"""

import json
import os
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass

from setup import cache
from testing.results import Result

PROCESSORS = len(os.sched_getaffinity(0))
# Tests of Godot and of the tools wait for clocks and processes most of their time: more of them run at once than there
# are processors.
AT_A_TIME = {"format": 1, "cpp": PROCESSORS, "godot": PROCESSORS + 1, "python": PROCESSORS + 1}
ALL_AT_A_TIME = PROCESSORS + 4

_TIMES = cache.clone() / "build/test_times.json"


@dataclass(frozen=True)
class Job:
    """Tests that run one after another. `name` is the same in every run."""

    suite: str  # a key of AT_A_TIME
    name: str
    run: Callable[[], list[Result]]


@dataclass(frozen=True)
class Done:
    results: list[Result]
    times: dict[str, float]  # by the names of the jobs (unit: seconds)


def carry_out(jobs: list[Job], known: dict[str, float], ended: Callable[[str, list[Result]], None] = lambda *_: None) -> Done:
    """`known`: how long jobs have taken before, by their names. `ended` is called with a suite and its results when its
    last job is done."""
    waiting = sorted(jobs, key=lambda job: known.get(job.name, float("inf")), reverse=True)
    left = Counter(job.suite for job in jobs)
    found: dict[str, list[Result]] = {suite: [] for suite in left}
    times: dict[str, float] = {}
    running: dict[Future[tuple[list[Result], float]], Job] = {}
    with ThreadPoolExecutor(ALL_AT_A_TIME) as pool:
        while waiting or running:
            while job := next_of(waiting, list(running.values())):
                waiting.remove(job)
                running[pool.submit(_timed, job)] = job
            for one in wait(running, return_when=FIRST_COMPLETED).done:
                job = running.pop(one)
                results, times[job.name] = one.result()
                found[job.suite] += results
                left[job.suite] -= 1
                if left[job.suite] == 0:
                    ended(job.suite, found[job.suite])
    return Done([result for results in found.values() for result in results], times)


def next_of(waiting: list[Job], running: list[Job]) -> Job | None:
    """The first for which its suite and all suites together have room."""
    if len(running) >= ALL_AT_A_TIME:
        return None
    count = Counter(job.suite for job in running)
    return next((job for job in waiting if count[job.suite] < AT_A_TIME[job.suite]), None)


def known_times() -> dict[str, float]:
    try:
        return json.loads(_TIMES.read_text())
    except (OSError, ValueError):
        return {}


def keep_times(times: dict[str, float]) -> None:
    _TIMES.parent.mkdir(parents=True, exist_ok=True)
    _TIMES.write_text(json.dumps(times, indent=1))


def _timed(job: Job) -> tuple[list[Result], float]:
    began = time.monotonic()
    return job.run(), time.monotonic() - began
