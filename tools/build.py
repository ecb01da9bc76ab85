"""Calls SCons."""

import os
import subprocess
import sys
from pathlib import Path

from setup import cache, processes
from setup.progress import Pace, Progress, in_words
from setup.steps import Step


# In the environment of what a command starts that has built all that they need, such as ./run test: the clone, and each
# TARGET:WHAT that is up to date, a line each.
BUILT = "TACTUS_BUILT"


def step(target: str, *more: str) -> Step:
    """Builds the extension, and more of scons's targets; SCons itself knows what is up to date."""

    def do() -> None:
        build(target, "extension", *more, "commands")

    return Step(f"Build {target}", lambda: False, do, place=cache.clone() / "build")


def _shown(line: str, pace: Pace) -> str:
    """Of a line "@ 12/240" of scons."""
    done, wanted = map(int, line.removeprefix("@ ").split("/"))
    left = pace.left(done, wanted)
    return f"{done}/{wanted} files" + (f", {in_words(left)} left" if left is not None else "")


def build(target: str, *what: str) -> None:
    """What is to be built: SCons's own arguments, such as sanitize=thread, may stand among it."""
    if is_declared(target, *what):
        return
    options = ["-s", f"-j{os.cpu_count() or 1}", f"target={target}", "progress=yes"]
    if named := os.environ.get("GODOT_CPP"):
        # As the caller's folder has it; SCons runs in the clone.
        prefix = Path(named).expanduser().absolute()
        print(f"godot-cpp: {prefix} (GODOT_CPP)")
        options.append(f"godot_cpp={prefix}")
    progress, pace, printed = Progress(), Pace(), []
    # Two at once in one clone would write each other's records of what is built.
    with cache.lock(cache.clone() / "build", "scons"), processes.started(
        [cache.venv_bin("scons"), *options, *what],
        cwd=cache.clone(),
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    ) as scons:
        for line in scons.stdout or []:
            if line.startswith("@ "):
                progress.show(_shown(line, pace))
            else:
                printed.append(line)
    progress.end()
    if scons.returncode != 0:
        print("".join(printed), file=sys.stderr)
        raise RuntimeError(f"the build of {target} failed")


def declare(built: dict[str, list[str]]) -> None:
    """That these are up to date, by their target, for all processes that this one starts: SCons takes seconds to see it."""
    lines = [f"{target}:{one}" for target, what in built.items() for one in what]
    os.environ[BUILT] = "\n".join([str(cache.clone()), *lines])


def is_declared(target: str, *what: str) -> bool:
    clone, *built = os.environ.get(BUILT, "").split("\n")
    return clone == str(cache.clone()) and {f"{target}:{one}" for one in what} <= set(built)
