"""SCons, the formatters, matplotlib, Dask, Sphinx and pytest in a virtual environment of the cache, each file checked by its hash."""

import shutil
import subprocess
import sys

from . import cache, fetching


def is_done() -> bool:
    return cache.is_done(_folder(), _key())


def install() -> None:
    shutil.rmtree(_folder(), ignore_errors=True)
    subprocess.run([sys.executable, "-m", "venv", _folder()], check=True)
    requirements = cache.clone() / "tools/requirements.txt"
    options = ["--quiet", "--disable-pip-version-check", "--no-compile", "--require-hashes", "--only-binary=:all:"]
    command = [cache.venv_bin("python"), "-m", "pip", "install", *options, "-r", requirements]
    done = subprocess.run(command, text=True, capture_output=True)
    if done.returncode != 0:
        raise fetching.trouble("pip", done.stderr)
    cache.mark_done(_folder(), _key())


def _folder():
    return cache.root() / "venv"


def _key() -> str:
    requirements = (cache.clone() / "tools/requirements.txt").read_text()
    return cache.digest(requirements, sys.version, str(_folder()))
