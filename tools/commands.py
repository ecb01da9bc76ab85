"""The commands of ./run and their arguments: help, checks and refusals follow from this table.

It is read before anything is set up, by the system's Python alone. What depends on files of the clone (names of experiments
and benches, their options) is taken from these files.
"""

import ast
import importlib
import sys
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path

import absent
import bench
from arguments import Command, Given, Option, choose
from measuring.options import Refused, parse
from setup import cache, interfaces, platforms

sys.path.insert(0, str(cache.clone() / "site_scons"))
import toolchain  # noqa: E402

_EXPERIMENTS = cache.clone() / "tools/experiments"
_PROJECT = cache.clone() / "demo_project"
_BUNDLE_PART = "*_inputs.tactus"  # replay.py
_SWEEP = (".toml", ".json")


def _no_more_than(count: int, words: Sequence[str]) -> None:
    if len(words) > count:
        raise Refused(f"{words[count]!r} is too much")


# setup


def _one_thing_to_set_up(given: Given) -> None:
    if len(given.options) > 1:
        raise Refused("--device-access stands alone: it sets nothing else up")


# test


def _test_words(words: tuple[str, ...]) -> None:
    is_elsewhere = bool(words) and platforms.tested_by(words[0]) is not None
    _no_more_than(2 if is_elsewhere else 1, words)


def _sanitizers(value: str) -> None:
    for name in value.split(","):
        choose(name, toolchain.SANITIZERS, "sanitizer")


def _watched_here(given: Given) -> None:
    if given.has("--sanitize") and given.words and platforms.tested_by(given.words[0]):
        raise Refused(f"--sanitize watches programs of this machine, not those for {given.words[0]}")


# proof


def _proof_options(_: tuple[str, ...]) -> Sequence[Option]:
    of_parts = {field.name for part in _parts().values() for field in fields(part.Settings)}
    own = [Option("--only", "PART[.CASE]", _part), Option("--page"), Option("--output", "FOLDER")]
    return [*own, *(Option(f"--{name}", "VALUE") for name in sorted(of_parts))]


def _part(value: str) -> None:
    name, dot, case = value.partition(".")
    part = _parts()[choose(name, _parts(), "part")]
    if dot:
        choose(case, part.CASES, f"case of {name}")


def _of_a_part(given: Given) -> None:
    own = {name: value for name, value in given.options.items() if name not in ("--only", "--page", "--output")}
    if own and not given.has("--only"):
        raise Refused(f"say with --only=PART which part {next(iter(own))} is for")
    if given.has("--only"):
        _parse(_parts()[given.options["--only"].partition(".")[0]].Settings, own)


def _parts() -> dict:
    with absent.stood_in_for():
        return importlib.import_module("prove").PARTS


# bench


def _bench_words(words: tuple[str, ...]) -> None:
    for position, word in enumerate(words):
        choose(word, bench.names(), "bench")
        if word in words[:position]:
            raise Refused(f"{word} is given twice: say it once")


def _options_of_the_bench(words: tuple[str, ...]) -> str:
    options = bench.options(words[0]) if len(words) == 1 and words[0] in bench.names() else []
    return "\n".join(option.name + (f"={option.value}" if option.value else "") for option in options)


def _bench_options(words: tuple[str, ...]) -> Sequence[Option]:
    return bench.options(words[0]) if len(words) == 1 else ()


# experiment


def experiments() -> list[str]:
    return sorted(path.stem for path in _EXPERIMENTS.glob("[!_]*.py"))


def _experiment_words(words: tuple[str, ...]) -> None:
    if not words:
        raise Refused(f"say which: one of {', '.join(experiments())}, a file of a sweep, or the folder of a bundle")
    _no_more_than(1, words)
    word = words[0]
    if word in experiments() or _is_bundle(Path(word)):
        return
    if word.endswith(_SWEEP):
        _check_sweep(Path(word))
        return
    if Path(word).is_dir():
        raise Refused(f"{word} is no bundle: no file of it is named {_BUNDLE_PART}")
    choose(word, experiments(), "experiment")


def _check_sweep(path: Path) -> None:
    with absent.stood_in_for():
        importlib.import_module("sweeps.description").read(path, experiments())


def _is_bundle(path: Path) -> bool:
    return path.is_dir() and any(path.glob(_BUNDLE_PART))


def _experiment_options(words: tuple[str, ...]) -> Sequence[Option]:
    settings = _settings(words[0])
    return [Option(f"--{field.name}", "VALUE") for field in fields(settings)] if settings else []


def _parsed_by_the_experiment(given: Given) -> None:
    settings = _settings(given.words[0])
    if settings:
        _parse(settings, given.options)


def _settings(word: str) -> type | None:
    """What an experiment, or the command that plays sweeps, understands; none for a bundle."""
    with absent.stood_in_for():
        if word in experiments():
            found = getattr(importlib.import_module(f"experiments.{word}"), "Settings", None)
            if found is None:
                raise Refused(f"tools/experiments/{word}.py has no Settings: docs/tutorials/own_experiment.md says what these are")
            return found
        if word.endswith(_SWEEP):
            return importlib.import_module("sweeps.command").Settings
    return None


def _parse(settings: type, options) -> None:
    parse(settings, {name.removeprefix("--"): value for name, value in options.items()})


def _head_of_the_experiment(words: tuple[str, ...]) -> str:
    """The options, with what they mean and their units."""
    if not words or words[0] not in experiments():
        return ""
    return ast.get_docstring(ast.parse((_EXPERIMENTS / f"{words[0]}.py").read_text())) or ""


# replay


def _replay_words(words: tuple[str, ...]) -> None:
    if not words:
        raise Refused("say which folder is to be played again")
    _no_more_than(1, words)
    if not _is_bundle(Path(words[0])):
        raise Refused(f"{words[0]} is no bundle: no file of it is named {_BUNDLE_PART}")


# edit, app


def _scene_words(words: tuple[str, ...]) -> None:
    _no_more_than(1, words)
    if words and not scene(words[0]):
        below = [f"res://{path.relative_to(_PROJECT)}" for path in sorted(_PROJECT.rglob("*.tscn"))]
        choose(words[0], below, "scene")


def scene(word: str) -> str:
    """What Godot is to open: of the project, or, by its path, from the caller's folder; empty where there is no such file."""
    if word.startswith(("user://", "uid://")):
        return word
    if word.startswith("res://"):
        return word if (_PROJECT / word.removeprefix("res://")).is_file() else ""
    if Path(word).is_file():
        return str(Path(word).resolve())
    return f"res://{word}" if (_PROJECT / word).is_file() else ""


# addon


def _platforms(value: str) -> None:
    for name in value.split(","):
        choose(name, platforms.names(), "platform")


def _older_godot(value: str) -> None:
    choose(value, interfaces.VERSIONS, "Godot")


TABLE = (
    Command(
        "setup",
        [
            ("", "bring every dependency, build, import the project"),
            ("--with-sensing", "the same with depth cameras (OpenNI2), which demo and test bring by themselves, and PCL"),
            ("--device-access", "let this machine's users open haptic devices on USB"),
        ],
        options=lambda _: [Option("--with-sensing"), Option("--device-access")],
        together=_one_thing_to_set_up,
    ),
    Command("demo", [("", "touch both scenes for the thesis's path, report in build/report/index.html")]),
    Command(
        "test",
        [
            ("[FILTER]", "every test, or those whose name contains FILTER"),
            ("windows|arm64 [FILTER]", "the C++ tests and benches for Windows by Wine, for ARM Linux by QEMU"),
            ("--changed [FILTER]", "those that a change since the last green run of all can reach"),
            ("--times [FILTER]", "the same, and the slowest twenty with their share"),
            ("--sanitize=LIST [FILTER]", "the C++ tests watched by address,undefined or by thread"),
        ],
        options=lambda _: [Option("--sanitize", "LIST", _sanitizers), Option("--changed"), Option("--times")],
        words=_test_words,
        together=_watched_here,
    ),
    Command(
        "proof",
        [
            ("[--only=PART[.CASE]] [--key=value …]", "what takes hours: fuzzing, faults, endurance; the page docs/proof.md"),
            ("--page", "that page anew, of what has been run"),
        ],
        options=_proof_options,
        together=_of_a_part,
    ),
    Command(
        "bench",
        [("[NAME] [--key=value …]", "benches, results in build/bench/NAME.json")],
        options=_bench_options,
        words=_bench_words,
        details=_options_of_the_bench,
    ),
    Command(
        "experiment",
        [
            ("NAME [--key=value …]", "one experiment, results in build/experiments/NAME/"),
            ("SWEEPFILE [--cluster=ADDRESS] [--workers=N]", "many runs, described in one file, results in build/sweeps/"),
            ("BUNDLE", "one that has left its inputs, again, results in build/experiments/BUNDLE_again/"),
        ],
        options=_experiment_options,
        words=_experiment_words,
        together=_parsed_by_the_experiment,
        details=_head_of_the_experiment,
    ),
    Command(
        "replay",
        [("BUNDLE", "the same inputs again: does the same come of them, to the bit")],
        words=_replay_words,
    ),
    Command(
        "docs",
        [
            ("", "this documentation and the class reference as pages, in build/docs/"),
            ("--figures", "each table of the documents that a command makes, made anew: an hour or so"),
            ("--pictures", "the pictures of the editor and of scenes in docs/pictures/, drawn anew: some minutes"),
        ],
        options=lambda _: [Option("--figures"), Option("--pictures")],
    ),
    Command("edit", [("[SCENE]", "the demo project in the Godot editor")], words=_scene_words),
    Command(
        "app",
        [
            ("[SCENE]", "the demo project's main scene, or the one named"),
            ("-- --launch=form", "its launcher; behind -- stands what the program takes (./run app -- --help)"),
        ],
        words=_scene_words,
        starts_program=True,
    ),
    Command("export", [("", "a program that runs on its own, in build/export/")]),
    Command(
        "addon",
        [
            ("[--platform=NAME,…]", "one archive to unzip into any Godot project, in build/addon/"),
            ("--all", "the same with libraries for every platform that there is a cross compiler for: Windows, ARM Linux, macOS"),
            ("--godot=VERSION", "the same for an older Godot and all newer ones"),
        ],
        options=lambda _: [Option("--platform", "NAME,…", _platforms), Option("--all"), Option("--godot", "VERSION", _older_godot)],
    ),
)
BY_NAME = {command.name: command for command in TABLE}
