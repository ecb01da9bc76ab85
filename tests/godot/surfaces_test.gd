extends "nodes_case.gd"
## Surfaces of a mesh with materials of their own, and images by its texture coordinates, in stepped time.


## A floor of two halves with texture coordinates of ten to the metre, left of x = 0 and right of it.
func _halves(with_uv := true) -> ArrayMesh:
	var mesh := ArrayMesh.new()
	for left: float in [-1.0, 0.0]:
		var corners := PackedVector3Array(
			[
				Vector3(left, 0, -1),
				Vector3(left + 1.0, 0, -1),
				Vector3(left, 0, 1),
				Vector3(left, 0, 1),
				Vector3(left + 1.0, 0, -1),
				Vector3(left + 1.0, 0, 1),
			]
		)
		var arrays := []
		arrays.resize(Mesh.ARRAY_MAX)
		arrays[Mesh.ARRAY_VERTEX] = corners
		if with_uv:
			var places := PackedVector2Array()
			for corner in corners:
				places.append(10.0 * Vector2(corner.x, corner.z))
			arrays[Mesh.ARRAY_TEX_UV] = places
		mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh


func _floor(world: HapticWorld, mesh: Mesh) -> HapticMesh:
	var body := StaticBody3D.new()
	body.physics_material_override = material(500.0)
	var touched := HapticMesh.new()
	touched.mesh = mesh
	body.add_child(touched)
	world.add_child(body)
	return touched


## What a hand feels that is pressed 10 mm deep at x.
func _pressed(world: HapticWorld, x: float, z := 0.3) -> ProxyPointer:
	var device := HapticDevice.new()
	device.name = "DeviceAt%d" % roundi(1000.0 * x)
	device.path = path(Vector3(x, 0.05, z), Vector3(x, 0.0, z), 0.2)
	world.add_child(device)
	var proxy := ProxyPointer.new()
	proxy.radius = 0.01
	world.add_child(proxy)
	proxy.device = proxy.get_path_to(device)
	return proxy


func test_each_surface_feels_as_its_own_material() -> void:
	var world := add_world()
	var touched := _floor(world, _halves())
	touched.surface_materials = [null, material(900.0)]
	var left := _pressed(world, -0.5)
	var right := _pressed(world, 0.5)
	world.advance(0.5)
	check_near(left.get_force().y, 5.0, 1e-2, "the body's own material")
	check_near(right.get_force().y, 9.0, 1e-2, "that of the second surface")
	check_equal(touched.get_problems().size(), 0, "warnings")


func test_a_surface_takes_over_what_changes_while_running() -> void:
	var world := add_world()
	var touched := _floor(world, _halves())
	var own := material(900.0)
	touched.surface_materials = [null, own]
	var right := _pressed(world, 0.5)
	world.advance(0.5)
	own.stiffness = 700.0
	world.advance(0.2)
	check_near(right.get_force().y, 7.0, 1e-2, "after its stiffness changed")
	touched.surface_materials = [own]
	world.advance(0.2)
	check_near(right.get_force().y, 5.0, 1e-2, "after it was taken away")


func test_an_image_lies_by_the_texture_coordinates() -> void:
	var world := add_world()
	var touched := _floor(world, _halves())
	var look := material(500.0)
	# Four pixels of 25 mm along x: the second is raised.
	look.texture_image = image_of(4, 1, func(x: int, _y: int) -> float: return 1.0 if x == 1 else 0.0)
	look.texture_depth = 0.002
	look.texture_mapping = HapticMaterial.TEXTURE_MAPPING_UV
	(touched.get_parent() as StaticBody3D).physics_material_override = look
	var raised := _pressed(world, 0.125)
	var level := _pressed(world, 0.175)
	world.advance(0.5)
	check_near(raised.get_force().y, 500.0 * 0.012, 2e-2, "on the raised pixel")
	check_near(level.get_force().y, 5.0, 2e-2, "beside it")
	# Without texture coordinates it lies in the frame, 0.05 m to a repetition.
	touched.mesh = _halves(false)
	world.advance(0.5)
	check_near(raised.get_force().y, 5.0, 2e-2, "where the mesh has none")


func test_a_friction_image_makes_a_surface_slippery() -> void:
	var world := add_world()
	var touched := _floor(world, _halves())
	var look := material(500.0)
	look.static_friction = 0.8
	look.dynamic_friction = 0.8
	look.friction_image = image_of(1, 1, func(_x: int, _y: int) -> float: return 0.25)
	touched.surface_materials = [look]
	var way := path(Vector3.ZERO, Vector3.ZERO)
	way.points_positions = PackedVector3Array(
		[Vector3(-0.6, 0.05, 0), Vector3(-0.6, 0, 0), Vector3(-0.2, 0, 0)]
	)
	way.points_times = PackedFloat64Array([0.0, 0.2, 1.2])
	var proxy := add_hand(world, way)
	world.advance(1.0)
	check_near(proxy.get_force().x, -0.25 * 0.8 * 5.0, 2e-2, "a quarter of the friction")


## Of a body without a material, and of a new material.
func test_no_surface_is_ice_until_it_is_asked_to_be() -> void:
	for look: HapticMaterial in [null, HapticMaterial.new()]:
		var world := add_world()
		add_floor(world).physics_material_override = look
		var way := path(Vector3.ZERO, Vector3.ZERO)
		way.points_positions = PackedVector3Array([Vector3(0, 0.05, 0), Vector3.ZERO, Vector3(0.4, 0, 0)])
		way.points_times = PackedFloat64Array([0.0, 0.2, 1.2])
		var proxy := add_hand(world, way)
		world.advance(1.0)
		var force := proxy.get_force()
		check_near(-force.x / force.y, 0.3, 0.01, "friction of %s while it slides" % look)


func test_what_cannot_be_felt_is_said() -> void:
	var touched := HapticMesh.new()
	touched.mesh = _halves(false)
	touched.surface_materials = [material(500.0), material(500.0), material(500.0)]
	check(_says(touched, "more than 'mesh' has surfaces"), "too many surfaces")
	var look := material(500.0)
	look.texture_depth = 0.001
	look.texture_mapping = HapticMaterial.TEXTURE_MAPPING_UV
	touched.surface_materials = [look]
	check(_says(touched, "no texture coordinates"), "no texture coordinates")
	touched.mesh = _halves()
	check(not _says(touched, "surface_materials"), "nothing is wrong any more")
	touched.free()


func _says(node: HapticMesh, text: String) -> bool:
	return Array(node.get_problems()).any(func(warning: String) -> bool: return text in warning)
