"""Draws the pictures that the gallery's menu shows of its scenes: demo_project/gallery/NAME/NAME.webp.

    PYTHONPATH=tools python3 tools/make_pictures.py [NAME …]
"""

import subprocess
import sys

from project import FOLDER
from setup import cache, display, godot


def main(names: list[str]) -> int:
    command = [str(godot.command()), "--path", FOLDER, "--script", cache.clone() / "tools/pictures.gd", "--", *names]
    with display.environment() as environment:
        return subprocess.run(command, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
