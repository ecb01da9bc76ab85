"""Set-up as a list of steps, each with a name, a test whether it is done, and what does it."""

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

from . import cache, godot, jolt, python_tools


@dataclass
class Step:
    name: str
    is_done: Callable[[], bool]
    do: Callable[[], object]


def dependencies() -> list[Step]:
    steps = [Step("Python tools", python_tools.is_done, python_tools.install)]
    if godot.installed() is None:
        steps.append(Step(f"Godot {godot.PINNED}", godot.is_private_ready, godot.fetch))
    steps.append(Step("Godot's API", _is_api_ready, lambda: godot.dump_api(_godot())))
    steps.append(Step(f"Jolt {jolt.VERSION}", lambda: jolt.ready() is not None, jolt.fetch_and_build))
    return steps


def export_template() -> Step:
    return Step("Export template", lambda: godot.is_template_ready(_godot()), lambda: godot.install_template(_godot()))


def run(steps: list[Step]) -> None:
    """Does what is not done yet and shows it; ends the program at the first step that fails."""
    for number, step in enumerate(steps, 1):
        print(f"[{number}/{len(steps)}] {step.name} … ", end="", flush=True)
        started = time.monotonic()
        try:
            done_before = step.is_done()
            if not done_before:
                step.do()
        except (RuntimeError, OSError) as error:
            print(f"failed\n{error}", file=sys.stderr)
            sys.exit(1)
        print("ready" if done_before else f"{time.monotonic() - started:.0f} s", flush=True)


def _godot() -> str:
    command = godot.command()
    if command is None:
        raise RuntimeError("no Godot")
    return command


def _is_api_ready() -> bool:
    return godot.is_api_ready(_godot())
