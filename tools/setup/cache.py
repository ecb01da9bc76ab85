"""Where Tactus keeps what it fetched and built outside the clone, and when such a thing counts as done."""

import ctypes
import fcntl
import hashlib
import os
import re
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from . import processes

# <fcntl.h>, <linux/fs.h>
_AT_FDCWD, _RENAME_EXCHANGE = -100, 2


def root() -> Path:
    return xdg_folder("XDG_CACHE_HOME", ".cache") / "tactus"


def xdg_folder(variable: str, below_home: str) -> Path:
    """A relative path counts as none, as the XDG Base Directory Specification has it: it would be another one in each folder."""
    named = Path(os.environ.get(variable) or "")
    return named if named.is_absolute() else Path.home() / below_home


def clone() -> Path:
    return Path(__file__).resolve().parents[2]


def venv_bin(name: str) -> Path:
    return root() / "venv" / "bin" / name


def digest(*parts: str) -> str:
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:16]


def is_done(folder: Path, key: str) -> bool:
    """A folder counts only when its stamp, which is written last, names the same content."""
    stamp = folder / ".done"
    return stamp.is_file() and stamp.read_text() == key


def mark_done(folder: Path, key: str) -> None:
    partial = folder / ".done.partial"
    partial.write_text(key)
    partial.rename(folder / ".done")


@contextmanager
def lock(place: Path, name: str) -> Iterator[None]:
    """Holds off other processes that would write the same; the system lets go when the holder dies."""
    folder = place / "locks"
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / re.sub(r"\W+", "_", name), "w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def emptied(folder: Path) -> Path:
    """There, with nothing in it. It stays the same folder: it may be a mount point, or a link to a folder elsewhere."""
    folder.mkdir(parents=True, exist_ok=True)
    for path in folder.iterdir():
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink()
    return folder


@contextmanager
def replacing(folder: Path) -> Iterator[Path]:
    """A new folder beside it that takes its place where the body comes to its end; else all stays as it was."""
    fresh = emptied(folder.with_name(f".{folder.name}.new"))
    try:
        yield fresh
        _exchange(fresh, folder)
    finally:
        shutil.rmtree(fresh, ignore_errors=True)


def _exchange(fresh: Path, folder: Path) -> None:
    """`folder` is one or the other at any time: the system swaps the two names. Where it cannot (a mount point, a link), the
    content is moved."""
    folder.mkdir(parents=True, exist_ok=True)
    if sys.platform == "linux" and not folder.is_symlink():
        library = ctypes.CDLL(None, use_errno=True)
        swapped = getattr(library, "renameat2", None)
        if swapped and swapped(_AT_FDCWD, os.fsencode(fresh), _AT_FDCWD, os.fsencode(folder), _RENAME_EXCHANGE) == 0:
            return
    emptied(folder)
    for path in fresh.iterdir():
        shutil.move(path, folder / path.name)


def variant(target: str, sanitizers: str = "", foreign: str = "", godot: str = "") -> str:
    """The folder in build/: what sanitizers watch, and what another platform runs, share nothing with the rest; of what is
    built against the interface of another `godot`, only what depends on it has a folder of its own."""
    parts = (target, foreign, sanitizers.replace(",", "_"), f"godot-{godot}" if godot else "")
    return ".".join(part for part in parts if part)


def shown(path: Path) -> str:
    """As the caller can type it."""
    return os.path.relpath(path)


def run_tool(script: str, *arguments: str) -> int:
    """A script of tools/ with the packages of the virtual environment. What Python compiles is kept in the cache: nothing
    is written between the sources, and nothing is compiled twice."""
    path = clone() / "tools"
    environment = os.environ | {"PYTHONPATH": str(path), "PYTHONPYCACHEPREFIX": str(root() / "pycache")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    return processes.run([venv_bin("python"), path / script, *arguments], env=environment)
