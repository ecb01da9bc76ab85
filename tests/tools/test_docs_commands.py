"""Every command that the documents name can be given, and every table of docs/teleoperation.md says how it is made."""

import dataclasses
import re
import typing

import experiment
import pytest

from setup import cache
from sweeps import command, description

FOLDER = cache.clone()
DOCUMENTS = sorted([FOLDER / "README.md", *(FOLDER / "docs").glob("*.md")])
_COMMAND = re.compile(r"\./run (\w+)((?: [\w./=,{}-]+)*)")
# In place of a name.
_ANY = ("NAME", "NAME…", "FILTER", "SCENE", "SWEEPFILE")


def _commands() -> list[tuple[str, str, list[str]]]:
    found = []
    for document in DOCUMENTS:
        for verb, words in _COMMAND.findall(document.read_text()):
            found.append((document.name, verb, words.split()))
    return found


def _front_door() -> set[str]:
    case = re.search(r"^([\w |]+)\) ;;$", (FOLDER / "run").read_text(), re.MULTILINE)
    return set(case[1].split(" | "))


def _benches() -> set[str]:
    return {path.stem for path in (FOLDER / "tests/bench").iterdir() if path.suffix in (".cpp", ".gd")}


@pytest.mark.parametrize(("document", "verb", "words"), _commands())
def test_a_command_of_the_documents_can_be_given(document: str, verb: str, words: list[str]):
    assert verb in _front_door(), document
    if verb not in ("experiment", "bench") or not words or words[0] in _ANY or words[0].startswith("--"):
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
