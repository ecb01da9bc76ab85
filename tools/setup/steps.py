"""Set-up as a list of steps, each with a name, a test whether it is done, and what does it."""

import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import entry

from . import cache, cross, godot, interfaces, jolt, python_tools, zig
from .platforms import Platform


@dataclass
class Step:
    name: str
    is_done: Callable[[], bool]
    do: Callable[[], object]
    place: Path = field(default_factory=cache.root)  # what it writes to, one process at a time
    alone: bool = False  # needs no other step: begins with the first one, so that compiling and downloading overlap


def python() -> Step:
    return Step("Python tools", python_tools.is_done, python_tools.install)


def checkers() -> Step:
    return Step("Checkers of citation and workflow", lambda: python_tools.is_done("papers"), lambda: python_tools.install("papers"), alone=True)


def dependencies() -> list[Step]:
    steps = [python()]
    if godot.installed() is None:
        steps.append(Step("Godot", godot.is_private_ready, godot.fetch))
    steps.append(Step("Godot's API", _is_api_ready, lambda: godot.dump_api(_godot())))
    steps.append(Step(f"Jolt {jolt.VERSION}", lambda: jolt.ready() is not None, jolt.fetch_and_build, alone=True))
    return steps


def for_platforms(platforms: list[Platform]) -> list[Step]:
    """What programs for other platforms need, and this machine's own, which are asked whether they compute the same."""
    return dependencies() + of_platforms(platforms)


def of_platforms(platforms: list[Platform]) -> list[Step]:
    """What other platforms need besides."""
    steps = [Step("Zig, the compiler for macOS", zig.is_done, zig.install)] if any(one.system == "macos" for one in platforms) else []
    for one in platforms:
        steps.append(Step(f"libsodium for {one.name}", lambda one=one: bool(cross.ready(one)), lambda one=one: cross.build(one)))
        steps.append(
            Step(
                f"Jolt {jolt.VERSION} for {one.name}",
                lambda one=one: jolt.ready(platform=one) is not None,
                lambda one=one: jolt.fetch_and_build(platform=one),
            )
        )
    return steps


def older_interfaces() -> Step:
    return Step("Interface of Godot 4.4", interfaces.is_ready, interfaces.fetch, alone=True)


def export_template() -> Step:
    return Step("Export template", lambda: godot.is_template_ready(_godot()), lambda: godot.install_template(_godot()))


def run(steps: list[Step]) -> None:
    """Does what is not done yet and shows it; ends the program at the first step that fails."""
    pool = ThreadPoolExecutor()
    try:
        begun = {step.name: pool.submit(_carry_out, step) for step in steps if step.alone}
        for number, step in enumerate(steps, 1):
            print(f"[{number}/{len(steps)}] {step.name} … ", end="", flush=True)
            try:
                print(_finished(step, begun), flush=True)
            except (RuntimeError, OSError, subprocess.SubprocessError) as error:
                why = entry.in_words(error) if isinstance(error, OSError) else error
                print(f"failed\n{why}", file=sys.stderr, flush=True)
                sys.exit(1)
    finally:
        # Who is ended, or has failed, does not wait for what runs beside: what that has done half is done anew.
        pool.shutdown(wait=False, cancel_futures=True)


def _finished(step: Step, begun: dict[str, Future[str]]) -> str:
    return begun[step.name].result() if step.name in begun else _carry_out(step)


def _carry_out(step: Step) -> str:
    started = time.monotonic()
    if step.is_done():
        return "ready"
    with cache.lock(step.place, step.name):
        if step.is_done():  # another process has done it meanwhile
            return "ready"
        step.do()
    return f"{time.monotonic() - started:.0f} s"


def _godot() -> str:
    command = godot.command()
    if command is None:
        raise RuntimeError("no Godot")
    return command


def _is_api_ready() -> bool:
    return godot.is_api_ready(_godot())
