"""Which Tactus this is."""

import re
import subprocess

from setup import cache


def version() -> str:
    """The newest one in the changelog."""
    found = re.search(r"^## (\d+\.\d+\.\d+)$", (cache.clone() / "CHANGELOG.md").read_text(), re.M)
    return found[1] if found else "of no version"


def commit() -> str:
    """Of the clone, with a plus where files are others than there; without Git, that."""
    try:
        said = subprocess.run(["git", "describe", "--always", "--dirty=+"], cwd=cache.clone(), text=True, capture_output=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return "without Git"
    return said.stdout.strip()
