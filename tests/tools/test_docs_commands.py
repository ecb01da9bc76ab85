"""Every command that the documents name can be given, and every table of docs/teleoperation.md says how it is made."""

import dataclasses
import re
import subprocess
import typing

import commands
import experiment
import prove
import pytest

from setup import cache
from sweeps import command, description

FOLDER = cache.clone()
DOCUMENTS = sorted([FOLDER / "README.md", *(FOLDER / "docs").rglob("*.md")])
_COMMAND = re.compile(r"\./run (\w+)((?: [\w./=,{}-]+)*)")
# In place of a name.
_ANY = ("NAME", "NAME…", "FILTER", "SCENE", "SWEEPFILE", "BUNDLE", "PART")


def _commands() -> list[tuple[str, str, list[str]]]:
    found = []
    for document in DOCUMENTS:
        for verb, words in _COMMAND.findall(document.read_text()):
            found.append((document.name, verb, words.split()))
    return found


def _benches() -> set[str]:
    return {path.stem for path in (FOLDER / "tests/bench").iterdir() if path.suffix in (".cpp", ".gd", ".py")}


@pytest.mark.parametrize(("document", "verb", "words"), _commands())
def test_a_command_of_the_documents_can_be_given(document: str, verb: str, words: list[str]):
    assert verb in commands.BY_NAME, document
    if verb == "proof":
        for option in words:
            key, _, value = option.partition("=")
            part, _, case = value.partition(".")
            assert key in ("--only", "--page") and (not value or value in _ANY or part in prove.PARTS), f"{document}: {option}"
            assert not case or case in prove.PARTS[part].CASES, f"{document}: {option}"
        return
    if verb not in ("experiment", "bench") or not words or words[0] in _ANY or words[0].startswith("--"):
        return
    if words[0] == "build/bundle":  # test_replay.py plays the one of the page
        assert document == "bundles.md"
        return
    if verb == "bench":
        assert words[0] in _benches(), f"{document}: ./run bench {words[0]}"
        return
    known = _fields(_settings(words[0]))
    for option in (word for word in words[1:] if word.startswith("--")):
        assert option[2:].split("=")[0] in known, f"{document}: {words[0]} {option}"


def _settings(experiment_or_sweep: str) -> type:
    if experiment_or_sweep.endswith(description.ENDINGS):
        description.read(FOLDER / experiment_or_sweep, experiment.names())
        return command.Settings
    assert experiment_or_sweep in experiment.names()
    return description.settings(experiment_or_sweep)


def _fields(settings: type) -> set[str]:
    return {field.name for field in dataclasses.fields(typing.cast(typing.Any, settings))}


# Commands that are none of ./run's: by which test each is carried out, as the documents have it.
CARRIED_OUT = {"dask": "test_sweeps.py", "openssl": "test_docs_commands.py", "mkdir": "test_docs_commands.py"}


def _shell_lines() -> list[str]:
    found = []
    for document in DOCUMENTS:
        for block in re.findall(r"```sh\n(.*?)```", document.read_text(), re.DOTALL):
            found += [line.split("    #")[0].strip() for line in block.splitlines() if line.strip()]
    return found


def test_every_command_is_one_of_the_front_door_or_carried_out_by_a_test():
    lines = _shell_lines()
    assert len(lines) > 10
    for line in lines:
        program = next(word for word in line.split() if "=" not in word).rpartition("/")[2]
        assert program == "run" or CARRIED_OUT[program]


@pytest.mark.parametrize(("program", "made"), [("openssl", "tactus.key"), ("mkdir", ".godot/extension_list.cfg")])
def test_a_command_of_the_shell_does_what_it_says(program: str, made: str, tmp_path):
    (line,) = (line for line in _shell_lines() if line.startswith(program))
    subprocess.run(["bash", "-c", line], cwd=tmp_path, check=True)
    text = (tmp_path / made).read_text().strip()
    if program == "openssl":
        assert re.fullmatch(r"[0-9a-f]{64}", text) and (tmp_path / made).stat().st_mode & 0o777 == 0o600
    else:
        assert text == "res://addons/tactus/tactus.gdextension"


def test_every_scene_that_is_named_is_there():
    named = [scene for document in DOCUMENTS for scene in re.findall(r"\./run (?:app|edit) res://(\S+\.tscn)", document.read_text())]
    assert named
    assert all((FOLDER / "demo_project" / scene).is_file() for scene in named)


def test_every_table_says_how_it_is_made():
    sections = re.split(r"^## ", (FOLDER / "docs/teleoperation.md").read_text(), flags=re.MULTILINE)
    tables = 0
    for section in sections:
        # What stands before a table, from the last one on.
        parts = re.split(r"(?:^\|.*\n)+", section, flags=re.MULTILINE)
        for before in parts[:-1]:
            tables += 1
            assert "./run experiment" in before, f"{section.splitlines()[0]}: …{before.strip()[-80:]}"
    assert tables >= 5
