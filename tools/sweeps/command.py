"""./run experiment SWEEPFILE [--cluster=ADDRESS] [--workers=N]: plays what is missing of a sweep, then its table and report.

Everything is in build/sweeps/NAME of the file's name: runs/ (one file a run), sweep.csv, sweep.json (what was asked),
report.html and the figures beside it. A file of the same name in another folder has a NAME with a number of its own.
"""

import dataclasses
import json
import os
import sys
import time
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from measuring import columns, options
from setup import cache
from setup.progress import Progress, bar
from sweeps import description, playing, results, sources, table
from sweeps.description import Run, Sweep

OWNER = "described_by.txt"  # has the path of the file that describes the sweep


@dataclass(frozen=True)
class Settings:
    cluster: str = options.text()  # address of a Dask scheduler; none: processes of this machine
    workers: int = options.option(0, "count", 0, 1024)  # how many of them; 0: one for each processor


def run(path: Path, given: dict[str, str], experiments: list[str]) -> int:
    settings = options.parse(Settings, given)
    sweep = description.read(path, experiments)
    place = cache.clone() / "build/sweeps"
    with cache.lock(cache.clone() / "build", "sweep names"):
        folder = owned(place, path)
    with cache.lock(cache.clone() / "build", f"sweep {folder.name}"):
        return play(sweep, folder, settings)


def owned(place: Path, path: Path) -> Path:
    """The folder of the sweep that `path` describes, and of no other."""
    for number in count(1):
        folder = place / (path.stem if number == 1 else f"{path.stem}_{number}")
        owner = folder / OWNER
        if not owner.is_file():
            results.write_whole(owner, f"{path.resolve()}\n")
        if owner.read_text() == f"{path.resolve()}\n":
            return folder
    raise AssertionError


def play(sweep: Sweep, folder: Path, settings: Settings, arrived=lambda _: None) -> int:
    """`arrived` is called with the count of runs after each."""
    runs = sweep.runs()
    found = results.read(folder / "runs", runs, sources.digest())
    print(f"{len(runs)} runs of {sweep.experiment}, {len(found.summaries)} of them done before", flush=True)
    for name in found.damaged:
        print(f"{folder / 'runs' / name} is damaged: that run is played again", flush=True)
    if found.outdated:
        print(f"{found.outdated} are of other sources of Tactus: they are played again", flush=True)
    _check_measures(sweep, found.summaries)
    missing = [one for one in runs if one.identity not in found.summaries]
    failed = _Arrivals(sweep, folder, found, len(runs), arrived).collect(missing, settings) if missing else []
    for problem in failed:
        print(problem, file=sys.stderr)
    _write(sweep, folder, runs, found, failed)
    return 1 if failed else 0


class _Arrivals:
    def __init__(self, sweep: Sweep, folder: Path, found: results.Found, count: int, arrived):
        self._sweep, self._folder, self._found, self._count, self._arrived = sweep, folder, found, count, arrived
        self._failed: list[str] = []
        self._progress = Progress()
        self._started, self._before = time.monotonic(), len(found.summaries)

    def collect(self, missing: list[Run], settings: Settings) -> list[str]:
        """Why runs have failed."""
        try:
            playing.play(missing, self._take, settings.cluster, settings.workers)
        except RuntimeError as error:
            raise RuntimeError(f"{error}\n{self._kept()}") from None
        except KeyboardInterrupt:
            self._progress.end()
            print(f"\n{self._kept()}", file=sys.stderr)
            raise
        finally:
            self._progress.end()
        return self._failed

    def _take(self, run: Run, summary: results.Summary | None, problem: str) -> None:
        if summary is None:
            self._failed.append(f"{run}: {problem}")
        else:
            results.write(self._folder / "runs", run, sources.digest(), summary)
            self._found.summaries[run.identity] = summary
            _check_measures(self._sweep, {run.identity: summary})
        self._progress.show(self._bar())
        self._arrived(len(self._found.summaries))

    def _bar(self) -> str:
        done = len(self._found.summaries)
        played, left = done - self._before, self._count - done - len(self._failed)
        seconds = (time.monotonic() - self._started) / max(played, 1) * left
        failed = f", {len(self._failed)} failed" if self._failed else ""
        return bar(done, self._count, seconds, failed)

    def _kept(self) -> str:
        return f"{len(self._found.summaries)} of {self._count} runs are kept: the same command goes on from there"


def _check_measures(sweep: Sweep, summaries: dict[str, results.Summary]) -> None:
    for summary in list(summaries.values())[:1]:
        numbers = [key for key, value in summary.items() if isinstance(value, (int, float))]
        for measure in sweep.measures:
            if measure not in numbers:
                raise RuntimeError(f"{sweep.experiment} has no figure {measure!r}; near it: {description.like(measure, numbers)}")


def _clear(folder: Path, written: set[str]) -> None:
    """What is left of before is not of this sweep."""
    for path in folder.glob("*"):
        if path.is_file() and path.name not in written:
            path.unlink()


def _write(sweep: Sweep, folder: Path, runs: list[Run], found: results.Found, failed: list[str]) -> None:
    from plots import sweep as plots
    from sweeps import effects, report

    rows = table.rows(sweep, runs, found.summaries)
    results.write_whole(folder / "sweep.json", json.dumps(dataclasses.asdict(sweep), indent=2) + "\n")
    results.write_whole(folder / "sweep.csv", table.text(rows))
    print(_shown(folder / "sweep.csv"))
    results.write_whole(folder / "effects.csv", table.lines(effects.HEAD, effects.rows(sweep, rows)))
    columns.write(folder)
    written = {OWNER, "sweep.json", "sweep.csv", "effects.csv", columns.FILE}
    if rows:
        pictures = {measure: plots.draw(sweep, rows, measure, folder / measure) for measure in sweep.measures}
        written |= {"report.html", *(path.name for paths in pictures.values() for path in paths)}
        results.write_whole(folder / "report.html", report.page(sweep, rows, len(runs), sources.digest(), pictures, failed))
        print(_shown(folder / "report.html"))
    _clear(folder, written)


def _shown(path: Path) -> str:
    return os.path.relpath(path)
