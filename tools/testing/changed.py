"""Which tests a change since the last green run of all tests can reach, for the hand; .ci/run runs all.

C++: the tests of a program whose bytes have changed; where only test files have, those in these. Godot: all of it
where the extension or anything in the project has changed, else the files that have. The tools: all of them where
anything that is not compiled has changed, else the files that have.
"""

import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from setup import cache
from testing import cpp_suite

_FILE = cache.clone() / "build/last_green.json"
_PROGRAMS = "build/template_debug/tests/"
_COMPILED = (".cpp", ".hpp", ".h")


@dataclass
class Reached:
    """Predicates of a test's name."""

    cpp: Callable[[str], bool]
    godot: Callable[[str], bool]
    tools: Callable[[str], bool]


def everything() -> Reached:
    return Reached(*[lambda _: True] * 3)


def since_last_green() -> Reached:
    if not _FILE.is_file():
        print("No green run of all tests is known here: all of them are run.")
        return everything()
    before, now = json.loads(_FILE.read_text()), _digests()
    changed = {path for path in before.keys() | now.keys() if before.get(path) != now.get(path)}
    print(f"{len(changed)} files differ from the last green run.")
    return reached_by(changed)


def reached_by(changed: set[str]) -> Reached:
    """What changes of these files, relative to the clone, can reach."""
    compiled = {path for path in changed if path.endswith(_COMPILED)}
    own = {name for path in compiled for name in _tests_in(path)}
    only_tests = all(path.endswith("_test.cpp") for path in compiled)
    programs = {path.rpartition("/test_")[2] for path in changed if path.startswith(_PROGRAMS)}
    in_project = {path for path in changed if path.startswith(("demo_project/", "tests/godot/"))}
    all_of_godot = any(not path.endswith("_test.gd") for path in in_project)
    of_tools = {path for path in changed - in_project - compiled if not path.startswith("build/")}
    all_of_tools = all_of_godot or any(not _is_tool_test(path) for path in of_tools)
    stems = {Path(path).stem for path in changed}
    return Reached(
        cpp=lambda name: name.split(".")[1] in programs and (not only_tests or _without_parameters(name) in own),
        godot=lambda name: all_of_godot or name.split(".")[-2] in stems,
        tools=lambda name: all_of_tools or name.split(".")[1] in stems,
    )


def _without_parameters(name: str) -> str:
    """cpp.LAYER.SUITE.TEST of cpp.LAYER.INSTANCE/SUITE.TEST/0."""
    _, layer, suite, test = name.split(".", 3)
    return f"cpp.{layer}.{suite.rpartition('/')[2]}.{test.partition('/')[0]}"


def note_green() -> None:
    _FILE.parent.mkdir(parents=True, exist_ok=True)
    _FILE.write_text(json.dumps(_digests()))


def _is_tool_test(path: str) -> bool:
    return path.startswith("tests/tools/test_") and path.endswith(".py")


def _tests_in(path: str) -> list[str]:
    source = cache.clone() / path
    if not path.endswith("_test.cpp") or not source.is_file():
        return []
    return cpp_suite.named_in(source)


def _digests() -> dict[str, str]:
    """Of all files that a test can read: sources, and the libraries that they have become."""
    clone = cache.clone()
    folders = ["extension", "tests", "tools", "site_scons", "demo_project", "docs", _PROGRAMS.rstrip("/")]
    paths = [path for folder in folders for path in (clone / folder).rglob("*") if path.is_file()]
    paths += [path for path in clone.iterdir() if path.is_file()]
    kept = [path for path in paths if ".godot" not in path.parts and "__pycache__" not in path.parts]
    return {str(path.relative_to(clone)): hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(kept)}
