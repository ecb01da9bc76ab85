extends "test_case.gd"
## A project of its own, with the addon in another folder than in the demo project.

const PROJECT := """config_version=5
[application]
config/name="Elsewhere"
"""
const SCENE := """[gd_scene format=3]
[ext_resource type="Script" path="res://look.gd" id="look"]
[sub_resource type="HapticPath" id="path"]
circle_radius = 0.0
circle_amplitude = 0.02
circle_turn_time = 0.5
circle_waves = 1
[node name="HapticWorld" type="HapticWorld"]
[node name="Body" type="StaticBody3D" parent="."]
[node name="Mesh" type="HapticMesh" parent="Body"]
library_mesh = "cube"
[node name="Bare" type="StaticBody3D" parent="."]
[node name="HapticDevice" type="HapticDevice" parent="."]
transform = Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.075, 0)
path = SubResource("path")
[node name="ProxyPointer" type="ProxyPointer" parent="."]
device = NodePath("../HapticDevice")
[node name="Look" type="Node" parent="."]
script = ExtResource("look")
"""
const LOOK := """@tool
extends Node
var _frames := 0
var _touched := false

func _process(_delta: float) -> void:
	_frames += 1
	var world: HapticWorld = get_parent()
	var proxy: ProxyPointer = world.get_node("ProxyPointer")
	_touched = _touched or proxy.is_touching()
	if _frames == 60:
		print("LOOK ", JSON.stringify({"editor": Engine.is_editor_hint(), "running": world.is_running(),
			"ticks": world.get_ticks(), "warnings": world.get_problems(), "touched": _touched,
			"device": world.get_node("HapticDevice").get_problems()}))
"""

## A node for each fault that the editor knows of, and what its warning says; the ball moves meanwhile.
const FAULTS := """[gd_scene format=3]
[ext_resource type="Script" path="res://look_at_faults.gd" id="look"]
[sub_resource type="SphereShape3D" id="ball"]
[sub_resource type="HapticMaterial" id="material"]
[node name="Scene" type="Node3D"]
[node name="Outside" type="StaticBody3D" parent="."]
physics_material_override = SubResource("material")
[node name="World" type="HapticWorld" parent="."]
authority = 0
[node name="Csg" type="CSGBox3D" parent="World"]
use_collision = true
[node name="Tiles" type="GridMap" parent="World"]
[node name="Area" type="Area3D" parent="World"]
[node name="Soft" type="SoftBody3D" parent="World"]
[node name="Ball" type="StaticBody3D" parent="World"]
[node name="Shape" type="CollisionShape3D" parent="World/Ball"]
shape = SubResource("ball")
[node name="Mouse" type="HapticDevice" parent="World"]
[node name="Pathless" type="HapticDevice" parent="World"]
driver = 0
[node name="Inside" type="ProxyPointer" parent="World"]
device = NodePath("../Mouse")
[node name="Large" type="ProxyPointer" parent="World"]
device = NodePath("../Mouse")
radius = 30.0
[node name="Small" type="ProxyPointer" parent="World"]
device = NodePath("../Mouse")
radius = 0.000002
[node name="Masked" type="ProxyPointer" parent="World"]
device = NodePath("../Mouse")
collision_mask = 4
[node name="Blind" type="ProxyPointer" parent="World"]
device = NodePath("../Mouse")
collision_mask = 0
[node name="Handless" type="ProxyPointer" parent="World"]
device = NodePath("../Nowhere")
[node name="Look" type="Node" parent="."]
script = ExtResource("look")
"""
const LOOK_AT_FAULTS := """@tool
extends Node
var _frames := 0
var _told := 0

func _enter_tree() -> void:
	get_tree().node_configuration_warning_changed.connect(_on_changed)

func _on_changed(node: Node) -> void:
	if _frames > 100 and node.name == &"Inside":
		_told += 1

func _say(mark: String) -> void:
	var said := {"told": _told}
	for node in get_parent().find_children("*", "", true, false):
		if node.has_method("get_problems"):
			said[node.name] = " ".join(node.get_problems())
	print(mark, JSON.stringify(said))

func _process(_delta: float) -> void:
	_frames += 1
	if _frames == 100:
		_say("LOOK ")
		get_node("../World/Ball").position.y = 3.0
	if _frames > 100 and (_told > 0 or _frames == 2000):
		_say("AGAIN ")
		set_process(false)
		get_tree().quit()
"""
const SAID := {
	"World":
	[
		"'Csg' is not carried out as Godot has it",
		"bake its collision shape",
		"a GridMap is not carried over",
		"a SoftBody3D is not carried over",
		"'Outside' has a HapticMaterial",
	],
	"Mouse": ["the mouse needs a camera"],
	"Pathless": ["set 'path' to a HapticPath"],
	"Inside": ["its hand begins inside 'Ball'"],
	"Large": ["the proxy's radius"],
	"Small": ["the proxy's radius"],
	"Masked": ["'collision_mask' has no layer"],
	"Blind": ["'collision_mask' is empty"],
	"Handless": ["set 'device' anew"],
}

static var _folder := ""


func _make_project() -> void:
	if _folder != "":
		return
	_folder = OS.get_user_data_dir().path_join("elsewhere")
	_copy(ProjectSettings.globalize_path("res://addons/tactus"), _folder.path_join("third_party/touch"))
	_write("project.godot", PROJECT)
	_write("look.gd", LOOK)
	_write("scene.tscn", SCENE)
	_write("look_at_faults.gd", LOOK_AT_FAULTS)
	_write("faults.tscn", FAULTS)
	_write(".godot/extension_list.cfg", "res://third_party/touch/tactus.gdextension\n")
	_godot(["--import"])


func _copy(from: String, to: String) -> void:
	DirAccess.make_dir_recursive_absolute(to)
	for file in DirAccess.get_files_at(from):
		DirAccess.copy_absolute(from.path_join(file), to.path_join(file))
	for folder in DirAccess.get_directories_at(from):
		_copy(from.path_join(folder), to.path_join(folder))


func _write(file: String, text: String) -> void:
	var path := _folder.path_join(file)
	DirAccess.make_dir_recursive_absolute(path.get_base_dir())
	FileAccess.open(path, FileAccess.WRITE).store_string(text)


func _godot(arguments: Array) -> String:
	var output := []
	OS.execute(OS.get_executable_path(), ["--headless", "--path", _folder] + arguments, output, true)
	return output[0]


func _what_look_saw(output: String, mark := "LOOK ") -> Dictionary:
	for line in output.split("\n"):
		if line.begins_with(mark):
			return JSON.parse_string(line.trim_prefix(mark))
	check(false, "the scene was not opened: " + output)
	return {}


func test_the_editor_opens_a_scene_and_runs_nothing_in_it() -> void:
	_make_project()
	var output := _godot(["--editor", "--quit-after", "120", "res://scene.tscn"])
	var seen := _what_look_saw(output)
	if seen.is_empty():
		return
	check_equal(seen.editor, true, "editor")
	check_equal(seen.running, false, "running")
	check_equal(seen.ticks, 0.0, "ticks")
	check_equal(seen.warnings.size(), 1, "warnings")
	check(
		seen.warnings[0].contains("'Bare'") and seen.warnings[0].contains("it has no shape"), seen.warnings[0]
	)
	check_equal(seen.device, [], "warnings of the device")
	check(not output.contains("ERROR"), output)


func test_the_editor_warns_of_every_fault_and_no_longer_than_it_is_there() -> void:
	_make_project()
	var output := _godot(["--editor", "--quit-after", "3000", "res://faults.tscn"])
	var seen := _what_look_saw(output)
	for node: String in SAID:
		for text: String in SAID[node]:
			check(text in seen.get(node, ""), "%s does not say '%s': %s" % [node, text, seen.get(node)])
	var later := _what_look_saw(output, "AGAIN ")
	check(not "begins inside" in later.get("Inside", "begins inside"), "Inside: %s" % later.get("Inside"))
	check(later.get("told", 0) > 0, "the editor was not told that a warning is gone")


func test_the_library_is_found_where_the_addon_is() -> void:
	_make_project()
	var output := _godot(["--max-fps", "60", "--quit-after", "90", "res://scene.tscn"])
	var seen := _what_look_saw(output)
	if seen.is_empty():
		return
	check_equal(seen.running, true, "running")
	check_equal(seen.touched, true, "touched")
	check(output.contains("Bare: it has no shape"), output)
