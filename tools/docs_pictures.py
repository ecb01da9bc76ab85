"""./run docs --pictures: the pictures of docs/pictures/: the editor with the addon, and running scenes, drawn without a screen.

Each needs a Godot with a window, on a virtual screen (setup/display.py). Pictures of scenes are of stepped time, those of the
overlay and of the editor's panel of real time, so that their curves differ from run to run. An editor and the scene that it
plays are two programs: both are in pictures of the screen alone.
"""

import shutil
import struct
import subprocess
import tempfile
import time
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING

import project
from setup import cache, display, godot

if TYPE_CHECKING:
    from PIL import Image

FOLDER = cache.clone() / "docs/pictures"
SCREEN = "1440x1200x24"
PLUGIN = '[plugin]\n\nname="Pictures"\ndescription=""\nauthor=""\nversion=""\nscript="editor_pictures.gd"\n'
MOVING_SCENE = """[gd_scene format=3]

[ext_resource type="Script" path="res://pictures/moving_scene.gd" id="script"]

[node name="Moving" type="Node"]
script = ExtResource("script")
"""
# Of what is seen from a distance, and of what is read (unit: pixels).
WIDTH_OF_SCENES = 960
FILM, FILM_WIDTH = "playing", 960  # by moving_scene.gd
FRAME_MS = 125  # as moving_scene.gd has it
FILM_QUALITY = 60
TIME_LIMIT = 900  # (unit: seconds)


def make() -> list[str]:
    """Their names."""
    with tempfile.TemporaryDirectory() as made, tempfile.TemporaryDirectory() as screen, _screen(screen) as environment:
        _play([*_godot(project.FOLDER), "--script", str(cache.clone() / "tools/scene_pictures.gd"), "--", made], environment)
        folder = _project_with_plugin()
        own = {f"XDG_{kind}_HOME": str(folder / ".godot" / kind.lower()) for kind in ("CONFIG", "DATA", "CACHE")}
        # A Godot that has never been an editor leaves extensions out of its help; the second start has them.
        _play([*_godot(folder), "--editor", "--headless", "--quit-after", "20"], environment | own)
        _plug_in(folder, made)
        _film([*_godot(folder), "--editor", "--", made], environment | own, Path(screen), Path(made))
        return _keep(Path(made))


def _screen(folder: str) -> AbstractContextManager[dict[str, str]]:
    """One whose content is a file in that folder."""
    return display.virtual(SCREEN, "-fbdir", folder, "-nocursor")


def _godot(folder: Path) -> list[str]:
    return [str(godot.command()), "--path", str(folder)]


def _play(command: list[str], environment: dict[str, str]) -> None:
    done = subprocess.run(command, env=environment, timeout=TIME_LIMIT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    _check(done.returncode == 0, done.stdout)


def _check(is_done: bool, said: str) -> None:
    if not is_done or "SCRIPT ERROR" in said:
        raise RuntimeError(said[-4000:])


def _film(command: list[str], environment: dict[str, str], screen: Path, made: Path) -> None:
    """The same, with the pictures of the screen that the editor and moving_scene.gd ask for."""
    with (screen / "said").open("w") as output:
        editor = subprocess.Popen(command, env=environment, stdout=output, stderr=subprocess.STDOUT)
        deadline, shown, taken = time.monotonic() + TIME_LIMIT, made / "shown", ""
        try:
            while editor.poll() is None and time.monotonic() < deadline:
                if shown.is_file() and (name := shown.read_text()) not in (taken, "end"):
                    picture = _of_screen(screen)
                    picture.crop(picture.getbbox()).save(made / f"{name}.png")  # beside the window the screen is black
                    (made / "taken").write_text(name)
                    taken = name
                time.sleep(0.02)
        finally:
            editor.kill()
            editor.wait()
    said = (screen / "said").read_text()
    _check("\nDONE\n" in said, said)  # Godot 4.6.3 crashes as it ends when a scene was played in its view


def _of_screen(folder: Path) -> "Image.Image":
    """What Xvfb shows: a dump of the X Window System (XWDFile.h), whose pixels are blue, green, red and nothing."""
    from PIL import Image

    content = next(folder.glob("Xvfb_screen*")).read_bytes()
    head = struct.unpack_from(">25I", content)
    length, width, height, bytes_per_line, colors = head[0], head[4], head[5], head[12], head[19]
    pixels = content[length + 12 * colors :]  # behind a table of colors
    return Image.frombuffer("RGB", (width, height), pixels, "raw", "BGRX", bytes_per_line, 1)


def _project_with_plugin() -> Path:
    folder = cache.emptied(cache.clone() / "build/docs_pictures")
    shutil.copytree(project.FOLDER, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns(".godot"))
    project.import_into(folder)
    return folder


def _plug_in(folder: Path, made: str) -> None:
    (folder / "pictures").mkdir()
    (folder / "pictures/plugin.cfg").write_text(PLUGIN)
    (folder / "pictures/moving_scene.tscn").write_text(MOVING_SCENE)
    for script in ("editor_pictures.gd", "moving_scene.gd"):
        shutil.copy(cache.clone() / "tools" / script, folder / "pictures")
    settings = folder / "project.godot"
    with_plugin = settings.read_text().replace("enabled=PackedStringArray(", 'enabled=PackedStringArray("res://pictures/plugin.cfg", ')
    settings.write_text(f'{with_plugin}\n[editor]\n\nrun/main_run_args="--audio-driver Dummy -- {made}"\n')
    # What is played shows within the editor: without a window manager a window of its own would lie over it anywhere.
    (folder / ".godot/editor/project_metadata.cfg").write_text("[game_view]\n\nmake_floating_on_play=false\n")


def _keep(made: Path) -> list[str]:
    from PIL import Image

    FOLDER.mkdir(exist_ok=True)
    names = []
    moving = sorted(made.glob("*-*.png"))
    for name in sorted({file.stem.partition("-")[0] for file in moving}):
        frames = [_narrowed(Image.open(file).convert("RGB"), FILM_WIDTH) for file in moving if file.stem.startswith(f"{name}-")]
        rest = {"append_images": frames[1:], "duration": FRAME_MS, "loop": 0}
        frames[0].save(FOLDER / f"{name}.webp", save_all=True, quality=FILM_QUALITY, method=6, minimize_size=True, **rest)
        names.append(name)
    for file in sorted(set(made.glob("*.png")) - set(moving)):
        picture = Image.open(file).convert("RGB")
        if file.stem.startswith(("scene_", "rig_")):
            picture = _narrowed(picture, WIDTH_OF_SCENES)
        picture.save(FOLDER / f"{file.stem}.webp", quality=80, method=6)
        names.append(file.stem)
    return names


def _narrowed(picture: "Image.Image", width: int) -> "Image.Image":
    from PIL import Image

    return picture.resize((width, picture.height * width // picture.width), Image.Resampling.LANCZOS)
