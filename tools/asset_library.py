"""What Godot's asset library asks of an entry, beside the archive: asset_library.json with the form's fields, icon.png and previews.

The archive holds compiled libraries, which a repository does not: the entry's download is the archive itself, by the provider
"Custom". A zip of the repository is the source, and every folder of it is hidden from a project that it is unzipped into.
"""

import json
import re
import subprocess
from pathlib import Path

from setup import cache, godot

TITLE = "Tactus"
CATEGORY = "3D Tools"
PREVIEWS = ("rig_ball", "editor_rig", "scene_textures", "scene_soft", "overlay")  # of docs/pictures/, in this order
ICON = "demo_project/icon.svg"


def write(folder: Path, version: str, oldest_godot: str) -> None:
    (folder / "asset_library.json").write_text(json.dumps(entry(version, oldest_godot), indent=2) + "\n")
    _write_icon(folder / "icon.png")
    for name in PREVIEWS:
        _write_preview(name, folder / f"preview_{name}.png")


def entry(version: str, oldest_godot: str) -> dict:
    """Addresses are those of CITATION.cff; empty where it has none, and then who files the entry fills them in."""
    repository = _cited("repository-code")
    return {
        "title": TITLE,
        "category": CATEGORY,
        "godot_version": oldest_godot,
        "version_string": version,
        "cost": _cited("license"),
        "description": description(),
        "download_provider": "Custom",
        "download_url": f"{repository}/releases/download/v{version}/tactus-{version}.zip" if repository else "",
        "browse_url": repository,
        "issues_url": f"{repository}/issues" if repository else "",
        "icon": "icon.png",
        "previews": [f"preview_{name}.png" for name in PREVIEWS],
    }


def description() -> str:
    """The README's: its first sentence, what runs where, and the list of what one can do."""
    readme = (cache.clone() / "README.md").read_text()
    paragraphs = [part.strip() for part in readme.partition("\n## Install")[0].split("\n\n")]
    kept = [part for part in paragraphs if not part.startswith(("#", "![", "```"))]
    return re.sub(r"\*\*|`", "", "\n\n".join(kept))


def _cited(key: str) -> str:
    found = re.search(rf"^{key}: *\"?([^\"\n]+)\"?$", (cache.clone() / "CITATION.cff").read_text(), re.M)
    return found[1] if found else ""


def _write_icon(target: Path) -> None:
    command = [godot.command() or "godot", "--headless", "--script", cache.clone() / "tools/icon.gd", "--", cache.clone() / ICON, target]
    done = subprocess.run(command, text=True, capture_output=True, timeout=60)
    if done.returncode != 0:
        raise RuntimeError(f"Godot has made no icon of {ICON}:\n{done.stderr}")


def _write_preview(name: str, target: Path) -> None:
    from PIL import Image

    Image.open(cache.clone() / f"docs/pictures/{name}.webp").convert("RGB").save(target)
