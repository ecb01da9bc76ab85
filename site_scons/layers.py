"""The layers, and what each may include: the one place that says so.

Every layer is compiled with one include folder of its own, build/<target>/include/<layer>/, that holds links to itself
and to the layers named here and to nothing else. An include of any other layer does not find its file.
"""

from pathlib import Path

_ENGINE_FREE = ["core", "platform", "realtime", "physics", "devices", "network", "session", "world"]

MAY_INCLUDE = {
    "core": [],
    "platform": ["core"],
    "realtime": ["core", "platform"],
    "physics": ["core", "platform", "realtime"],
    "devices": ["core", "platform", "realtime", "physics"],
    "network": ["core", "platform", "realtime", "physics"],
    "session": ["core", "realtime", "physics", "devices", "network"],
    "world": ["core", "platform", "realtime", "physics", "devices", "network", "session"],
    # A shared library of its own: nobody includes it, core/ports/depth_sensing.hpp is its door.
    "sensing": ["core", "platform"],
    "binding": [],
    "nodes": _ENGINE_FREE,
}

# Of a layer's folders those that make its static library; the others need what not every machine has.
EVERYWHERE = {"sensing": ["image", "discovery", "recording", "watch"]}


def linked(layer):
    """The layer and all that it stands on, also where it may not include it itself."""
    below = {name for other in MAY_INCLUDE[layer] for name in linked(other)}
    return below | {layer}


SEES_JOLT = ["physics"]
SEES_GODOT = ["binding", "nodes"]
HAS_TEST_PROGRAM = [*_ENGINE_FREE, "sensing"]
# What tests share stands on it, also where the layer that they are of does not.
STANDS_UNDER_TESTS = {"platform"}
# They divide themselves into processes as only Unix does, or forge packets.
BENCHES_OF_LINUX = ["stress", "teleop_stress"]

# A source whose name ends in one of these is for that system, or that processor, alone; "other": wherever only Linux can
# do it.
_SYSTEMS = {"linux": ["linux", "posix"], "macos": ["macos", "posix", "other"], "windows": ["windows", "other"]}
_ARCHITECTURES = ["x86_64", "arm64"]


def is_for(path, system, architecture):
    """Whether a source is for that system and processor: clock_windows.cpp, clock_windows_test.cpp."""
    stem = Path(path).stem.removesuffix("_test")
    others = {ending for endings in _SYSTEMS.values() for ending in endings} - set(_SYSTEMS[system])
    others |= set(_ARCHITECTURES) - {architecture}
    return not stem.endswith(tuple(f"_{ending}" for ending in others))


def chosen(folder, pattern, system, architecture):
    """The sources of a folder that are for that system and processor."""
    return sorted(str(path) for path in Path(folder).rglob(pattern) if is_for(path, system, architecture))


def sources(layer, system, architecture):
    return [path for folder in _folders(layer) for path in chosen(folder, "*.cpp", system, architecture)]


def part(layer, folder, platform):
    """The sources of one of its folders; of "", those that lie in no folder of it."""
    found = chosen(Path("extension", layer, folder), "*.cpp", platform.system, platform.architecture)
    return [path for path in found if folder or Path(path).parent == Path("extension", layer)]


def present():
    return with_sources(MAY_INCLUDE)


def with_sources(layers):
    return [layer for layer in layers if any(path for folder in _folders(layer) for path in folder.rglob("*.cpp"))]


def _folders(layer):
    return [Path("extension", layer, part) for part in EVERYWHERE.get(layer, [""])]


def stage(target, layer):
    """The include folder of a layer."""
    return _links(target, layer, {name: Path("extension", name) for name in [layer, *MAY_INCLUDE[layer]]})


def stage_tests(target, layer):
    """The include folder of a layer's tests: what the layer sees, and what tests share."""
    links = {name: Path("extension", name) for name in [layer, *MAY_INCLUDE[layer]]}
    return _links(target, f"tests_{layer}", links | _SHARED_BY_TESTS)


def stage_benches(target):
    """The include folder of benches, and of the devices that are played for benches and tests."""
    links = {name: Path("extension", name) for name in HAS_TEST_PROGRAM} | {"played": Path("tests/played")}
    return _links(target, "bench", links | _SHARED_BY_TESTS)


_SHARED_BY_TESTS = {name: Path("tests", name) for name in ("support", "shared", "stand_ins")}


def _links(target, name, links):
    folder = Path("build", target, "include", name)
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.iterdir():
        if old.name not in links or old.resolve() != links[old.name].resolve():
            old.unlink()
    for link, aim in links.items():
        if aim.is_dir() and not (folder / link).is_symlink():
            (folder / link).symlink_to(aim.resolve())
    return f"#{folder}"
