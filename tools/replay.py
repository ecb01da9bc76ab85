"""./run replay BUNDLE: plays again what entered the loops of an experiment, and says whether the same comes of it.

BUNDLE is a folder that an experiment has left (the program's launcher, or any scene with --inputs=1): for each of its
sides CASE_inputs.tactus, CASE.csv and CASE_settings.json. The exit code is 0 where everything is the same to the bit, 1
where something is not, 2 where not all of it could be played.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import entry
from project import FOLDER
from setup import godot

INPUTS = "_inputs.tactus"


def is_bundle(folder: Path) -> bool:
    return folder.is_dir() and any(folder.glob(f"*{INPUTS}"))


def play(bundle: Path, output: Path) -> int:
    """Into `output`: for each side, CASE.csv as it is now and CASE_replay.json."""
    arguments = ["--headless", "--path", FOLDER, "--", f"--replay={bundle.resolve()}", f"--output={output.resolve()}"]
    done = subprocess.run([str(godot.command()), *map(str, arguments)], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    lines = [line for line in done.stdout.splitlines() if line.strip() and not line.startswith("Godot Engine")]
    print("\n".join(lines), flush=True)
    return done.returncode


def main(arguments: list[str]) -> int:
    if len(arguments) != 1:
        print("./run replay BUNDLE", file=sys.stderr)
        return 2
    bundle = Path(arguments[0])
    if not is_bundle(bundle):
        print(f"{bundle} is no bundle: no file of it ends in {INPUTS}", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as output:
        return play(bundle, Path(output))


if __name__ == "__main__":
    entry.leave(main)
