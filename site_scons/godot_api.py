"""Where nodes/ finds the godot-cpp API: an installed godot-cpp, or binding/ with its generated part."""

import hashlib
import re
import subprocess
import sys
from pathlib import Path

BINDING = Path("extension/binding")
sys.path.append(str(BINDING.resolve()))


def installed(prefix, target, system="linux", architecture="x86_64"):
    """Include folders and library of a godot-cpp: one that was installed (include/, lib/), a checkout in which SCons
    built it (include/, gen/include/, gdextension/, bin/), or one that CMake built (gen/include/ and bin/ in a folder of
    its own): the checkout with its build folders in it, or the build folder itself."""
    root = Path(prefix)
    source = _cmake_source(root) or root
    builds = [root, *sorted(folder for folder in root.glob("*") if (folder / "CMakeCache.txt").is_file())]
    if not (source / "include/godot_cpp/godot.hpp").is_file():
        raise RuntimeError(f"{prefix} has no include/godot_cpp/godot.hpp: it is no godot-cpp")
    built = [build for build in builds if any((build / name / "godot_cpp/classes/node3d.hpp").is_file() for name in ("include", "gen/include"))]
    if not built:
        raise RuntimeError(f"{prefix} has no generated classes yet: build godot-cpp first, with scons target={target}")
    build, library = _installed_library(built, target, system, architecture)
    includes = [source / "include", build / "gen/include", source / "gdextension"]
    return [folder for folder in includes if folder.is_dir()], library


def _cmake_source(build):
    """The checkout that CMake built into this folder; None where it did not."""
    cache = build / "CMakeCache.txt"
    named = re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.+)$", cache.read_text(), re.M) if cache.is_file() else None
    return Path(named[1]) if named else None


def _installed_library(builds, target, system, architecture):
    """The build that has a library for this target, and the library."""
    found = [(build, path) for build in builds for folder in ("lib", "bin") for path in sorted((build / folder).glob("libgodot-cpp*.a"))]
    kinds = [f".{system}.{target}.{suffix}" for suffix in (architecture, "universal")]
    suits = [one for one in found if any(kind in one[1].name for kind in kinds)]
    # Without a target in its name it is the only one there is.
    suits += [one for one in found if one[1].name == "libgodot-cpp.a"]
    if not suits:
        names = ", ".join(path.name for _, path in found) or "none"
        raise RuntimeError(
            f"{builds[0]} has no libgodot-cpp for {system}, {target}, {architecture} (found: {names}): "
            f"scons platform={system} target={target} arch={architecture} builds it"
        )
    return suits[0]


SYSTEM_DEFINES = {
    "linux": ["LINUX_ENABLED", "UNIX_ENABLED"],
    "windows": ["WINDOWS_ENABLED"],
    "macos": ["MACOS_ENABLED", "UNIX_ENABLED"],
}


def defines(target, system):
    """What godot-cpp's headers expect, for the same layout as in its library."""
    common = [*SYSTEM_DEFINES[system], "GDEXTENSION"]
    return common + (["DEBUG_ENABLED", "HOT_RELOAD_ENABLED"] if target == "template_debug" else [])


def generated(api, output):
    """Runs the generator when the engine's API, the generator or the classes in use have changed."""
    inputs = [api / "extension_api.json", api / "gdextension_interface.h", *sorted(BINDING.rglob("*.py"))]
    inputs += sorted(path for path in BINDING.rglob("*") if path.suffix in (".txt", ".inc"))
    inputs += sorted(path for folder in ("nodes", "binding") for path in Path("extension", folder).rglob("*.[hc]pp"))
    digest = hashlib.sha256()
    for path in inputs:
        digest.update(str(path).encode() + b"\0" + path.read_bytes())
    stamp = output / ".done"
    if not stamp.is_file() or stamp.read_text() != digest.hexdigest():
        subprocess.run([sys.executable, BINDING / "generate.py", "--api", api, "--output", output], check=True)
        stamp.write_text(digest.hexdigest())
    return output / "include", sorted(str(path) for path in (output / "src").rglob("*.cpp"))


def class_bindings():
    """The sources that bind and register the classes whose table is the class reference."""
    import bind_classes

    output = Path("build/classes")
    tables = [table for table in map(bind_classes.ClassTable, sorted(Path("extension/doc_classes").glob("*.xml"))) if table.is_bound()]
    sources = {f"{table.name}.cpp": table.source() for table in tables}
    sources["register_classes.cpp"] = bind_classes.ClassTable.registration(tables)
    for name, source in sources.items():
        _write_if_changed(output / name, source.encode())
    return [str(output / name) for name in sources]


def class_reference(target):
    """The source that gives the editor the class reference; a program for players has none."""
    import bind_classes
    import doc_data

    tables = [bind_classes.ClassTable(path) for path in sorted(Path("extension/doc_classes").glob("*.xml"))]
    if target != "template_debug" or not tables:
        return None
    help_ = [table.help() for table in tables] + [table.old_help() for table in tables if table.old_name()]
    output = Path("build", target, "doc_data.cpp")
    _write_if_changed(output, doc_data.doc_source(help_).encode())
    return str(output)


def _write_if_changed(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.is_file() or path.read_bytes() != content:
        path.write_bytes(content)
