extends "nodes_case.gd"
## Scenes of the gallery and scripts with the former names of CHANGELOG.md work the same.

const Stepping := preload("res://gallery/stage/stepping.gd")
const FOLDER := "user://renames_play_test"
## They have nodes, sub-resources and scripts of renamed classes.
const SCENES := ["delay_lab", "field", "two_operators"]
const FORMER := {
	"DepthSensor": "HapticDepthSensor",
	"HapticFeedback": "HapticVibrationSound",
	"HapticField": "HapticVolume",
	"NetworkConditions": "MMTNetworkConditions",
	"TeleopTuning": "MMTTuning"
}


func _former(scene_path: String, name: String) -> Node:
	var text := FileAccess.get_file_as_string(scene_path)
	for old: String in FORMER:
		text = text.replace('type="%s"' % FORMER[old], 'type="%s"' % old)
	DirAccess.make_dir_recursive_absolute(FOLDER)
	var to := FOLDER.path_join(name + ".tscn")
	FileAccess.open(to, FileAccess.WRITE).store_string(text)
	return (load(to) as PackedScene).instantiate()


func _poses_after_a_second(scene: Node) -> Array:
	var worlds := Stepping.hold(scene)
	add_child(scene)
	for _i in 25:
		Stepping.advance(worlds, 0.04)
		await get_tree().process_frame
	var found := []
	for proxy: ProxyPointer in scene.find_children("*", "ProxyPointer", true, false):
		found.append([proxy.get_proxy_position(), proxy.get_force()])
	scene.free()
	await frames(1)
	return found


func _scenes() -> void:
	for name: String in SCENES:
		var scene_path := "res://gallery/%s/%s.tscn" % [name, name]
		var expected: Array = await _poses_after_a_second((load(scene_path) as PackedScene).instantiate())
		var found: Array = await _poses_after_a_second(_former(scene_path, name))
		check(expected.size() > 0, "%s has no pointer" % name)
		check_equal(found, expected, name)


func _scripts() -> void:
	var script := GDScript.new()
	script.source_code = """extends HapticFeedback

var tuning: TeleopTuning = TeleopTuning.new()
var volume := HapticField.new()

func run(conditions: NetworkConditions) -> bool:
	tuning.derivation = TeleopTuning.DERIVATION_VELOCITY
	tuning.stand_in_leash = 0.25
	conditions.delay = 0.5
	var mesh := HapticMesh.new()
	mesh.field = volume
	var is_set := mesh.volume == volume and mesh.field == volume and tuning.get_stand_in_leash() == 0.25
	mesh.free()
	return is_set and tuning.derivation == MMTTuning.DERIVATION_VELOCITY and sound
"""
	check_equal(script.reload(), OK, "compiling")
	var node: Node = ClassDB.instantiate("HapticFeedback")
	node.set_script(script)
	check(node.run(ClassDB.instantiate("NetworkConditions")), "something has another value")
	node.free()


## One test: each former name is warned of once a run.
func test_former_names_play_the_same() -> void:
	expect_error(" now. The old name still works")
	_scripts()
	await _scenes()
