extends "nodes_case.gd"
## Shapes and meshes as Godot has them: holes, strips, doubled corners, mirrors.


func _touched_at(world: HapticWorld, x: float, z: float) -> float:
	var found := world.get_nearest_surface(Vector3(x, 0.3, z), 1.0, -1)
	return found.position.y if not found.is_empty() else -INF


func test_a_height_map_with_holes_is_touched_where_it_is() -> void:
	for hole: float in [NAN, INF, -INF, 3.4028234663852886e38]:
		var shape := HeightMapShape3D.new()
		shape.map_width = 9
		shape.map_depth = 9
		var data := PackedFloat32Array()
		data.resize(81)
		data[40] = hole
		shape.map_data = data
		var world := add_world()
		world.gravity = Vector3(0, -9.8, 0)
		world.add_child(with_shape(StaticBody3D.new(), shape))
		for x: float in [0.0, 2.5]:
			var ball := with_shape(RigidBody3D.new(), sphere(0.1), Vector3(x, 0.15, 0)) as RigidBody3D
			ball.name = "Ball%d" % int(x)
			world.add_child(ball)
		world.advance(1.0)
		check_equal(Array(world.get_problems()), [], "problems with a hole of %s" % hole)
		check_near((world.get_node("Ball2") as Node3D).position.y, 0.1, 0.01, "ball on the ground")
		check((world.get_node("Ball0") as Node3D).position.y < -1.0, "the other has not fallen in")
		var deep: Dictionary = world.intersect_ray(Vector3(0.3, 1, 0.3), Vector3(0.3, -1, 0.3), -1)
		check(deep.is_empty(), "the hole of %s is touched" % hole)
		var flat: Dictionary = world.intersect_ray(Vector3(2.3, 1, 0.3), Vector3(2.3, -1, 0.3), -1)
		check(not flat.is_empty(), "the ground beside a hole of %s is not touched" % hole)
		world.advance(0.5)
		world.free()


## A square of a strip, beside points and lines.
func _strip_mesh(also: Array[Mesh.PrimitiveType]) -> ArrayMesh:
	var mesh := ArrayMesh.new()
	for primitive: Mesh.PrimitiveType in also:
		var arrays := []
		arrays.resize(Mesh.ARRAY_MAX)
		arrays[Mesh.ARRAY_VERTEX] = PackedVector3Array([Vector3(9, 0, 0), Vector3(9, 1, 0)])
		mesh.add_surface_from_arrays(primitive, arrays)
	for x: float in [-1.0, 0.0]:
		var arrays := []
		arrays.resize(Mesh.ARRAY_MAX)
		arrays[Mesh.ARRAY_VERTEX] = PackedVector3Array(
			[Vector3(x, 0, 1), Vector3(x, 0, -1), Vector3(x + 1, 0, 1), Vector3(x + 1, 0, -1)]
		)
		mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLE_STRIP, arrays)
	return mesh


func _force_on(mesh: Mesh, materials: Array, x: float, follows := false) -> float:
	var world := add_world()
	var body := StaticBody3D.new()
	body.physics_material_override = material(300.0)
	var touched := HapticMesh.new()
	if follows:
		var drawn := MeshInstance3D.new()
		drawn.name = "Drawn"
		drawn.mesh = mesh
		body.add_child(drawn)
		touched.mesh_instance = NodePath("../Drawn")
	else:
		touched.mesh = mesh
		touched.surface_materials = materials
	body.add_child(touched)
	world.add_child(body)
	var proxy := add_hand(world, path(Vector3(x, 0.05, 0), Vector3(x, 0, 0), 0.1))
	world.advance(0.3)
	check_equal(Array(world.get_problems()), [], "problems")
	var force := proxy.get_force().y
	world.free()
	return force


func test_surfaces_of_strips_points_and_lines_keep_their_materials() -> void:
	var mixed := _strip_mesh([Mesh.PRIMITIVE_POINTS, Mesh.PRIMITIVE_LINES])
	var materials := [null, null, material(900.0), null]
	check_near(_force_on(mixed, materials, -0.5), 9.0, 0.1, "force on the surface with a material of its own")
	check_near(_force_on(mixed, materials, 0.5), 3.0, 0.1, "force on the other")
	check_near(_force_on(_strip_mesh([]), [material(900.0)], -0.5), 9.0, 0.1, "force on a strip alone")
	check_near(_force_on(mixed, [], 0.5, true), 3.0, 0.1, "force on a strip that is followed")


func _held(soft: HapticSoftBody) -> Array[bool]:
	var world := add_world()
	world.gravity = Vector3(0, -9.8, 0)
	var body := StaticBody3D.new()
	body.add_child(soft)
	world.add_child(body)
	world.advance(TICK)
	var before := soft.get_surface()
	world.advance(0.2)
	var after := soft.get_surface()
	var held: Array[bool] = []
	for i in before.size():
		held.append(before[i].distance_to(after[i]) < 1e-6)
	var wrong := 0
	for i in before.size():
		# Held is what is at the end where x is least.
		var is_end := before[i].x < -0.0999
		wrong += 1 if is_end and not held[i] else 0
		wrong += 1 if before[i].x > 0.03 and held[i] else 0
	check(before.size() > 20, "it has %d vertices" % before.size())
	check_equal(wrong, 0, "vertices that are held or not held wrongly, of %d" % before.size())
	world.free()
	return held


func test_held_vertices_are_those_of_the_mesh() -> void:
	var brick := BoxMesh.new()
	brick.size = Vector3(0.2, 0.06, 0.06)
	brick.subdivide_width = 9
	brick.subdivide_height = 2
	brick.subdivide_depth = 2
	var barrel := CylinderMesh.new()
	barrel.top_radius = 0.03
	barrel.bottom_radius = 0.03
	barrel.height = 0.2
	barrel.radial_segments = 12
	barrel.rings = 9
	for mesh: PrimitiveMesh in [brick, barrel]:
		var soft := HapticSoftBody.new()
		soft.cells = 10
		soft.stiffness = 2e4
		var lies := Basis.from_euler(Vector3(0, 0, -0.5 * PI)) if mesh == barrel else Basis.IDENTITY
		var ends := PackedInt32Array()
		var corners: PackedVector3Array = mesh.get_mesh_arrays()[Mesh.ARRAY_VERTEX]
		for i in corners.size():
			if (lies * corners[i]).x < -0.0999:
				ends.append(i)
		soft.mesh = mesh
		soft.basis = lies
		soft.held_vertices = ends
		_held(soft)


func test_what_is_held_stays_the_same_end_under_a_mirror() -> void:
	for mirror: Vector3 in [Vector3(1, 1, 1), Vector3(1, -1, 1), Vector3(-1, 1, 1), Vector3(1, 1, -1)]:
		var world := add_world()
		world.gravity = Vector3(0, -9.8, 0)
		var brick := BoxMesh.new()
		brick.size = Vector3(0.2, 0.06, 0.06)
		var soft := HapticSoftBody.new()
		soft.mesh = brick
		soft.cells = 10
		soft.held = AABB(Vector3(-0.2, -0.1, -0.1), Vector3(0.12, 0.2, 0.2))
		var body := StaticBody3D.new()
		body.scale = mirror
		body.add_child(soft)
		world.add_child(body)
		world.advance(TICK)
		# Seen from the node, the end at low x is held, and the one at high x hangs down.
		var unscaled := Transform3D(Basis(body.global_basis.orthonormalized().get_rotation_quaternion()))
		var mirrored := body.global_transform.affine_inverse() * unscaled
		var before := soft.get_surface()
		world.advance(0.3)
		var after := soft.get_surface()
		var lowest := {-1.0: INF, 1.0: INF}
		for i in before.size():
			var x := (mirrored * before[i]).x
			if absf(x) > 0.095:
				lowest[signf(x)] = minf(lowest[signf(x)], (unscaled * after[i]).y)
		check_near(lowest[-1.0], -0.03, 0.004, "the held end, %s" % mirror)
		check(lowest[1.0] < lowest[-1.0] - 0.002, "the other end does not hang: %s, %s" % [lowest, mirror])
		world.free()


func test_what_a_soft_body_falls_through_is_said() -> void:
	var rough := SphereMesh.new()
	for shape: Shape3D in [HeightMapShape3D.new(), rough.create_trimesh_shape(), rough.create_convex_shape()]:
		var world := add_world()
		world.add_child(with_shape(StaticBody3D.new(), shape, Vector3(0, -1, 0)))
		var body := _sponge(Vector3.ZERO)
		body.name = "Gives"
		var soft: HapticSoftBody = body.get_child(0)
		world.add_child(body)
		world.advance(TICK)
		var problems := "\n".join(world.get_problems())
		check(problems.contains("Gives") and problems.contains("falls through"), "it says: " + problems)
		soft.held = AABB(-Vector3.ONE, Vector3.ONE * 2.0)
		world.advance(TICK)
		check(not "\n".join(world.get_problems()).contains("falls through"), "of one that is held")
		world.free()


func _sponge(at: Vector3) -> StaticBody3D:
	var soft := HapticSoftBody.new()
	var brick := BoxMesh.new()
	brick.size = Vector3.ONE * 0.1
	soft.mesh = brick
	soft.cells = 3
	var body := StaticBody3D.new()
	body.position = at
	body.add_child(soft)
	return body


func test_soft_bodies_that_meet_are_said_and_others_not() -> void:
	for apart: float in [0.12, 0.3]:
		var world := add_world()
		add_floor(world)
		world.add_child(_sponge(Vector3(0, 0.06, 0)))
		world.add_child(_sponge(Vector3(0, 0.06 + apart, 0)))
		world.advance(TICK)
		var is_said := "\n".join(world.get_problems()).contains("falls through")
		check_equal(is_said, apart < 0.2, "said at a distance of %s m" % apart)
		world.free()


## A U: its convex hull is a block.
func _u_mesh() -> ArrayMesh:
	var tool := SurfaceTool.new()
	for place: Vector3 in [Vector3(-0.05, 0, 0), Vector3(0.05, 0, 0), Vector3(0, -0.05, 0)]:
		var brick := BoxMesh.new()
		brick.size = Vector3(0.02, 0.08, 0.02) if place.y == 0.0 else Vector3(0.12, 0.02, 0.02)
		tool.append_from(brick, 0, Transform3D(Basis.IDENTITY, place))
	return tool.commit()


func test_a_moving_body_that_collides_as_its_hull_says_so() -> void:
	var ball := SphereMesh.new()
	for mesh: Mesh in [_u_mesh(), ball]:
		for freeze: bool in [false, true]:
			var world := add_world()
			var body := RigidBody3D.new()
			body.freeze = freeze
			var touched := HapticMesh.new()
			touched.mesh = mesh
			body.add_child(touched)
			world.add_child(body)
			world.advance(TICK)
			var is_said := "\n".join(world.get_problems()).contains("convex hull")
			check_equal(is_said, mesh != ball and not freeze, "said of %s, frozen: %s" % [mesh, freeze])
			world.free()


func _felt_with(image: Texture2D, is_friction: bool, on_surface: bool) -> String:
	var world := add_world()
	var felt := material(500.0)
	felt.set("friction_image" if is_friction else "texture_image", image)
	felt.texture_depth = 1e-4
	var body := with_shape(StaticBody3D.new(), box(Vector3.ONE)) as StaticBody3D
	if on_surface:
		var touched := HapticMesh.new()
		touched.mesh = BoxMesh.new()
		touched.surface_materials = [felt]
		body.add_child(touched)
	else:
		body.physics_material_override = felt
	world.add_child(body)
	world.advance(TICK)
	var problems := "\n".join(world.get_problems())
	world.free()
	return problems


func test_a_texture_without_an_image_is_said() -> void:
	for on_surface: bool in [false, true]:
		for is_friction: bool in [false, true]:
			for without: Texture2D in [PlaceholderTexture2D.new(), AtlasTexture.new()]:
				var problems := _felt_with(without, is_friction, on_surface)
				var name := "friction_image" if is_friction else "texture_image"
				check(problems.contains("'%s'" % name), "of %s it says: %s" % [without, problems])
			var noise := NoiseTexture2D.new()
			noise.noise = FastNoiseLite.new()
			var image := ImageTexture.create_from_image(Image.create_empty(4, 4, false, Image.FORMAT_L8))
			var ramp := GradientTexture2D.new()
			ramp.gradient = Gradient.new()
			for sound: Texture2D in [image, noise, ramp]:
				check_equal(_felt_with(sound, is_friction, on_surface), "", "said of %s" % sound)
