"""Python packages in virtual environments of the cache, each file checked by its hash.

"venv" has SCons, the formatters, matplotlib, Dask, Sphinx and pytest; "mujoco" what the bench of credibility asks; "franka" and
"franka_simulator" the vendor's library for its arm, and what plays that arm; "zig" the compiler for macOS; "papers" the checkers of
CITATION.cff and of the workflow.
"""

import shutil
import subprocess
import sys
from pathlib import Path

from . import cache, fetching

REQUIREMENTS = {
    "venv": "tools/requirements.txt",
    "mujoco": "tools/credibility/requirements.txt",
    "franka": "tools/franka/requirements.txt",
    "franka_simulator": "tools/franka/simulator.txt",
    "zig": "tools/cross/requirements.txt",
    "papers": "tools/papers/requirements.txt",
}


def is_done(name: str = "venv") -> bool:
    return cache.is_done(_folder(name), _key(name))


def install(name: str = "venv") -> None:
    shutil.rmtree(_folder(name), ignore_errors=True)
    subprocess.run([sys.executable, "-m", "venv", _folder(name)], check=True)
    # Each list is whole. One package is left out of its own: docopt has no wheel, and only a command that is not called needs it.
    options = ["--quiet", "--disable-pip-version-check", "--no-compile", "--no-deps", "--require-hashes", "--only-binary=:all:"]
    command = [python(name), "-m", "pip", "install", *options, "-r", cache.clone() / REQUIREMENTS[name]]
    done = subprocess.run(command, text=True, capture_output=True)
    if done.returncode != 0:
        raise fetching.trouble("pip", done.stderr)
    cache.mark_done(_folder(name), _key(name))


def python(name: str = "venv") -> Path:
    return _folder(name) / "bin" / "python"


def _folder(name: str) -> Path:
    return cache.root() / name


def _key(name: str) -> str:
    return cache.digest((cache.clone() / REQUIREMENTS[name]).read_text(), sys.version, str(_folder(name)))
