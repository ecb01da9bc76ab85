"""The cache of objects that clones share: never a wrong object of it, and never a build that fails because of it."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from setup import cache

# As the clone's own, with a compiler that can be exchanged and counts what it compiles. What has changed is seen by content
# alone: times are whole seconds to SCons, and a test builds twice within one.
SCONSTRUCT = """import sys

sys.path.insert(0, {site!r})
import object_cache

environment = Environment(CXX="compile", CXXFLAGS=ARGUMENTS.get("flags", "-O1").split(), ENV={{"PATH": Dir(".").abspath + ":/usr/bin:/bin"}})
environment.CacheDir(ARGUMENTS["cache"], object_cache.ObjectCache)
environment.Program("program", ["main.cpp", environment.StaticLibrary("part", ["part.cpp"])])
"""
COMPILER = """#!/bin/sh
# {which}
case "$*" in *" -c "*) echo "$*" >>compiled ;; esac
exec g++ "$@"
"""
needs_mounts = pytest.mark.skipif(
    subprocess.run(["unshare", "-m", "true"], capture_output=True).returncode != 0, reason="only root may mount a file system for itself"
)


class Builds:
    def __init__(self, folder: Path, cache_folder: Path, answer: int = 1):
        self.folder, self.cache = folder, cache_folder
        folder.mkdir()
        cache_folder.mkdir(exist_ok=True)
        (folder / "SConstruct").write_text(SCONSTRUCT.format(site=str(cache.clone() / "site_scons")))
        self.compiler("one")
        self.source(answer)
        (folder / "main.cpp").write_text("int part();\nint main() { return part(); }\n")

    def source(self, answer: int) -> None:
        (self.folder / "part.cpp").write_text(f"int part() {{ return {answer}; }}\n")

    def compiler(self, which: str) -> None:
        (self.folder / "compile").write_text(COMPILER.format(which=which))
        (self.folder / "compile").chmod(0o755)

    def build(self, *words: str, within: str = "") -> int:
        """What the program answers."""
        (self.folder / "compiled").unlink(missing_ok=True)
        command = [sys.executable, "-m", "SCons", "-s", f"cache={self.cache}", *words]
        command = ["unshare", "-m", "sh", "-c", f'{within}; exec "$@"', "sh", *command] if within else command
        done = subprocess.run(command, cwd=self.folder, text=True, capture_output=True)
        assert done.returncode == 0 and "Traceback" not in done.stderr, done.stdout + done.stderr
        return subprocess.run([self.folder / "program"]).returncode

    def compiled(self) -> int:
        log = self.folder / "compiled"
        return len(log.read_text().splitlines()) if log.is_file() else 0


@pytest.fixture
def first(tmp_path):
    return Builds(tmp_path / "first", tmp_path / "objects")


def another(first: Builds, name: str = "second") -> Builds:
    return Builds(first.folder.with_name(name), first.cache)


def test_a_second_clone_compiles_nothing(first):
    assert first.build() == 1 and first.compiled() == 2
    second = another(first)
    assert second.build() == 1 and second.compiled() == 0


def test_an_object_of_another_compiler_is_none_of_ours(first):
    first.build()
    second = another(first)
    second.compiler("two")
    assert second.build() == 1 and second.compiled() == 2


def test_nor_is_one_of_other_flags(first):
    first.build()
    second = another(first)
    assert second.build("flags=-O2") == 1 and second.compiled() == 2


@pytest.mark.parametrize("left", [0, 7, -1])
def test_what_was_cut_short_is_built_anew(first, left):
    first.build()
    for path in (path for path in first.cache.rglob("*") if path.is_file()):
        os.truncate(path, left if left >= 0 else path.stat().st_size - 1)
    second = another(first)
    assert second.build() == 1 and second.compiled() == 2
    third = another(first, "third")
    assert third.build() == 1 and third.compiled() == 0  # and is in the cache again


def test_a_lock_that_was_left_behind_stops_nobody(first):
    (first.cache / "config.lock").touch()
    assert first.build() == 1


@needs_mounts
@pytest.mark.parametrize("options", ["ro", "nr_inodes=1", "size=8k"])
def test_a_cache_that_cannot_be_written_costs_no_build(first, options):
    assert first.build(within=f"mount -t tmpfs -o {options} cache {first.cache}") == 1


@needs_mounts
def test_a_cache_that_can_only_be_read_is_read(first):
    first.build()
    second = another(first)
    assert second.build(within=f"mount --bind {first.cache} {first.cache}; mount -o remount,bind,ro {first.cache}") == 1
    assert second.compiled() == 0
    second.source(2)
    assert second.build(within=f"mount --bind {first.cache} {first.cache}; mount -o remount,bind,ro {first.cache}") == 2


def test_two_clones_that_build_at_once_each_get_their_own(first):
    clones = [first, *(another(first, f"clone {number}") for number in range(2, 5))]
    for number, clone in enumerate(clones):
        clone.source(1 + number % 2)
    with ThreadPoolExecutor() as pool:
        assert list(pool.map(lambda clone: clone.build(), clones)) == [1, 2, 1, 2]


def test_an_interrupted_build_is_gone_on_with(first):
    first.compiler("slow")
    slow = (first.folder / "compile").read_text().replace("exec g++", "case $* in *part.cpp*) g++ \"$@\" && exec sleep 30 ;; esac\nexec g++")
    (first.folder / "compile").write_text(slow)
    command = [sys.executable, "-m", "SCons", "-s", f"cache={first.cache}"]
    with subprocess.Popen(command, cwd=first.folder, start_new_session=True) as scons:
        while not (first.folder / "part.o").is_file():
            pass
        os.killpg(scons.pid, 9)
    first.source(3)
    first.compiler("one")
    assert first.build() == 3
