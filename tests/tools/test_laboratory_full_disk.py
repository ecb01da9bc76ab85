"""A disk that takes no more, wherever something is written: the exit code and the words say so, and nothing of before is lost.

A limit of a file's size is what a full disk is to a program; who ignores its signal sees it as an error of writing.
"""

import json
import resource
import signal
import subprocess
from pathlib import Path

import bench
import prove
import pytest

import project
from setup import godot


def play(*words: object, most_bytes: int | None = None) -> subprocess.CompletedProcess:
    def limit() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        if most_bytes is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, most_bytes))

    command = [godot.command(), "--headless", "--path", project.FOLDER, *words]
    return subprocess.run(
        list(map(str, command)), timeout=180, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, preexec_fn=limit, restore_signals=False
    )


def experiment(folder: Path, *words: str, most_bytes: int | None = None) -> subprocess.CompletedProcess:
    options = ["--scene=res://gallery/static_testbed/static_testbed.tscn", "--case=hand", "--clock=stepped", "--duration=1", "--inputs=1"]
    return play("--", *options, f"--output={folder}", *words, most_bytes=most_bytes)


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


@pytest.mark.parametrize("most_bytes", [500, 50_000])
def test_an_experiment_says_that_its_files_are_cut_short(tmp_path, most_bytes):
    done = experiment(tmp_path, most_bytes=most_bytes)
    assert done.returncode == 1 and "is the disk full?" in done.stdout, done.stdout
    assert (tmp_path / "hand.unfinished").is_dir(), "it is marked as what is not whole"


def test_a_replay_says_so_and_leaves_the_bundle(tmp_path):
    assert experiment(tmp_path).returncode == 0
    before = content(tmp_path)
    done = play("--", f"--replay={tmp_path}", f"--output={tmp_path / 'again'}", most_bytes=50_000)
    assert done.returncode != 0 and "is the disk full?" in done.stdout, done.stdout
    assert content(tmp_path) == before


def test_a_launch_says_so(tmp_path):
    done = play("--", "--launch=now", "--scenario=1", "--seconds=1", f"--output={tmp_path}", most_bytes=50_000)
    assert done.returncode == 1 and "is the disk full?" in done.stdout, done.stdout


def test_a_study_that_can_keep_no_answer_does_not_begin(tmp_path):
    done = play("res://studies/stiffness.tscn", "--", "--participant=P1", f"--folder={tmp_path}", most_bytes=200)
    assert done.returncode == 1 and "could not be written" in done.stdout, done.stdout


def test_a_bench_keeps_the_result_of_before(tmp_path):
    result, partial = tmp_path / "idle.json", tmp_path / "idle.partial"
    result.write_text('{"before": 1}\n')
    for cut in ('{"mouse_share": 0.', "", None):
        if cut is not None:
            partial.write_text(cut)
        with pytest.raises(RuntimeError, match="is the disk full"):
            bench.keep(partial, result)
        assert json.loads(result.read_text()) == {"before": 1} and not partial.exists()
    partial.write_text('{"now": 2}\n')
    bench.keep(partial, result)
    assert json.loads(result.read_text()) == {"now": 2}


def test_a_chart_that_could_not_be_drawn_is_told(tmp_path):
    assert bench.draw("proxy", tmp_path / "proxy.json") != 0, "there is no such result"
    assert bench.draw("emulator", tmp_path / "emulator.json") == 0, "this bench has no charts"


class Part:
    """Of a proof, with more figures than there is room for."""

    CASES = {"one": None}
    Settings = prove.loop.Settings

    @staticmethod
    def run(*_) -> dict:
        return {f"figure_{number}": number for number in range(10_000)}


def test_a_proof_keeps_the_figures_of_hours(tmp_path, monkeypatch):
    monkeypatch.setattr(prove, "PARTS", {"loop": Part})
    (tmp_path / "loop.json").write_text('{"before": 1}\n')
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, hard))
    try:
        with pytest.raises(RuntimeError, match="could not be written"):
            prove.play("loop", "", {}, tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert json.loads((tmp_path / "loop.json").read_text()) == {"before": 1}
    assert list(tmp_path.glob("*.partial")) == []
