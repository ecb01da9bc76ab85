"""What a platform needs that this machine's own packages do not have for it: libsodium, GoogleTest, and the headers that
are the same everywhere apart from those of this machine.

libsodium's whole source lies in the crate libsodium-sys: the release that Debian 12 has as well, so that both builds
seal with the same code.
"""

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

from . import cache, crates, zig
from .platforms import Platform

CRATE = "libsodium-sys"
CRATE_SHA256 = "6b779387cd56adfbc02ea4a668e704f729be8d6a6abd2c27ca5ee537849a92fd"
SODIUM = "1.0.18"
GOOGLETEST = Path("/usr/src/googletest/googletest")
HEADERS_ONLY = {"glm": Path("/usr/include/glm"), "gtest": Path("/usr/include/gtest")}


@dataclass(frozen=True)
class Tools:
    sodium: str  # for the linker: names where the machine's own serve, else files
    googletest: tuple[str, ...]
    include: Path | None = None


def ready(platform: Platform) -> Tools | None:
    if not platform.is_foreign:
        return Tools(":libsodium.a", ("gtest_main", "gtest"))
    folder = _folder(platform)
    if not cache.is_done(folder, folder.name):
        return None
    tests = (str(folder / "lib/libgtest_main.a"), str(folder / "lib/libgtest.a")) if platform.emulator else ()
    return Tools(str(folder / "lib/libsodium.a"), tests, folder / "include")


def build(platform: Platform) -> None:
    folder = cache.emptied(_folder(platform))
    (folder / "lib").mkdir()
    _build_sodium(platform, folder)
    if platform.emulator:  # else no test could run
        _build_googletest(platform, folder / "lib")
    for name, place in HEADERS_ONLY.items():
        (folder / "include" / name).symlink_to(place)
    cache.mark_done(folder, folder.name)


def licence() -> str:
    return (_sodium_source() / "LICENSE").read_text()


def _folder(platform: Platform) -> Path:
    compiler = _run([platform.compiler, "--version"]).splitlines()[0]
    key = cache.digest(compiler, *platform.flags, CRATE_SHA256, _sodium_flags())
    return cache.root() / f"cross-{platform.name}-{key}"


def _sodium_source() -> Path:
    return cache.root() / f"libsodium-{SODIUM}-source/libsodium"


def _sodium_flags() -> str:
    """Its assertions name files as in its own folder, and no folder of this machine."""
    return f"CFLAGS=-O2 -ffile-prefix-map={_sodium_source()}=libsodium"


def _build_sodium(platform: Platform, folder: Path) -> None:
    if not cache.is_done(_sodium_source().parent, CRATE_SHA256):
        crates.fetch(CRATE, CRATE_SHA256, "tools/cross/Cargo.toml", _sodium_source().parent)
    work = cache.emptied(folder / "work")
    configure = ["sh", _sodium_source() / "configure", f"--host={platform.triple}", f"--prefix={folder}"]
    _run([*configure, "--disable-shared", "--with-pic", "--disable-ssp", _sodium_flags()], work)
    _run(["make", "install"], work)
    subprocess.run(["rm", "-r", work], check=True)


def _build_googletest(platform: Platform, folder: Path) -> None:
    for name, source in {"gtest": "gtest-all.cc", "gtest_main": "gtest_main.cc"}.items():
        target = folder / f"{name}.o"
        include = ["-isystem", GOOGLETEST / "include", "-I", GOOGLETEST]
        command = [platform.compiler, "-std=c++20", "-O1", *platform.flags, *include]
        _run([*command, "-c", GOOGLETEST / "src" / source, "-o", target])
        _run([platform.tool("ar"), "rcs", folder / f"lib{name}.a", target])
        target.unlink()


def _run(command: list, place: Path | None = None) -> str:
    environment = os.environ | {"PATH": zig.path_with_tools()}  # configure scripts look for the tools by name
    done = subprocess.run(command, cwd=place, env=environment, text=True, capture_output=True)
    if done.returncode != 0:
        raise RuntimeError(f"{command[0]} failed:\n{done.stdout[-1500:]}{done.stderr[-1500:]}")
    return done.stdout
