extends SceneTree
## The operator's side of a teleoperation whose teleoperator is another program, played in steps that a caller
## asks for:
##
##     godot --headless --path demo_project --script res://experiments/peer_operator.gd -- --NAME=VALUE …
##
## --way=PATH         a HapticPath that the hand follows once it sets out
## --device.NAME=VALUE  a property of the HapticDevice
## --tuning.NAME=VALUE  a property of the MMTLink's MMTTuning
## --NAME=VALUE       a property of the MMTLink
##
## Each line of the standard input is a command: `step` advances the world by one tick, `go` lets the hand set
## out, `quit` ends. Each step is answered by a line of JSON: time of the world (s), device position (m),
## displayed force (N), proxy (m), whether it touches, state of the link, and bodies of the local model (m).
## The UDP packets of a step may still be on their way within the machine when it is answered.

const Sides := preload("res://experiments/sides.gd")
const TICK := 0.001
const LONGEST_COMMAND := 64

var _world := HapticWorld.new()
var _device := HapticDevice.new()
var _pointer := ProxyPointer.new()
var _link := MMTLink.new()
var _way: HapticPath
var _model := {}  ## the nodes of the local model, by the names of their bodies


func _initialize() -> void:
	OS.low_processor_usage_mode_sleep_usec = 1  # a frame that is not drawn waits for so long
	RenderingServer.render_loop_enabled = false
	_world.clock = HapticWorld.CLOCK_STEPPED
	_link.side = MMTLink.SIDE_OPERATOR
	_link.tuning = MMTTuning.new()
	_device.name = "Device"
	_pointer.radius = 0.01
	_way = _rest_at(Vector3(0, 0.1, 0))
	for argument in OS.get_cmdline_user_args():
		var problem := _take(argument)
		if not problem.is_empty():
			printerr("peer_operator: ", problem, ".")
			quit(2)
			return
	_device.path = _rest_at(_way.sample(0.0))
	_link.object_discovered.connect(func(name: String, node: Node3D) -> void: _model[name] = node)
	_link.object_removed.connect(func(name: String) -> void: _model.erase(name))
	for node: Node in [_device, _pointer, _link]:
		_world.add_child(node)
	_pointer.device = NodePath("../Device")
	root.add_child(_world)


func _take(argument: String) -> String:
	if argument.begins_with("--way="):
		_way = load(argument.trim_prefix("--way=")) as HapticPath
		return "" if _way != null else "%s is refused: it must be a HapticPath" % argument
	if argument.begins_with("--device."):
		return Sides.set_property(_device, "--" + argument.trim_prefix("--device."))
	if argument.begins_with("--tuning."):
		return Sides.set_property(_link.tuning, "--" + argument.trim_prefix("--tuning."))
	return Sides.set_property(_link, argument)


func _process(_delta: float) -> bool:
	match OS.read_string_from_stdin(LONGEST_COMMAND).strip_edges():
		"step":
			_world.advance(TICK)
			_say()
		"go":
			_device.path = _way
		_:
			return true
	return false


func _say() -> void:
	var bodies := {}
	for name: String in _model:
		bodies[name] = _numbers((_model[name] as Node3D).global_position)
	var line := {
		"time": _world.get_time(),
		"hand": _numbers(_device.get_hand_position()),
		"force": _numbers(_device.get_force()),
		"proxy": _numbers(_pointer.global_position),
		"touches": _pointer.is_touching(),
		"connected": _link.is_peer_connected(),
		"text": _link.get_state_text(),
		"bodies": bodies,
	}
	print(JSON.stringify(line, "", true, true))


func _rest_at(place: Vector3) -> HapticPath:
	var rest := HapticPath.new()
	rest.form = HapticPath.FORM_POINTS
	rest.points_positions = PackedVector3Array([place, place])
	rest.points_times = PackedFloat64Array([0.0, 1.0])
	return rest


func _numbers(v: Vector3) -> Array:
	return [v.x, v.y, v.z]
