"""Godot as the project uses it, with a virtual screen where there is none: run_godot.py ARGUMENTS…"""

import subprocess
import sys

from setup import display, godot

if __name__ == "__main__":
    with display.environment() as environment:
        sys.exit(subprocess.run([str(godot.command()), *sys.argv[1:]], env=environment).returncode)
