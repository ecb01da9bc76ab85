extends SceneTree
## A depth camera by itself, whose images another program draws (tools/measuring/depth_file.py): says after
## each image what it has recognized.
##
##     godot --headless --path demo_project --script res://experiments/eye.gd -- --pose=NUMBERS --NAME=VALUE …
##
## --pose=NUMBERS  of the camera in the scene: [x, y, z] of its three axes and of its place, 12 numbers (m)
## --NAME=VALUE    a property of the HapticDepthSensor
##
## Each line is JSON: how many images it has looked at or left out, its state, its support ([normal, offset],
## or nothing), and the objects by their names: transform as above, linear and angular velocity, and whether
## they rest.

const Sides := preload("res://experiments/sides.gd")

var _sensor := HapticDepthSensor.new()
var _looked := -1


func _initialize() -> void:
	OS.low_processor_usage_mode_sleep_usec = 1
	RenderingServer.render_loop_enabled = false
	_sensor.rate = 60.0
	for argument in OS.get_cmdline_user_args():
		var problem := _take(argument)
		if not problem.is_empty():
			printerr("eye: ", problem, ".")
			quit(2)
			return
	root.add_child(_sensor)


func _take(argument: String) -> String:
	if not argument.begins_with("--pose="):
		return Sides.set_property(_sensor, argument)
	var numbers: Variant = JSON.parse_string(argument.trim_prefix("--pose="))
	if not numbers is Array or numbers.size() != 12:
		return "%s is refused: it must be 12 numbers" % argument
	var columns := []
	for first in range(0, 12, 3):
		columns.append(Vector3(numbers[first], numbers[first + 1], numbers[first + 2]))
	_sensor.transform = Transform3D(columns[0], columns[1], columns[2], columns[3])
	return ""


func _process(_delta: float) -> bool:
	var statistics := _sensor.get_statistics()
	var looked: int = statistics.get("frames", 0) + statistics.get("dropped", 0)
	if looked != _looked:
		_looked = looked
		_say()
	return false


func _say() -> void:
	var plane := _sensor.get_plane()
	var line := {"looked": _looked, "text": _sensor.get_state_text(), "plane": [], "objects": {}}
	if not plane.is_empty():
		line["plane"] = [_numbers(plane.normal), plane.offset]
	for object in _sensor.get_objects():
		var at: Transform3D = object.transform
		line.objects[object.name] = {
			"pose": _numbers(at.basis.x) + _numbers(at.basis.y) + _numbers(at.basis.z) + _numbers(at.origin),
			"linear_velocity": _numbers(object.linear_velocity),
			"angular_velocity": _numbers(object.angular_velocity),
			"rests": object.rests,
			"is_known": object.is_known,
			"state": object.state,
		}
	print(JSON.stringify(line))


func _numbers(v: Vector3) -> Array:
	return [v.x, v.y, v.z]
