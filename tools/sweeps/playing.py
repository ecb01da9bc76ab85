"""Runs of a sweep in parallel processes: Dask's workers, on this machine or on all that have joined a scheduler.

A run that a dying worker has taken along is given to another one, by Dask. What arrives here is written at once.
"""

import asyncio
import contextlib
import importlib
import io
import logging
import os
import signal
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import resource_tracker
from pathlib import Path

from sweeps import sources
from sweeps.description import Run
from sweeps.results import Summary

PATIENCE = 30.0  # for a scheduler, and for a first worker (unit: seconds)
# Runs that wait in the scheduler at once: none of its workers is idle, however many have joined meanwhile.
AHEAD = 1000

Arrived = Callable[[Run, Summary | None, str], None]  # the summary, or why there is none


def play(runs: list[Run], arrived: Arrived, cluster: str = "", workers: int = 0) -> None:
    """Calls `arrived` for each run, in the order in which they end."""
    from distributed import as_completed

    with _client(cluster, workers) as client:
        _refuse_other_sources(client)
        left = iter(runs)
        of_future = {}

        def submit() -> list:
            run = next(left, None)
            if run is None:
                return []
            future = client.submit(carry_out, run, sources.digest(), pure=False)
            of_future[future.key] = run
            return [future]

        under_way = as_completed([future for _ in range(AHEAD) for future in submit()])
        for future in under_way:
            run = of_future.pop(future.key)
            summary, problem = _outcome(future)
            arrived(run, summary, problem)
            under_way.update(submit())


def carry_out(run: Run, wanted_sources: str) -> Summary:
    """On a worker. Files that the experiment writes are its own matter, and go with it."""
    if sources.digest() != wanted_sources:
        raise RuntimeError("the worker has other sources of Tactus than who started the sweep")
    said = io.StringIO()
    with tempfile.TemporaryDirectory(prefix="tactus-") as folder, contextlib.redirect_stdout(said):
        return importlib.import_module(f"experiments.{run.experiment}").run(dict(run.options), Path(folder))


def _outcome(future) -> tuple[Summary | None, str]:
    if future.status == "finished":
        try:
            return future.result(), ""
        except Exception as error:  # lost on its way: its worker died with it, and no other could be had
            return None, _in_words(error)
    if future.status == "error":
        return None, _in_words(future.exception())
    raise RuntimeError("the scheduler has gone")


def _in_words(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


@contextlib.contextmanager
def _client(cluster: str, workers: int) -> Iterator:
    from distributed import Client

    if not cluster:
        with _processes(workers or os.cpu_count() or 1) as local, Client(local) as client:
            yield client
        return
    try:
        client = Client(cluster, timeout=PATIENCE)
    except (OSError, ValueError, asyncio.TimeoutError) as error:
        raise RuntimeError(f"no Dask scheduler answers at {cluster} ({_in_words(error)}); docs/experiments.md says how one is started") from None
    with client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except asyncio.TimeoutError:
            raise RuntimeError(f"no worker has joined {cluster}: docs/experiments.md says how one does") from None
        yield client


@contextlib.contextmanager
def _processes(count: int) -> Iterator:
    """Workers on this machine. One that dies is restarted without a word: its run goes to another one."""
    from distributed import LocalCluster

    # A cluster that is half there cannot be closed, so an interrupt waits for the rest of it, in another thread. The threads
    # and processes that this one starts inherit its signal mask: a terminal's interrupt reaches this program alone.
    resource_tracker.ensure_running()  # it unblocks the interrupt in the thread that starts it
    with ThreadPoolExecutor(1, initializer=signal.pthread_sigmask, initargs=(signal.SIG_BLOCK, {signal.SIGINT})) as starter:
        starting = starter.submit(LocalCluster, n_workers=count, threads_per_worker=1, dashboard_address="127.0.0.1:0", silence_logs=logging.CRITICAL + 1)
        try:
            local = starting.result()
        except KeyboardInterrupt:
            starting.result().close()
            raise
    with local:
        yield local


def _refuse_other_sources(client) -> None:
    found = client.run(sources.digest, on_error="return")
    for worker, word in found.items():
        if isinstance(word, BaseException):
            raise RuntimeError(f"the worker {worker} has no Tactus: start it with PYTHONPATH=tools ({_in_words(word)})")
        if word != sources.digest():
            raise RuntimeError(f"the worker {worker} has other sources of Tactus ({word}) than this clone ({sources.digest()})")
