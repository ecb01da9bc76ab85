extends SceneTree
## One side of depth_camera.tscn by itself, which says in every frame how it is, until it is ended:
##
##     godot --headless --path demo_project --script res://experiments/camera_side.gd -- --part=PART …
##
## --part=operator  the hand and its model
## --part=far       the robot, the camera, and the place that both are in
## --part=direct    that place alone, touched by the operator's hand itself
## --moves=1        the cube is pushed along in that place
## --sensor.NAME=VALUE, --robot.NAME=VALUE, --surface.NAME=VALUE  far: properties of the HapticDepthSensor,
##                  of the robot, and of the material that the model has for what the camera finds
## --NAME=VALUE     a property of the part's MMTLink
##
## The hand sets out when the model has all that is there, or at once where it touches directly. Each line is
## JSON: time since the epoch and since the hand has set out (s; below 0: it has not), place and force of the
## hand, how far its proxy is from it, force on the robot's tip, and where the bodies are, by their names;
## once, what the camera sees.

const Sides := preload("res://experiments/sides.gd")
const OBJECTS := 3
const SHOWN_POINTS := 2  ## of so many one is said
const KEPT := {
	"operator": ["HapticWorld"],
	"far": ["Far", "Reality"],
	"direct": ["Reality"],
}

var _part := "far"
var _moves := false
var _world: HapticWorld
var _reality: HapticWorld
var _device: HapticDevice
var _link: MMTLink
var _way: HapticPath
var _set_out := -1.0
var _has_shown := false


func _initialize() -> void:
	Engine.max_fps = 60
	RenderingServer.render_loop_enabled = false
	var scene := (load("res://gallery/depth_camera/depth_camera.tscn") as PackedScene).instantiate()
	var settings := {}
	for argument in OS.get_cmdline_user_args():
		var words := argument.trim_prefix("--").split("=", true, 1)
		settings[words[0]] = words[1] if words.size() == 2 else ""
	_part = settings.get("part", "")
	if not KEPT.has(_part):
		printerr("camera_side: --part=%s is refused: it must be one of %s." % [_part, ", ".join(KEPT.keys())])
		quit(2)
		return
	_moves = settings.get("moves", "0") == "1"
	_way = (scene.get_node("HapticWorld/HapticDevice") as HapticDevice).path
	for part: String in ["HapticWorld", "Far", "Reality", "Tip", "Placard"]:
		if part not in KEPT[_part]:
			scene.get_node(part).free()
	_world = scene.get_node(KEPT[_part][0])
	_reality = scene.get_node_or_null("Reality")
	_device = _world.find_children("*", "HapticDevice")[0]
	if _part == "direct":
		_device.driver = HapticDevice.DRIVER_PATH
		_device.transform = Transform3D.IDENTITY
	if _part != "far":
		_device.path = _rest()
	if _part != "direct":
		_link = _world.get_node("MMTLink")
		_link.partner = NodePath()
	var problem := _take(settings, scene)
	if not problem.is_empty():
		printerr("camera_side: ", problem, ".")
		quit(2)
		return
	if _part == "far":
		scene.get_node("Far/DepthSensor").show_cloud = true
	root.add_child(scene)


## Empty, or why a setting was refused.
func _take(settings: Dictionary, scene: Node) -> String:
	var owners := {"": _link}
	if _part == "far":
		_world.default_material = _world.default_material.duplicate()
		owners["sensor"] = scene.get_node("Far/DepthSensor")
		owners["robot"] = scene.get_node("Far/Robot")
		owners["surface"] = _world.default_material
	for property: String in settings:
		if property in ["part", "moves"]:
			continue
		var dot := property.find(".")
		var owner: Object = owners.get(property.left(maxi(dot, 0)))
		if owner == null:
			return "--%s is refused: the part %s has no such thing" % [property, _part]
		var problem := Sides.set_property(owner, "--%s=%s" % [property.substr(dot + 1), settings[property]])
		if not problem.is_empty():
			return problem
	return ""


func _process(_delta: float) -> bool:
	var now := Time.get_ticks_usec() * 1e-6
	if _set_out < 0.0 and _part != "far" and _knows_all():
		_set_out = now
		_device.path = _way
	if _moves and _reality != null:
		_push()
	_say(now)
	return false


func _knows_all() -> bool:
	return _part == "direct" or _link.get_statistics().get("objects", 0) >= OBJECTS


## Back and forth by 4 cm, as if somebody slid it.
func _push() -> void:
	var cube: RigidBody3D = _reality.get_node("Cube")
	var meant := -0.1 + 0.04 * sin(Time.get_unix_time_from_system() * 1.2)
	var speed := _reality.get_linear_velocity(cube).x
	var force := clampf(150.0 * (meant - cube.global_position.x) - 10.0 * speed, -8.0, 8.0)
	_reality.apply_central_force(cube, Vector3(force, 0, 0))


## Where the way begins.
func _rest() -> HapticPath:
	var rest := HapticPath.new()
	rest.form = HapticPath.FORM_POINTS
	rest.points_positions = PackedVector3Array([_way.points_positions[0], _way.points_positions[0]])
	rest.points_times = PackedFloat64Array([0.0, 1.0])
	return rest


func _say(now: float) -> void:
	var line := {
		"time": Time.get_unix_time_from_system(),
		"since": now - _set_out if _set_out >= 0.0 else -1.0,
		"bodies": {},
	}
	line["hand"] = _numbers(_device.get_hand_position())
	line["force"] = _numbers(_device.get_force())
	line["depth"] = _depth()
	if _link != null:
		line["text"] = _link.get_state_text()
	if _part == "far":
		var proxy: ProxyPointer = _reality.get_node("ProxyPointer")
		line["tip_force"] = _numbers(proxy.get_force())
		var sensor: HapticDepthSensor = _world.get_node("DepthSensor")
		line["sensor"] = sensor.get_state_text()
		line["frame_ms"] = 1e3 * sensor.frame_time
		if not _has_shown and sensor.get_objects().size() >= OBJECTS - 1:
			_has_shown = true
			line["seen"] = _seen(sensor)
			sensor.show_cloud = false
	var among: Node = _reality if _reality != null else _world
	for body: Node in among.find_children("*", "Node3D", true, false):
		var name := String(body.name).get_slice("_", 0).to_lower()
		if name in ["cube", "bracket"]:
			var at: Transform3D = body.global_transform
			line.bodies[name] = _numbers(at.origin) + _numbers(at.basis.x) + _numbers(at.basis.y)
	print(JSON.stringify(line))


## Of the device position below its proxy.
func _depth() -> float:
	var pointer: ProxyPointer = _world.get_node("ProxyPointer")
	return _device.get_hand_position().distance_to(pointer.global_position)


## The points that the camera sees, and what it has found where: in millimeters, in its own frame.
func _seen(sensor: HapticDepthSensor) -> Dictionary:
	var cloud: MeshInstance3D = sensor.get_child(-1, true)
	var points: PackedVector3Array = cloud.mesh.surface_get_arrays(0)[Mesh.ARRAY_VERTEX]
	var said := []
	for i in range(0, points.size(), SHOWN_POINTS):
		said.append_array(_numbers((points[i] * 1000.0).round()))
	var objects := {}
	for object in sensor.get_objects():
		var at: Transform3D = sensor.global_transform.affine_inverse() * object.transform
		objects[object.name] = [at.basis.x, at.basis.y, at.basis.z, at.origin * 1000.0].map(_numbers)
	return {"points": said, "objects": objects}


func _numbers(v: Vector3) -> Array:
	return [v.x, v.y, v.z]
