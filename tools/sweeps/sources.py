"""What the results of an experiment depend on: the sources, as one word."""

import hashlib
from collections.abc import Iterator
from functools import cache as once
from pathlib import Path

from setup import cache

# Files by their folder and ending; none stands for all.
PLACES = {
    "extension": (), "tests/bench": (), "tests/shared": (), "site_scons": (".py",), "tools/experiments": (".py",),
    "tools/measuring": (".py",), "demo_project": (".tscn", ".tres", ".gd", ".json", ".obj", ".godot"),
}  # fmt: skip


@once
def digest() -> str:
    found = hashlib.sha256((cache.clone() / "SConstruct").read_bytes())
    for path in _files():
        found.update(f"{path.relative_to(cache.clone())}\0".encode() + hashlib.sha256(path.read_bytes()).digest())
    return found.hexdigest()[:16]


def _files() -> Iterator[Path]:
    for place, endings in PLACES.items():
        for path in sorted((cache.clone() / place).rglob("*")):
            is_made = any(part.startswith(".") or part in ("__pycache__", "bin") for part in path.relative_to(cache.clone()).parts)
            if path.is_file() and not is_made and (not endings or path.suffix in endings):
                yield path
