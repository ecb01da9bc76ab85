"""What a user does with the addon: copies its folder into another project, wherever they like."""

import contextlib
import io
import json
import re
import shutil
import struct
import subprocess
import zipfile
from pathlib import Path

import addon
import project
import pytest
import shipped_library
from setup import cache, godot, interfaces, platforms

# The scene of docs/addon.md, by its five steps.
FIRST_TOUCH = """[gd_scene format=3]

[sub_resource type="SphereShape3D" id="shape"]
radius = 0.05

[sub_resource type="SphereMesh" id="ball"]
radius = 0.05
height = 0.1

[node name="Scene" type="Node3D"]

[node name="HapticWorld" type="HapticWorld" parent="."]

[node name="Ball" type="StaticBody3D" parent="HapticWorld"]

[node name="Shape" type="CollisionShape3D" parent="HapticWorld/Ball"]
shape = SubResource("shape")

[node name="Look" type="MeshInstance3D" parent="HapticWorld/Ball"]
mesh = SubResource("ball")

[node name="HapticDevice" type="HapticDevice" parent="HapticWorld"]
transform = Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0.1)

[node name="ProxyPointer" type="ProxyPointer" parent="HapticWorld"]

[node name="Camera3D" type="Camera3D" parent="."]
transform = Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0.4)

[node name="Light" type="DirectionalLight3D" parent="."]
"""

# A user who points at the middle and turns the wheel six notches away from themselves.
USER = """extends Node


func _ready() -> void:
	get_tree().change_scene_to_file.call_deferred("res://first_touch.tscn")
	for notch in 6:
		await get_tree().create_timer(0.2).timeout
		var wheel := InputEventMouseButton.new()
		wheel.button_index = MOUSE_BUTTON_WHEEL_UP
		wheel.pressed = true
		wheel.position = get_viewport().get_visible_rect().size / 2
		Input.parse_input_event(wheel)
	await get_tree().create_timer(0.5).timeout
	var scene := get_tree().current_scene
	var device: HapticDevice = scene.get_node("HapticWorld/HapticDevice")
	var proxy: ProxyPointer = scene.get_node("HapticWorld/ProxyPointer")
	print("FIRST TOUCH ", proxy.is_touching(), " ", device.get_force().z > 1.0, " ", snappedf(proxy.position.z, 0.001))
	get_tree().quit()
"""

EXPORT = """[preset.0]

name="Linux"
platform="Linux"
runnable=true
export_filter="all_resources"
include_filter="addons/tactus/meshes/*"

[preset.0.options]

binary_format/embed_pck=true
binary_format/architecture="x86_64"
"""

PROJECT = """config_version=5

[application]

config/name="Elsewhere"
"""

SCRIPT = """extends SceneTree


func _initialize() -> void:
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	var body := StaticBody3D.new()
	var touched := HapticMesh.new()
	touched.library_mesh = "torus"
	body.add_child(touched)
	world.add_child(body)
	root.add_child(world)
	await process_frame
	world.advance(0.01)
	print("NAMES ", ",".join(HapticMesh.get_library_names()))
	print("BODIES ", world.get_statistics().bodies, " PROBLEMS ", world.get_problems())
	quit()
"""

# Held before the first step of Godot's own physics, which puts to sleep what it does not move.
AT_THE_START = """extends SceneTree


func _initialize() -> void:
	_play.call_deferred()


func _play() -> void:
	var world := HapticWorld.new()
	root.add_child(world)
	var body := RigidBody3D.new()
	var child := CollisionShape3D.new()
	child.shape = BoxShape3D.new()
	body.add_child(child)
	world.add_child(body)
	await create_timer(0.5).timeout
	print("BODIES ", world.get_statistics().bodies, " PROBLEMS ", world.get_problems())
	quit()
"""


def godot_in(folder, *arguments: str) -> str:
    command = [str(godot.command()), "--headless", "--path", folder, *arguments]
    return subprocess.run(command, timeout=120, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT).stdout


def test_copied_to_another_folder_it_finds_its_meshes(tmp_path):
    shutil.copytree(project.FOLDER / "addons/tactus", tmp_path / "third_party/touch")
    (tmp_path / "project.godot").write_text(PROJECT)
    (tmp_path / "touch.gd").write_text(SCRIPT)
    godot_in(tmp_path, "--import")
    printed = godot_in(tmp_path, "--script", "res://touch.gd")
    assert "torus" in printed.partition("NAMES ")[2].splitlines()[0].split(","), printed
    assert "BODIES 1 PROBLEMS []" in printed, printed


def others_built() -> list[platforms.Platform]:
    """Those that ./run addon --platform=… has built here, debug and release."""
    return [one for one in platforms.FOREIGN if len(addon.built(one)) == len(addon.manifest.TARGETS)]


@pytest.fixture(scope="module")
def archive() -> bytes:
    return addon.pack(others_built()).read_bytes()


@pytest.fixture(scope="module")
def own_project(archive, tmp_path_factory):
    return project_with(archive, tmp_path_factory.mktemp("own_project"))


def project_with(archive: bytes, folder: Path) -> Path:
    """An empty project with the archive unzipped into it and the scene of its README, imported without a list of
    extensions written first: as the editor does it."""
    with zipfile.ZipFile(io.BytesIO(archive)) as files:
        files.extractall(folder)
    (folder / "project.godot").write_text(PROJECT + '\n[autoload]\n\nUser="*res://user.gd"\n')
    (folder / "first_touch.tscn").write_text(FIRST_TOUCH)
    (folder / "user.gd").write_text(USER)
    (folder / "start.tscn").write_text('[gd_scene format=3]\n\n[node name="Start" type="Node"]\n')
    (folder / "export_presets.cfg").write_text(EXPORT)
    (folder / ".godot").mkdir()
    (folder / ".godot/extension_list.cfg").write_text("res://addons/tactus/tactus.gdextension\n")
    imported = subprocess.run(
        [str(godot.command()), "--headless", "--path", folder, "--import"], timeout=120, capture_output=True, text=True
    )
    assert imported.returncode == 0, imported.stdout + imported.stderr
    return folder


def test_the_archive_names_what_is_in_it(own_project):
    folder = own_project / "addons/tactus"
    for name in ("README.md", "LICENSE", "CHANGELOG.md", "NOTICES.txt", "tactus.gdextension"):
        assert (folder / name).is_file(), name
    for work in ("Jolt Physics", "libsodium", "GLM", "Godot Engine"):
        assert work in (folder / "NOTICES.txt").read_text()
    assert ("OpenNI2" in (folder / "NOTICES.txt").read_text()) == any("sensing" in path.name for path in (folder / "bin").iterdir())
    assert "AVX2" in "".join((folder / "README.md").read_text().splitlines()[:12])
    assert addon.version() in (folder / "CHANGELOG.md").read_text()
    assert f'version="{addon.version()}"' in (folder / "plugin.cfg").read_text()
    description = (folder / "tactus.gdextension").read_text()
    for name in addon._libraries(description):
        assert (folder / name).is_file(), name
    for one in platforms.given_away([platforms.host(), *others_built()]):
        processor = "" if one.architecture == platforms.UNIVERSAL else f".{one.architecture}"
        for target in addon.manifest.TARGETS:
            assert f"{one.system}.{target}.single{processor} = " in description


def test_the_oldest_godot_is_the_one_whose_api_was_used():
    major, minor, *_ = godot.version(str(godot.command()))
    description = (project.FOLDER / "addons/tactus/tactus.gdextension").read_text()
    assert f'compatibility_minimum = "{major}.{minor}"' in description
    assert "linux.debug.single.x86_64" in description


def test_two_archives_of_the_same_are_the_same_bytes(archive):
    assert addon.pack(others_built()).read_bytes() == archive


def test_a_platform_that_was_not_built_is_named(monkeypatch):
    built = addon.built
    monkeypatch.setattr(addon, "built", lambda platform, other_godot: [] if platform.is_foreign else built(platform, other_godot))
    with pytest.raises(RuntimeError, match=r"not built yet: bin/libtactus\.windows\.template_debug.*./run addon --platform"):
        addon.pack([platforms.named("windows")])


def test_an_archive_for_an_older_godot_is_felt_in_this_one(tmp_path):
    (version,) = interfaces.VERSIONS
    if len(addon.built(platforms.host(), version)) < len(addon.manifest.TARGETS):
        pytest.skip(f"not built here: ./run addon --godot={version} builds it")
    path = addon.pack(other_godot=version)
    assert path.name == f"tactus-{addon.version()}-godot-{version}.zip"
    folder = project_with(path.read_bytes(), tmp_path)
    assert f'compatibility_minimum = "{version}"' in (folder / "addons/tactus/tactus.gdextension").read_text()
    assert f"Godot {version} or newer" in (folder / "addons/tactus/README.md").read_text()
    printed = godot_in(folder, "res://start.tscn")
    assert "FIRST TOUCH true true 0.06" in printed, printed


def test_libraries_for_an_older_godot_that_were_not_built_are_named():
    with pytest.raises(RuntimeError, match=r"not built yet: bin/libtactus\.linux.*--godot=VERSION"):
        addon.pack(other_godot="4.0")


def test_the_published_pointers_are_to_void():
    header = "typedef const struct __GdextVariant *GDExtensionConstVariantPtr;\nstruct Own *own;\n"
    assert interfaces.as_published(header) == "typedef const void *GDExtensionConstVariantPtr;\nstruct Own *own;\n"


def names_in(part: object) -> set[str]:
    """All that a part of an extension_api.json gives a name, but parameters."""
    if isinstance(part, list):
        return set().union(*map(names_in, part))
    if not isinstance(part, dict):
        return set()
    return {str(part.get("name"))}.union(*(names_in(inner) for key, inner in part.items() if key != "arguments"))


def test_the_addons_scripts_name_nothing_that_the_oldest_godot_lacks():
    folders = (godot.api_folder(str(godot.command())), interfaces.folder("4.4"))
    here, there = (names_in(json.loads((folder / "extension_api.json").read_text())) for folder in folders)
    newer = here - there
    assert "EditorDock" in newer
    for path in [path for path in addon.FOLDER.rglob("*") if path.suffix in (".gd", ".tscn")]:
        assert set(re.findall(r"\w+", path.read_text())) & newer == set(), path


def test_what_windows_libraries_contain_besides_has_its_licence():
    if not Path(addon.NOTICES_OF["windows"]["MinGW-w64, its C runtime and winpthreads"]).is_file():
        pytest.skip("MinGW-w64 is not on this machine: ./run addon --platform=windows brings it")
    assert "winpthreads" in addon.notices([platforms.named("windows")])
    assert "winpthreads" not in addon.notices([platforms.host()])


def test_macos_libraries_are_universal_and_show_the_door():
    """As a Mac would read them; none has: docs/platforms.md."""
    macos = platforms.given_away([one for one in others_built() if one.system == "macos"])
    if not macos or macos[0].architecture != platforms.UNIVERSAL:
        pytest.skip("not built here: ./run addon --platform=macos builds them")
    libraries = addon.built(macos[0])
    assert len(libraries) == len(addon.manifest.TARGETS)
    for library in libraries:
        magic, count = struct.unpack(">II", library.read_bytes()[:8])
        assert (magic, count) == (0xCAFEBABE, 2)
        found = shipped_library.read(library, macos[0])
        assert found.complaint("macos") == "" and found.libraries == {"/usr/lib/libsystem.b.dylib"}
    with pytest.raises(RuntimeError, match="is no library"):
        shipped_library.read(Path(addon.__file__), macos[0])


def test_first_touch_by_the_five_steps(own_project):
    printed = godot_in(own_project, "res://start.tscn")
    assert "FIRST TOUCH true true 0.06" in printed, printed


@contextlib.contextmanager
def without_user(folder):
    settings = folder / "project.godot"
    before = settings.read_text()
    settings.write_text(before.replace('User="*res://user.gd"\n', ""))
    yield
    settings.write_text(before)


def test_a_body_that_is_there_at_the_start_has_no_problem(own_project):
    (own_project / "at_the_start.gd").write_text(AT_THE_START)
    with without_user(own_project):
        printed = godot_in(own_project, "--script", "res://at_the_start.gd")
    assert "BODIES 1 PROBLEMS []" in printed and "WARNING" not in printed, printed


def test_the_five_lines_of_the_readme(own_project):
    (script,) = re.findall(r"```gdscript\n(.*?)```", (cache.clone() / "README.md").read_text(), re.DOTALL)
    assert len(script.splitlines()) == 5
    (own_project / "readme.gd").write_text(script)
    scene = '[gd_scene format=3]\n\n[ext_resource type="Script" path="res://readme.gd" id="1"]\n\n[node name="Scene" type="Node3D"]\nscript = ExtResource("1")\n'
    (own_project / "readme.tscn").write_text(scene)
    with without_user(own_project):
        printed = godot_in(own_project, "--quit-after", "30", "res://readme.tscn")
    assert "(0.0, 0.0, 0.0)" in printed and "ERROR" not in printed, printed


def test_first_touch_in_an_exported_program(own_project):
    settings = own_project / "project.godot"
    plugin = '[editor_plugins]\n\nenabled=PackedStringArray("res://addons/tactus/plugin.cfg")\n\n[autoload]'
    settings.write_text(settings.read_text().replace("[autoload]", f'run/main_scene="res://start.tscn"\n\n{plugin}'))
    (own_project / "program").mkdir()
    program = own_project / "program/touch.x86_64"
    exported = godot_in(own_project, "--export-release", "Linux", str(program))
    assert program.is_file(), exported
    done = subprocess.run([program, "--headless"], timeout=120, capture_output=True, text=True)
    assert "FIRST TOUCH true true 0.06" in done.stdout, done.stdout + done.stderr
    assert (program.parent / "tactus_license.txt").read_text() == (cache.clone() / "LICENSE").read_text(), exported
    assert "Jolt Physics" in (program.parent / "tactus_notices.txt").read_text(), exported


def test_the_cache_names_no_folder_of_this_machine_in_the_archive(own_project):
    for path in (own_project / "addons/tactus").rglob("*"):
        if path.is_file() and path.suffix in (".md", ".txt", ".gdextension"):
            assert str(cache.root()) not in path.read_text()
        if path.is_file() and "template_release" in path.name:
            content = path.read_bytes()
            assert str(cache.root()).encode() not in content and str(cache.clone()).encode() not in content, path.name
            assert b".symtab" not in content, f"{path.name} is not stripped"
