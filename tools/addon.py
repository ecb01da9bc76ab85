"""./run addon [--platform=NAME,…] [--all] [--godot=VERSION]: one archive of the addon, to be unzipped into any Godot project:
build/addon/tactus-VERSION.zip. It has the libraries of this machine's platform, and of those named or all. They are built
against the interface of this machine's Godot, or of an older one.
"""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import asset_library
import build
import entry
import shipped_library
from setup import cache, godot, interfaces, jolt, platforms, zig
from setup.platforms import Platform

sys.path.insert(0, str(cache.clone() / "site_scons"))
import manifest  # noqa: E402

FOLDER = cache.clone() / "demo_project/addons/tactus"
STAGE = cache.clone() / "build/addon"
OLDEST_DATE = (1980, 1, 1, 0, 0, 0)  # of a zip: the same content gives the same bytes

SYSTEM_NOTICES = {
    "GLM": "/usr/share/doc/libglm-dev/copyright",
    "libsodium": "/usr/share/doc/libsodium-dev/copyright",  # the same work in the libraries of every platform
    "GCC's runtime libraries, linked under the GCC Runtime Library Exception": "/usr/share/doc/libstdc++-*-dev/copyright",
}
# In the libraries for depth cameras alone: the camera's driver is compiled with OpenNI2's headers.
NOTICES_OF_EYES = {"OpenNI2 (interface to its drivers)": "/usr/share/doc/libopenni2-dev/copyright"}
# In the libraries for one system alone.
NOTICES_OF = {
    "windows": {"MinGW-w64, its C runtime and winpthreads": "/usr/share/doc/mingw-w64-x86-64-dev/copyright"},
    "macos": {"LLVM's libc++ and libunwind": str(zig.LICENSE_OF_LIBCXX)},
}


def version() -> str:
    """The newest one in the changelog."""
    found = re.search(r"^## (\d+\.\d+\.\d+)$", (cache.clone() / "CHANGELOG.md").read_text(), re.M)
    if not found:
        raise RuntimeError("CHANGELOG.md names no version: a heading '## 1.2.3'")
    return found[1]


def archive(other_godot: str = "") -> Path:
    return STAGE / f"tactus-{version()}{f'-godot-{other_godot}' if other_godot else ''}.zip"


def pack(others: list[Platform] | None = None, other_godot: str = "") -> Path:
    """`others`: platforms besides this machine's own. `other_godot`: whose interface is meant, where it is not that of this
    machine's Godot. The libraries are built already. Beside the archive lies the asset library's entry."""
    content = contents(others or [], other_godot)
    oldest_godot = _written(content["tactus.gdextension"].decode())[0]
    with cache.replacing(STAGE) as fresh:
        _write(content, fresh / archive(other_godot).name)
        asset_library.write(fresh, version(), oldest_godot)
    return archive(other_godot)


def _write(content: dict[str, bytes], target: Path) -> None:
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as file:
        for name, data in sorted(content.items()):
            one = zipfile.ZipInfo(f"addons/tactus/{name}", OLDEST_DATE)
            one.compress_type = zipfile.ZIP_DEFLATED
            one.external_attr = 0o644 << 16
            file.writestr(one, data)


def contents(others: list[Platform], other_godot: str = "") -> dict[str, bytes]:
    """Path below the addon's folder → bytes."""
    found = {}
    own = {manifest.library(platforms.host(), target) for target in manifest.TARGETS.values()}  # those that are meant are named below
    for path in sorted(FOLDER.rglob("*")):
        # What Godot imports into this project, it imports anew into another one.
        if path.is_file() and path.suffix != ".import" and ".partial" not in path.name and path.name not in own:
            found[str(path.relative_to(FOLDER))] = path.read_bytes()
    clone = cache.clone()
    for platform in platforms.given_away([platforms.host(), *others]):
        for library in built(platform, other_godot):
            if complaint := shipped_library.read(library, platform).complaint(platform.system):
                raise RuntimeError(f"{library.name} {complaint}")
            found[f"bin/{library.name}"] = library.read_bytes()
    description = _description(others, other_godot)
    found["tactus.gdextension"] = description.encode()
    if missing := [name for name in _libraries(description) if name not in found]:
        raise RuntimeError(f"not built yet: {', '.join(missing)}. ./run setup builds this machine's, ./run addon --platform=NAME and --godot=VERSION others")
    readme = (clone / "docs/addon.md").read_text()
    found["README.md"] = readme.replace("Godot 4.6 or newer", f"Godot {_written(description)[0]} or newer").encode()
    for name in ("LICENSE", "CHANGELOG.md"):
        found[name] = (clone / name).read_bytes()
    found["NOTICES.txt"] = notices([platforms.host(), *others]).encode()
    return found


def built(platform: Platform, other_godot: str = "") -> list[Path]:
    """The platform's libraries, as far as there are any."""
    if platform.architecture == platforms.UNIVERSAL:
        return _joined(platform, other_godot)
    made = [_place(platform, target, other_godot) for target in manifest.TARGETS.values()]
    return [library for library in made if library.is_file()]


def _place(platform: Platform, target: str, other_godot: str) -> Path:
    """Where the build leaves a library."""
    variant = cache.variant(target, foreign=platform.name if platform.is_foreign else "", godot=other_godot)
    folder = cache.clone() / "build" / variant if platform.is_foreign or other_godot else FOLDER
    return folder / "bin" / manifest.library(platform, target)


def _joined(platform: Platform, other_godot: str) -> list[Path]:
    """The universal libraries, each joined of its slices where all are built."""
    made = []
    for target in manifest.TARGETS.values():
        of_system = [one for one in platforms.FOREIGN if one.system == platform.system]
        slices = [library for one in of_system for library in built(one, other_godot) if target in library.name]
        if len(slices) == len(platforms.ARCHITECTURES):
            made.append(_place(platform, target, other_godot))
            made[-1].parent.mkdir(parents=True, exist_ok=True)
            subprocess.run([zig.llvm("llvm-lipo"), "-create", *slices, "-output", made[-1]], check=True)
    return made


def _description(others: list[Platform], other_godot: str) -> str:
    """tactus.gdextension as this machine's build has written it, for the other platforms as well."""
    minimum, precision = _written((FOLDER / "tactus.gdextension").read_text())
    seeing = [platforms.host()] if has_eyes() else []
    return manifest.text(other_godot or minimum, precision, platforms.given_away([platforms.host(), *others]), seeing)


def _written(description: str) -> tuple[str, str]:
    """The oldest Godot and the precision of a tactus.gdextension."""
    minimum = re.search(r'compatibility_minimum = "(.*)"', description)
    precision = re.search(r"\.debug\.(\w+)\.", description)
    if not minimum or not precision:
        raise RuntimeError(f"{FOLDER}/tactus.gdextension names no version or no library: ./run setup writes it")
    return minimum[1], precision[1]


def has_eyes() -> bool:
    """Whether this machine's libraries for depth cameras are there."""
    names = [manifest.library(platforms.host(), target, name) for target in manifest.TARGETS.values() for name in manifest.EYES]
    return all((FOLDER / "bin" / name).is_file() for name in names)


def _libraries(description: str) -> list[str]:
    return sorted(set(re.findall(r'"(bin/[^"]+)"', description)))


def notices(systems: list[Platform]) -> str:
    """The licence of everything that the platforms' libraries contain, as it stands where it came from."""
    command = godot.command()
    interface = godot.api_folder(command) / "gdextension_interface.h" if command else None
    texts = {"Jolt Physics": jolt.licence(), "Godot Engine (interface to extensions)": _first_comment(interface)}
    places = SYSTEM_NOTICES | (NOTICES_OF_EYES if has_eyes() else {})
    for one in systems:
        places |= NOTICES_OF.get(one.system, {})
    for name, path in places.items():
        files = sorted(Path("/").glob(path.lstrip("/")))
        if not files:
            raise RuntimeError(f"the licence of {name} is not on this machine: {path}")
        texts[name] = files[-1].read_text()
    rule = "=" * 80
    parts = [f"{rule}\n{name}\n{rule}\n\n{text.strip()}\n" for name, text in texts.items()]
    return "Tactus contains parts of the following works.\n\n" + "\n".join(parts)


def _first_comment(header: Path | None) -> str:
    if header is None:
        raise RuntimeError("there is no Godot whose licence could be given")
    lines = []
    for line in header.read_text().splitlines():
        if not line.startswith("/*"):
            break
        lines.append(line.strip("/* "))
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    others = platforms.named_in(arguments)
    other_godot = next((word.partition("=")[2] for word in arguments if word.startswith("--godot=")), "")
    interface = [f"interface={interfaces.folder(other_godot)}"] if other_godot else []
    for platform in [*([platforms.host()] if other_godot else []), *others]:
        for target in manifest.TARGETS.values():
            print(f"Building {target} for {platform.name} … ", end="", flush=True)
            build.build(target, "extension", f"platform={platform.name}", *interface)
            print("done", flush=True)
    path = pack(others, other_godot)
    print(f"{cache.shown(path)}: {path.stat().st_size / 1e6:.1f} MB, for")
    for platform in platforms.given_away([platforms.host(), *others]):
        for library in built(platform, other_godot):
            glibc = shipped_library.read(library, platform).glibc
            print(f"  {library.name}" + (f", from glibc {glibc} on" if glibc else ""))
    return 0


if __name__ == "__main__":
    entry.leave(main)
