"""Sweeps: what is asked is checked, what is done is kept, and however the runs are spread, the rows are the same."""

import importlib
import json
import math
import os
import random
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import experiment
import pytest

import plots.sweep
from measuring import options
from plots import style
from setup import cache
from sweeps import command, description, effects, playing, results, sources, statistics, table
from sweeps.command import Settings
from sweeps.description import Sweep

# 100 runs: the hand is at the box from the start, half a second long.
DESCRIPTION = {
    "experiment": "linked_touch",
    "measures": ["force_error_mean_N"],
    "seeds": [3, 1, 4, 5, 9],
    "options": {"seconds": 0.5, "hand_shift": 0.005, "mass": 1.2, "jitter": 3},
    "factors": {"way": ["traditional", "default"], "delay": [0, 10, 20, 50, 100], "loss": [0, 0.2]},
}
SMALL = DESCRIPTION | {"seeds": [1, 2], "factors": {"delay": [0, 20, 50]}}


def described(given: dict, folder: Path, name: str = "sweep.json") -> Sweep:
    path = folder / name
    path.write_text(json.dumps(given))
    return description.read(path, experiment.names())


def alone(sweep: Sweep) -> str:
    """The table of the same runs, one after another, without anything of a sweep."""
    play = importlib.import_module(f"experiments.{sweep.experiment}").run
    folder = cache.clone() / "build/sweeps/alone"
    summaries = {run.identity: play(dict(run.options), folder) for run in sweep.runs()}
    return table.text(table.rows(sweep, sweep.runs(), summaries))


@pytest.fixture(scope="module")
def hundred(tmp_path_factory) -> tuple[Sweep, str]:
    sweep = described(DESCRIPTION, tmp_path_factory.mktemp("hundred"))
    assert len(sweep.runs()) == 100
    return sweep, alone(sweep)


@pytest.fixture(scope="module")
def six(tmp_path_factory) -> tuple[Sweep, str]:
    sweep = described(SMALL, tmp_path_factory.mktemp("six"))
    return sweep, alone(sweep)


@contextmanager
def cluster(folder: Path, workers: int) -> Iterator[tuple[str, list[subprocess.Popen]]]:
    """A scheduler and workers by the commands of docs/experiments.md, but that nobody restarts a worker that dies."""
    said = folder / "scheduler.json"
    scheduler, worker = re.findall(r"^.*bin/dask .*$", (cache.clone() / "docs/experiments.md").read_text(), re.MULTILINE)

    def started(command: str, *words: object) -> subprocess.Popen:
        command = command.replace("~/.cache/tactus/venv/bin/dask", str(cache.venv_bin("dask")))
        return subprocess.Popen(
            ["bash", "-c", f"exec env {command} {' '.join(map(str, words))}"],
            cwd=cache.clone(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip

    running = [started(scheduler, "--host 127.0.0.1 --port 0 --scheduler-file", said)]
    try:
        while not said.is_file() or not said.read_text():
            assert running[0].poll() is None
            time.sleep(0.05)
        address = json.loads(said.read_text())["address"]
        here = worker.replace("tcp://SCHEDULER:8786", address).replace("--nworkers auto", "--no-nanny")
        running += [started(here) for _ in range(workers)]
        yield address, running[1:]
    finally:
        for one in reversed(running):
            one.kill()
        for one in running:
            one.wait()


@pytest.fixture(scope="module")
def running(tmp_path_factory) -> Iterator[Settings]:
    """A cluster of two workers, which takes longer to start than most sweeps here to play."""
    with cluster(tmp_path_factory.mktemp("cluster"), 2) as (address, _):
        yield Settings(cluster=address)


def test_a_cluster_of_two_workers_gives_the_rows_of_the_sweep_alone(hundred, running, tmp_path):
    sweep, expected = hundred
    assert command.play(sweep, tmp_path / "out", running) == 0
    assert (tmp_path / "out/sweep.csv").read_text() == expected
    rows = expected.splitlines()
    assert len(rows) == 101 and rows[0].startswith("run,way,delay_ms,loss_share,seed,")
    assert len({row.split(",", 1)[1] for row in rows}) == 101


def test_a_worker_killed_in_the_middle_changes_nothing(hundred, tmp_path):
    sweep, expected = hundred
    with cluster(tmp_path, 2) as (address, workers):

        def kill(done: int) -> None:
            if done == 30:
                workers[0].kill()

        assert command.play(sweep, tmp_path / "out", Settings(cluster=address), kill) == 0
        assert workers[0].wait() == -signal.SIGKILL
    assert (tmp_path / "out/sweep.csv").read_text() == expected


def test_a_killed_sweep_leaves_nothing_half_and_goes_on(hundred, tmp_path, monkeypatch):
    sweep, expected = hundred
    given = tmp_path / "sweep.json"
    given.write_text(json.dumps(DESCRIPTION))
    program = (
        "import sys; from pathlib import Path; from sweeps import command, description; import experiment\n"
        "if __name__ == '__main__':\n"
        "    sweep = description.read(Path(sys.argv[1]), experiment.names())\n"
        "    command.play(sweep, Path(sys.argv[2]), command.Settings(workers=2))\n"
    )
    script = tmp_path / "play.py"
    script.write_text(program)
    environment = os.environ | {"PYTHONPATH": str(cache.clone() / "tools")}
    folder = tmp_path / "out"
    running = subprocess.Popen([sys.executable, script, given, folder], env=environment, stdout=subprocess.PIPE, start_new_session=True)
    while len(list((folder / "runs").glob("*.json"))) < 20:
        assert running.poll() is None
        time.sleep(0.01)
    running.kill()
    running.wait()
    kept = {path.stem for path in (folder / "runs").glob("*.json")}
    assert 20 <= len(kept) < 100 and not (folder / "sweep.csv").exists()
    played = []
    carry_on = playing.play
    monkeypatch.setattr(playing, "play", lambda runs, *rest: (played.extend(runs), carry_on(runs, *rest)))
    assert command.play(sweep, folder, Settings(workers=2)) == 0
    assert {run.identity for run in played} == {run.identity for run in sweep.runs()} - kept
    assert (folder / "sweep.csv").read_text() == expected


@pytest.mark.parametrize("seconds", [0.5, 1.0, 1.5, 2.0])
def test_an_interrupt_while_the_workers_start_ends_them_without_a_trace(seconds, tmp_path):
    """As a terminal sends it: to the program and to all that it has started."""
    given, script = tmp_path / "sweep.json", tmp_path / "play.py"
    given.write_text(json.dumps(DESCRIPTION))
    script.write_text(
        "import sys; from pathlib import Path; from sweeps import command, description; import entry, experiment\n"
        "if __name__ == '__main__':\n"
        "    sweep = description.read(Path(sys.argv[1]), experiment.names())\n"
        "    entry.leave(lambda _: command.play(sweep, Path(sys.argv[2]), command.Settings(workers=2)))\n"
    )
    environment = os.environ | {"PYTHONPATH": str(cache.clone() / "tools")}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    running = subprocess.Popen([sys.executable, script, given, tmp_path / "out"], env=environment, start_new_session=True, **pipes)
    assert "0 of them done before" in running.stdout.readline()
    time.sleep(seconds)
    os.killpg(running.pid, signal.SIGINT)
    # A pipe ends when the last process that has it does: nothing is left running.
    _, said = running.communicate(timeout=120)
    assert running.returncode == 128 + signal.SIGINT
    assert re.fullmatch(r"(.*\r)?\s*\d+ of 100 runs are kept: the same command goes on from there\n", said), said


def test_what_is_done_is_kept_when_a_level_is_added(six, running, tmp_path, monkeypatch):
    sweep, expected = six
    assert command.play(sweep, tmp_path / "out", running) == 0
    assert (tmp_path / "out/sweep.csv").read_text() == expected
    played = []
    monkeypatch.setattr(playing, "play", lambda runs, *_: played.extend(runs))
    command.play(sweep, tmp_path / "out", Settings())
    assert not played
    more = described(SMALL | {"factors": {"delay": [0, 20, 35, 50]}}, tmp_path)
    command.play(more, tmp_path / "out", Settings())
    assert [run.options["delay"] for run in played] == ["35", "35"]


def test_a_damaged_and_a_partly_written_result_are_told_and_played_again(six, running, tmp_path, capsys):
    sweep, expected = six
    folder = tmp_path / "out"
    assert command.play(sweep, folder, running) == 0
    first, second, third, *_ = sorted((folder / "runs").glob("*.json"))
    first.write_text(first.read_text()[:200])
    second.write_text(re.sub(r'("force_error_mean_N": \d*\.?)\d', r"\g<1>7", second.read_text()))
    third.write_text("[]")
    (folder / "runs/0123.partial").write_text('{"check"')
    capsys.readouterr()
    assert command.play(sweep, folder, running) == 0
    told = capsys.readouterr().out
    assert all(f"{path} is damaged" in told for path in (first, second, third, folder / "runs/0123.partial"))
    assert "3 of them done before" in told
    assert (folder / "sweep.csv").read_text() == expected
    assert not list((folder / "runs").glob("*.partial"))


def test_a_result_of_other_sources_is_told_and_not_mixed_in(six, tmp_path, capsys):
    sweep, _ = six
    run = sweep.runs()[0]
    results.write(tmp_path / "runs", run, "of yesterday", {"force_error_mean_N": 5.0})
    found = results.read(tmp_path / "runs", sweep.runs(), sources.digest())
    assert (found.outdated, found.summaries, found.damaged) == (1, {}, [])


def test_a_run_that_fails_is_told_and_the_others_are_kept(running, tmp_path, capsys):
    sweep = described(SMALL | {"seeds": [1], "factors": {"set": ["", "nonsense=1"]}}, tmp_path)
    assert command.play(sweep, tmp_path / "out", running) == 1
    assert "--set=nonsense=1" in (told := capsys.readouterr().err) and "nonsense=1 is " in told
    assert len((tmp_path / "out/sweep.csv").read_text().splitlines()) == 2
    assert "What is missing" in (tmp_path / "out/report.html").read_text()
    assert len(list((tmp_path / "out/runs").glob("*"))) == 1


def test_a_figure_that_there_is_not_is_told_at_once(tmp_path):
    sweep = described(SMALL | {"measures": ["force_error_N"]}, tmp_path)
    with pytest.raises(RuntimeError, match="no figure 'force_error_N'; near it: .*force_error_m"):
        command.play(sweep, tmp_path / "out", Settings(workers=1))


def test_nobody_at_the_address_is_told(six, tmp_path, monkeypatch):
    monkeypatch.setattr(playing, "PATIENCE", 0.5)
    with pytest.raises(RuntimeError, match="no Dask scheduler answers at tcp://127.0.0.1:1 .*docs/experiments.md says how one is started"):
        command.play(six[0], tmp_path / "out", Settings(cluster="tcp://127.0.0.1:1"))


class _Cluster:
    def __init__(self, answer: object):
        self._answer = answer

    def run(self, *_, **__) -> dict[str, object]:
        return {"tcp://there:1": self._answer}


@pytest.mark.parametrize(("answer", "why"), [("abc", "has other sources"), (ModuleNotFoundError("sweeps"), "PYTHONPATH=tools")])
def test_a_worker_that_has_not_the_same_sources_is_refused(answer, why):
    with pytest.raises(RuntimeError, match=f"tcp://there:1 .*{why}"):
        playing._refuse_other_sources(_Cluster(answer))


def test_a_worker_that_joins_later_is_refused_too(six):
    with pytest.raises(RuntimeError, match="other sources"):
        playing.carry_out(six[0].runs()[0], "abc")


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"experiment": "nothing"}, "'nothing' is none of .*linked_touch"),
        ({"measure": []}, "unknown key 'measure'.*measures"),
        ({"measures": []}, "measures = .* must name"),
        ({"factors": {"delay": []}}, "factors.delay must be a list"),
        ({"factors": {"delay": 5}}, "factors.delay must be a list"),
        ({"factors": {"delay": [1, 1]}}, "factors.delay has a level twice"),
        ({"factors": {"delay": [50, "50.0"]}}, "factors.delay has a level twice"),
        ({"factors": {"delay": ["far"]}}, "--delay=far is refused: it must be a number from 0 to 10000 .ms"),
        ({"factors": {"delays": [5]}}, "unknown option --delays"),
        ({"factors": {"way": ["default", "best"]}}, "--way=best is refused .*one of default"),
        ({"factors": {"delay": [[5]]}}, "neither a number nor a text"),
        ({"factors": {"seconds": [5]}}, "seconds is an option of all runs and a factor"),
        ({"factors": {"seed": [5]}}, "seed: say repeats"),
        ({"factors": []}, "factors must be a table"),
        ({"repeats": 3}, "one of them"),
        ({"seeds": [1.5]}, "whole numbers"),
        ({"seeds": [1, 1]}, "seeds has a level twice"),
        ({"seeds": list(range(200_000))}, "are more than 100000"),
        ({"experiment": "scenario3", "options": {}, "factors": {"seconds": [5]}}, "scenario3 has no --seed"),
        ({"x": "loss"}, "'loss' is drawn, but is none of the factors delay"),
        ({"x": "delay", "lines": "delay"}, "three different factors"),
    ],
)
def test_a_description_that_cannot_be_carried_out_says_why(change, why, tmp_path):
    with pytest.raises(ValueError, match=f"sweep.json: .*{why}"):
        described(SMALL | change, tmp_path)


def test_what_is_no_file_or_not_in_its_form_is_told(tmp_path):
    with pytest.raises(ValueError, match="cannot be read: No such file"):
        description.read(tmp_path / "none.toml", experiment.names())
    (tmp_path / "half.toml").write_text("experiment = ")
    with pytest.raises(ValueError, match="not in the form its ending promises"):
        description.read(tmp_path / "half.toml", experiment.names())


def test_what_is_drawn_where_nothing_is_said(tmp_path):
    assert described(DESCRIPTION, tmp_path).drawn == ("delay", "loss", "way")
    assert described(DESCRIPTION | {"lines": "delay"}, tmp_path).drawn == ("loss", "delay", "way")
    assert described(SMALL, tmp_path).drawn == ("delay",)


# Tables of Student's distribution, two-sided 95 %.
@pytest.mark.parametrize(("freedom", "t"), [(1, 12.706), (2, 4.303), (4, 2.776), (5, 2.571), (10, 2.228), (30, 2.042), (100, 1.984)])
def test_the_confidence_of_a_mean(freedom, t):
    assert statistics.student_t(0.95, freedom) == pytest.approx(t, abs=6e-4)


def test_a_mean_and_its_interval():
    assert statistics.mean_and_interval([1.0, 2.0, 3.0]) == (2.0, pytest.approx(4.303 / 3**0.5, abs=1e-3))
    mean, half = statistics.mean_and_interval([4.0])
    assert mean == 4.0 and half != half


def test_figures_are_the_same_bytes_each_time_in_every_form(tmp_path):
    sweep = described(DESCRIPTION, tmp_path)
    summaries = {run.identity: {"force_error_mean_N": 0.01 * number} for number, run in enumerate(sweep.runs())}
    rows = table.rows(sweep, sweep.runs(), summaries)
    first, second = (plots.sweep.draw(sweep, rows, "force_error_mean_N", tmp_path / name) for name in ("first", "second"))
    assert [path.suffix for path in first] == [".png", ".svg", ".pdf"]
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]


def test_lines_are_told_apart_in_grey():
    looks = style.told_apart(5)
    greys = [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b, _ in (look["color"] for look in looks)]
    assert greys == sorted(greys) and min(b - a for a, b in zip(greys, greys[1:])) > 0.08
    assert len({look["marker"] for look in looks}) == len({str(look["linestyle"]) for look in looks}) == 5


@pytest.mark.parametrize("more", [{"options": {"seconds": True}}, {"factors": {"delay": [True, 50]}}, {"factors": {"way": [True]}}])
def test_true_is_no_number(more, tmp_path):
    with pytest.raises(options.Refused, match="= true is refused: it must be"):
        described(DESCRIPTION | more, tmp_path)
    assert described(DESCRIPTION | {"options": {"rows": False}}, tmp_path).options["rows"] == "0"


def test_an_effect_has_its_size_and_its_interval():
    found = effects.of_pairs([1.0, 2.0, 3.0, 4.0], [2.0, 3.0, 4.0, 5.5])
    assert found.pairs == 4 and found.difference == pytest.approx(1.125)
    assert found.low == pytest.approx(1.125 - 3.182 * 0.125, abs=1e-3) and found.high == pytest.approx(1.125 + 3.182 * 0.125, abs=1e-3)
    # The pooled deviation is sqrt((5/3 + 2.2292) / 2), the correction 1 - 3 / 23 (Hedges 1981).
    assert found.g == pytest.approx(1.125 / 1.39567 * (1 - 3 / 23), rel=1e-4)
    assert found.g_low < found.g < found.g_high
    assert effects.of_pairs([1.0, 2.0], [1.0, 2.0]).g == 0.0


def compared(tmp_path, figures) -> dict:
    """The effect of a delay over five seeds, where a run has figures(delay, seed)."""
    sweep = described(DESCRIPTION | {"factors": {"delay": [0, 50]}, "seeds": [1, 2, 3, 4, 5]}, tmp_path)
    values = [{sweep.column(name): value for name, value in sweep.values(run).items()} for run in sweep.runs()]
    rows = [{"run": number, **one, **figures(one["delay_ms"], one["seed"])} for number, one in enumerate(values, 1)]
    (found,) = effects.rows(sweep, rows)
    return dict(zip(effects.HEAD, found))


def test_an_effect_of_the_same_pair_again_is_of_one_pair(tmp_path):
    found = compared(tmp_path, lambda delay, _: {DESCRIPTION["measures"][0]: 2.0 if delay else 1.0})
    assert (found["pairs"], found["difference"]) == (1, 1.0)
    assert all(found[key] != found[key] for key in ("difference_low", "difference_high", "hedges_g"))


def test_other_runs_with_the_same_figure_count_each(tmp_path):
    """Such as one that counts: four of five runs gain 1, one loses 1, and no two runs are the same."""
    gained = {1: 1.0, 2: 1.0, 3: 1.0, 4: 1.0, 5: -1.0}
    found = compared(tmp_path, lambda delay, seed: {DESCRIPTION["measures"][0]: gained[seed] if delay else 0.0, "other": seed + delay})
    assert (found["pairs"], found["difference"]) == (5, pytest.approx(0.6))


def test_ninety_five_in_a_hundred_intervals_of_an_effect_hold():
    draw, held, of_g = random.Random(5), 0, 0
    for _ in range(300):
        first = [draw.gauss(0.0, 1.0) for _ in range(20)]
        found = effects.of_pairs(first, [draw.gauss(0.8, 1.0) for _ in first])
        held += found.low <= 0.8 <= found.high
        of_g += found.g_low <= 0.8 <= found.g_high
    assert 275 <= held <= 297 and 275 <= of_g <= 297


@pytest.mark.parametrize("count", [3, 5, 10])
@pytest.mark.parametrize("common", [0.0, 2.0])
def test_so_they_do_of_few_pairs_that_have_something_in_common_or_not(count, common):
    """The same seed makes both figures of a pair larger or smaller. 500 intervals: 95 % within four standard deviations.

    The effect's scale is estimated as well: of three pairs with much in common the intervals hold in nine of ten cases.
    """
    draw, held = random.Random(7), 0
    truth = 0.8 / math.sqrt(1.0 + common**2)
    for _ in range(500):
        shared = [draw.gauss(0.0, common) for _ in range(count)]
        found = effects.of_pairs([draw.gauss(one, 1.0) for one in shared], [draw.gauss(one + 0.8, 1.0) for one in shared])
        held += found.g_low <= truth <= found.g_high
    assert (430 if count == 3 and common else 455) <= held <= 494, held


def test_levels_are_compared_run_by_run_with_the_first(tmp_path):
    sweep = described(DESCRIPTION | {"factors": {"delay": [0, 50]}, "seeds": [1, 2, 3]}, tmp_path)
    rows = [
        {"run": number, **{sweep.column(name): value for name, value in sweep.values(run).items()}, sweep.measures[0]: 0.1 * number**2}
        for number, run in enumerate(sweep.runs(), 1)
    ]
    found = [dict(zip(effects.HEAD, row)) for row in effects.rows(sweep, rows)]
    assert [(one["factor"], one["level"], one["against"], one["pairs"]) for one in found] == [("delay_ms", 50, 0, 3)]
    assert found[0]["difference"] == pytest.approx(0.1 * (16 + 25 + 36 - 1 - 4 - 9) / 3)


def test_runs_without_chance_count_as_one():
    rows = [{"run": seed, "delay_ms": 5, "seed": seed, "force_N": 0.25} for seed in range(4)]
    assert len(statistics.independent(rows, ["run", "delay_ms", "seed"])) == 1
    rows[2]["force_N"] = 0.5
    assert len(statistics.independent(rows, ["run", "delay_ms", "seed"])) == 2


def test_equal_names_in_two_folders_have_tables_of_their_own(tmp_path):
    for folder in ("one", "other"):
        (tmp_path / folder).mkdir()
    place = tmp_path / "sweeps"
    first, second = tmp_path / "one/sweep.json", tmp_path / "other/sweep.json"
    assert [command.owned(place, path).name for path in (first, second, first, second)] == ["sweep", "sweep_2", "sweep", "sweep_2"]
