extends "nodes_case.gd"
## Ten thousand calls that no sane script makes, the same ones on every run: nothing crashes or hangs, and a
## value that is not taken is refused aloud.

const CALLS := 10_000
const CLASSES: Array[String] = [
	"HapticWorld",
	"HapticDevice",
	"ProxyPointer",
	"HapticRecorder",
	"HapticMesh",
	"MMTLink",
	"HapticMaterial",
	"HapticPath",
	"HapticVolume",
	"HapticForce",
	"HapticGuide",
	"MMTNetworkConditions",
	"MMTTuning"
]
const FLOATS: Array[float] = [
	0.0, -0.0, 1.0, -1.0, 0.01, 0.5, 3.0, 100.0, 1e-9, 1e6, 1e20, 1e300, -1e300, INF, -INF, NAN
]
const INTEGERS: Array[int] = [
	0, 1, 2, 3, 5, 7, 50, 99, 500, 1000, 4096, 70000, -1, -2, -3, 0xffffffff, 0x7fffffff, 1 << 40, -(1 << 62)
]
const STRINGS: Array[String] = [
	"", " ", "x", "bunny", "127.0.0.1", "::1", "fe80::zz", "short", "a long enough key", "\n\t\"'\\"
]
## Only these are written to: any other word would be a file in the project.
const PATHS: Array[String] = ["", "user://random.csv", "user://random.json", "/proc/nothing/x"]
## What may take its time, or is the test's own business.
const NOT_CALLED: Array[String] = ["_validate_property"]


class Ears:
	extends Logger

	var heard := 0
	var script_errors := PackedStringArray()

	func _log_error(
		_function: String,
		_file: String,
		_line: int,
		code: String,
		rationale: String,
		_editor: bool,
		kind: int,
		_traces: Array[ScriptBacktrace]
	) -> void:
		heard += 1
		# Godot itself frees nothing that is on the way to a handler, and says so.
		if kind == ERROR_TYPE_SCRIPT and not "locked object" in code + rationale:
			script_errors.append(code + " " + rationale)


var _chance := RandomNumberGenerator.new()
## Some of them are gone by now.
var _objects := []
var _ears := Ears.new()


func _any(from: Array) -> Variant:
	return from[_chance.randi() % from.size()]


func _living(kind := "Object") -> Array:
	var living := []
	for object in _objects:
		if is_instance_valid(object) and object.is_class(kind):
			living.append(object)
	return living


func _node() -> Node:
	var nodes := _living("Node")
	return _any(nodes) if not nodes.is_empty() else null


# gdlint: disable=max-returns
func _value(type: int, name: String, kind: String) -> Variant:
	match type:
		TYPE_BOOL:
			return _chance.randi() % 2 == 0
		TYPE_INT:
			return _any(INTEGERS)
		TYPE_FLOAT:
			# A step longer than this only takes long.
			return _any(FLOATS) if name != "seconds" else _any([0.0, 0.001, 0.01, -1.0, NAN, 1e300])
		TYPE_STRING:
			if name.contains("path") or name.contains("file"):
				return _any(PATHS)
			# Others are looked up in the network, for as long as that takes.
			return _any(STRINGS) if not name.ends_with("address") else _any(["127.0.0.1", "::1", ""])
		TYPE_STRING_NAME:
			return StringName(_any(STRINGS))
		TYPE_NODE_PATH:
			var node := _node()
			var known := node != null and node.is_inside_tree() and _chance.randi() % 2 == 0
			return node.get_path() if known else NodePath(_any(["", "..", ".", "../Nothing", "../Device"]))
		TYPE_VECTOR2:
			return Vector2(_any(FLOATS), _any(FLOATS))
		TYPE_VECTOR3:
			return Vector3(_any(FLOATS), _any(FLOATS), _any(FLOATS))
		TYPE_VECTOR3I:
			return _any([Vector3i.ZERO, Vector3i(2, 2, 2), Vector3i(-1, 3, 0x7fffffff)])
		TYPE_ARRAY:
			return _any([[], [null, 1], [Image.create_empty(2, 2, false, Image.FORMAT_L8)]])
		TYPE_PACKED_FLOAT32_ARRAY:
			return _any([PackedFloat32Array(), PackedFloat32Array([-1, 1, 1, 1, 1, 1, 1, NAN])])
		TYPE_DICTIONARY:
			return _any([{}, {"Box": 1}, {"Box": {"move": [NAN]}}, {1: {"turn": "x"}}])
		TYPE_PACKED_VECTOR3_ARRAY:
			return _any([PackedVector3Array(), PackedVector3Array([Vector3.ZERO, Vector3(NAN, 0, 0)])])
		TYPE_PACKED_FLOAT64_ARRAY:
			return _any([PackedFloat64Array(), PackedFloat64Array([1.0, 0.0]), PackedFloat64Array([NAN])])
		TYPE_OBJECT:
			var fitting := _living(kind if not kind.is_empty() else "Object")
			return _any(fitting) if not fitting.is_empty() and _chance.randi() % 4 != 0 else null
	return null


func _set_something(object: Object) -> String:
	var name := object.get_class()
	var properties := ClassDB.class_get_property_list(name, true).filter(
		func(property: Dictionary) -> bool:
			return property.usage & (PROPERTY_USAGE_STORAGE | PROPERTY_USAGE_EDITOR)
	)
	var property: Dictionary = _any(properties)
	var value: Variant = _value(property.type, property.name, property["class_name"])
	var what := "%s.%s = %s" % [name, property.name, value]
	var before := _ears.heard
	object.set(property.name, value)
	if is_instance_valid(object):
		var now: Variant = object.get(property.name)
		var taken: bool = var_to_str(now) == var_to_str(value)
		if value is float or value is Vector3:
			taken = taken or is_same(now, value) or (now - value) == (now - now) and now == value
			# Some are kept in another unit and come back rounded.
			taken = taken or value is Vector3 and (now as Vector3).is_equal_approx(value)
			taken = taken or value is float and is_equal_approx(now, value)
		if value is String:
			taken = taken or now == (value as String).strip_edges()
		check(taken or _ears.heard > before, "%s was refused without a word, it is %s" % [what, now])
	return what


func _call_something(object: Object) -> String:
	var methods := ClassDB.class_get_method_list(object.get_class(), true).filter(
		func(method: Dictionary) -> bool: return not method.name in NOT_CALLED
	)
	var method: Dictionary = _any(methods)
	var arguments := []
	for argument: Dictionary in method.args:
		arguments.append(_value(argument.type, argument.name, argument["class_name"]))
	object.callv(method.name, arguments)
	return "%s.%s(%s)" % [object.get_class(), method.name, arguments]


func _make_something() -> String:
	if _objects.size() > 60:
		return ""
	var made: Object
	match _chance.randi() % 3:
		0:
			# A start of a world takes longer than a thousand other calls.
			var kind: String = _any(CLASSES)
			var has_room := kind != "HapticWorld" or _living(kind).size() < 3
			made = ClassDB.instantiate(kind if has_room else "HapticPath")
		1:
			made = with_shape(
				_any([StaticBody3D, RigidBody3D, AnimatableBody3D, CharacterBody3D]).new(), sphere(0.1)
			)
		2:
			made = _any([CollisionShape3D, HingeJoint3D, PinJoint3D, Node3D, Camera3D]).new()
	_objects.append(made)
	if made is Node:
		var parent := _node()
		(parent if parent != null and parent != made and parent.is_inside_tree() else self).add_child(made)
	return "made %s" % made.get_class()


func _move_something() -> String:
	var node := _node()
	if node == null:
		return ""
	var what := "moved %s" % node.get_class()
	match _chance.randi() % 6:
		0:
			node.free()
		1:
			node.queue_free()
		2:
			if node.get_parent() != null:
				node.get_parent().remove_child(node)
				add_child(node)
		3:
			var parent := _node()
			if (
				parent != null
				and parent != node
				and not node.is_ancestor_of(parent)
				and node.get_parent() != null
			):
				node.reparent(parent, false)
		4:
			# Godot's own physics complains about such bodies in every frame.
			if node is Node3D and not node is CollisionObject3D:
				(node as Node3D).transform.origin = _value(TYPE_VECTOR3, "", "")
		5:
			if node is Node3D and node.get_class() in CLASSES:
				(node as Node3D).scale = _any([Vector3.ONE, Vector3.ZERO, Vector3(1, 2, 3), -Vector3.ONE])
			elif node is Node3D:
				(node as Node3D).scale = _any([Vector3.ONE, Vector3(1, 2, 3), Vector3.ONE * 1e20])
	return what


func _do_something() -> String:
	_objects = _living()
	var ours := _objects.filter(func(object: Object) -> bool: return object.get_class() in CLASSES)
	var kind := _chance.randi() % 10
	if ours.size() < 12 or kind == 0:
		return _make_something()
	if kind == 1:
		return _move_something()
	return _set_something(_any(ours)) if kind < 6 else _call_something(_any(ours))


## Handlers that answer every signal with something else that makes no sense.
func _answer(object: Object) -> void:
	for info: Dictionary in ClassDB.class_get_signal_list(object.get_class(), true):
		var answer := func() -> void: _do_something()
		object.connect(info.name, answer.unbind(info.args.size()) if not info.args.is_empty() else answer)


func test_ten_thousand_calls() -> void:
	expect_error("")
	OS.add_logger(_ears)
	# It would move bodies that are nowhere, and complain in every step.
	PhysicsServer3D.set_active(false)
	_chance.seed = 20260101
	var answered := {}
	var slowest := 0
	for i in CALLS:
		var before := Time.get_ticks_msec()
		var what := _do_something()
		if Time.get_ticks_msec() - before > slowest:
			slowest = Time.get_ticks_msec() - before
			print("slowest so far: %d ms, call %d: %s" % [slowest, i, what])
		if i % 1000 == 999:
			print("%d calls after %d ms" % [i + 1, Time.get_ticks_msec()])
		if not failure.is_empty():
			break
		for object in _objects:
			if (
				is_instance_valid(object)
				and _chance.randi() % 8 == 0
				and not answered.has(object.get_instance_id())
			):
				answered[object.get_instance_id()] = true
				_answer(object)
		if i % 25 == 24:
			await frames(1)
		check(_ears.script_errors.is_empty(), "%s: %s" % [what, _ears.script_errors])
	for object in _objects:
		if is_instance_valid(object) and object is Node:
			object.free()
	_objects.clear()
	await frames(3)
	PhysicsServer3D.set_active(true)
	OS.remove_logger(_ears)
