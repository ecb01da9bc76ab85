"""The build itself forbids what a layer may not include; the folders of one are in an order, too."""

import functools
import graphlib
import re
import shutil
import subprocess

import build
import layers
import pytest
from setup import cache, platforms

ALLOWED = [
    ("platform", '"core/thing.hpp"'),
    ("realtime", '"core/thing.hpp"'),
    ("realtime", '"platform/thing.hpp"'),
    ("network", '"platform/thing.hpp"'),
    ("physics", '"realtime/thing.hpp"'),
    ("physics", "<Jolt/Jolt.h>"),
    ("devices", '"realtime/thing.hpp"'),
    ("devices", '"platform/thing.hpp"'),
    ("session", '"devices/thing.hpp"'),
    ("session", '"network/thing.hpp"'),
    ("world", '"session/thing.hpp"'),
    ("world", '"platform/thing.hpp"'),
    ("sensing/image", '"core/thing.hpp"'),
    ("sensing/image", '"platform/thing.hpp"'),
    ("sensing/image", '"sensing/thing.hpp"'),
]
FORBIDDEN = [
    ("core", '"realtime/thing.hpp"'),
    ("core", '"physics/thing.hpp"'),
    ("core", "<Jolt/Jolt.h>"),
    ("platform", '"realtime/thing.hpp"'),
    ("realtime", '"physics/thing.hpp"'),
    ("physics", '"session/thing.hpp"'),
    ("devices", '"network/thing.hpp"'),
    ("network", '"devices/thing.hpp"'),
    ("session", "<Jolt/Jolt.h>"),
    ("session", "<godot_cpp/classes/node.hpp>"),
    ("session", '"nodes/thing.hpp"'),
    ("session", '"platform/thing.hpp"'),
    ("session", '"world/thing.hpp"'),
    ("world", '"nodes/thing.hpp"'),
    ("world", "<godot_cpp/classes/node.hpp>"),
    ("world", "<Jolt/Jolt.h>"),
    ("world", '"sensing/thing.hpp"'),
    ("sensing/image", '"session/thing.hpp"'),
    ("sensing/image", '"realtime/thing.hpp"'),
]
# The compiler's own vectors are 70,000 lines of core/; Jolt and Godot come with 60,000 to 80,000.
MOST_LINES = {
    "binding": 75_000, "core": 175_000, "platform": 90_000, "realtime": 180_000, "physics": 215_000, "devices": 105_000,
    "network": 120_000, "sensing": 120_000, "session": 190_000, "world": 200_000, "nodes": 215_000,
}  # fmt: skip
LAYERS = ["core", "platform", "realtime", "physics", "devices", "network", "session", "world", "sensing"]


def _object(number: int, layer: str) -> str:
    return f"build/template_debug/obj/extension/{layer}/case_{number}.o"


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A project of one-line layers under the real SConstruct, with one source for each case."""
    folder = tmp_path_factory.mktemp("layers")
    for name in ("tools", "site_scons"):
        shutil.copytree(cache.clone() / name, folder / name)
    shutil.copy(cache.clone() / "SConstruct", folder)
    for layer in LAYERS:
        (folder / "extension" / layer).mkdir(parents=True)
        (folder / "extension" / layer / "thing.hpp").write_text("#pragma once\n")
    for number, (layer, include) in enumerate(ALLOWED + FORBIDDEN):
        case = folder / "extension" / layer / f"case_{number}.cpp"
        case.parent.mkdir(exist_ok=True)
        case.write_text(f"#include {include}\n")
    command = [cache.venv_bin("scons"), "--keep-going", "--cache-disable", "units=no", "libraries"]
    done = subprocess.run(command, cwd=folder, text=True, capture_output=True)
    return folder, done.stdout + done.stderr


@pytest.mark.parametrize("number", range(len(ALLOWED)))
def test_allowed_include_compiles(built, number):
    folder, output = built
    assert (folder / _object(number, ALLOWED[number][0])).is_file(), output


@pytest.mark.parametrize("number", range(len(FORBIDDEN)))
def test_forbidden_include_does_not_compile(built, number):
    folder, output = built
    layer, include = FORBIDDEN[number]
    source = f"extension/{layer}/case_{len(ALLOWED) + number}.cpp"
    assert not (folder / _object(len(ALLOWED) + number, layer)).exists()
    assert f"{source}:1:10: fatal error: {include[1:-1]}: No such file" in output


@pytest.fixture(scope="module")
def lines_of():
    """How many lines the compiler reads for each header, compiled by itself, with what its layer may include."""
    build.build("template_debug", "alone")
    top = cache.clone() / "build/template_debug/alone/extension"
    found = {str(path.relative_to(top)).removesuffix(".lines"): int(path.read_text()) for path in top.rglob("*.lines")}
    return {path: lines for path, lines in found.items() if (cache.clone() / "extension" / path).is_file()}


def test_each_header_stands_alone(lines_of):
    sources = {str(path.relative_to(cache.clone() / "extension")) for path in (cache.clone() / "extension").rglob("*.hpp")}
    elsewhere = {path for path in sources if not layers.is_for(path, platforms.host().system, platforms.host().architecture)}
    assert sources - elsewhere == set(lines_of)


def test_no_header_pulls_in_more_than_its_layer_may(lines_of):
    heavy = {path: lines for path, lines in lines_of.items() if lines > MOST_LINES[path.split("/")[0]]}
    assert heavy == {}, "include less there, or declare what is only pointed to"


def test_no_include_climbs_out_of_its_folder():
    # Through "..", the compiler would follow a link of the include folder back into the clone.
    sources = [path for path in (cache.clone() / "extension").rglob("*.[hc]pp")]
    climbing = [str(path) for path in sources if re.search(r'^\s*#\s*include\s*["<][^">]*\.\./', path.read_text(), re.M)]
    assert climbing == []


@functools.cache
def included(path: str) -> frozenset[str]:
    """What a file of extension/ includes of it, directly or not."""
    top = cache.clone() / "extension"
    direct = {name for name in re.findall(r'^#include "([^"]+)"', (top / path).read_text(), re.M) if (top / name).is_file()}
    return frozenset(direct.union(*map(included, direct)))


def test_half_of_core_includes_the_header_that_the_bench_of_the_build_changes():
    (header,) = re.findall(r'^HEADER = "extension/(.*?)"', (cache.clone() / "tests/bench/build.py").read_text(), re.M)
    sources = [str(path.relative_to(cache.clone() / "extension")) for path in (cache.clone() / "extension/core").rglob("*.cpp")]
    assert sum(header in included(source) for source in sources) >= len(sources) // 2


# Plain values that go into a session and come out of it: who shows or asks them compiles without what moves a proxy.
@pytest.mark.parametrize("header", ["session/session.hpp", "session/session_types.hpp", "session/side_plan.hpp", "world/soft_plan.hpp", "realtime/workers.hpp"])
def test_who_holds_a_session_sees_nothing_of_how_it_moves(header):
    moving = {"core/math/lanes.hpp", "core/tree/triangle_tree.hpp", "core/proxy/proxy.hpp", "core/tool/tool_proxy.hpp", "core/soft/soft_model.hpp"}
    assert included(header) & moving == set()


@pytest.mark.parametrize("layer", LAYERS)
def test_folders_of_a_layer_do_not_include_each_other_in_circles(layer):
    top = cache.clone() / "extension" / layer
    stands_on = {}
    for source in top.rglob("*.[hc]pp"):
        folder = source.relative_to(top).parts[0]
        included = re.findall(rf'#include "{layer}/([^/"]+)/', source.read_text())
        if source.parent != top:
            stands_on.setdefault(folder, set()).update(set(included) - {folder})
    list(graphlib.TopologicalSorter(stands_on).static_order())  # raises CycleError, which names them
