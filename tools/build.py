"""Calls SCons."""

import os
import subprocess
import sys

from setup import cache
from setup.steps import Step


def step(target: str) -> Step:
    # SCons itself knows what is up to date.
    def do() -> None:
        build(target, "libraries", "extension", "commands")

    return Step(f"Build {target}", lambda: False, do, place=cache.clone() / "build")


def build(target: str, *what: str) -> None:
    """What is to be built: SCons's own arguments, such as sanitize=thread, may stand among it."""
    command = [cache.venv_bin("scons"), "-s", f"-j{os.cpu_count() or 1}", f"target={target}", *what]
    done = subprocess.run(command, cwd=cache.clone(), text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        print(done.stdout, file=sys.stderr)
        raise RuntimeError(f"the build of {target} failed")
