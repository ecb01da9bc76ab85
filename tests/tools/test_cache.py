"""Folders that are made anew: what was there is lost only when its successor is whole."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from setup import cache

needs_mounts = pytest.mark.skipif(
    subprocess.run(["unshare", "-m", "true"], capture_output=True).returncode != 0, reason="only root may mount a file system for itself"
)
REPLACE = """
import sys
from pathlib import Path
sys.path.insert(0, {tools!r})
from setup import cache
with cache.replacing(Path({folder!r})) as fresh:
    (fresh / "new").write_text("new")
"""


def _filled(folder: Path) -> Path:
    folder.mkdir(parents=True)
    (folder / "old").write_text("old")
    (folder / "below").mkdir()
    return folder


def _names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_the_new_one_takes_the_place_of_the_old_one(tmp_path):
    folder = _filled(tmp_path / "out")
    with cache.replacing(folder) as fresh:
        (fresh / "new").write_text("new")
        assert _names(folder) == ["below", "old"]
    assert _names(folder) == ["new"] and _names(tmp_path) == ["out"]


@pytest.mark.parametrize("trouble", [RuntimeError, OSError, KeyboardInterrupt])
def test_what_fails_half_way_leaves_the_old_one(trouble, tmp_path):
    folder = _filled(tmp_path / "out")
    with pytest.raises(trouble):
        with cache.replacing(folder) as fresh:
            (fresh / "new").write_text("half")
            raise trouble
    assert _names(folder) == ["below", "old"] and _names(tmp_path) == ["out"]


def test_what_an_earlier_one_has_left_half_is_not_taken_over(tmp_path):
    (tmp_path / ".out.new").mkdir()
    (tmp_path / ".out.new/half").touch()
    with cache.replacing(tmp_path / "out") as fresh:
        (fresh / "new").write_text("new")
    assert _names(tmp_path / "out") == ["new"]


def test_a_link_to_a_folder_elsewhere_stays_one(tmp_path):
    elsewhere = _filled(tmp_path / "elsewhere")
    (tmp_path / "out").symlink_to(elsewhere)
    with cache.replacing(tmp_path / "out") as fresh:
        (fresh / "new").write_text("new")
    assert (tmp_path / "out").is_symlink() and _names(elsewhere) == ["new"]
    assert cache.emptied(tmp_path / "out").is_symlink() and _names(elsewhere) == []


def test_emptying_follows_no_link(tmp_path):
    elsewhere = _filled(tmp_path / "elsewhere")
    folder = _filled(tmp_path / "out")
    (folder / "link").symlink_to(elsewhere)
    assert _names(cache.emptied(folder)) == [] and _names(elsewhere) == ["below", "old"]


@needs_mounts
def test_a_mount_point_stays_one(tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    code = REPLACE.format(tools=str(cache.clone() / "tools"), folder=str(folder))
    script = 'mount -t tmpfs out "$1" && touch "$1/old" && "$2" -c "$3" && ls "$1" && mountpoint -q "$1"'
    done = subprocess.run(["unshare", "-m", "sh", "-c", script, "sh", folder, sys.executable, code], text=True, capture_output=True)
    assert done.returncode == 0 and done.stdout.split() == ["new"], done.stderr


def test_a_relative_cache_counts_as_none(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", "cache")
    assert cache.root() == tmp_path / ".cache/tactus"
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "named"))
    assert cache.root() == tmp_path / "named/tactus"
    assert os.listdir(tmp_path) == []


def test_what_python_compiles_is_kept_in_the_cache_and_not_between_the_sources(tmp_path, monkeypatch):
    def venv_bin(name: str) -> Path:
        return Path(sys.executable).parent / name

    monkeypatch.setattr(cache, "root", lambda: tmp_path / "cache")
    monkeypatch.setattr(cache, "clone", lambda: tmp_path / "clone")
    monkeypatch.setattr(cache, "venv_bin", venv_bin)
    tools = tmp_path / "clone/tools"
    tools.mkdir(parents=True)
    (tools / "imported.py").write_text("")
    (tools / "tool.py").write_text("import imported")
    assert cache.run_tool("tool.py") == 0
    assert _names(tools) == ["imported.py", "tool.py"]
    assert [path.name.partition(".")[0] for path in (tmp_path / "cache/pycache" / tools.relative_to("/")).iterdir()] == ["imported"]
