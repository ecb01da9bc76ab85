extends SceneTree
## One side of a teleoperation that says twenty times a second how it is, until it is ended:
##
##     godot --headless --path demo_project --script res://experiments/networked_side.gd -- --NAME=VALUE …
##
## --NAME=VALUE   a property of the scene's MMTLink
##
## As soon as the operator knows both bodies of the far side its hand comes down onto the box and stays there,
## pressing. Each line is JSON: time (s since the epoch), state and text of the link, force on the hand (N),
## whether it touches, objects that are known, and where the box is (m).

const Sides := preload("res://experiments/sides.gd")
const SCENE := "res://gallery/dynamic_testbed/dynamic_testbed.tscn"
const SAY_EVERY := 0.05

var _link: MMTLink
var _device: HapticDevice
var _pointer: ProxyPointer
var _box: Node3D
var _said_at := 0.0
var _presses := false


func _initialize() -> void:
	Engine.max_fps = 60
	RenderingServer.render_loop_enabled = false
	var scene := (load(SCENE) as PackedScene).instantiate()
	_link = scene.find_children("*", "MMTLink")[0]
	_device = scene.find_children("*", "HapticDevice")[0]
	_pointer = scene.find_children("*", "ProxyPointer")[0]
	_box = scene.find_child("Box")
	_link.scenario = MMTLink.SCENARIO_MMT
	for argument in OS.get_cmdline_user_args():
		var problem := Sides.set_property(_link, argument)
		if not problem.is_empty():
			printerr("networked_side: ", problem, ".")
			quit(2)
			return
	_device.path = _way([Vector3(0.0, 0.3, 0.25), Vector3(0.0, 0.3, 0.25)], [0.0, 1.0])
	root.add_child(scene)


func _process(_delta: float) -> bool:
	var now := Time.get_unix_time_from_system()
	if not _presses and _link.side == MMTLink.SIDE_OPERATOR and _link.get_statistics().model_complete:
		_presses = true
		_device.path = _way(
			[Vector3(0.0, 0.3, 0.25), Vector3(0.0, 0.155, 0.25), Vector3(0.0, 0.155, 0.25)], [0.0, 2.0, 1e5]
		)
	if now - _said_at >= SAY_EVERY:
		_said_at = now
		_say(now)
	return false


func _say(now: float) -> void:
	var force := _device.get_force()
	var at := _box.global_position
	var line := {
		"time": now,
		"state": _link.get_state(),
		"text": _link.get_state_text(),
		"force": [force.x, force.y, force.z],
		"touches": _pointer.is_touching(),
		"objects": _link.get_statistics().objects,
		"box": [at.x, at.y, at.z],
	}
	print(JSON.stringify(line))


func _way(positions: Array, times: Array) -> HapticPath:
	var way := HapticPath.new()
	way.form = HapticPath.FORM_POINTS
	way.points_positions = PackedVector3Array(positions)
	way.points_times = PackedFloat64Array(times)
	return way
