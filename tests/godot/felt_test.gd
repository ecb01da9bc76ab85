extends "nodes_case.gd"
## What Godot's own physics has and no body node: hands feel it where Godot moves the bodies. Runs with
## each of Godot's physics engines.

const FRAME := 1.0 / 60.0
const STIFFNESS := 500.0
const DEPTH := 0.01


func _play(world: HapticWorld, seconds: float) -> void:
	for _i in int(seconds / FRAME):
		await get_tree().physics_frame
		world.advance(FRAME)


## A hand that comes down from above onto y = 0 and presses.
func _add_pressing_hand(world: HapticWorld, x := 0.0) -> ProxyPointer:
	var down := path(Vector3(x, 0.3, 0.02), Vector3(x, 0.01 - DEPTH, 0.02), 0.5)
	return add_hand(world, down)


func _check_pressed(proxy: ProxyPointer, owner: Node, tolerance := 0.05) -> void:
	check_near(proxy.get_force(), Vector3(0, STIFFNESS * DEPTH, 0), tolerance, "force")
	var contacts := proxy.get_contacts()
	check(contacts.size() == 1 and contacts[0].body == owner, "touched: %s" % [contacts])


## Of a script's own, without a node. Goes with the test.
func _server_body(shape: RID, mode := PhysicsServer3D.BODY_MODE_STATIC, at := Vector3.ZERO) -> RID:
	var body := PhysicsServer3D.body_create()
	PhysicsServer3D.body_set_mode(body, mode)
	PhysicsServer3D.body_set_space(body, get_viewport().world_3d.space)
	PhysicsServer3D.body_add_shape(body, shape)
	PhysicsServer3D.body_set_state(body, PhysicsServer3D.BODY_STATE_TRANSFORM, Transform3D(Basis(), at))
	return body


func test_a_grid_map() -> void:
	var world := add_godot_world(material(STIFFNESS))
	var grid := tiles(20)
	world.add_child(grid)
	var proxy := _add_pressing_hand(world)
	await _play(world, 1.0)
	_check_pressed(proxy, grid)
	check_equal(world.get_problems(), PackedStringArray(), "problems")
	for x in range(-1, 1):
		for z in range(-1, 1):
			grid.set_cell_item(Vector3i(x, -1, z), GridMap.INVALID_CELL_ITEM)
	await _play(world, 0.5)
	check_equal(proxy.is_touching(), false, "touches where the tile was")


func test_csg() -> void:
	var world := add_godot_world(material(STIFFNESS))
	var csg := CSGBox3D.new()
	csg.use_collision = true
	csg.size = Vector3(2, 0.4, 2)
	csg.position.y = -0.2
	world.add_child(csg)
	var proxy := _add_pressing_hand(world)
	await _play(world, 1.0)
	_check_pressed(proxy, csg)


func test_a_height_map_that_only_the_server_knows() -> void:
	var world := add_godot_world(material(STIFFNESS))
	var shape := PhysicsServer3D.heightmap_shape_create()
	var heights := PackedFloat32Array()
	heights.resize(64)
	PhysicsServer3D.shape_set_data(
		shape, {"width": 8, "depth": 8, "heights": heights, "min_height": 0.0, "max_height": 0.0}
	)
	var body := _server_body(shape)
	var proxy := _add_pressing_hand(world)
	await _play(world, 1.0)
	_check_pressed(proxy, null)
	PhysicsServer3D.free_rid(body)
	await _play(world, 0.2)
	check_equal(proxy.is_touching(), false, "touches what is freed")
	check_near(proxy.get_force(), Vector3.ZERO, 1e-6, "force")
	PhysicsServer3D.free_rid(shape)


func _check_server_shape(shape: RID, data: Variant) -> void:
	var world := add_godot_world(material(STIFFNESS))
	PhysicsServer3D.shape_set_data(shape, data)
	var body := _server_body(shape)
	var proxy := _add_pressing_hand(world)
	await _play(world, 1.0)
	_check_pressed(proxy, null)
	PhysicsServer3D.free_rid(body)
	PhysicsServer3D.free_rid(shape)


func test_triangles_that_only_the_server_knows() -> void:
	var faces := PlaneMesh.new().get_faces()
	var shape := PhysicsServer3D.concave_polygon_shape_create()
	await _check_server_shape(shape, {"faces": faces, "backface_collision": false})


func test_a_hull_that_only_the_server_knows() -> void:
	var corners := PackedVector3Array()
	for i in 8:
		corners.append(Vector3(i & 1, (i >> 1) & 1, i >> 2) - Vector3(0.5, 1, 0.5))
	await _check_server_shape(PhysicsServer3D.convex_polygon_shape_create(), corners)


func test_a_plane_that_only_the_server_knows() -> void:
	await _check_server_shape(PhysicsServer3D.world_boundary_shape_create(), Plane(Vector3.UP, 0.0))


func test_a_body_that_a_script_moves_by_the_server() -> void:
	var world := add_godot_world(material(STIFFNESS))
	var shape := PhysicsServer3D.box_shape_create()
	PhysicsServer3D.shape_set_data(shape, Vector3(0.5, 0.1, 0.5))
	var body := _server_body(shape, PhysicsServer3D.BODY_MODE_KINEMATIC, Vector3(0, -0.1, 0))
	var proxy := _add_pressing_hand(world)
	await _play(world, 1.0)
	_check_pressed(proxy, null)
	for i in 30:
		var at := Transform3D(Basis(), Vector3(0, -0.1 + 0.0005 * (i + 1), 0))
		PhysicsServer3D.body_set_state(body, PhysicsServer3D.BODY_STATE_TRANSFORM, at)
		await _play(world, FRAME)
	await _play(world, 0.2)
	check_near(proxy.get_force(), Vector3(0, STIFFNESS * (DEPTH + 0.015), 0), 0.05, "force")
	PhysicsServer3D.free_rid(body)
	PhysicsServer3D.free_rid(shape)


func test_a_body_that_godot_moves_and_no_node_has_is_pushed() -> void:
	var world := add_godot_world(material(STIFFNESS))
	add_floor(world)
	var shape := PhysicsServer3D.box_shape_create()
	PhysicsServer3D.shape_set_data(shape, Vector3.ONE * 0.05)
	var body := _server_body(shape, PhysicsServer3D.BODY_MODE_RIGID, Vector3(0, 0.05, 0))
	add_hand(world, path(Vector3(-0.1, 0.05, 0), Vector3(0.1, 0.05, 0), 2.0))
	await _play(world, 3.0)
	var place: Transform3D = PhysicsServer3D.body_get_state(body, PhysicsServer3D.BODY_STATE_TRANSFORM)
	check(place.origin.x > 0.1, "it is at %s" % place.origin)
	check_near(place.origin.y, 0.05, 0.02, "height")
	PhysicsServer3D.free_rid(body)
	PhysicsServer3D.free_rid(shape)


## A bone of a ragdoll that has not begun to fall, and has.
func test_a_bone() -> void:
	var world := add_godot_world(material(STIFFNESS))
	add_floor(world)
	var skeleton := Skeleton3D.new()
	skeleton.add_bone("Bone")
	var simulator := PhysicalBoneSimulator3D.new()
	skeleton.add_child(simulator)
	var bone := PhysicalBone3D.new()
	bone.bone_name = "Bone"
	simulator.add_child(with_shape(bone, box(Vector3(0.3, 0.1, 0.1))))
	skeleton.position.y = -0.05
	world.get_node("Floor").position.y = -0.21
	world.add_child(skeleton)
	var proxy := _add_pressing_hand(world)
	await _play(world, 1.0)
	_check_pressed(proxy, bone)
	simulator.physical_bones_start_simulation()
	await _play(world, 1.0)
	check_near(bone.global_position.y, -0.06, 0.03, "height")
	check_equal(world.get_problems(), PackedStringArray(), "problems")


## Godot's Jolt finds a mesh once for each of its triangles.
func test_meshes_of_many_triangles_hide_nothing_that_is_close() -> void:
	var world := add_godot_world(material(STIFFNESS))
	var plane := PlaneMesh.new()
	plane.subdivide_depth = 150
	plane.subdivide_width = 150
	world.add_child(with_shape(StaticBody3D.new(), plane.create_trimesh_shape(), Vector3(0, -0.02, 0)))
	var ball := SoftBody3D.new()
	ball.mesh = SphereMesh.new()
	ball.position.y = -0.3
	add_child(ball)
	var shape := PhysicsServer3D.box_shape_create()
	PhysicsServer3D.shape_set_data(shape, Vector3.ONE * 0.05)
	var body := _server_body(shape, PhysicsServer3D.BODY_MODE_STATIC, Vector3(0, -0.05, 0))
	var proxy := _add_pressing_hand(world)
	await _play(world, 1.0)
	_check_pressed(proxy, null)
	check_equal(world.get_problems(), PackedStringArray(), "problems")
	PhysicsServer3D.free_rid(body)
	PhysicsServer3D.free_rid(shape)


## Also what stands far from hands, or belongs to a node that is not below the world.
func test_no_more_than_is_close_is_looked_at() -> void:
	var world := add_godot_world(material(STIFFNESS))
	var shape := PhysicsServer3D.box_shape_create()
	PhysicsServer3D.shape_set_data(shape, Vector3.ONE * 0.01)
	var bodies: Array[RID] = []
	for i in 300:
		var at := Vector3(0.03 * (i % 20) - 0.3, -0.01, 0.03 * (i / 20) - 0.2)
		bodies.append(_server_body(shape, PhysicsServer3D.BODY_MODE_STATIC, at))
	var outside := CSGBox3D.new()
	outside.use_collision = true
	outside.position.y = -0.5
	add_child(outside)
	expect_error("so many shapes about a hand")
	var proxy := _add_pressing_hand(world)
	await _play(world, 1.0)
	_check_pressed(proxy, null)
	var count := 0
	for body in world.intersect_sphere(Vector3.ZERO, 10.0):
		count += int(body == null)
	check_equal(count, 0, "bodies of no node in the queries")
	for rid: RID in bodies + [shape]:
		PhysicsServer3D.free_rid(rid)


func test_what_cannot_be_felt_is_said() -> void:
	var world := add_godot_world(material(STIFFNESS))
	var shape := PhysicsServer3D.separation_ray_shape_create()
	PhysicsServer3D.shape_set_data(shape, {"length": 0.5, "slide_on_slope": false})
	var box_shape := PhysicsServer3D.box_shape_create()
	PhysicsServer3D.shape_set_data(box_shape, Vector3.ONE)
	var body := _server_body(box_shape, PhysicsServer3D.BODY_MODE_RIGID, Vector3(0, -1, 0))
	PhysicsServer3D.body_set_param(body, PhysicsServer3D.BODY_PARAM_GRAVITY_SCALE, 0.0)
	PhysicsServer3D.body_add_shape(body, shape)
	_add_pressing_hand(world)
	expect_error("cannot be felt")
	await _play(world, 0.5)
	var problems := "\n".join(world.get_problems())
	check(problems.contains("cannot be felt"), problems)
	PhysicsServer3D.free_rid(body)
	PhysicsServer3D.free_rid(shape)
	PhysicsServer3D.free_rid(box_shape)
