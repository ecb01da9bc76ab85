"""The front door: what it says before it sets anything up."""

import re
import subprocess
from pathlib import Path

import pytest

RUN = Path(__file__).resolve().parents[2] / "run"
COMMANDS = re.search(r"^# The front door: ./run (.+)$", RUN.read_text(), re.MULTILINE)[1].split(" | ")


def ask(*arguments: str) -> subprocess.CompletedProcess:
    return subprocess.run([RUN, *arguments], capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_says_what_it_takes_without_setting_up(command):
    answer = ask(command, "--help")
    assert answer.returncode == 0, answer.stderr
    assert "[1/" not in answer.stdout  # a step of the set-up
    assert all(line.startswith(f"./run {command}") for line in answer.stdout.splitlines())
    assert answer.stdout


def test_what_it_does_not_know_it_refuses():
    assert ask("nonsense").returncode == 2
    assert ask("help").returncode == 0
