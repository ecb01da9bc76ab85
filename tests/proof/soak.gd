extends "../godot/nodes_case.gd"
## Hours of virtual time in which bodies, joints, devices, pointers, tools, what gives, recordings and
## links come and go in two worlds, each a side of the other's link: tools/proof/soak.py judges the memory.
##
## A line "SAMPLE …" is JSON: virtual time (s), memory (MB), objects, nodes, files and threads, what has
## come and gone so far, and in how many frames a pointer and a tool have pressed on something.

const FRAME := 1.0 / 60.0
const MOST_BODIES := 12
const SAMPLES := 480

var _hours := float(OS.get_environment("TACTUS_PROOF_HOURS"))
var _chance := RandomNumberGenerator.new()
var _worlds: Array[HapticWorld] = []
var _bodies: Array[Array] = [[], []]
var _others: Array[Array] = [[], []]
var _links: Array[MMTLink] = []
var _changes := {}
var _pressed := {"pointer": 0, "tool": 0}
var _ticks := 0
var _meshes: Array[Mesh] = []


func _count(folder: String) -> int:
	return DirAccess.get_files_at(folder).size() + DirAccess.get_directories_at(folder).size()


func _resident() -> float:
	var words := FileAccess.open("/proc/self/statm", FileAccess.READ).get_buffer(256).get_string_from_ascii()
	return 4096e-6 * words.get_slice(" ", 1).to_float()


func _say(time: float) -> void:
	var sample := {
		"time": time,
		"resident_mb": _resident(),
		"objects": Performance.get_monitor(Performance.OBJECT_COUNT),
		"nodes": Performance.get_monitor(Performance.OBJECT_NODE_COUNT),
		"files": _count("/proc/self/fd"),
		"threads": _count("/proc/self/task"),
		"ticks": _ticks,
		"changes": _changes,
		"pressed": _pressed,
	}
	print("SAMPLE ", JSON.stringify(sample))


func _note(change: String) -> void:
	_changes[change] = _changes.get(change, 0) + 1


func _place() -> Vector3:
	return Vector3(
		_chance.randf_range(-0.3, 0.3), _chance.randf_range(0.05, 0.4), _chance.randf_range(-0.3, 0.3)
	)


func _ball(segments: int) -> Mesh:
	var mesh := SphereMesh.new()
	mesh.radius = 0.05
	mesh.height = 0.1
	mesh.radial_segments = segments
	mesh.rings = segments / 2
	return mesh


func _shape() -> Shape3D:
	match _chance.randi() % 5:
		0:
			return sphere(_chance.randf_range(0.02, 0.06))
		1:
			return box(Vector3.ONE * _chance.randf_range(0.03, 0.1))
		2:
			var capsule := CapsuleShape3D.new()
			capsule.radius = 0.02
			capsule.height = 0.1
			return capsule
		3:
			return _meshes[_chance.randi() % 2].create_convex_shape()
	return _meshes[_chance.randi() % 2].create_trimesh_shape()


func _add_body(which: int) -> void:
	var kinds: Array = [RigidBody3D, RigidBody3D, StaticBody3D, AnimatableBody3D]
	var body: PhysicsBody3D = kinds[_chance.randi() % kinds.size()].new()
	if body is StaticBody3D and _chance.randi() % 3 == 0:
		var touched := HapticMesh.new()
		touched.mesh = _meshes[_chance.randi() % _meshes.size()]
		body.add_child(touched)
		body.position = _place()
	else:
		var shape := _shape()
		with_shape(
			body,
			shape if body is StaticBody3D or not shape is ConcavePolygonShape3D else sphere(0.04),
			_place()
		)
	if _chance.randi() % 2 == 0 and "physics_material_override" in body:
		body.set("physics_material_override", material(_chance.randf_range(100.0, 900.0)))
	_worlds[which].add_child(body)
	_bodies[which].append(body)


func _remove_body(which: int) -> void:
	(_bodies[which].pop_at(_chance.randi() % _bodies[which].size()) as Node).free()


func _add_joint(which: int) -> void:
	var rigid: Array = _bodies[which].filter(func(body: Node) -> bool: return body is RigidBody3D)
	if rigid.is_empty():
		return
	var joint: Joint3D = [PinJoint3D, HingeJoint3D, SliderJoint3D][_chance.randi() % 3].new()
	_worlds[which].add_child(joint)
	joint.node_a = joint.get_path_to(rigid[_chance.randi() % rigid.size()])
	_others[which].append(joint)


func _add_what_gives(which: int) -> void:
	var soft := HapticSoftBody.new()
	soft.mesh = _meshes[0]
	soft.cells = 2
	soft.position = _place()
	_worlds[which].add_child(soft)
	_others[which].append(soft)


func _add_tool(which: int) -> void:
	var tool := HapticTool.new()
	tool.mesh = _meshes[0]
	tool.max_spheres = 40
	tool.device = NodePath("../Device")
	_worlds[which].add_child(tool)
	_others[which].append(tool)


func _hand(which: int) -> void:
	for name: String in ["Proxy", "Device"]:
		if _worlds[which].has_node(name):
			var node := _worlds[which].get_node(name)
			_worlds[which].remove_child(node)
			node.free()
	var way := HapticPath.new()
	way.form = HapticPath.FORM_POINTS
	var places := PackedVector3Array()
	var times := PackedFloat64Array()
	for i in 6:
		places.append(_place() - Vector3(0, 0.06, 0))
		times.append(i * 1.5)
	places[5] = places[0]
	way.points_positions = places
	way.points_times = times
	way.points_loop = true
	add_hand(_worlds[which], way)


func _record(which: int) -> void:
	var recorder := HapticRecorder.new()
	recorder.proxy = NodePath("../Proxy")
	recorder.csv_path = "user://soak_%d_%d.csv" % [OS.get_process_id(), which]
	_worlds[which].add_child(recorder)
	_others[which].append(recorder)


## One time in four there is none, and tools touch.
func _link() -> void:
	for link in _links:
		link.free()
	_links.clear()
	if _chance.randi() % 4 == 0:
		return
	for which in 2:
		var link := MMTLink.new()
		link.name = "Link"
		link.side = MMTLink.SIDE_OPERATOR if which == 0 else MMTLink.SIDE_TELEOPERATOR
		link.scenario = MMTLink.SCENARIO_MMT if _chance.randi() % 3 > 0 else MMTLink.SCENARIO_DIRECT
		link.conditions = MMTNetworkConditions.new()
		link.conditions.delay = _chance.randf_range(0.0, 0.05)
		link.conditions.loss = 0.02
		link.tuning = MMTTuning.new()
		_worlds[which].add_child(link)
		_links.append(link)
	_links[1].scenario = _links[0].scenario
	_links[0].partner = NodePath("../../World1/Link")
	_links[1].partner = NodePath("../../World0/Link")


func _change() -> void:
	var which := _chance.randi() % 2
	var kind: String = [
		"body",
		"body",
		"body",
		"body",
		"gone",
		"gone",
		"gone",
		"joint",
		"gives",
		"tool",
		"hand",
		"record",
		"link"
	][_chance.randi() % 13]
	match kind:
		"body":
			if _bodies[which].size() >= MOST_BODIES:
				_remove_body(which)
			_add_body(which)
		"gone":
			if not _bodies[which].is_empty():
				_remove_body(which)
			elif not _others[which].is_empty():
				(_others[which].pop_front() as Node).free()
		"joint":
			_add_joint(which)
		"gives":
			_add_what_gives(which)
		"tool":
			_add_tool(which)
		"hand":
			_hand(which)
		"record":
			_record(which)
		"link":
			_link()
	while _others[which].size() > 3:
		(_others[which].pop_front() as Node).free()
	_note(kind)


func _watch_forces() -> void:
	for world in _worlds:
		for hand: Node in world.get_children():
			if hand is ProxyPointer or hand is HapticTool:
				var force: Vector3 = hand.call("get_force")
				check(force.is_finite(), "a force is none")
				_pressed["tool" if hand is HapticTool else "pointer"] += int(force.length() > 0.05)


func test_memory_stays_flat() -> void:
	# Godot rests for 6.9 ms after each frame that nobody sees: hours of nothing.
	OS.low_processor_usage_mode_sleep_usec = 1
	_chance.seed = 20260108
	_meshes = [_ball(8), _ball(16), BoxMesh.new(), _ball(64)]
	for which in 2:
		_worlds.append(add_world())
		_worlds[which].name = "World%d" % which
		add_floor(_worlds[which])
		_hand(which)
	_link()
	var time := 0.0
	var next_change := 0.0
	var next_sample := 0.0
	while time < _hours * 3600.0 and failure.is_empty():
		if time >= next_change:
			_change()
			next_change += 0.5
		if time >= next_sample:
			_say(time)
			next_sample += _hours * 3600.0 / SAMPLES
		for world in _worlds:
			_ticks += world.advance(FRAME)
		_watch_forces()
		time += FRAME
		await frames(1)
	_say(time)
