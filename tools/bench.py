"""./run bench [NAME] [--key=value …]: builds and runs tests/bench/NAME.cpp, which writes build/bench/NAME.json.

NAME.gd is a bench inside Godot, NAME.py one of what is around it.
"""

import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import build
import entry
import project
from arguments import Option
from measuring.options import Refused
from setup import cache, godot, jolt


# How a source asks for an option: of shared::Options, the later the more it says; and where it compares the words itself.
_KINDS = ["", "has", "text", "number"]
_ASKED = re.compile(r'\boptions\.(has|text|number)\("([a-z][\w-]*)"')
_COMPARED = re.compile(r'\bargument(?: == |\.starts_with\()"--([a-z][\w-]*)(=?)"')


ONLY_WHEN_NAMED = ["build"]  # it takes an hour


def names() -> list[str]:
    return sorted(path.stem for path in (cache.clone() / "tests/bench").iterdir() if path.suffix in (".cpp", ".gd", ".py"))


def options(name: str) -> list[Option]:
    """Those that its source asks for."""
    folder = cache.clone() / "tests/bench"
    texts = [path.read_text() for path in sorted([folder / f"{name}.cpp", *(folder / name).rglob("*.cpp")]) if path.is_file()]
    kinds: dict[str, str] = {}
    for kind, key in (pair for text in texts for pair in _ASKED.findall(text)):
        kinds[key] = max(kind, kinds.get(key, ""), key=_KINDS.index)
    for key, equals in (pair for text in texts for pair in _COMPARED.findall(text)):
        kinds[key] = "text" if equals else "has"
    return [Option(f"--{key}", "" if kind == "has" else "VALUE", _number if kind == "number" else str) for key, kind in sorted(kinds.items())]


def _number(value: str) -> None:
    try:
        if math.isfinite(float(value)):
            return
    except ValueError:
        pass
    raise Refused(f"{value!r} is not a number")


def _run(command: list, result: Path) -> int:
    return subprocess.run(command, env=os.environ | {"TACTUS_BENCH_JSON": str(result)}).returncode


def run_in_godot(script: Path, result: Path, engine: str = "DEFAULT") -> int:
    """`engine`: Godot's own physics, as the project's settings name it."""
    build.build("template_release", "extension")
    command = [godot.command(), "--headless", "--path", _project_of_release(engine), "--script", script, "--", result]
    return subprocess.run(command).returncode


def _project_of_release(engine: str) -> Path:
    """An empty project with the library that players get; a Godot that has an editor would take the one for debugging."""
    folder = cache.emptied(cache.clone() / "build/bench_project")
    addon = folder / "addons/tactus"
    addon.mkdir(parents=True)
    own = project.FOLDER / "addons/tactus"
    (addon / "bin").symlink_to(own / "bin")
    description = (own / "tactus.gdextension").read_text()
    (addon / "tactus.gdextension").write_text(description.replace("template_debug", "template_release"))
    (folder / "project.godot").write_text(f'config_version=5\n\n[physics]\n\n3d/physics_engine="{engine}"\n')
    project.name_extension(folder)
    return folder


def keep(partial: Path, result: Path) -> None:
    """What a script has left takes the place of the result before when it is whole."""
    try:
        json.loads(partial.read_text())
        partial.replace(result)
    except (OSError, ValueError):
        raise RuntimeError(f"{result} could not be written: is the disk full? The one before is as it was.") from None
    finally:
        partial.unlink(missing_ok=True)


def draw(name: str, result: Path) -> int:
    """Runs tools/bench_plots/NAME.py on the result of a bench that has one: CSV and chart beside the JSON."""
    plot = cache.clone() / "tools/bench_plots" / f"{name}.py"
    return subprocess.run([sys.executable, plot, result]).returncode if plot.is_file() else 0


def main(arguments: list[str]) -> int:
    chosen = [argument for argument in arguments if not argument.startswith("--")]
    passed_on = [argument for argument in arguments if argument.startswith("--")]
    run = chosen or [name for name in names() if name not in ONLY_WHEN_NAMED]
    if "proxy" in run and jolt.installed() is None and jolt.ready(fast=True) is None:
        print("Building Jolt without its deterministic mode, once, to hold beside it …", flush=True)
        jolt.fetch_and_build(fast=True)
    if any((cache.clone() / "tests/bench" / f"{name}.cpp").is_file() for name in run):
        build.build("template_release", "benches")
    output = cache.clone() / "build/bench"
    output.mkdir(parents=True, exist_ok=True)
    for name in run:
        program = cache.clone() / "build/template_release/bench" / name
        result = output / f"{name}.json"
        print(f"== {name}", flush=True)
        script = cache.clone() / "tests/bench" / name
        partial = result.with_suffix(".partial")
        if script.with_suffix(".gd").is_file():
            code = run_in_godot(script.with_suffix(".gd"), partial)
        elif script.with_suffix(".py").is_file():
            code = _run([sys.executable, script.with_suffix(".py"), *passed_on], partial)
        else:
            code = _run([program, *passed_on], result)  # shared/bench_kit.hpp keeps it itself
        if code == 0 and not script.with_suffix(".cpp").is_file():
            keep(partial, result)
        if code == 0 and result.is_file():
            print(f"   {cache.shown(result)}")
            code = draw(name, result)
        if code != 0:
            return code
    return 0


if __name__ == "__main__":
    entry.leave(main)
