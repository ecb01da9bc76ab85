extends "binding_case.gd"
## Values of every type on their way between Godot and C++.

var samples: Dictionary = load(sibling("binding_samples.gd")).samples


func test_every_type_comes_back_from_a_call() -> void:
	var echo: Object = instance("BindingEcho")
	samples["callable"] = check
	samples["signal"] = tree_exiting
	for type in samples:
		var back: Variant = echo.call("echo_" + type, samples[type])
		check_equal(back, samples[type], type)
		check_equal(echo.echo_variant(samples[type]), samples[type], type + " in a Variant")
	check_equal(echo.echo_variant(null), null, "null")


func test_every_type_comes_back_from_a_typed_call() -> void:
	check_equal(typed("changed"), PackedStringArray(), "types that changed")


func test_every_type_comes_back_to_cpp() -> void:
	var echo: Object = instance("BindingEcho")
	var changed: PackedStringArray = echo.send_through(func(value: Variant) -> Variant: return value)
	check_equal(changed, PackedStringArray(), "types that changed")


func test_objects_keep_their_identity() -> void:
	var echo: Object = instance("BindingEcho")
	check(echo.echo_object(echo) == echo, "the object is another one")
	check(echo.echo_node(self) == self, "the node is another one")
	check(echo.echo_object(null) == null, "null became an object")
	var box := BoxMesh.new()
	check(echo.echo_resource(box) == box, "the resource is another one")
	check(echo.echo_resource(null) == null, "null became a resource")
	check_equal(box.get_reference_count(), 1, "references")


func test_arrays_keep_their_type() -> void:
	var echo: Object = instance("BindingEcho")
	var numbers: Array[int] = [1, 2]
	check(echo.echo_int_array(numbers).is_typed(), "Array[int] lost its type")
	check_equal(echo.echo_int_array(numbers), numbers, "Array[int]")
	var nodes: Array[Node] = [self]
	check_equal(echo.echo_node_array(nodes), nodes, "Array[Node]")


func test_wrong_arguments_are_refused() -> void:
	expect_error("Cannot convert argument 1 from String to Vector3")
	var result: Variant = instance("BindingEcho").callv("echo_vector3", ["no vector"])
	check_equal(result, null, "result of a refused call")


func test_static_method_and_defaults() -> void:
	var echo: Object = instance("BindingEcho")
	check_equal(echo.join("a", 1, true), "A-1", "join")
	check_equal(echo.join("a", 1), "a-1", "one default")
	check_equal(echo.join("a"), "a-7", "two defaults")


func test_packed_arrays_carry_their_contents() -> void:
	var echo: Object = instance("BindingEcho")
	var points := PackedVector3Array([Vector3.ZERO, Vector3.ONE])
	check_equal(
		echo.moved(points, Vector3.UP), PackedVector3Array([Vector3(0, 1, 0), Vector3(1, 2, 1)]), "moved"
	)
	check_equal(points[0], Vector3.ZERO, "the array that was given")
	check_equal(echo.sum(PackedFloat32Array([0.5, 1.5, 2.0])), 4.0, "sum")


func test_enums_and_constants() -> void:
	check_equal(ClassDB.class_get_enum_list("BindingEcho", true), PackedStringArray(["Flavour"]), "enums")
	check_equal(ClassDB.class_get_integer_constant("BindingEcho", "FLAVOUR_BITTER"), 7, "FLAVOUR_BITTER")
	check_equal(ClassDB.class_get_integer_constant("BindingNode", "NOTIFICATION_READY"), 13, "constant")


func test_calls_from_cpp_into_the_engine() -> void:
	var calls: Node = instance("BindingEngineCalls")
	add_child(calls)
	var unlisted := SpotLight3D.new()
	unlisted.name = "unlisted"
	add_child(unlisted)
	for part in ["values", "objects", "containers", "strings", "math", "utilities"]:
		check_equal(calls.call(part), PackedStringArray(), part)
