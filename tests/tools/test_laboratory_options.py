"""Every option of every experiment with every kind of nonsense: refused with its key and what is allowed, exit code 2, before
anything of an earlier run could be touched.
"""

import dataclasses
import sys
from typing import get_args, get_origin

import entry
import experiment
import pytest

from measuring import options, outputs
from sweeps import command, description

NONSENSE = ["nan", "inf", "-inf", "-1e9", "1e300", "", "abc", "5O", "100parsecs", "1_0", "no_such_name", "Stepped"]


def _options() -> list[tuple[str, dataclasses.Field]]:
    return [(name, field) for name in experiment.names() for field in dataclasses.fields(description.settings(name))]


def _refused(capsys, monkeypatch, *words: str) -> str:
    """What is said to a command that ends before its results have a place."""

    def touched(*_):
        raise AssertionError("the command was carried out")

    monkeypatch.setattr(outputs, "output", touched)
    monkeypatch.setattr(sys, "argv", ["experiment.py", *words])
    with pytest.raises(SystemExit) as left:
        entry.leave(experiment.main)
    assert left.value.code == 2, words
    return capsys.readouterr().err


@pytest.mark.parametrize(("name", "field"), _options(), ids=lambda one: getattr(one, "name", one))
def test_nonsense_is_refused_before_anything_is_touched(name, field, capsys, monkeypatch):
    none_is_written = get_origin(field.type) is dict
    for value in NONSENSE:
        if none_is_written and not value:
            continue
        said = _refused(capsys, monkeypatch, name, f"--{field.name}={value}")
        assert f"--{field.name}={value} is refused" in said and f"it must be {options.allowed(field)}" in said


@pytest.mark.parametrize("name", experiment.names())
def test_a_misspelt_a_repeated_and_a_formless_option_are_refused(name, capsys, monkeypatch):
    first = next((field.name for field in dataclasses.fields(description.settings(name))), "option")
    assert f"unknown option --{first}_x" in _refused(capsys, monkeypatch, name, f"--{first}_x=1")
    assert "given twice" in _refused(capsys, monkeypatch, name, f"--{first}=1", f"--{first}=1")
    for word in (first, f"--{first}", "--", "--=1", f"-{first}=1"):
        assert "is not --key=value" in _refused(capsys, monkeypatch, name, word)


def test_every_number_has_its_unit_and_its_range():
    for name, field in [*_options(), *(("sweep", one) for one in dataclasses.fields(command.Settings))]:
        kinds = (field.type, *get_args(field.type))
        if float in kinds or (int in kinds and field.type is not bool):
            assert field.metadata["unit"], f"{name} --{field.name}"
            assert field.metadata["least"] < field.metadata["most"] < float("inf"), f"{name} --{field.name}"


def test_every_default_is_allowed():
    for name, field in _options():
        default = getattr(options.parse(description.settings(name), {}), field.name)
        if isinstance(default, (int, float)) and not isinstance(default, bool):
            assert field.metadata["least"] <= default <= field.metadata["most"], f"{name} --{field.name}"


@pytest.mark.parametrize("name", experiment.names())
def test_what_is_cited_gives_the_same_options_again(name):
    kind = description.settings(name)
    settings = options.parse(kind, {})
    given = [word for word in options.words(settings).split() if not word.endswith("=")]
    assert options.parse(kind, options.of_words(given)) == settings


def test_delays_are_milliseconds_and_losses_shares_in_every_experiment():
    units = {"delay": "ms", "grid_delay": "ms", "loss": "share", "grid_loss": "share"}
    seen = [(name, field) for name, field in _options() if field.name in units]
    assert {field.name for _, field in seen} == set(units)
    assert not [(name, field.name) for name, field in seen if options.unit_of(field) != units[field.name]]


def test_a_delay_is_one_option_with_one_value_or_several():
    names = {field.name for _, field in _options()}
    assert not {name for name in names if "delay" in name} - {"delay", "grid_delay"}


@pytest.mark.parametrize(("name", "word"), [("scenario4", "--delay=0.1"), ("timing_networked", "--delay=0.1"), ("dynamic_mmt", "--loss=0,10,50"), ("dynamic_mmt", "--delays=0.5")])
def test_commands_from_before_that_are_refused_and_not_misread(name, word, capsys, monkeypatch):
    key = word.removeprefix("--").partition("=")[0].removesuffix("s")
    assert f"--{key}" in _refused(capsys, monkeypatch, name, word)
