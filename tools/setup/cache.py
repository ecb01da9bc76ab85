"""Where Tactus keeps what it fetched and built outside the clone, and when such a thing counts as done."""

import fcntl
import hashlib
import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


def root() -> Path:
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(base) / "tactus"


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
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def variant(target: str, sanitizers: str = "", foreign: str = "") -> str:
    """The folder in build/: what sanitizers watch, and what another platform runs, share nothing with the rest."""
    return ".".join(part for part in (target, foreign, sanitizers.replace(",", "_")) if part)


def run_tool(script: str, *arguments: str) -> int:
    """A script of tools/ with the packages of the virtual environment."""
    path = clone() / "tools"
    environment = os.environ | {"PYTHONPATH": str(path), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run([venv_bin("python"), path / script, *arguments], env=environment).returncode
