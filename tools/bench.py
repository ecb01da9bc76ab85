"""./run bench [NAME] [--key=value …]: builds and runs tests/bench/NAME.cpp, which writes build/bench/NAME.json.

NAME.gd is a bench inside Godot.
"""

import os
import subprocess
import sys
from pathlib import Path

import build
import project
from setup import cache, godot, jolt


def names() -> list[str]:
    return sorted(path.stem for path in (cache.clone() / "tests/bench").iterdir() if path.suffix in (".cpp", ".gd"))


def run_in_godot(script: Path, result: Path) -> int:
    build.build("template_release", "extension")
    command = [godot.command(), "--headless", "--path", _project_of_release(), "--script", script, "--", result]
    return subprocess.run(command).returncode


def _project_of_release() -> Path:
    """An empty project with the library that players get; a Godot that has an editor would take the one for debugging."""
    folder = cache.emptied(cache.clone() / "build/bench_project")
    addon = folder / "addons/tactus"
    addon.mkdir(parents=True)
    own = project.FOLDER / "addons/tactus"
    (addon / "bin").symlink_to(own / "bin")
    description = (own / "tactus.gdextension").read_text()
    (addon / "tactus.gdextension").write_text(description.replace("template_debug", "template_release"))
    (folder / "project.godot").write_text("config_version=5\n")
    project.name_extension(folder)
    return folder


def draw(name: str, result: Path) -> None:
    """Runs tools/bench_plots/NAME.py on the result of a bench that has one: CSV and chart beside the JSON."""
    plot = cache.clone() / "tools/bench_plots" / f"{name}.py"
    if plot.is_file():
        subprocess.run([sys.executable, plot, result], check=False)


def main(arguments: list[str]) -> int:
    chosen = [argument for argument in arguments if not argument.startswith("--")]
    passed_on = [argument for argument in arguments if argument.startswith("--")]
    unknown = sorted(set(chosen) - set(names()))
    if unknown or (passed_on and len(chosen) != 1):
        print(f"./run bench [NAME] [--key=value …], where NAME is one of: {', '.join(names())}", file=sys.stderr)
        return 2
    if "proxy" in (chosen or names()) and jolt.installed() is None and jolt.ready(fast=True) is None:
        print("Building Jolt without its deterministic mode, once, to hold beside it …", flush=True)
        jolt.fetch_and_build(fast=True)
    build.build("template_release", "benches")
    output = cache.clone() / "build/bench"
    output.mkdir(parents=True, exist_ok=True)
    for name in chosen or names():
        program = cache.clone() / "build/template_release/bench" / name
        result = output / f"{name}.json"
        print(f"== {name}", flush=True)
        environment = os.environ | {"TACTUS_BENCH_JSON": str(result)}
        script = cache.clone() / "tests/bench" / f"{name}.gd"
        if script.is_file():
            code = run_in_godot(script, result)
        else:
            code = subprocess.run([program, *passed_on], env=environment).returncode
        if code != 0:
            return code
        if result.is_file():
            print(f"   {result.relative_to(cache.clone())}")
            draw(name, result)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
