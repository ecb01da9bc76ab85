extends "nodes_case.gd"
## Scenes with the former names of CHANGELOG.md load, and each name is warned of once.

const FOLDER := "user://renames_test"
## What a number of now is multiplied by under its former name.
const FORMER_UNITS := {
	"HapticDepthSensor.synthetic_error_percent": 100.0,
	"HapticDepthSensor.camera_delay": 1000.0,
	"HapticEffect.budget_ms": 1000.0
}


class Ears:
	extends Logger
	var said := PackedStringArray()

	func _log_error(
		_function: String,
		_file: String,
		_line: int,
		code: String,
		rationale: String,
		_editor_notify: bool,
		_type: int,
		_backtraces: Array[ScriptBacktrace]
	) -> void:
		said.append(rationale if not rationale.is_empty() else code)


## Every former name of a class or property, with the new one; `table`: of another kind.
func _renames(table := "Former name") -> Dictionary[String, String]:
	var here: String = (get_script() as Script).resource_path.get_base_dir()
	var text := FileAccess.get_file_as_string(here.path_join("../../CHANGELOG.md"))
	text = text.get_slice("| %s | Now |" % table, 1).get_slice("\n\n", 0)
	var found: Dictionary[String, String] = {}
	for row in RegEx.create_from_string("(?m)^\\| `([\\w.]+)` \\| `([\\w.]+)` \\|$").search_all(text):
		found[row.get_string(1)] = row.get_string(2)
	return found


func _former_classes() -> Dictionary[String, String]:
	var all := _renames()
	var found: Dictionary[String, String] = {}
	for old in all:
		if not "." in old:
			found[old] = all[old]
	return found


func _stored(kind: String) -> PackedStringArray:
	var names := PackedStringArray()
	for property in ClassDB.class_get_property_list(kind, true):
		if property.usage & PROPERTY_USAGE_STORAGE:
			names.append(property.name)
	return names


## Each number and switch of the class has another value than by default.
func _changed(object: Object) -> Object:
	var kind := object.get_class()
	for property in ClassDB.class_get_property_list(kind, true):
		if not property.usage & PROPERTY_USAGE_STORAGE:
			continue
		var before: Variant = object.get(property.name)
		if property.hint == PROPERTY_HINT_ENUM and property.type == TYPE_INT:
			var entries: PackedStringArray = property.hint_string.split(",")
			var last := int(entries[-1].get_slice(":", 1))
			object.set(property.name, last if last != before else int(entries[0].get_slice(":", 1)))
		elif property.type == TYPE_BOOL:
			object.set(property.name, not before)
		elif property.type == TYPE_INT or property.type == TYPE_FLOAT:
			var ends: PackedStringArray = property.hint_string.split(",")
			var within := (float(ends[0]) + 3.0 * float(ends[1])) / 4.0
			within = deg_to_rad(within) if "radians_as_degrees" in ends else within
			object.set(property.name, roundi(within) if property.type == TYPE_INT else within)
		if property.type in [TYPE_BOOL, TYPE_INT, TYPE_FLOAT]:
			check(object.get(property.name) != before, "%s.%s did not change" % [kind, property.name])
	return object


func _loaded(text: String, file: String) -> Node:
	DirAccess.make_dir_recursive_absolute(FOLDER)
	var to := FOLDER.path_join(file + ".tscn")
	FileAccess.open(to, FileAccess.WRITE).store_string(text)
	var packed := ResourceLoader.load(to, "", ResourceLoader.CACHE_MODE_IGNORE) as PackedScene
	return packed.instantiate()


func _check_same(found: Object, expected: Object) -> void:
	var kind := expected.get_class()
	check(found.is_class(kind), "it is %s, not %s" % [found.get_class(), kind])
	for name in _stored(kind):
		var now: Variant = found.get(name)
		if now is Object:
			check(now.is_class(expected.get(name).get_class()), "%s.%s is %s" % [kind, name, now])
		elif _renames().find_key("%s.%s" % [kind, name]) in FORMER_UNITS:
			check(is_equal_approx(now, expected.get(name)), "%s.%s is %s" % [kind, name, now])
		else:
			check_equal(now, expected.get(name), "%s.%s" % [kind, name])


## All that has a former name, under its new one.
func _new_scene() -> Node3D:
	var root := Node3D.new()
	for kind: String in [
		"HapticDepthSensor", "HapticVibrationSound", "HapticMesh", "HapticWorld", "HapticEffect", "MMTLink"
	]:
		var node: Node = _changed(ClassDB.instantiate(kind))
		node.name = kind
		root.add_child(node)
		node.owner = root
	root.get_node("HapticMesh").volume = _changed(HapticVolume.new())
	root.get_node("MMTLink").conditions = _changed(MMTNetworkConditions.new())
	root.get_node("MMTLink").tuning = _changed(MMTTuning.new())
	return root


func _text_of(scene: Node) -> String:
	var packed := PackedScene.new()
	packed.pack(scene)
	DirAccess.make_dir_recursive_absolute(FOLDER)
	ResourceSaver.save(packed, FOLDER.path_join("new.tscn"))
	return FileAccess.get_file_as_string(FOLDER.path_join("new.tscn"))


func _with_former_names(text: String) -> String:
	var renames := _renames()
	for old in renames:
		var now := renames[old]
		if not "." in old:
			text = text.replace('type="%s"' % now, 'type="%s"' % old)
		elif old.get_slice(".", 0) == now.get_slice(".", 0):
			var line := RegEx.create_from_string("(?m)^%s = (.*)$" % now.get_slice(".", 1))
			check_equal(line.search_all(text).size(), 1, "lines of %s" % now)
			var value := line.search(text).get_string(1)
			value = var_to_str(FORMER_UNITS[old] * float(value)) if old in FORMER_UNITS else value
			text = line.sub(text, "%s = %s" % [old.get_slice(".", 1), value])
	return text


func _with_the_links_former_properties(expected: Node) -> String:
	var link: MMTLink = expected.get_node("MMTLink")
	var text := '[gd_scene format=3]\n\n[node name="Link" type="MMTLink"]\n'
	var renames := _renames()
	for old in renames:
		if old.begins_with("MMTLink."):
			var of: Resource = link.tuning if renames[old].begins_with("MMTTuning.") else link.conditions
			text += "%s = %s\n" % [old.get_slice(".", 1), var_to_str(of.get(renames[old].get_slice(".", 1)))]
	return text


func test_every_former_name_loads_and_warns_once() -> void:
	var made := _new_scene()
	# Numbers as they are in a text.
	var expected := _loaded(_text_of(made), "expected")
	made.free()
	expect_error(" now. The old name still works")
	var ears := Ears.new()
	OS.add_logger(ears)
	for file: String in ["first", "second"]:
		var old := _loaded(_with_former_names(_text_of(expected)), file)
		for node in expected.get_children():
			_check_same(old.get_node(NodePath(node.name)), node)
		_check_same(old.get_node("HapticMesh").volume, expected.get_node("HapticMesh").volume)
		_check_same(old.get_node("MMTLink").conditions, expected.get_node("MMTLink").conditions)
		_check_same(old.get_node("MMTLink").tuning, expected.get_node("MMTLink").tuning)
		old.free()
		var link := _loaded(_with_the_links_former_properties(expected), file) as MMTLink
		_check_same(link.conditions, expected.get_node("MMTLink").conditions)
		for name in _stored("MMTTuning"):
			if _renames().values().has("MMTTuning." + name) and name != "stealth_release_time":
				check_equal(link.tuning.get(name), expected.get_node("MMTLink").tuning.get(name), name)
		link.free()
	OS.remove_logger(ears)
	expected.free()
	var renames := _renames()
	check_equal(ears.said.size(), renames.size(), "messages: %s" % ears.said)
	for old in renames:
		var now := renames[old]
		if old.begins_with("MMTLink."):
			now = now.replace("MMTTuning.", "tuning.").replace("MMTNetworkConditions.", "conditions.")
		var is_said := func(text: String) -> bool: return text.begins_with("%s is %s now." % [old, now])
		check(Array(ears.said).any(is_said), "of %s there is no message: %s" % [old, ears.said])


## Methods and constants, and properties that are read only.
func test_every_former_method_and_constant_works_and_warns_once() -> void:
	expect_error(" now. The old name still works")
	var ears := Ears.new()
	OS.add_logger(ears)
	var former := _renames("Former method, constant or read-only property")
	var warned := PackedStringArray()
	for _round in 2:
		for old in former:
			var kind := old.get_slice(".", 0)
			var name := old.get_slice(".", 1)
			var now := former[old].get_slice(".", 1)
			check_equal(former[old].get_slice(".", 0), kind, "class of " + former[old])
			if ClassDB.class_has_integer_constant(kind, now):
				var value := ClassDB.class_get_integer_constant(kind, now)
				check_equal(ClassDB.class_get_integer_constant(kind, name), value, old)
				continue
			var object: Object = ClassDB.instantiate(kind)
			var is_method := object.has_method(name)
			check(is_method == object.has_method(now), now + " is missing")
			var before: Variant = object.call(name) if is_method else object.get(name)
			var after: Variant = object.call(now) if is_method else object.get(now)
			if before is String:
				# What is wrong with a node beside it is in the list as well.
				var is_same: bool = before.is_empty() or "\n".join(after).contains(before)
				check(is_same, "%s is '%s', and now '%s'" % [old, before, after])
			else:
				check_equal(before, after, old)
			warned.append("%s is %s now." % [old, former[old]])
			if object is Node:
				object.free()
	OS.remove_logger(ears)
	for said in warned:
		var heard := Array(ears.said).filter(func(text: String) -> bool: return text.begins_with(said))
		check_equal(heard.size(), 1, "messages '%s'" % said)
	check(former.size() > 20 and warned.size() > 30, "former names: %s" % [former.keys()])


func test_a_former_class_has_only_a_name() -> void:
	for old in _former_classes():
		var kind := _former_classes()[old]
		check(ClassDB.class_exists(old) and ClassDB.is_parent_class(old, kind), old)
		check_equal(ClassDB.class_get_property_list(old, true).size(), 0, "properties of %s alone" % old)
