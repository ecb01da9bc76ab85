"""What the program makes of paths, in a Godot that has left the caller's folder for the project's."""

import shutil
import subprocess

import project
import pytest
from setup import godot

SCRIPT = """extends SceneTree

const Caller := preload("res://caller.gd")


func _initialize() -> void:
	var given := OS.get_cmdline_user_args()
	print("HELP ", Caller.asks_for_help(given))
	print("WORDS ", "|".join(Caller.words(given)))
	print("PROBLEM ", Caller.problem(given))
	quit()
"""


@pytest.fixture
def ask(tmp_path):
    """The three answers to the words of a caller in the folder `here`."""
    folder = tmp_path / "project"
    folder.mkdir()
    (tmp_path / "here").mkdir()
    shutil.copy(project.FOLDER / "experiments/caller.gd", folder)
    (folder / "project.godot").write_text("config_version=5\n")
    (folder / "asks.gd").write_text(SCRIPT)
    # As a shell starts it: PWD is its folder.
    command = 'cd "$1" && shift && exec "$@"'

    def answers(*words: str) -> dict[str, str]:
        called = [str(godot.command()), "--headless", "--path", folder, "--script", "res://asks.gd", "--", *words]
        done = subprocess.run(["sh", "-c", command, "sh", tmp_path / "here", *called], text=True, capture_output=True, timeout=60)
        return dict(line.partition(" ")[::2] for line in done.stdout.splitlines() if line[:4] in ("HELP", "WORD", "PROB"))

    return answers


def test_a_relative_path_is_one_of_the_callers_folder(ask, tmp_path):
    found = ask("--scene=res://x.tscn", "--output=build/x", "--replay=../there", "--key_file=/etc/key")
    here = tmp_path / "here"
    assert found["WORDS"] == f"--scene=res://x.tscn|--output={here}/build/x|--replay={tmp_path}/there|--key_file=/etc/key"
    assert found["PROBLEM"] == "" and found["HELP"] == "false"


def test_nothing_is_written_into_the_project(ask, tmp_path):
    assert "choose a folder outside" in ask(f"--output={tmp_path}/project/build/x")["PROBLEM"]
    assert "choose a folder outside" in ask("--output=../project/build/x")["PROBLEM"]
    assert "choose a folder outside" in ask("--output=res://build")["PROBLEM"]
    assert ask(f"--output={tmp_path}/project_of_mine")["PROBLEM"] == ""
    assert ask("--output=user://x")["PROBLEM"] == ""


def test_it_is_asked_for_help(ask):
    assert ask("--help")["HELP"] == ask("-h")["HELP"] == "true"
