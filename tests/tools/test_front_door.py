"""The front door: what it refuses before it sets anything up, how its commands end, and what they leave."""

import os
import signal
import subprocess
import time
from pathlib import Path

import bench
import commands
import front_door
import project
import pytest
from setup import godot
from stand_in_clone import Clone

RUN = Path(__file__).resolve().parents[2] / "run"
COMMANDS = list(commands.BY_NAME)
# Words with which a command is right; what it stands for is there in every clone.
RIGHT = {"experiment": ["scenario1"], "replay": ["bundle"]}
WRONG = {
    "setup": ["--with-senssing"], "demo": ["--clock=stepped"], "test": ["--sanitise=thread"], "proof": ["--onyl=fuzz"],
    "bench": ["proxi"], "experiment": ["scenario1", "--secnds=2"], "replay": ["docs"], "docs": ["x"],
    "edit": ["res://galery.tscn"], "app": ["--headless"], "export": ["foo"], "addon": ["--platform=window"],
}  # fmt: skip
TWICE = {
    "setup": "--with-sensing", "test": "--sanitize=thread", "proof": "--only=fuzz", "bench": "proxy", "experiment": "--seconds=1",
    "replay": "bundle", "edit": "main.tscn", "app": "main.tscn", "addon": "--platform=windows",
}  # fmt: skip
SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]


def made(folder: Path) -> Clone:
    clone = Clone(folder)
    (clone.folder / "bundle").mkdir()
    (clone.folder / "bundle/here_inputs.tactus").touch()
    return clone


@pytest.fixture(scope="module")
def clone(tmp_path_factory):
    clone = made(tmp_path_factory.mktemp("front door ü#"))
    yield clone
    clone.end_all()


@pytest.fixture
def refuses(clone, monkeypatch, capsys):
    """Checks that words are refused with one line, and returns it. Nothing is begun: only carry_out() does anything."""

    def check(*words: str) -> str:
        assert front_door.main(words) == 2
        said = capsys.readouterr()
        assert said.out == "" and len(said.err.splitlines()) == 1 and "--help" in said.err
        return said.err

    monkeypatch.chdir(clone.folder)
    monkeypatch.setattr(front_door, "carry_out", lambda *_: pytest.fail("carried out"))
    return check


def ask(*words: str) -> subprocess.CompletedProcess:
    return subprocess.run([RUN, *words], capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_says_what_it_takes_without_setting_up(command):
    answer = ask(command, "--help")
    assert answer.returncode == 0, answer.stderr
    assert "[1/" not in answer.stdout  # a step of the set-up
    assert all(line.startswith(f"./run {command}") for line in answer.stdout.splitlines())
    assert answer.stdout
    assert front_door.read([command, "-h"]) == front_door.read([command, "--help"]) == answer.stdout


def test_help_of_one_bench_or_experiment_has_its_options():
    assert "--deformations=VALUE" in front_door.read(["bench", "kick", "--help"])
    assert "--quick\n" in front_door.read(["bench", "physics", "-h"])
    assert "--warmup " in front_door.read(["experiment", "scenario1", "--help"])


def test_scripts_keep_their_line_endings_in_every_checkout():
    if not (RUN.parent / ".git").exists():
        pytest.skip("this is no checkout")
    asked = ["git", "check-attr", "eol", "run", ".ci/run", "tools/debian_packages.sh", "tools/front_door.py"]
    said = subprocess.run(asked, cwd=RUN.parent, text=True, capture_output=True, check=True).stdout
    assert [line.rpartition(" ")[2] for line in said.splitlines()] == ["lf"] * 4


def test_what_it_does_not_know_it_refuses():
    answer = ask("exprot")
    assert answer.returncode == 2 and "did you mean export?" in answer.stderr
    assert ask("help").returncode == 0
    assert front_door.read(["help"]) == front_door.read(["-h"]) == front_door.read(["--help"]) == front_door.read([])


@pytest.mark.parametrize("command", COMMANDS)
def test_an_unknown_option_is_refused_before_anything_is_set_up(command, clone, tmp_path):
    """As any user gives it: from another folder, by a symlink."""
    link = tmp_path / "tactus"
    link.symlink_to(clone.folder / "run")
    before = sorted(clone.stand_ins.rglob("*"))
    words = [str(clone.folder / word) if word == "bundle" else word for word in RIGHT.get(command, [])]
    answer = clone.ask(command, *words, "--no-such-option", run=link, cwd=tmp_path)
    assert answer.returncode == 2 and answer.stdout == "" and len(answer.stderr.splitlines()) == 1
    assert f"./run {command}: there is no option --no-such-option" in answer.stderr
    assert sorted(clone.stand_ins.rglob("*")) == before and list(tmp_path.iterdir()) == [link]


@pytest.mark.parametrize(("words", "builds"), [((), False), (("--pictures",), True), (("--figures",), True)])
def test_only_figures_and_pictures_of_the_documents_need_what_is_built(words, builds):
    given = front_door.read(["docs", *words])
    names = [step.name for step in front_door.needed(*given)]
    assert ("build" in front_door.packages(*given)) == ("Godot" in names) == builds
    assert (project.import_step().name in names) == (words == ("--pictures",))


@pytest.mark.parametrize("command", COMMANDS)
def test_a_misspelt_word_is_refused_before_anything_is_set_up(command, refuses):
    refuses(command, *WRONG[command])


@pytest.mark.parametrize("command", TWICE)
def test_what_is_given_twice_is_refused(command, refuses):
    first = RIGHT.get(command, []) if TWICE[command].startswith("--") else []
    refuses(command, *first, TWICE[command], TWICE[command])


@pytest.mark.parametrize(
    "words",
    [
        ["proof", "--only=nosuch"], ["proof", "--only=fuzz.nosuch"], ["proof", "--seconds=3"], ["proof", "--only=soak", "--rounds=3"],
        ["proof", "--only=loop", "--rounds=few"], ["proof", "--only=soak", "--hours=nan"], ["experiment", "scenario1", "--seconds=-1"], ["bench", "proxy", "--tick=3"], ["bench", "proxy", "--ticks=many"],
        ["bench", "proxy", "--ticks=nan"], ["bench", "physics", "--quick=1"], ["bench", "proxy", "pareto", "--ticks=3"],
        ["experiment"], ["experiment", "scenario1", "--seconds=long"], ["experiment", "scenario1", "--clock=sideways"],
        ["experiment", "no.toml"], ["experiment", "docs"], ["test", "windows", "--sanitize=thread"], ["test", "one", "two"],
        ["setup", "--with-sensing", "--device-access"], ["docs", "--", "x"], ["help", "test"],
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_before_anything_is_set_up(words, refuses):
    refuses(*words)


def test_a_sweep_is_read_before_anything_is_set_up(refuses, tmp_path):
    file = tmp_path / "sweep.toml"
    file.write_text('experiment = "linked_touch"\nmeasures = ["x"]\n[factors]\ndealy = [1, 2]\n')
    assert "dealy" in refuses("experiment", str(file))


def test_options_of_a_bench_are_those_that_its_source_asks_for():
    assert {option.name for option in bench.options("kick")} == {"--seeds", "--deformations"}
    assert {option.name: option.value for option in bench.options("pacing")} == {
        "--compare": "", "--alone": "", "--only": "VALUE", "--seconds": "VALUE", "--rounds": "VALUE", "--output": "VALUE",
    }  # fmt: skip
    assert bench.options("frames") == []
    for name in bench.names():
        source = RUN.parent / "tests/bench" / f"{name}.cpp"
        assert bool(bench.options(name)) == (source.is_file() and "options." in source.read_text()), name


def test_what_stands_behind_two_dashes_reaches_the_program(clone, tmp_path):
    telling = tmp_path / "godot"
    telling.write_text(f'#!/bin/bash\nprintf "%s\\n" "$@" >>"{tmp_path}/told"\nexec "{clone.programs}/godot" "$@"\n')
    telling.chmod(0o755)
    answer = clone.ask("app", "main.tscn", "--", "--help", "--output=x", env={"GODOT": str(telling)})
    assert answer.returncode == 0, answer.stderr
    assert (tmp_path / "told").read_text().splitlines()[-4:] == ["res://main.tscn", "--", "--help", "--output=x"]


def test_paths_are_those_of_the_caller(clone, tmp_path, monkeypatch):
    assert clone.ask("replay", "bundle", cwd=tmp_path).returncode == 2  # there is none here
    (tmp_path / "bundle").mkdir()
    (tmp_path / "bundle/here_inputs.tactus").touch()
    (tmp_path / "own.tscn").touch()
    monkeypatch.chdir(tmp_path)
    commands.BY_NAME["replay"].words(("bundle",))
    assert commands.scene("own.tscn") == str(tmp_path / "own.tscn")
    assert commands.scene("main.tscn") == "res://main.tscn"


# How each command is interrupted: by whom it is kept waiting.
WAITED_FOR = {"bench": "python", "docs": "python", "edit": "godot", "app": "godot"}


def check_nothing_is_left(clone: Clone, process: subprocess.Popen, code: int) -> None:
    stderr = process.communicate(timeout=20)[1]
    assert process.returncode == code, stderr
    assert "Traceback" not in stderr
    assert clone.left_running() == []


@pytest.mark.parametrize("number", SIGNALS, ids=lambda one: one.name)
@pytest.mark.parametrize("command", COMMANDS)
def test_what_a_command_has_started_ends_with_it(command, number, clone):
    process = clone.begin(command, *RIGHT.get(command, []), waits=WAITED_FOR.get(command, "scons"))
    process.send_signal(number)
    check_nothing_is_left(clone, process, 128 + number)


@pytest.mark.parametrize("number", SIGNALS, ids=lambda one: one.name)
def test_a_closed_terminal_or_its_interrupt_reaches_all_at_once(number, clone):
    process = clone.begin("app", waits="godot")
    os.killpg(process.pid, number)
    check_nothing_is_left(clone, process, 128 + number)


def test_also_where_it_is_killed_itself(clone):
    process = clone.begin("app", waits="godot")
    process.kill()
    process.wait()
    until = time.monotonic() + 30.0
    while clone.left_running() and time.monotonic() < until:
        time.sleep(0.05)
    assert clone.left_running() == []


def test_who_was_asked_to_stay_stays(clone):
    hung_up = clone.begin("docs", waits="python", within=["nohup"])
    hung_up.send_signal(signal.SIGHUP)
    time.sleep(0.5)
    assert hung_up.poll() is None
    hung_up.terminate()
    check_nothing_is_left(clone, hung_up, 128 + signal.SIGTERM)


def test_a_build_that_fails_says_so_and_starts_nothing(clone):
    answer = clone.ask("app", env={"SCONS_ENDS": "1"})
    assert answer.returncode == 1 and "the build of template_debug failed" in answer.stderr
    assert clone.left_running() == []


def test_what_was_made_is_named_as_the_caller_can_type_it(clone, tmp_path):
    answer = clone.ask("export", cwd=tmp_path)
    assert answer.returncode == 0, answer.stderr
    program = tmp_path / answer.stdout.splitlines()[-1].partition(" runs on")[0]
    assert program.resolve() == clone.folder / "build/export/tactus.x86_64" and program.read_text() == "new\n"
    assert list(tmp_path.iterdir()) == []


def test_a_failed_export_leaves_the_last_one(clone):
    kept = clone.folder / "build/export/tactus.x86_64"
    kept.parent.mkdir(parents=True, exist_ok=True)
    kept.write_text("the last one")
    answer = clone.ask("export", env={"EXPORT_ENDS": "1"})
    assert answer.returncode == 1 and "could not export" in answer.stderr, answer.stderr
    assert kept.read_text() == "the last one"
    assert [path.name for path in kept.parent.parent.iterdir() if path.name.startswith(".export")] == []


def test_an_export_says_whom_it_runs_for(monkeypatch):
    monkeypatch.setattr(godot, "installed", lambda: None)
    assert "for this user" in project._runs_on()
    monkeypatch.setattr(godot, "installed", lambda: "/usr/bin/godot")
    assert project._runs_on() == "runs on its own"


def test_an_interrupted_export_leaves_the_last_one(clone):
    kept = clone.folder / "build/export/tactus.x86_64"
    kept.parent.mkdir(parents=True, exist_ok=True)
    kept.write_text("the last one")
    process = clone.begin("export", waits="godot")
    process.terminate()
    check_nothing_is_left(clone, process, 128 + signal.SIGTERM)
    assert kept.read_text() == "the last one"


needs_mounts = pytest.mark.skipif(
    subprocess.run(["unshare", "-m", "true"], capture_output=True).returncode != 0, reason="only root may mount a file system for itself"
)


def mounted(script: str) -> list[str]:
    """A command that what follows runs in, with file systems of its own."""
    return ["unshare", "-m", "bash", "-c", f'set -e; {script}; exec "$@"', "bash"]


def check_stopped(answer: subprocess.CompletedProcess, words: str) -> None:
    assert answer.returncode == 1, answer.stdout + answer.stderr
    assert "Traceback" not in answer.stderr and words in answer.stderr.splitlines()[-1], answer.stderr


@needs_mounts
@pytest.mark.parametrize("command", COMMANDS)
def test_a_clone_that_cannot_be_written_is_named(command, clone):
    (clone.folder / "build").mkdir(exist_ok=True)
    place = f"'{clone.folder}'"
    within = mounted(f"mount --bind {place} {place}; mount -o remount,bind,ro {place}")
    check_stopped(clone.ask(command, *RIGHT.get(command, []), within=within), "cannot be written")


@needs_mounts
@pytest.mark.parametrize("command", COMMANDS)
def test_a_full_disk_is_named(command, clone):
    build = clone.folder / "build"
    build.mkdir(exist_ok=True)
    within = mounted(f"mount -t tmpfs -o nr_inodes=1,size=4k full '{build}'")
    check_stopped(clone.ask(command, *RIGHT.get(command, []), within=within), "The disk is full")


@needs_mounts
@pytest.mark.parametrize(("options", "words"), [("ro", "cannot be written"), ("nr_inodes=1", "The disk is full")])
def test_a_cache_that_cannot_be_written_is_named(options, words, clone):
    answer = clone.ask("setup", within=mounted(f"mount -t tmpfs -o {options} cache '{clone.cache}'"))
    check_stopped(answer, words)


def test_a_file_that_may_not_grow_is_named(clone):
    """ulimit -f, as administrators set it, and the last documentation stays."""
    kept = clone.folder / "build/docs/index.html"
    kept.parent.mkdir(parents=True, exist_ok=True)
    kept.write_text("the last one")
    answer = clone.ask("docs", within=["bash", "-c", 'ulimit -f 1; exec "$@"', "bash"])
    check_stopped(answer, "ulimit -f")
    assert kept.read_text() == "the last one"


def test_two_commands_at_once_wait_for_each_other(clone):
    first = clone.begin("export", waits="scons")
    second = subprocess.Popen(
        [clone.folder / "run", "export"], cwd=clone.folder, env=clone.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    time.sleep(1.0)
    assert second.poll() is None  # it waits for the first one's build
    first.terminate()
    first.communicate(timeout=20)
    assert first.returncode == 128 + signal.SIGTERM
    said, problems = second.communicate(timeout=60)
    assert "Build template_release" in said, said + problems
    assert clone.left_running() == []

