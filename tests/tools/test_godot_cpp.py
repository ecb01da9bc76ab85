"""Where a godot-cpp is found: installed, or as an upstream checkout lies after its own build."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "site_scons"))
import godot_api  # noqa: E402
import layers  # noqa: E402
import manifest  # noqa: E402
import toolchain  # noqa: E402
import units  # noqa: E402

CLONE = Path(__file__).resolve().parents[2]


def _with_files(root, *names):
    for name in names:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text("")
    return root


CHECKOUT = ["include/godot_cpp/godot.hpp", "gen/include/godot_cpp/classes/node3d.hpp", "gdextension/gdextension_interface.h"]


def test_a_checkout_is_used_as_it_lies(tmp_path):
    debug = "bin/libgodot-cpp.linux.template_debug.x86_64.a"
    release = "bin/libgodot-cpp.linux.template_release.x86_64.a"
    root = _with_files(tmp_path, *CHECKOUT, debug, release)
    includes, library = godot_api.installed(root, "template_release")
    assert includes == [root / "include", root / "gen/include", root / "gdextension"]
    assert library == root / release
    assert godot_api.installed(root, "template_debug")[1] == root / debug


def test_a_library_of_another_target_is_not_taken(tmp_path):
    root = _with_files(tmp_path, *CHECKOUT, "bin/libgodot-cpp.linux.template_debug.x86_64.a")
    with pytest.raises(RuntimeError, match="no libgodot-cpp for linux, template_release.*template_debug.*scons .*target=template_release"):
        godot_api.installed(root, "template_release")


def test_a_library_of_another_processor_or_precision_is_not_taken(tmp_path):
    own = "bin/libgodot-cpp.linux.template_debug.x86_64.a"
    others = [own.replace("x86_64", "arm64"), own.replace("template_debug", "template_debug.double")]
    root = _with_files(tmp_path, *CHECKOUT, own, *others)
    assert godot_api.installed(root, "template_debug")[1] == root / own
    assert godot_api.installed(root, "template_debug", "linux", "arm64")[1] == root / others[0]
    (root / own).unlink()
    with pytest.raises(RuntimeError, match="no libgodot-cpp for linux, template_debug, x86_64"):
        godot_api.installed(root, "template_debug")


def test_an_unbuilt_checkout_is_told_so(tmp_path):
    with pytest.raises(RuntimeError, match="no generated classes yet"):
        godot_api.installed(_with_files(tmp_path, CHECKOUT[0]), "template_debug")


def test_another_folder_is_told_so(tmp_path):
    with pytest.raises(RuntimeError, match="it is no godot-cpp"):
        godot_api.installed(tmp_path, "template_debug")


def test_an_installed_one_without_a_target_in_its_name_serves_both(tmp_path):
    root = _with_files(tmp_path, "include/godot_cpp/godot.hpp", "include/godot_cpp/classes/node3d.hpp", "lib/libgodot-cpp.a")
    assert godot_api.installed(root, "template_debug")[1] == root / "lib/libgodot-cpp.a"


def test_the_version_is_that_of_its_header(tmp_path):
    header = _with_files(tmp_path, "gen/include/godot_cpp/core/version.hpp") / "gen/include/godot_cpp/core/version.hpp"
    header.write_text("#define GODOT_VERSION_MAJOR 4\n#define GODOT_VERSION_MINOR 7\n")
    assert manifest.installed_api_version([tmp_path / "include", tmp_path / "gen/include"]) == ("4.7", "single")


CMAKE_BUILT = ["CMakeCache.txt", "gen/include/godot_cpp/classes/node3d.hpp", "bin/libgodot-cpp.linux.template_debug.x86_64.a"]


def _cmake_built(source, build):
    _with_files(source, "include/godot_cpp/godot.hpp", "gdextension/gdextension_interface.h")
    _with_files(build, *CMAKE_BUILT)
    (build / "CMakeCache.txt").write_text(f"CMAKE_HOME_DIRECTORY:INTERNAL={source}\n")


def test_cmake_builds_inside_a_checkout_are_found_by_their_target(tmp_path):
    debug, release = tmp_path / "cmake-build-debug", tmp_path / "cmake-build-release"
    _cmake_built(tmp_path, debug)
    _cmake_built(tmp_path, release)
    library = (release / CMAKE_BUILT[2]).rename(release / CMAKE_BUILT[2].replace("debug", "release"))
    includes = [tmp_path / "include", release / "gen/include", tmp_path / "gdextension"]
    assert godot_api.installed(tmp_path, "template_release") == (includes, library)
    assert godot_api.installed(tmp_path, "template_debug")[1] == debug / CMAKE_BUILT[2]


def test_a_cmake_build_beside_its_checkout_is_found_by_its_own_path(tmp_path):
    source, build = tmp_path / "godot-cpp", tmp_path / "build"
    _cmake_built(source, build)
    includes = [source / "include", build / "gen/include", source / "gdextension"]
    assert godot_api.installed(build, "template_debug") == (includes, build / CMAKE_BUILT[2])


def test_a_folder_that_is_no_godot_cpp_ends_the_build_without_a_traceback(tmp_path):
    done = _scons(f"godot_cpp={tmp_path}")
    assert done.returncode != 0
    assert f"godot_cpp: {tmp_path} has no include/godot_cpp/godot.hpp: it is no godot-cpp" in done.stdout + done.stderr
    assert "Traceback" not in done.stdout + done.stderr


def test_the_environment_names_a_godot_cpp(tmp_path, monkeypatch):
    monkeypatch.setenv("GODOT_CPP", str(tmp_path))
    assert f"godot_cpp: {tmp_path} has no include" in _scons().stderr


def _scons(*arguments):
    scons = Path(sys.executable).with_name("scons")
    return subprocess.run([scons, "-n", "-s", *arguments, "extension"], cwd=CLONE, text=True, capture_output=True)


def test_the_list_of_classes_is_a_build_profile(tmp_path):
    generate = CLONE / "extension/binding/generate.py"
    subprocess.run([sys.executable, generate, "--profile", tmp_path / "profile.json"], check=True)
    classes = json.loads((tmp_path / "profile.json").read_text())["enabled_classes"]
    assert {"Object", "Node3D", "RigidBody3D"} <= set(classes) and len(classes) == len(set(classes))


# What is the binding's own; templates; and virtual methods, which the list names without a symbol.
_OWN = re.compile(r"internal::|~|_values\(|::name$|::(ClassDB|GDExtensionBinding|Wrapped)::|::_\w+\(")


def _names(objects):
    """Functions of godot-cpp that object files call or contain, as c++filt writes them."""
    printed = subprocess.run(["nm", "-C", *objects], check=True, text=True, capture_output=True).stdout
    called = {match[1] for match in re.finditer(r"^[0-9a-f ]* [UWV] (godot::.+)$", printed, re.M)}
    return {name for name in called if re.match(r"godot::(\w+::|operator)[^<]*\(", name) and not _OWN.search(name)}


def test_each_name_that_nodes_use_is_in_the_list_of_upstreams_signatures(monkeypatch):
    monkeypatch.chdir(CLONE)
    built = CLONE / "build/template_debug/obj"
    lists = sorted(built.glob("tests/godot/binding_extension/**/signatures_*.o"))
    # What the last build made of nodes/, and nothing that an older one has left.
    sources = layers.sources("nodes", "linux", "x86_64")
    parts = units.grouped(sources, lambda source: source in toolchain.RUN_ANYWHERE)
    nodes = [built / Path(part[0]).with_suffix(".o") for part in parts]
    if not lists or not all(path.is_file() for path in nodes):
        pytest.skip("the extension and the tests are not built")
    missing = sorted(_names(nodes) - _names(lists))
    assert not missing, "write upstream's signature into tests/godot/binding_extension/signatures_*.cpp: " + "\n".join(missing)
    assert len(_names(nodes)) > 200
