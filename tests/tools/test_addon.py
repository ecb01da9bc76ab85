"""What a user does with the addon: copies its folder into another project, wherever they like."""

import shutil
import subprocess

import project
from setup import godot

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
