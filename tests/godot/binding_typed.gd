extends SceneTree
## Calls that GDScript makes without Variants because it knows the types: the other way into every C++ method.
## Run by binding_types_test.gd and binding_classes_test.gd; prints one line of findings.


func _initialize() -> void:
	var samples: Dictionary = (
		load(get_script().resource_path.get_base_dir().path_join("binding_samples.gd")).samples
	)
	var findings := {"changed": changed(samples), "references": reference_failures()}
	await process_frame
	findings["made_by_new"] = made_by_new()
	print("FINDINGS ", var_to_str(findings).replace("\n", " "))
	quit()


## The types whose value came back changed.
func changed(samples: Dictionary) -> PackedStringArray:
	var result := PackedStringArray()
	var echo := BindingEcho.new()
	var back := {
		"bool": bool_back(echo, samples["bool"]),
		"int": int_back(echo, samples["int"]),
		"float": float_back(echo, samples["float"]),
	}
	if BindingEcho.join("b") != "b-7":
		result.append("defaults of a static method")
	var flavour: BindingEcho.Flavour = BindingEcho.FLAVOUR_BITTER
	if echo.echo_enum(flavour) != 7:
		result.append("enum")
	var s: String = samples["string"]
	back["string"] = echo.echo_string(s)
	var n: StringName = samples["string_name"]
	back["string_name"] = echo.echo_string_name(n)
	var p: NodePath = samples["node_path"]
	back["node_path"] = echo.echo_node_path(p)
	var c := Callable(self, "quit")
	if echo.echo_callable(c) != c:
		result.append("callable")
	var i := process_frame
	if echo.echo_signal(i) != i:
		result.append("signal")
	var d: Dictionary = samples["dictionary"]
	back["dictionary"] = echo.echo_dictionary(d)
	var a: Array = samples["array"]
	back["array"] = echo.echo_array(a)
	back.merge(math_back(echo, samples))
	back.merge(packed_back(echo, samples))
	for type in back:
		if typeof(back[type]) != typeof(samples[type]) or back[type] != samples[type]:
			result.append(type)
	return result


func bool_back(echo: BindingEcho, value: bool) -> bool:
	return echo.echo_bool(value)


func int_back(echo: BindingEcho, value: int) -> int:
	return echo.echo_int(value)


func float_back(echo: BindingEcho, value: float) -> float:
	return echo.echo_float(value)


func math_back(echo: BindingEcho, samples: Dictionary) -> Dictionary:
	var v2: Vector2 = samples["vector2"]
	var v2i: Vector2i = samples["vector2i"]
	var r: Rect2 = samples["rect2"]
	var ri: Rect2i = samples["rect2i"]
	var v3: Vector3 = samples["vector3"]
	var v3i: Vector3i = samples["vector3i"]
	var t2: Transform2D = samples["transform2d"]
	var v4: Vector4 = samples["vector4"]
	var v4i: Vector4i = samples["vector4i"]
	var plane: Plane = samples["plane"]
	var q: Quaternion = samples["quaternion"]
	var box: AABB = samples["aabb"]
	var b: Basis = samples["basis"]
	var t3: Transform3D = samples["transform3d"]
	var projection: Projection = samples["projection"]
	var color: Color = samples["color"]
	return {
		"vector2": echo.echo_vector2(v2),
		"vector2i": echo.echo_vector2i(v2i),
		"rect2": echo.echo_rect2(r),
		"rect2i": echo.echo_rect2i(ri),
		"vector3": echo.echo_vector3(v3),
		"vector3i": echo.echo_vector3i(v3i),
		"transform2d": echo.echo_transform2d(t2),
		"vector4": echo.echo_vector4(v4),
		"vector4i": echo.echo_vector4i(v4i),
		"plane": echo.echo_plane(plane),
		"quaternion": echo.echo_quaternion(q),
		"aabb": echo.echo_aabb(box),
		"basis": echo.echo_basis(b),
		"transform3d": echo.echo_transform3d(t3),
		"projection": echo.echo_projection(projection),
		"color": echo.echo_color(color),
	}


func packed_back(echo: BindingEcho, samples: Dictionary) -> Dictionary:
	var bytes: PackedByteArray = samples["packed_byte_array"]
	var int32: PackedInt32Array = samples["packed_int32_array"]
	var int64: PackedInt64Array = samples["packed_int64_array"]
	var float32: PackedFloat32Array = samples["packed_float32_array"]
	var float64: PackedFloat64Array = samples["packed_float64_array"]
	var strings: PackedStringArray = samples["packed_string_array"]
	var v2: PackedVector2Array = samples["packed_vector2_array"]
	var v3: PackedVector3Array = samples["packed_vector3_array"]
	var colors: PackedColorArray = samples["packed_color_array"]
	var v4: PackedVector4Array = samples["packed_vector4_array"]
	return {
		"packed_byte_array": echo.echo_packed_byte_array(bytes),
		"packed_int32_array": echo.echo_packed_int32_array(int32),
		"packed_int64_array": echo.echo_packed_int64_array(int64),
		"packed_float32_array": echo.echo_packed_float32_array(float32),
		"packed_float64_array": echo.echo_packed_float64_array(float64),
		"packed_string_array": echo.echo_packed_string_array(strings),
		"packed_vector2_array": echo.echo_packed_vector2_array(v2),
		"packed_vector3_array": echo.echo_packed_vector3_array(v3),
		"packed_color_array": echo.echo_packed_color_array(colors),
		"packed_vector4_array": echo.echo_packed_vector4_array(v4),
	}


## What is wrong with the reference counts, through typed and untyped calls.
func reference_failures() -> PackedStringArray:
	var before := BindingMaterial.count_alive()
	var failures := use_materials()
	if BindingMaterial.count_alive() != before:
		failures.append("left over: %d" % (BindingMaterial.count_alive() - before))
	return failures


func use_materials() -> PackedStringArray:
	var failures := PackedStringArray()
	var before := BindingMaterial.count_alive()
	var echo := BindingEcho.new()
	var material := BindingMaterial.new()
	# The stack of this function may hold one more.
	var references := material.get_reference_count()
	if BindingMaterial.references_gained(material) != 0:
		failures.append("used in C++: %d" % material.get_reference_count())
	for _round in 20:
		var back := echo.echo_resource(material)
		if back != material:
			failures.append("echo gave another one")
		echo.call("echo_resource", material)
		echo.call("echo_object", material)
		echo.echo_variant(material)
		back = null
	if material.get_reference_count() != references:
		failures.append("echoed: %d, not %d" % [material.get_reference_count(), references])
	var made := BindingMaterial.make(0.25)
	if made.softness != 0.25 or BindingMaterial.count_alive() != before + 2:
		failures.append("alive: %d more" % (BindingMaterial.count_alive() - before))
	return failures


class Scripted:
	extends BindingNode
	var seen := 0

	func _ready() -> void:
		seen += 1


## Objects made by new(), and a script on top of a class of ours.
func made_by_new() -> PackedStringArray:
	var failures := PackedStringArray()
	var node := BindingNode.new()
	node.stiffness = 5.0
	if node.stiffness != 5.0:
		failures.append("property of an object made by new")
	node.free()
	var scripted := Scripted.new()
	root.add_child(scripted)
	if scripted.seen != 1:
		failures.append("_ready of the script")
	if not scripted.get_notes().has("enter_tree"):
		failures.append("_enter_tree of the class below the script")
	scripted.free()
	return failures
