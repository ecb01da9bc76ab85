"""./run docs --pictures: the pictures of docs/pictures/: the editor with the addon, and running scenes, drawn without a screen.

Each needs a Godot with a window: a virtual one where there is no screen (setup/display.py). Pictures of scenes are of stepped
time, those of the overlay and of the editor's panel of real time, so that their curves differ from run to run.
"""

import shutil
import subprocess
import tempfile
from pathlib import Path

import project
from setup import cache, display, godot

FOLDER = cache.clone() / "docs/pictures"
SCREEN = "1440x1200x24"
PLUGIN = '[plugin]\n\nname="Pictures"\ndescription=""\nauthor=""\nversion=""\nscript="editor_pictures.gd"\n'
# Of what is seen from a distance, and of what is read (unit: pixels).
WIDTH_OF_SCENES = 960
FRAME_MS = 83  # of the moving one
TIME_LIMIT = 900  # (unit: seconds)


def make() -> list[str]:
    """Their names."""
    with tempfile.TemporaryDirectory() as made, display.environment(SCREEN) as environment:
        _play([*_godot(project.FOLDER), "--script", str(cache.clone() / "tools/scene_pictures.gd"), "--", made], environment)
        folder = _project_with_plugin()
        own = {f"XDG_{kind}_HOME": str(folder / ".godot" / kind.lower()) for kind in ("CONFIG", "DATA", "CACHE")}
        # A Godot that has never been an editor leaves extensions out of its help; the second start has them.
        _play([*_godot(folder), "--editor", "--headless", "--quit-after", "20"], environment | own)
        _plug_in(folder)
        _play([*_godot(folder), "--editor", "--", made], environment | own)
        return _keep(Path(made))


def _godot(folder: Path) -> list[str]:
    return [str(godot.command()), "--path", str(folder)]


def _play(command: list[str], environment: dict[str, str]) -> None:
    done = subprocess.run(command, env=environment, timeout=TIME_LIMIT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0 or "SCRIPT ERROR" in done.stdout:
        raise RuntimeError(done.stdout[-4000:])


def _project_with_plugin() -> Path:
    folder = cache.emptied(cache.clone() / "build/docs_pictures")
    shutil.copytree(project.FOLDER, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns(".godot"))
    project.import_into(folder)
    return folder


def _plug_in(folder: Path) -> None:
    (folder / "pictures").mkdir()
    (folder / "pictures/plugin.cfg").write_text(PLUGIN)
    shutil.copy(cache.clone() / "tools/editor_pictures.gd", folder / "pictures")
    settings = folder / "project.godot"
    settings.write_text(settings.read_text().replace("enabled=PackedStringArray(", 'enabled=PackedStringArray("res://pictures/plugin.cfg", '))


def _keep(made: Path) -> list[str]:
    from PIL import Image

    FOLDER.mkdir(exist_ok=True)
    names = []
    moving = sorted(made.glob("*-*.png"))
    for name in sorted({file.stem.partition("-")[0] for file in moving}):
        frames = [Image.open(file).convert("RGB") for file in moving if file.stem.startswith(f"{name}-")]
        rest = {"append_images": frames[1:], "duration": FRAME_MS, "loop": 0}
        frames[0].save(FOLDER / f"{name}.webp", save_all=True, quality=60, method=6, **rest)
        names.append(name)
    for file in sorted(set(made.glob("*.png")) - set(moving)):
        picture = Image.open(file).convert("RGB")
        if file.stem.startswith(("scene_", "rig_")):
            picture = picture.resize((WIDTH_OF_SCENES, picture.height * WIDTH_OF_SCENES // picture.width), Image.Resampling.LANCZOS)
        picture.save(FOLDER / f"{file.stem}.webp", quality=80, method=6)
        names.append(file.stem)
    return names
