"""The layers, and what each may include: the one place that says so.

Every layer is compiled with one include folder of its own, build/<target>/include/<layer>/, that holds links to itself
and to the layers named here and to nothing else. An include of any other layer does not find its file.
"""

from pathlib import Path

_ENGINE_FREE = ["core", "realtime", "physics", "devices", "network", "session", "world"]

MAY_INCLUDE = {
    "core": [],
    "realtime": ["core"],
    "physics": ["core", "realtime"],
    "devices": ["core", "realtime", "physics"],
    "network": ["core", "realtime", "physics"],
    "session": ["core", "realtime", "physics", "devices", "network"],
    "world": ["core", "realtime", "physics", "devices", "network", "session"],
    "binding": [],
    "nodes": _ENGINE_FREE,
}

SEES_JOLT = ["physics"]
SEES_GODOT = ["binding", "nodes"]
HAS_TEST_PROGRAM = _ENGINE_FREE


def sources(layer):
    return sorted(str(path) for path in Path("extension", layer).rglob("*.cpp"))


def present():
    return [layer for layer in MAY_INCLUDE if sources(layer)]


def with_sources(layers):
    return [layer for layer in layers if sources(layer)]


def stage(target, layer):
    """The include folder of a layer."""
    return _links(target, layer, {name: Path("extension", name) for name in [layer, *MAY_INCLUDE[layer]]})


def stage_tests(target, layer):
    """The include folder of a layer's tests: what the layer sees, and what tests share."""
    links = {name: Path("extension", name) for name in [layer, *MAY_INCLUDE[layer]]}
    return _links(target, f"tests_{layer}", links | _SHARED_BY_TESTS)


def stage_benches(target):
    return _links(target, "bench", {name: Path("extension", name) for name in _ENGINE_FREE} | _SHARED_BY_TESTS)


_SHARED_BY_TESTS = {"support": Path("tests/support"), "shared": Path("tests/shared")}


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
