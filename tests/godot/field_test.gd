extends "nodes_case.gd"
## Volumes of samples are touched where they have their iso-value, in stepped time.

const SIDE := 0.2


func _filled(samples: int, value: Callable) -> HapticVolume:
	var field := HapticVolume.new()
	var step := SIDE / (samples - 1)
	var values := PackedFloat32Array()
	for z in samples:
		for y in samples:
			for x in samples:
				values.append(value.call(Vector3(x, y, z) * step - Vector3.ONE * 0.5 * SIDE))
	field.size = Vector3i.ONE * samples
	field.voxel_size = Vector3.ONE * step
	field.values = values
	return field


func _ball(radius: float) -> HapticVolume:
	return _filled(24, func(p: Vector3) -> float: return p.length() - radius)


func _body_of(field: HapticVolume, body: CollisionObject3D = StaticBody3D.new()) -> CollisionObject3D:
	var touched := HapticMesh.new()
	touched.name = "Touched"
	touched.volume = field
	body.add_child(touched)
	return body


func test_a_field_is_touched_where_its_surface_is() -> void:
	var world := add_world()
	world.add_child(_body_of(_ball(0.08)))
	var proxy := add_hand(world, path(Vector3(0, 0.2, 0), Vector3(0, 0.085, 0)))
	world.advance(1.2)
	check_near(proxy.get_proxy_position(), Vector3(0, 0.09, 0), 1e-3, "proxy")
	check(proxy.is_touching(), "nothing is touched")
	check_equal(world.get_problems().size(), 0, "problems")


func test_slices_of_densities_are_touched_as_they_look() -> void:
	var field := HapticVolume.new()
	var slices: Array[Image] = []
	for z in 12:
		var slice := Image.create_empty(10, 11, false, Image.FORMAT_L8)
		# Solid up to between the rows 6 and 7.
		slice.fill_rect(Rect2i(0, 0, 10, 7), Color.WHITE)
		slices.append(slice)
	field.slices = slices
	field.voxel_size = Vector3(0.02, 0.01, 0.02)
	field.iso_value = 0.25
	field.solid_above = true
	check_equal(Array(field.get_problems()), [], "problems")
	var world := add_world()
	world.add_child(_body_of(field))
	var proxy := add_hand(world, path(Vector3(0, 0.2, 0), Vector3(0, 0.02, 0)))
	world.advance(1.2)
	# Rows are 10 mm apart, the middle one at 0; a quarter of the way from white to black.
	check_near(proxy.get_proxy_position(), Vector3(0, 0.01 + 0.0075 + 0.01, 0), 1e-6, "proxy")
	check(field.create_mesh().get_faces().size() > 0, "there is nothing to look at")


func test_a_field_that_moves_is_pushed() -> void:
	var world := add_world()
	var body := _body_of(_ball(0.05), RigidBody3D.new()) as RigidBody3D
	body.mass = 0.2
	world.add_child(body)
	add_hand(world, path(Vector3(-0.2, 0, 0), Vector3(0.1, 0, 0)))
	for _i in 90:
		world.advance(1.0 / 60.0)
	check(body.global_position.x > 0.1, "it was not pushed: %s" % body.global_position)


func test_a_field_that_changes_is_touched_anew() -> void:
	var field := _ball(0.05)
	var world := add_world()
	world.add_child(_body_of(field))
	var proxy := add_hand(world, path(Vector3(0, 0.2, 0), Vector3(0, 0.095, 0)))
	world.advance(1.2)
	check_near(proxy.get_proxy_position(), Vector3(0, 0.095, 0), 1e-5, "free")
	field.iso_value = 0.03
	world.advance(0.2)
	check(not proxy.is_touching(), "it is touched before the hand is there")
	proxy.get_node(proxy.device).path = path(Vector3(0, 0.2, 0), Vector3(0, 0.085, 0))
	world.advance(2.0)
	check_near(proxy.get_proxy_position(), Vector3(0, 0.09, 0), 1e-3, "proxy")


func test_what_is_no_field_is_said() -> void:
	for case: Array in [
		[func(f: HapticVolume) -> void: f.size = Vector3i.ZERO, "two samples along an axis"],
		[func(f: HapticVolume) -> void: f.size = Vector3i(24, 24, 23), "its size asks for"],
		[func(f: HapticVolume) -> void: f.voxel_size = Vector3(0.01, 0, 0.01), "not a positive length"],
		[func(f: HapticVolume) -> void: f.iso_value = 9.0, "one side of the iso-value"],
		[func(f: HapticVolume) -> void: f.values = PackedFloat32Array([1.0, NAN]), "has 2 values"]
	]:
		var field := _ball(0.08)
		case[0].call(field)
		check(
			"\n".join(field.get_problems()).contains(case[1]),
			"'%s' says '%s'" % [case[1], field.get_problems()]
		)
		check_equal(field.create_mesh().get_surface_count(), 0, "surfaces to look at")


func test_slices_of_different_sizes_are_said() -> void:
	var field := HapticVolume.new()
	field.slices = [
		Image.create_empty(4, 4, false, Image.FORMAT_L8), Image.create_empty(4, 5, false, Image.FORMAT_L8)
	]
	check(
		"\n".join(field.get_problems()).contains("has 16 values, and its size asks for 32"),
		str(field.get_problems())
	)
	field.slices = [null, null]
	check("\n".join(field.get_problems()).contains("two samples along an axis"), str(field.get_problems()))


## On its path the hand feels its way over one volume and pushes the other.
func test_the_scene_of_fields_plays() -> void:
	var scene := add_scene("res://gallery/field/field.tscn")
	var world: HapticWorld = scene.get_node("HapticWorld")
	var proxy: ProxyPointer = world.get_node("ProxyPointer")
	var lump: RigidBody3D = world.get_node("Lump")
	var before := lump.global_position
	var touched := {}
	proxy.contact_started.connect(func(body: Node3D) -> void: touched[body.name] = true)
	for _i in roundi(12.0 * 60.0):
		world.advance(1.0 / 60.0)
	check(touched.has(&"Maze") and touched.has(&"Lump"), "touched were %s" % [touched.keys()])
	check(lump.global_position.distance_to(before) > 0.02, "the lump was not pushed")
	check_equal(world.get_problems().size(), 0, "problems: %s" % world.get_problems())
	scene.free()
