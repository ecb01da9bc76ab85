extends "nodes_case.gd"
## Every shape of Godot is touched where its surface is, in stepped time.


func test_every_shape_is_touched_where_its_surface_is() -> void:
	var capsule := CapsuleShape3D.new()
	capsule.radius = 0.05
	capsule.height = 0.3
	var cylinder := CylinderShape3D.new()
	cylinder.radius = 0.05
	cylinder.height = 0.3
	var convex := ConvexPolygonShape3D.new()
	convex.points = _corners(0.1, 0.15, 0.1)
	var concave := ConcavePolygonShape3D.new()
	var cube := BoxMesh.new()
	cube.size = Vector3(0.2, 0.3, 0.2)
	concave.set_faces(cube.get_faces())
	var height_map := HeightMapShape3D.new()
	height_map.map_width = 3
	height_map.map_depth = 3
	height_map.map_data = PackedFloat32Array([0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15])
	var boundary := WorldBoundaryShape3D.new()
	boundary.plane = Plane(Vector3.UP, 0.15)
	for shape: Shape3D in [
		box(Vector3(0.2, 0.3, 0.2)), sphere(0.15), capsule, cylinder, convex, concave, height_map, boundary
	]:
		var world := add_world()
		world.add_child(with_shape(StaticBody3D.new(), shape))
		var proxy := add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0, 0.155, 0)))
		world.advance(1.2)
		check_near(proxy.get_proxy_position(), Vector3(0, 0.16, 0), 1e-5, shape.get_class())
		world.free()


func test_a_mirrored_height_map_is_touched_where_it_is_seen() -> void:
	var heights := HeightMapShape3D.new()
	heights.map_width = 3
	heights.map_depth = 3
	heights.map_data = PackedFloat32Array([0.1, 0.1, 0.4, 0.1, 0.1, 0.4, 0.1, 0.1, 0.4])
	for mirror: Vector3 in [Vector3(-1, 1, 1), Vector3(1, -1, 1), Vector3(1, 1, -1), Vector3(-1, -1, 1)]:
		var world := add_world()
		var body := with_shape(StaticBody3D.new(), heights)
		(body.get_child(0) as Node3D).scale = mirror
		world.add_child(body)
		var flat := Vector3(-0.5, 0.1, 0.3) * mirror
		var proxy := add_hand(world, path(flat + Vector3(0, 0.2, 0), flat + Vector3(0, 0.005, 0)))
		world.advance(1.2)
		check_near(proxy.get_proxy_position(), flat + Vector3(0, 0.01, 0), 1e-5, "mirrored by %s" % mirror)
		world.free()


## A 32-bit hash does not tell these two names apart.
func test_library_meshes_with_names_of_one_hash_are_two() -> void:
	check("Aa".hash() == "B@".hash(), "the names are not of one hash")
	var folder := "res://addons/tactus/meshes/"
	var text := "v -1 %s 1\nv 1 %s 1\nv 0 %s -1\nf 1 2 3\n"
	for name: String in ["Aa", "B@"]:
		var file := FileAccess.open(folder + name + ".obj", FileAccess.WRITE)
		file.store_string(text.replace("%s", "0" if name == "Aa" else "0.2"))
		file.close()
	var world := add_world()
	for name: String in ["Aa", "B@"]:
		var mesh := HapticMesh.new()
		mesh.library_mesh = name
		var body := StaticBody3D.new()
		body.add_child(mesh)
		world.add_child(body)
	var proxy := add_hand(world, path(Vector3(0, 0.4, 0), Vector3(0, 0.205, 0)))
	world.advance(1.2)
	for name: String in ["Aa", "B@"]:
		DirAccess.remove_absolute(folder + name + ".obj")
	check_near(proxy.get_proxy_position(), Vector3(0, 0.21, 0), 1e-5, "proxy")


func _corners(x: float, y: float, z: float) -> PackedVector3Array:
	var corners := PackedVector3Array()
	for i in 8:
		corners.append(Vector3(x if i & 1 else -x, y if i & 2 else -y, z if i & 4 else -z))
	return corners


func test_scale_of_body_and_shape_is_touched_as_it_is_seen() -> void:
	var world := add_world()
	var body := with_shape(StaticBody3D.new(), box(Vector3(0.1, 0.1, 0.1)))
	body.scale = Vector3(2, 3, 2)
	world.add_child(body)
	var proxy := add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0, 0.155, 0)))
	world.advance(1.2)
	check_near(proxy.get_proxy_position(), Vector3(0, 0.16, 0), 1e-5, "proxy")


func test_a_turned_body_is_touched_on_its_turned_face() -> void:
	var world := add_world()
	var body := with_shape(StaticBody3D.new(), box(Vector3(0.2, 0.2, 0.2)))
	body.rotation_degrees = Vector3(0, 0, 45)
	world.add_child(body)
	var proxy := add_hand(world, path(Vector3(0.2, 0.2, 0), Vector3(0.05, 0.05, 0)))
	world.advance(1.2)
	check_near(proxy.get_proxy_position(), Vector3(1, 1, 0).normalized() * 0.11, 1e-5, "proxy")


func test_a_disabled_shape_is_not_there() -> void:
	var world := add_world()
	var body := with_shape(StaticBody3D.new(), sphere(0.1))
	body.get_node("Shape").disabled = true
	body.add_child(_shape_at(sphere(0.05), Vector3.ZERO))
	world.add_child(body)
	var proxy := add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0, 0.055, 0)))
	world.advance(1.2)
	check_near(proxy.get_proxy_position(), Vector3(0, 0.06, 0), 1e-5, "proxy")


func _shape_at(shape: Shape3D, at: Vector3) -> CollisionShape3D:
	var child := CollisionShape3D.new()
	child.shape = shape
	child.position = at
	return child


func test_a_collision_polygon_is_touched() -> void:
	var world := add_world()
	var body := StaticBody3D.new()
	var polygon := CollisionPolygon3D.new()
	polygon.polygon = PackedVector2Array(
		[Vector2(-0.1, -0.1), Vector2(0.1, -0.1), Vector2(0.1, 0.1), Vector2(-0.1, 0.1)]
	)
	polygon.depth = 0.2
	body.add_child(polygon)
	world.add_child(body)
	var proxy := add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0, 0.105, 0)))
	world.advance(1.2)
	check_near(proxy.get_proxy_position(), Vector3(0, 0.11, 0), 1e-5, "proxy")


func test_a_haptic_mesh_is_touched_instead_of_the_shapes() -> void:
	var world := add_world()
	var body := with_shape(StaticBody3D.new(), sphere(0.2))
	var mesh := HapticMesh.new()
	mesh.library_mesh = "cube"
	body.add_child(mesh)
	world.add_child(body)
	var proxy := add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0, 0.055, 0)))
	world.advance(1.2)
	check_near(proxy.get_proxy_position(), Vector3(0, 0.06, 0), 1e-5, "proxy")


func test_a_haptic_mesh_takes_a_mesh_resource_and_is_touched_from_outside() -> void:
	var world := add_world()
	var body := StaticBody3D.new()
	var mesh := HapticMesh.new()
	var cylinder := CylinderMesh.new()
	cylinder.height = 0.2
	cylinder.top_radius = 0.1
	cylinder.bottom_radius = 0.1
	mesh.mesh = cylinder
	body.add_child(mesh)
	world.add_child(body)
	var proxy := add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0, 0.105, 0)))
	world.advance(1.2)
	check_near(proxy.get_proxy_position(), Vector3(0, 0.11, 0), 1e-5, "proxy")
	check_near(proxy.get_contacts()[0].normal, Vector3.UP, 1e-5, "normal")


func test_the_library_has_masses_and_sources() -> void:
	check("cube" in HapticMesh.get_library_names(), "there is no cube")
	for name in HapticMesh.get_library_names():
		var mesh := HapticMesh.new()
		mesh.library_mesh = name
		check(mesh.get_library_mass() > 0.01, name + " has no mass")
		check(mesh.get_library_source() != "", name + " has no source")
		check(HapticMesh.create_library_mesh(name).get_faces().size() > 0, name + " has no triangles")
		mesh.free()
