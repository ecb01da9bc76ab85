extends "nodes_case.gd"
## Beside each path to a node there is a property for scripts that is the node itself.


## Each class with the paths that it has, and the class of the node that each leads to.
func _paths() -> Dictionary[String, Dictionary]:
	var found: Dictionary[String, Dictionary] = {}
	for kind in ClassDB.get_class_list():
		if ClassDB.class_get_api_type(kind) != ClassDB.API_EXTENSION or not ClassDB.can_instantiate(kind):
			continue
		for property in ClassDB.class_get_property_list(kind, true):
			if property.type == TYPE_NODE_PATH and property.hint == PROPERTY_HINT_NODE_PATH_VALID_TYPES:
				found.get_or_add(kind, {})[property.name] = property.hint_string
	return found


func _property(kind: String, name: String) -> Dictionary:
	for property in ClassDB.class_get_property_list(kind, true):
		if property.name == name:
			return property
	return {}


func _instance_of(kinds: String) -> Node:
	var kind := kinds.get_slice(",", 0)
	return RigidBody3D.new() if kind == "PhysicsBody3D" else ClassDB.instantiate(kind)


## Of a property that may be one of several classes, which have this one in common.
func _common_class(kinds: String) -> String:
	return "Node3D" if "," in kinds else kinds


func test_each_path_has_a_node_of_its_class() -> void:
	var paths := _paths()
	check(paths.size() >= 8, "classes with paths: %s" % [paths.keys()])
	for kind in paths:
		for name: String in paths[kind]:
			var what := "%s.%s_node" % [kind, name]
			var property := _property(kind, name + "_node")
			check_equal(property.get("type"), TYPE_OBJECT, "type of " + what)
			check_equal(property.get("hint"), PROPERTY_HINT_NODE_TYPE, "hint of " + what)
			check_equal(property.get("hint_string"), _common_class(paths[kind][name]), "class of " + what)
			check_equal(property.get("usage", 0) & PROPERTY_USAGE_STORAGE, 0, what + " is stored")
			var owner_node: Node = ClassDB.instantiate(kind)
			var above := Node3D.new()
			var target := _instance_of(paths[kind][name])
			target.name = "Target"
			above.add_child(owner_node)
			above.add_child(target)
			check(owner_node.get(name + "_node") == null, what + " has a node by default")
			owner_node.set(name + "_node", target)
			check_equal(owner_node.get(name), NodePath("../Target"), "path of " + what)
			check_equal(owner_node.get(name + "_node"), target, what)
			owner_node.set(name + "_node", null)
			check_equal(owner_node.get(name), NodePath(), "path of none of " + what)
			above.free()


func test_a_node_that_cannot_be_reached_is_refused() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var device: HapticDevice = proxy.device_node
	check_equal(device, world.get_node("Device"), "device by its path")
	var stray := HapticDevice.new()
	expect_error("it must be in the same scene tree")
	proxy.device_node = stray
	expect_error("it must be a HapticDevice, or null")
	proxy.set("device_node", world)
	check_equal(proxy.device_node, device, "the old value stays")
	stray.free()


func test_a_hand_that_is_built_from_nodes_touches() -> void:
	var world := add_world()
	add_floor(world)
	var device := add_device(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.005, 0), 0.2))
	var proxy := ProxyPointer.new()
	world.add_child(proxy)
	proxy.device_node = device
	world.advance(0.3)
	check(proxy.is_touching(), proxy.get_state_text())
	var packed := PackedScene.new()
	proxy.owner = world
	device.owner = world
	packed.pack(world)
	var copy := packed.instantiate()
	check_equal(copy.find_children("*", "ProxyPointer")[0].device, NodePath("../Device"), "the stored path")
	copy.free()
