"""The headless tests of tests/godot: godot.FILE.TEST. One Godot per file, so that what it prints has an owner.

Files of RELEASED run once more, as godot.released.FILE.TEST, in a program that is exported for players; those of EDITED run
in the editor, and nowhere else. Those of WITH_EACH_ENGINE run with each of Godot's own physics engines, as godot.ENGINE.FILE.TEST.

A file passes only with its END marker, and a test only without lines of error or leak that it has not announced.
"""

import functools
import os
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import project
from setup import cache, godot
from testing import exports
from testing.jobs import Job
from testing.results import Result, matching

FOLDER = cache.clone() / "tests/godot"
PROJECT = cache.clone() / "demo_project"
RELEASED = ["first_touch_test", "misuse_test", "random_calls_test", "scripts_test", "turns_test"]
EDITED = ["citizen_editor_test", "editor_test"]
WITH_EACH_ENGINE = ["games_test", "felt_test", "uneven_frames_test", "godot_soft_bodies_test"]
ENGINES = {"jolt": "Jolt Physics", "own": "GodotPhysics3D"}
THREADED = ["threaded_test"]  # With Godot's physics on a thread of its own.
NEED_EYES = ["scenario5_test", "sensing_test"]
MAIN_SCENE = """[gd_scene load_steps=2 format=3]

[ext_resource type="Script" path="res://tests/runner.gd" id="runner"]

[node name="Runner" type="Node"]
script = ExtResource("runner")
"""
EDITOR_PLUGIN = """[plugin]

name="Tests"
description=""
author=""
version=""
script="editor_plugin.gd"
"""
# What is freed is filled with this, so that a use after it shows.
POISONED = os.environ | {"MALLOC_PERTURB_": "165"}
TIME_LIMIT = 300  # (unit: seconds) a file
TROUBLE = re.compile(r"^\s*(ERROR|SCRIPT ERROR|USER ERROR|USER SCRIPT ERROR):|leaked at exit|still in use at exit|^Leaked ")


def has(wanted: str) -> bool:
    """Whether there is a test whose name contains the words."""
    return any(matching([*_names(path), *_released_names(path)], wanted) for path in _files())


def _files() -> list[Path]:
    return sorted(FOLDER.rglob("*_test.gd"))


def _names(path: Path) -> list[str]:
    names = re.findall(r"^func (test_\w+)", path.read_text(), re.M)
    return [prefix + name for prefix in _prefixes(path) for name in names]


def _released_names(path: Path) -> list[str]:
    return [name.replace("godot.", "godot.released.", 1) for name in _names(path)] if path.stem in RELEASED else []


def jobs(wanted: str, is_reached: Callable[[str], bool] = lambda _: True) -> list[Job]:
    found = []
    released = {path.stem: _of(_released_names(path), wanted, is_reached) for path in _files()}
    if any(released.values()):
        found.append(Job("godot", "godot.released", lambda: _run_released(released)))
    for path in _files():
        if chosen := _of(_names(path), wanted, is_reached):
            found.append(Job("godot", f"godot.{path.stem}", functools.partial(_run_one, path, chosen)))
    return found


def _of(names: list[str], wanted: str, is_reached: Callable[[str], bool]) -> list[str]:
    return list(filter(is_reached, matching(names, wanted)))


def _run_one(path: Path, chosen: list[str]) -> list[Result]:
    if path.stem in EDITED:
        return _run_edited(path, chosen)
    if path.stem in NEED_EYES and not any(PROJECT.glob("addons/tactus/bin/libtactus_sensing.*")):
        return [Result(name, skipped="it needs OpenNI2: ./run setup --with-sensing") for name in chosen]
    return _run_file(path, chosen)


def _prefix(path: Path) -> str:
    return f"godot.{path.stem}."


def _prefixes(path: Path) -> list[str]:
    return [f"godot.{engine}.{path.stem}." for engine in ENGINES] if path.stem in WITH_EACH_ENGINE else [_prefix(path)]


def _run_file(path: Path, chosen: list[str]) -> list[Result]:
    results = []
    for prefix in _prefixes(path):
        names = [name.removeprefix(prefix) for name in chosen if name.startswith(prefix)]
        folder = _with_engine(prefix.split(".")[1]) if path.stem in WITH_EACH_ENGINE else PROJECT
        folder = _with_engine("thread") if path.stem in THREADED else folder
        command = [str(godot.command()), "--headless", "--path", folder, "--script", FOLDER / "run_tests.gd", "--", path]
        results += _run(prefix, command, names) if names else []
    return results


def _with_engine(name: str) -> Path:
    """The demo project, whose bodies are moved by that engine of Godot's."""
    folder = cache.emptied(cache.clone() / "build/engine_tests" / name)
    for part in PROJECT.iterdir():
        if part.name != "project.godot":
            (folder / part.name).symlink_to(part)
    settings = (PROJECT / "project.godot").read_text()
    engine = f'3d/physics_engine="{ENGINES[name]}"' if name in ENGINES else "3d/run_on_separate_thread=true"
    (folder / "project.godot").write_text(settings + f"\n[physics]\n\n{engine}\n")
    return folder


def _run_edited(path: Path, chosen: list[str]) -> list[Result]:
    folder = _with_tests(cache.clone() / "build/edited_tests" / path.stem)
    (folder / "tests/plugin.cfg").write_text(EDITOR_PLUGIN)
    settings = folder / "project.godot"
    with_plugin = settings.read_text().replace('enabled=PackedStringArray(', 'enabled=PackedStringArray("res://tests/plugin.cfg", ')
    # What the editor plays needs no screen either.
    settings.write_text(with_plugin + '\n[editor]\n\nrun/main_run_args="--headless"\n')
    project.import_into(folder)
    command = [str(godot.command()), "--headless", "--editor", "--path", folder, "--", f"res://tests/{path.name}"]
    names = [name.removeprefix(_prefix(path)) for name in chosen]
    # An editor of its own: what the person has set up for theirs is neither used nor changed.
    own = {f"XDG_{kind}_HOME": str(folder / ".godot" / kind.lower()) for kind in ("CONFIG", "DATA", "CACHE")}
    return _run(_prefix(path), command, names, POISONED | own)


def _run(prefix: str, command: list, names: list[str], environment: dict[str, str] = POISONED) -> list[Result]:
    try:
        done = subprocess.run(
            [*command, *names],
            env=environment,
            timeout=TIME_LIMIT,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
    except subprocess.TimeoutExpired:
        return [Result(prefix + "file", f"not done after {TIME_LIMIT} s")]
    took = times(done.stdout)
    verdicts = judge(done.stdout, names)
    return [Result(prefix + name, why, seconds=took.get(name, 0.0)) for name, why in verdicts.items()]


def _run_released(chosen_of: dict[str, list[str]]) -> list[Result]:
    program, results = _exported_tests(), []
    for stem, chosen in chosen_of.items():
        if chosen:
            prefix = f"godot.released.{stem}."
            command = [program, "--headless", "--", f"res://tests/{stem}.gd"]
            results += _run(prefix, command, [name.removeprefix(prefix) for name in chosen])
    return results


def _with_tests(folder: Path) -> Path:
    """The demo project with the tests in it, and with what Godot has made of its pictures and meshes already."""
    cache.emptied(folder)
    shutil.copytree(PROJECT, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns(".godot"))
    shutil.copytree(PROJECT / ".godot/imported", folder / ".godot/imported")
    (folder / "tests").mkdir()
    for path in FOLDER.glob("*.gd"):
        # The binding's own tests need an extension of their own.
        if not path.name.startswith("binding") and path.name != "run_tests.gd":
            shutil.copy(path, folder / "tests")
    return folder


def _exported_tests() -> Path:
    """The demo project with the tests in it, whose main scene runs them."""
    content = cache.digest(project.content(), *(path.read_text() for path in [*sorted(FOLDER.glob("*.gd")), Path(__file__)]))
    return exports.kept(cache.clone() / "build/released_program", content, _export_tests)


def _export_tests(program: Path) -> None:
    folder = _with_tests(cache.clone() / "build/released_tests")
    (folder / "tests/main.tscn").write_text(MAIN_SCENE)
    settings = folder / "project.godot"
    # A program for players keeps what it prints to itself for a while, and its errors not: here their order matters.
    changed = 'run/main_scene="res://tests/main.tscn"\nrun/flush_stdout_on_print=true'
    settings.write_text(re.sub(r'run/main_scene=".*"', changed, settings.read_text()))
    project.name_extension(folder)  # the export imports what is left
    project.export_to(program, folder)


def times(output: str) -> dict[str, float]:
    """How long each test took, as the runner prints it (unit: seconds)."""
    return {name: int(ms) / 1000.0 for name, ms in re.findall(r"^RUN (\w+)$(?:\n(?!RUN ).*)*?\nTOOK (\d+) ms$", output, re.M)}


def judge(output: str, expected_tests: list[str]) -> dict[str, str]:
    """Why each test failed, empty for those that passed. "start" and "exit" appear when there was trouble there."""
    sections, order = {"start": []}, ["start"]
    for line in output.splitlines():
        if line.startswith("RUN ") or line == "END":
            order.append("exit" if line == "END" else line.removeprefix("RUN "))
            sections[order[-1]] = []
        else:
            sections[order[-1]].append(line)
    verdicts = {name: _verdict(name, sections[name]) for name in order}
    for name in expected_tests:
        verdicts.setdefault(name, "did not run")
    if "exit" not in verdicts:
        verdicts["exit"] = f"ended before its end:\n{output[-2000:]}"
    return {name: why for name, why in verdicts.items() if why or name not in ("start", "exit")}


def _verdict(name: str, lines: list[str]) -> str:
    failures = [line for line in lines if line.startswith("FAIL ")]
    if failures:
        return failures[0].partition(": ")[2] or failures[0]
    announced = [line.removeprefix("EXPECT ") for line in lines if line.startswith("EXPECT ")]
    trouble = [line for line in lines if TROUBLE.search(line) and not any(text in line for text in announced)]
    if trouble:
        return "\n".join(trouble)
    said = [line for line in lines if not line.startswith("EXPECT ")]
    missing = [words for words in announced if sum(words in line for line in said) < announced.count(words)]
    if missing:
        return f"announced but not printed: {missing[0]}"
    return "" if name in ("start", "exit") or f"PASS {name}" in lines else "neither passed nor failed"
