"""Results of before stay until what is new is whole: when a run fails, is killed, finds the disk full, or meets another one."""

import json
import os
import random
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from measuring import outputs
from measuring.options import Refused
from setup import cache

# An experiment in little: writes a table row by row, as slowly as is said, and keeps it.
RUN = """
import sys, time
from pathlib import Path
import entry, experiment
from setup import cache
place, rows, pause = Path(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
cache.clone, experiment.citation = lambda: place, dict
def run(output):
    with (output / "rows.csv").open("w") as file:
        for row in range(rows):
            file.write(f"{row},{'x' * 60}\\n")
            time.sleep(pause)
    return {"rows": rows}
entry.leave(lambda _: experiment._carry_out("little", run))
"""


def start(place: Path, rows: int, pause: float = 0.0, most_bytes: int | None = None) -> subprocess.Popen:
    def limit() -> None:
        # A file that may not grow is what a full disk is to a program; Python itself ignores the signal.
        if most_bytes is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, most_bytes))

    environment = os.environ | {"PYTHONPATH": str(cache.clone() / "tools"), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-c", RUN, str(place), str(rows), str(pause)]
    return subprocess.Popen(command, env=environment, preexec_fn=limit, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def rows_of(folder: Path) -> int:
    """Of results that are whole."""
    rows = json.loads((folder / "summary.json").read_text())["rows"]
    assert len((folder / "rows.csv").read_text().splitlines()) == rows
    return rows


def ended(one: subprocess.Popen) -> tuple[int, str]:
    said = one.communicate(timeout=60)
    return one.returncode, said[1]


def test_a_run_that_is_whole_takes_the_place_of_the_one_before(tmp_path):
    for rows in (3, 5):
        assert ended(start(tmp_path, rows))[0] == 0
        assert rows_of(tmp_path / "build/experiments/little") == rows
    assert sorted(path.name for path in (tmp_path / "build/experiments").iterdir()) == [".locks", "little"]


def test_a_full_disk_ends_the_run_with_its_reason_and_loses_nothing(tmp_path):
    assert ended(start(tmp_path, 3))[0] == 0
    code, said = ended(start(tmp_path, 10_000, most_bytes=100_000))
    assert code == 1 and "longer than this user may write" in said and "Not whole" in said
    assert rows_of(tmp_path / "build/experiments/little") == 3
    assert not (tmp_path / "build/experiments/little.partial/summary.json").exists()


def test_a_refused_run_leaves_nothing_beside_the_results(tmp_path):
    """Where only the program that plays it can refuse it, the folder is there already."""
    with outputs.output(tmp_path, "little") as output:
        output.keep()
    with pytest.raises(Refused), outputs.output(tmp_path, "little") as output:
        (output.folder / "scene.txt").write_text("half")
        raise Refused("no such key")
    assert sorted(path.name for path in tmp_path.iterdir()) == [".locks", "little"]


def test_a_folder_that_may_not_be_written_is_said(tmp_path):
    (tmp_path / "build").write_text("a file where a folder should be")
    code, said = ended(start(tmp_path, 3))
    assert code == 1 and "Traceback" not in said and str(tmp_path) in said


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_read_only_folder_is_said(tmp_path):
    (tmp_path / "build").mkdir(mode=0o500)
    code, said = ended(start(tmp_path, 3))
    assert code == 1 and "may not be written" in said


def test_two_at_once_have_names_of_their_own(tmp_path):
    first = start(tmp_path, 50, 0.1)
    partial = tmp_path / "build/experiments/little.partial"
    while not partial.is_dir():
        time.sleep(0.01)
    second = start(tmp_path, 7)
    assert ended(second)[0] == 0 and ended(first)[0] == 0
    assert rows_of(tmp_path / "build/experiments/little") == 50
    assert rows_of(tmp_path / "build/experiments/little_2") == 7


def test_killed_at_any_time_nothing_is_lost_that_was_there_before(tmp_path):
    """A hundred times; each whole run writes one row more than the one before."""
    place = tmp_path / "build/experiments"
    draw = random.Random(4)
    assert ended(start(tmp_path, 1))[0] == 0
    before = 1
    for number in range(2, 102):
        one = subprocess.Popen([sys.executable, "-c", KILLED, str(place), str(number), str(draw.uniform(0.0, 0.004))], env=_environment())
        assert one.wait(60) in (0, -signal.SIGKILL)
        # The next run mends what a kill between two renamings has left.
        with outputs.output(place, "little"):
            pass
        now = rows_of(place / "little")
        assert now in (before, number)
        before = now


def test_a_kill_between_the_two_renamings_is_mended(tmp_path):
    with outputs.output(tmp_path, "little") as output:
        (output.folder / "rows.csv").write_text("0\n")
        (output.folder / "summary.json").write_text('{"rows": 1}')
        output.keep()
    (tmp_path / "little").rename(tmp_path / "little.former")
    (tmp_path / "little.partial").mkdir()
    with outputs.output(tmp_path, "little"):
        assert rows_of(tmp_path / "little") == 1 and not (tmp_path / "little.former").exists()


# The same, killed after a time that is counted from when it begins to write.
KILLED = """
import json, os, signal, sys
from pathlib import Path
from measuring import outputs
place, rows = Path(sys.argv[1]), int(sys.argv[2])
with outputs.output(place, "little") as output:
    signal.signal(signal.SIGALRM, lambda *_: os.kill(os.getpid(), signal.SIGKILL))
    signal.setitimer(signal.ITIMER_REAL, float(sys.argv[3]))
    with (output.folder / "rows.csv").open("w") as file:
        for row in range(rows):
            file.write(f"{row}\\n")
    (output.folder / "summary.json").write_text(json.dumps({"rows": rows}))
    output.keep()
    signal.setitimer(signal.ITIMER_REAL, 0)
"""


def _environment() -> dict[str, str]:
    return os.environ | {"PYTHONPATH": str(cache.clone() / "tools"), "PYTHONDONTWRITEBYTECODE": "1"}
