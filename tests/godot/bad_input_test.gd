extends "nodes_case.gd"
## What cannot be touched is named once, with what to do, and the rest of the scene goes on.


## A world with one body that is as it should be and one that is not; says what the world says of the latter.
func _problem_beside_a_sound_floor(bad: CollisionObject3D, expected: String) -> void:
	var world := add_world()
	add_floor(world, 500.0)
	bad.name = "Bad"
	bad.position += Vector3(5, 0, 0)
	world.add_child(bad)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1))
	expect_error(expected)
	world.advance(0.3)
	world.advance(0.1)
	check_near(proxy.get_force().y, 10.0, 1e-3, "force on the sound floor")
	check_equal(world.get_problems().size(), 1, "problems %s" % [world.get_problems()])
	if not world.get_problems().is_empty():
		check(
			world.get_problems()[0].contains("Bad") and world.get_problems()[0].contains(expected),
			world.get_problems()[0]
		)
	check(" ".join(world._list_warnings()).contains("'Bad'"), "no configuration warning names it")


func _with_mesh(mesh: Mesh, library_mesh := "") -> StaticBody3D:
	var body := StaticBody3D.new()
	var touched := HapticMesh.new()
	touched.mesh = mesh
	touched.library_mesh = library_mesh
	body.add_child(touched)
	return body


func _mesh_of(vertices: PackedVector3Array) -> ArrayMesh:
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = vertices
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh


func test_a_mesh_without_triangles() -> void:
	_problem_beside_a_sound_floor(_with_mesh(ArrayMesh.new()), "the mesh has no triangles")


func test_a_mesh_with_nan_vertices() -> void:
	var mesh := _mesh_of(PackedVector3Array([Vector3.ZERO, Vector3(NAN, 0, 0), Vector3(0, 1, 0)]))
	_problem_beside_a_sound_floor(_with_mesh(mesh), "is not a finite number")


func test_a_mesh_without_area() -> void:
	var mesh := _mesh_of(PackedVector3Array([Vector3.ZERO, Vector3(1, 0, 0), Vector3(2, 0, 0)]))
	_problem_beside_a_sound_floor(_with_mesh(mesh), "no triangle of the mesh has an area")


func test_a_mesh_that_is_not_in_the_library() -> void:
	_problem_beside_a_sound_floor(_with_mesh(null, "nowhere"), "no mesh 'nowhere': choose one of blob")


func test_a_name_that_leads_out_of_the_library() -> void:
	_problem_beside_a_sound_floor(_with_mesh(null, "../../../project"), "no mesh '../../../project'")


func _with_field(values: PackedFloat32Array, size: Vector3i) -> StaticBody3D:
	var body := _with_mesh(null)
	var field := HapticVolume.new()
	field.values = values
	field.size = size
	(body.get_child(0) as HapticMesh).volume = field
	return body


func test_a_field_of_nothing() -> void:
	_problem_beside_a_sound_floor(_with_field(PackedFloat32Array(), Vector3i.ZERO), "fewer than two samples")


func test_a_field_with_nan() -> void:
	var values := PackedFloat32Array([-1, 1, 1, 1, 1, NAN, 1, 1])
	_problem_beside_a_sound_floor(_with_field(values, Vector3i(2, 2, 2)), "value 5 of the field is not")


func test_a_field_without_a_surface() -> void:
	var values := PackedFloat32Array([2, 1, 1, 1, 1, 1, 1, 1])
	_problem_beside_a_sound_floor(_with_field(values, Vector3i(2, 2, 2)), "one side of the iso-value 0")


func test_a_haptic_mesh_without_a_mesh() -> void:
	_problem_beside_a_sound_floor(_with_mesh(null), "it has no mesh")


func test_a_mesh_scaled_to_zero() -> void:
	var body := _with_mesh(null, "cube")
	body.get_child(0).scale = Vector3(1, 0, 1)
	_problem_beside_a_sound_floor(body, "scaled to zero")


func test_a_body_without_a_shape() -> void:
	_problem_beside_a_sound_floor(
		StaticBody3D.new(), "it has no shape: give it a CollisionShape3D or a HapticMesh"
	)


func test_a_rigid_body_without_a_shape() -> void:
	_problem_beside_a_sound_floor(RigidBody3D.new(), "it has no shape")


func test_a_concave_shape_without_triangles() -> void:
	_problem_beside_a_sound_floor(with_shape(StaticBody3D.new(), ConcavePolygonShape3D.new()), "no triangles")


func test_a_convex_shape_without_volume() -> void:
	var flat := ConvexPolygonShape3D.new()
	flat.points = PackedVector3Array([Vector3.ZERO, Vector3(1, 0, 0), Vector3(0, 0, 1), Vector3(1, 0, 1)])
	_problem_beside_a_sound_floor(with_shape(StaticBody3D.new(), flat), "convex shape has no volume")


func test_a_sphere_scaled_unevenly() -> void:
	var body := with_shape(StaticBody3D.new(), sphere(0.1))
	body.get_child(0).scale = Vector3(1, 2, 1)
	_problem_beside_a_sound_floor(body, "scale it evenly")


func test_a_sphere_without_a_radius() -> void:
	_problem_beside_a_sound_floor(
		with_shape(StaticBody3D.new(), sphere(0.0)), "radius is not a positive length"
	)


func test_a_shape_that_is_no_surface() -> void:
	_problem_beside_a_sound_floor(
		with_shape(StaticBody3D.new(), SeparationRayShape3D.new()), "cannot be touched"
	)


func test_a_proxy_whose_scene_gives_it_a_negative_radius() -> void:
	var packed := PackedScene.new()
	var drawn := ProxyPointer.new()
	drawn.name = "Finger"
	packed.pack(drawn)
	drawn.free()
	var bundle: Dictionary = packed._bundled
	bundle.names.append("radius")
	bundle.variants.append(-0.01)
	# A node's part of the bundle: parent, owner, type, name, instance, properties, … groups.
	var nodes: PackedInt32Array = bundle.nodes
	check_equal(nodes[5], 0, "properties of the drawn node")
	nodes[5] = 1
	nodes.insert(6, bundle.names.size() - 1)
	nodes.insert(7, bundle.variants.size() - 1)
	bundle.nodes = nodes
	packed._bundled = bundle
	expect_error("radius = -0.01 was refused")
	var proxy: ProxyPointer = packed.instantiate()
	add_child(proxy)
	check_equal(proxy.radius, 0.01, "radius")
	check(
		" ".join(proxy.get_problems()).contains("'Finger' was given a radius that is no length above 0"),
		"no warning names it: %s" % [proxy.get_problems()]
	)
	proxy.radius = 0.02
	check(not " ".join(proxy.get_problems()).contains("radius"), "it still warns")


func test_a_problem_that_is_repaired_is_gone() -> void:
	var world := add_world()
	var body := StaticBody3D.new()
	world.add_child(body)
	expect_error("it has no shape")
	world.advance(TICK)
	with_shape(body, box(Vector3(1, 1, 1)))
	world.advance(TICK)
	check_equal(world.get_problems().size(), 0, "problems")
