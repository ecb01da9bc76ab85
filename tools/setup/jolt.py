"""Jolt: its source through cargo, and the part of it that rigid bodies need as a static library in the cache."""

import os
import re
import shlex
import subprocess
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from . import cache, crates, platforms
from .platforms import Platform

CRATE = "oxijolt-sys"
CRATE_SHA256 = "95f28c731530e7ad84db2bc94c787c41fb868089b1fd03b5aaa244bfe3e46b38"
VERSION = "5.6.0"

# What includes Jolt must be compiled with the same definitions: they change the layout of its classes.
DEFINES = ["JPH_NO_DEBUG", "JPH_DOUBLE_PRECISION", "JPH_CROSS_PLATFORM_DETERMINISTIC", "JPH_OBJECT_LAYER_BITS=16"]
# The same for a bench: Jolt as fast as it can be, with results that differ between machines.
FAST_DEFINES = [define for define in DEFINES if define != "JPH_CROSS_PLATFORM_DETERMINISTIC"]
CHUNKS = 4  # translation units: headers are read once for each of them

LEFT_OUT = re.compile(
    r"Compute/|Shaders/|Renderer/|Skeleton/|ObjectStream/ObjectStream|Physics/(Hair|Vehicle|Ragdoll|Character)/"
    r"|RegisterTypes\.cpp|PhysicsScene\.cpp|BroadPhaseBruteForce\.cpp|DeterminismLog\.cpp"
)


@dataclass
class Jolt:
    includes: list[Path]
    library: Path
    defines: list[str]


def installed() -> Jolt | None:
    """A Jolt built elsewhere: JOLT_PREFIX, and in JOLT_DEFINES the JPH_ definitions it was built with."""
    prefix = os.environ.get("JOLT_PREFIX")
    if not prefix:
        return None
    include = Path(prefix) / "include"
    jolt = Jolt([include], Path(prefix) / "lib/libJolt.a", shlex.split(os.environ.get("JOLT_DEFINES", "")))
    if not jolt.library.is_file() or not (include / "Jolt/Jolt.h").is_file():
        raise RuntimeError(f"JOLT_PREFIX={prefix} has no include/Jolt/Jolt.h or no lib/libJolt.a")
    return jolt


def ready(fast: bool = False, platform: Platform | None = None, compiler: str = "") -> Jolt | None:
    """`compiler` is that of the code that calls Jolt, where it is not the platform's own: gcc and clang hand a vector of
    32 bytes within a union over in different places."""
    platform = platform or platforms.host()
    own = None if platform.is_foreign or compiler else installed()
    if own:
        return None if fast else own
    source = _source_folder()
    if not cache.is_done(source, CRATE_SHA256):
        return None
    folder = _library_folder(fast, platform, compiler or platform.compiler)
    return _built(folder, fast, platform) if cache.is_done(folder, folder.name) else None


def fetch_and_build(fast: bool = False, platform: Platform | None = None, compiler: str = "") -> Jolt:
    platform = platform or platforms.host()
    compiler = compiler or platform.compiler
    if not cache.is_done(_source_folder(), CRATE_SHA256):
        crates.fetch(CRATE, CRATE_SHA256, "tools/jolt/Cargo.toml", _source_folder())
    folder = cache.emptied(_library_folder(fast, platform, compiler))
    units = [*_write_chunks(folder), cache.clone() / "tools/jolt/register_types.cpp"]
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        objects = list(pool.map(lambda unit: _compile(compiler, unit, folder, fast, platform), units))
    subprocess.run([platform.tool("ar"), "rcs", folder / "libJolt.a", *objects], check=True)
    for path in objects:
        path.unlink()
    cache.mark_done(folder, folder.name)
    return _built(folder, fast, platform)


def licence() -> str:
    """Of the Jolt that is linked in; one built elsewhere is not asked for it."""
    return (_jolt_source() / "LICENSE").read_text()


def _source_folder() -> Path:
    return cache.root() / f"jolt-{VERSION}-source"


def _jolt_source() -> Path:
    return _source_folder() / "vendor/JoltPhysics"


def _built(folder: Path, fast: bool, platform: Platform) -> Jolt:
    return Jolt(_includes(platform), folder / "libJolt.a", FAST_DEFINES if fast else DEFINES)


def _stand_ins(platform: Platform) -> Path:
    """Headers that take the place of Jolt's own of the same name on one system, where there is a reason."""
    return cache.clone() / "tools/jolt" / platform.system


def _includes(platform: Platform) -> list[Path]:
    return [folder for folder in (_stand_ins(platform), _jolt_source()) if folder.is_dir()]


def _sources() -> list[Path]:
    root = _jolt_source()
    paths = sorted(path.relative_to(root) for path in (root / "Jolt").rglob("*.cpp"))
    return [path for path in paths if not LEFT_OUT.search(str(path))]


def _flags(fast: bool, platform: Platform) -> list[str]:
    contraction = "-ffp-contract=fast" if fast else "-ffp-contract=off"
    language = ["-fno-exceptions", "-fno-rtti", *platform.position, "-fvisibility=hidden"]
    return ["-std=c++20", "-O3", *platform.machine, contraction, *language]


def _library_folder(fast: bool, platform: Platform, compiler: str) -> Path:
    version = subprocess.run([compiler, "--version"], check=True, text=True, capture_output=True).stdout
    ours = [cache.clone() / "tools/jolt/register_types.cpp", *sorted(_stand_ins(platform).rglob("*.h"))]
    own = "".join(path.read_text() for path in ours)
    defines = FAST_DEFINES if fast else DEFINES
    key = cache.digest(version.splitlines()[0], *_flags(fast, platform), *defines, own, str(CHUNKS), *map(str, _sources()))
    return cache.root() / f"jolt-{VERSION}-{key}"


def _write_chunks(folder: Path) -> list[Path]:
    sources, units = _sources(), []
    for index in range(CHUNKS):
        unit = folder / f"jolt_{index}.cpp"
        lines = ["#include <Jolt/Jolt.h>"]
        lines += [f'#include "{_jolt_source() / path}"' for path in sources[index::CHUNKS]]
        unit.write_text("\n".join(lines) + "\n")
        units.append(unit)
    return units


def _compile(compiler: str, unit: Path, folder: Path, fast: bool, platform: Platform) -> Path:
    target = folder / f"{unit.stem}.o"
    defines = [f"-D{define}" for define in (FAST_DEFINES if fast else DEFINES)]
    includes = [word for folder in _includes(platform) for word in ("-isystem", folder)]
    command = [compiler, *_flags(fast, platform), *defines, *includes, "-c", unit, "-o", target]
    done = subprocess.run(command, text=True, capture_output=True)
    if done.returncode != 0:
        raise RuntimeError(f"compiling {unit.name} failed:\n{done.stderr[:3000]}")
    return target
