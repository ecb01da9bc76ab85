"""What Godot's asset library gets, and what a zip of the repository is to a project that it is unzipped into."""

import io
import json
import os
import subprocess
import zipfile
from pathlib import Path

import addon
import asset_library
import pytest
from setup import cache, godot

CLONE = cache.clone()
# The fields of the asset library's form, as its API names them.
FIELDS = {
    "title", "category", "godot_version", "version_string", "cost", "description", "download_provider", "download_url", "browse_url",
    "issues_url", "icon", "previews",
}  # fmt: skip


def test_the_entry_has_every_field_and_its_pictures(tmp_path):
    from PIL import Image

    asset_library.write(tmp_path, addon.version(), "4.6")
    entry = json.loads((tmp_path / "asset_library.json").read_text())
    assert set(entry) == FIELDS
    assert entry["version_string"] == addon.version() and entry["godot_version"] == "4.6"
    assert entry["cost"] == "MIT" and (CLONE / "LICENSE").read_text().startswith("MIT")
    assert "haptic device" in entry["description"] and "](" not in entry["description"] and "**" not in entry["description"]
    icon = Image.open(tmp_path / entry["icon"])
    assert icon.width == icon.height >= 128
    for preview in entry["previews"]:
        assert Image.open(tmp_path / preview).width >= 640


def zip_of_the_repository(folder: Path) -> zipfile.ZipFile:
    """What is tracked as it lies in the clone, packed from an index of its own: other commands may hold the clone's."""
    settings = {**os.environ, "GIT_INDEX_FILE": str(folder / "index")}

    def git(*words: str) -> bytes:
        return subprocess.run(["git", *words], cwd=CLONE, env=settings, capture_output=True, check=True).stdout

    git("read-tree", "HEAD")
    git("add", "--update")
    tree = git("write-tree").decode().strip()
    return zipfile.ZipFile(io.BytesIO(git("archive", "--format=zip", "--prefix=tactus/", tree)))


@pytest.fixture(scope="module")
def repository(tmp_path_factory):
    if not (CLONE / ".git").exists():
        pytest.skip("this is no clone but a zip of one")
    folder = tmp_path_factory.mktemp("project")
    with zip_of_the_repository(tmp_path_factory.mktemp("index")) as archive:
        archive.extractall(folder)
    return folder


def test_a_zip_of_the_repository_builds_and_has_no_settings_of_the_hosts(repository):
    root = repository / "tactus"
    for name in ("run", "SConstruct", "LICENSE", "README.md", "demo_project/addons/tactus/plugin.cfg"):
        assert (root / name).is_file(), name
    assert not any((root / name).exists() for name in (".ci", ".gitattributes", ".gitignore"))
    assert not list((root / "demo_project").rglob(".gdignore")), "the addon's files would be hidden from Godot"


def test_a_zip_of_the_repository_adds_nothing_to_the_project_it_is_unzipped_into(repository):
    (repository / "project.godot").write_text('config_version=5\n\n[application]\n\nconfig/name="Own"\n')
    done = subprocess.run(
        [str(godot.command()), "--headless", "--path", repository, "--import"], timeout=120, capture_output=True, text=True
    )
    assert done.returncode == 0 and "ERROR" not in done.stdout + done.stderr, done.stdout + done.stderr
    assert [str(path) for path in repository.rglob("*.import") if "demo_project" not in path.parts] == []
    assert not (repository / ".godot/extension_list.cfg").is_file()
    assert list((repository / ".godot/imported").glob("*")) == []
