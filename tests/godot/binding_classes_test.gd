extends "binding_case.gd"
## Classes written in C++ as Godot sees them: properties, virtual methods, signals, lifetimes, resources.


func test_properties_say_what_they_are() -> void:
	var node: Node = instance("BindingNode")
	var found := {}
	for property in node.get_property_list():
		found[property["name"]] = property
	check_equal(found["stiffness"]["hint_string"], "0,5000,1,suffix:N/m", "hint of stiffness")
	check_equal(found["stiffness"]["hint"], PROPERTY_HINT_RANGE, "kind of hint")
	check_equal(found["Look"]["usage"], PROPERTY_USAGE_GROUP, "group")
	check_equal(found["Fine"]["usage"], PROPERTY_USAGE_SUBGROUP, "subgroup")
	check_equal(found["look_fine_mode"]["type"], TYPE_INT, "type of the mode")
	check_equal(found["material"]["class_name"], &"PhysicsMaterial", "class of the material")
	check_equal(found["material"]["usage"], PROPERTY_USAGE_NO_EDITOR, "usage changed by _validate_property")
	node.look_fine_mode = 1
	for property in node.get_property_list():
		if property["name"] == "material":
			check_equal(property["usage"], PROPERTY_USAGE_DEFAULT, "usage left by _validate_property")
	node.first_part = 1.5
	node.second_part = 2.5
	check_equal([node.first_part, node.second_part], [1.5, 2.5], "indexed properties")
	check_equal(ClassDB.class_get_property_default_value("BindingNode", "stiffness"), 100.0, "default")
	node.free()


func test_properties_made_by_code() -> void:
	var node: Node = instance("BindingNode")
	check_equal(node.extra, 3, "extra")
	node.extra = 8
	check_equal(node.get("extra"), 8, "extra after set")
	check(node.property_can_revert("extra"), "extra cannot be reverted")
	check_equal(node.property_get_revert("extra"), 3, "what extra reverts to")
	var listed := node.get_property_list().any(func(entry): return entry["name"] == "extra")
	check(listed, "extra is not listed")
	check_equal(node.get("nothing"), null, "a property that does not exist")
	check_equal(str(node), "a binding node", "text of the node")
	node.free()


func test_virtual_methods_are_called() -> void:
	var node: Node = instance("BindingNode")
	check_equal(node.get_notes(), PackedStringArray(["postinitialize"]), "notes before the tree")
	add_child(node)
	await get_tree().physics_frame
	await frames(2)
	check(node.get_seen_delta()[0] > 0.0, "_process was not called")
	check(node.get_seen_delta()[1] > 0.0, "_physics_process was not called")
	get_viewport().push_input(InputEventKey.new())
	check(node.get_notes().has("input InputEventKey"), "_input was not called: %s" % node.get_notes())
	remove_child(node)
	check_equal(
		node.get_notes(),
		PackedStringArray(
			["postinitialize", "parented", "enter_tree", "ready", "input InputEventKey", "exit_tree"]
		),
		"notes"
	)
	node.free()


func test_a_class_derived_from_our_own() -> void:
	var node: Node = instance("BindingDerived")
	check(node.is_class("BindingNode"), "BindingDerived is no BindingNode")
	check_equal(node.own(), 42, "own method")
	node.stiffness = 7.0
	check_equal(node.stiffness, 7.0, "inherited property")
	add_child(node)
	await frames(2)
	check(node.get_seen_delta()[0] > 0.0, "the inherited _process was not called")
	check_equal(
		node.get_notes(),
		PackedStringArray(
			["postinitialize", "parented", "derived parented", "enter_tree", "ready", "derived ready"]
		),
		"notes"
	)


func test_signals_from_cpp() -> void:
	var node: Node = instance("BindingNode")
	var heard := []
	node.stiffness_changed.connect(func(before: float, after: float) -> void: heard.append([before, after]))
	node.stiffness = 250.0
	check_equal(heard, [[100.0, 250.0]], "what was heard")
	var arguments: Array = node.get_signal_list().filter(func(entry): return entry["name"] == "stiffness_changed")[0]["args"]
	check_equal(arguments.map(func(entry): return entry["name"]), ["before", "after"], "argument names")
	node.free()


func test_signals_to_cpp() -> void:
	var node: Node = instance("BindingNode")
	var source := Object.new()
	source.add_user_signal("counted", [{"name": "n", "type": TYPE_INT}, {"name": "s", "type": TYPE_STRING}])
	node.connect_to(source, "counted")
	check(node.is_connected_to(source, "counted"), "not connected")
	source.emit_signal("counted", 5, "apples")
	check(node.get_notes().has("5 apples"), "the signal did not arrive")
	node.disconnect_from(source, "counted")
	check(not node.is_connected_to(source, "counted"), "still connected")
	source.emit_signal("counted", 6, "pears")
	check(not node.get_notes().has("6 pears"), "the signal arrived after disconnect")
	node.connect_to(source, "counted")
	node.free()
	check_equal(source.get_signal_connection_list("counted").size(), 0, "connections of a freed node")
	source.emit_signal("counted", 7, "plums")
	source.free()


func test_an_object_freed_while_referenced() -> void:
	var node: Node = instance("BindingNode")
	var victim := Node.new()
	node.watch(victim)
	check(node.is_watched_alive(), "the watched node is not seen")
	check(node.get_watched() == victim, "the watched node is another one")
	victim.free()
	check(not node.is_watched_alive(), "the freed node still counts as alive")
	var own: Node = instance("BindingNode")
	node.watch(own)
	own.free()
	check(not node.is_watched_alive(), "the freed node of ours still counts as alive")
	node.free()


func test_nodes_are_freed_once() -> void:
	var echo: Object = instance("BindingEcho")
	var before: int = ClassDB.class_call_static("BindingNode", "count_alive")
	for _round in 50:
		var node: Node = instance("BindingNode")
		echo.echo_node(node)
		node.free()
	var queued: Node = instance("BindingDerived")
	add_child(queued)
	queued.queue_free()
	await frames(2)
	check_equal(ClassDB.class_call_static("BindingNode", "count_alive"), before, "living nodes")


func test_references_are_counted() -> void:
	check_equal(typed("references"), PackedStringArray(), "wrong counts")


func test_a_resource_is_saved_and_loaded() -> void:
	var material: Resource = instance("BindingMaterial")
	material.softness = 0.75
	material.friction = 0.25
	material.curve = PackedVector2Array([Vector2(0, 1), Vector2(2, 3)])
	for path in ["user://binding_probe.tres", "user://binding_probe.res"]:
		check_equal(ResourceSaver.save(material, path), OK, "saving")
		var loaded: Resource = ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE)
		check(loaded is PhysicsMaterial, "not a PhysicsMaterial any more")
		check_equal(loaded.get_class(), "BindingMaterial", "class")
		check_equal(loaded.softness, 0.75, "softness")
		check_equal(loaded.friction, 0.25, "friction")
		check_equal(loaded.curve, material.curve, "curve")
	var copy: Resource = material.duplicate()
	check_equal(copy.softness, 0.75, "softness of the copy")
	var body := StaticBody3D.new()
	body.physics_material_override = material
	check(body.physics_material_override == material, "the body has another material")
	body.free()


func test_a_scene_keeps_our_properties() -> void:
	var node: Node = instance("BindingNode")
	node.stiffness = 333.0
	node.material = instance("BindingMaterial")
	node.material.softness = 0.125
	var scene := PackedScene.new()
	check_equal(scene.pack(node), OK, "packing")
	node.free()
	var again: Node = scene.instantiate()
	check_equal(again.stiffness, 333.0, "stiffness")
	check_equal(again.material.softness, 0.125, "softness")
	again.free()


func test_a_virtual_method_answers_with_an_array() -> void:
	var mesh: Mesh = instance("BindingMesh")
	check_equal(
		mesh.get_mesh_arrays()[Mesh.ARRAY_VERTEX],
		PackedVector3Array([Vector3.ZERO, Vector3.RIGHT, Vector3(0, 2, 0)]),
		"vertices"
	)
	check_equal(mesh.get_aabb(), AABB(Vector3.ZERO, Vector3(1, 2, 0)), "box")


func test_scripts_stand_on_our_classes() -> void:
	check_equal(typed("made_by_new"), PackedStringArray(), "failures")


func test_a_wrong_call_of_a_callable_is_an_error() -> void:
	var node: Node = instance("BindingNode")
	var source := Object.new()
	source.add_user_signal("counted", [{"name": "n", "type": TYPE_INT}])
	node.connect_to(source, "counted")
	expect_error("Error calling from signal 'counted' to callable")
	source.emit_signal("counted", 5)
	source.free()
	node.free()
