"""Where a godot-cpp is found: installed, or as an upstream checkout lies after its own build."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "site_scons"))
import godot_api  # noqa: E402
import manifest  # noqa: E402


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
