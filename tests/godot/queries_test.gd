extends "nodes_case.gd"
## What scripts can ask of the surfaces of a world.


func _mesh_box(size: float) -> StaticBody3D:
	var body := StaticBody3D.new()
	var touched := HapticMesh.new()
	var mesh := BoxMesh.new()
	mesh.size = Vector3.ONE * size
	touched.mesh = mesh
	body.add_child(touched)
	return body


func _worlds() -> Array[HapticWorld]:
	var solid := add_world()
	solid.add_child(with_shape(StaticBody3D.new(), box(Vector3.ONE)))
	var meshed := add_world()
	meshed.add_child(_mesh_box(1.0))
	for world: HapticWorld in [solid, meshed]:
		var body: StaticBody3D = world.get_child(0)
		body.position = Vector3(1, 2, 3)
		body.rotation.y = PI / 4.0
		world.advance(0.01)
	return [solid, meshed]


func test_the_nearest_surface() -> void:
	for world in _worlds():
		var found: Dictionary = world.get_nearest_surface(Vector3(1, 3, 3))
		check_equal(found.get("body"), world.get_child(0), "body")
		check_near(found.distance, 0.5, 1e-5, "distance")
		check_near(found.position, Vector3(1, 2.5, 3), 1e-5, "position")
		check_near(found.normal, Vector3.UP, 1e-5, "normal")
		# The turned box reaches half its diagonal along x: an edge.
		found = world.get_nearest_surface(Vector3(3, 2, 3), 5.0)
		check_near(found.distance, 2.0 - sqrt(0.5), 1e-5, "distance of the edge")
		check_near(found.normal, Vector3.RIGHT, 1e-5, "normal of the edge")
		check_equal(world.get_nearest_surface(Vector3(1, 4, 3)), {}, "farther than 1 m")
		check_equal(world.get_nearest_surface(Vector3(1, 3, 3), 1.0, 4), {}, "in another layer")


func test_a_ray() -> void:
	for world in _worlds():
		var found: Dictionary = world.intersect_ray(Vector3(1.1, 10, 3), Vector3(1.1, -10, 3))
		check_equal(found.get("body"), world.get_child(0), "body")
		check_near(found.position, Vector3(1.1, 2.5, 3), 1e-5, "position")
		check_near(found.normal, Vector3.UP, 1e-4, "normal")
		check_near(found.distance, 7.5, 1e-5, "distance")
		check_equal(world.intersect_ray(Vector3(1, 10, 3), Vector3(1, 2.6, 3)), {}, "too short")
		check_equal(world.intersect_ray(Vector3(2, 10, 3), Vector3(2, -10, 3)), {}, "beside it")
		check_equal(world.intersect_ray(Vector3(1, 10, 3), Vector3(1, 20, 3)), {}, "away from it")
		check_equal(world.intersect_ray(Vector3(1, 10, 3), Vector3(1, -10, 3), 2), {}, "in another layer")


func test_a_sphere() -> void:
	for world in _worlds():
		var ball := with_shape(StaticBody3D.new(), sphere(0.1), Vector3(1, 3, 3))
		world.add_child(ball)
		world.advance(0.01)
		check_equal(world.intersect_sphere(Vector3(1, 2.8, 3), 0.35).size(), 2, "both")
		check_equal(
			world.intersect_sphere(Vector3(1, 3.2, 3), 0.2), [ball] as Array[CollisionObject3D], "the ball"
		)
		check_equal(world.intersect_sphere(Vector3(1, 5, 3), 0.2).size(), 0, "none")


func test_what_is_no_place_is_refused() -> void:
	var world := _worlds()[0]
	expect_error("get_nearest_surface() was asked with numbers that are no place")
	check_equal(world.get_nearest_surface(Vector3(NAN, 0, 0)), {}, "nearest to nowhere")
	expect_error("intersect_sphere() was asked with numbers that are no place")
	check_equal(world.intersect_sphere(Vector3.ZERO, -1.0).size(), 0, "within a radius below zero")
