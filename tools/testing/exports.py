"""Programs that are exported for tests, anew only where what goes into them has changed."""

from collections.abc import Callable
from pathlib import Path

import project
from setup import cache


def of_project() -> Path:
    """The demo project as ./run export gives it."""
    return kept(cache.clone() / "build/exported_project", project.content(), project.export_to)


def kept(folder: Path, content: str, export: Callable[[Path], None]) -> Path:
    """The program, alone in its folder but for what belongs to it. `content` names all that it is made of."""
    program = folder / "tactus.x86_64"
    with cache.lock(cache.clone() / "build", folder.name):
        if not cache.is_done(folder, content):
            cache.emptied(folder)
            export(program)
            cache.mark_done(folder, content)
    return program
