"""Draws the pictures that the gallery's menu shows of its scenes: demo_project/gallery/NAME/NAME.webp.

    PYTHONPATH=tools python3 tools/make_pictures.py [NAME …]

With --moving the one moving picture of some of them, docs/gallery.webp (docs/gallery.md).
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from project import FOLDER
from setup import cache, display, godot

MOVING = ["static_testbed", "mesh_library", "soft", "stack", "pinch", "hinge_door", "peg_in_hole"]
FRAME_MS = 83


def draw(words: list[str]) -> int:
    command = [str(godot.command()), "--path", FOLDER, "--script", cache.clone() / "tools/pictures.gd", "--", *words]
    with display.environment() as environment:
        return subprocess.run(command, env=environment).returncode


def draw_moving(names: list[str]) -> int:
    from PIL import Image

    with tempfile.TemporaryDirectory() as folder:
        code = draw([f"--frames={folder}", *names])
        files = [file for name in names for file in sorted(Path(folder).glob(f"{name}_*.png"))]
        frames = [Image.open(file).convert("RGB") for file in files]
        if code == 0 and frames:
            frames[0].save(
                cache.clone() / "docs/gallery.webp",
                save_all=True,
                append_images=frames[1:],
                duration=FRAME_MS,
                loop=0,
                quality=60,
                method=6,
            )
    return code


def main(words: list[str]) -> int:
    if "--moving" in words:
        return draw_moving([word for word in words if word != "--moving"] or MOVING)
    return draw(words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
