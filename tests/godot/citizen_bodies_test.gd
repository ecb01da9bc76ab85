extends "nodes_case.gd"
## Bodies of Godot's scenes as their owners use them: large floors, scripts, families, turning, freeing.

var _ended := 0
var _started := 0


## A flat floor of 2 · cells² triangles, its surface at y = 0.
func _large_floor(cells: int, size: float, as_mesh: bool) -> StaticBody3D:
	var plane := PlaneMesh.new()
	plane.size = Vector2(size, size)
	plane.subdivide_width = cells - 1
	plane.subdivide_depth = cells - 1
	var body := StaticBody3D.new()
	body.name = "Floor"
	body.physics_material_override = material(500.0)
	if as_mesh:
		var touched := HapticMesh.new()
		touched.mesh = plane
		body.add_child(touched)
	else:
		with_shape(body, plane.create_trimesh_shape())
	return body


func _falling_box(at: Vector3) -> RigidBody3D:
	var body := with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.1, 0.1)), at) as RigidBody3D
	body.name = "Box"
	return body


func _real_world(gravity := Vector3(0, -9.8, 0)) -> HapticWorld:
	var world := HapticWorld.new()
	world.gravity = gravity
	return world


func _height_map(side: int) -> HeightMapShape3D:
	var shape := HeightMapShape3D.new()
	shape.map_width = side
	shape.map_depth = side
	return shape


func test_nothing_moves_before_a_large_floor_is_there() -> void:
	var floors: Array[StaticBody3D] = [_large_floor(151, 10.0, false), _large_floor(151, 10.0, true)]
	floors.append(with_shape(StaticBody3D.new(), _height_map(512)) as StaticBody3D)
	for floor: StaticBody3D in floors:
		var world := _real_world()
		var body := _falling_box(Vector3(0.3, 0.05, 0.2))
		world.add_child(body)
		world.add_child(floor)
		var proxy := add_hand(world, path(Vector3(0, 0.03, 0), Vector3(0, -0.05, 0), 0.01))
		add_child(world)
		check(await until(func() -> bool: return world.get_ticks() > 300, 60.0), "it does not tick")
		check_near(body.position.y, 0.05, 0.005, "height of the box on %s" % floor.get_child(0))
		check(proxy.is_touching(), "the finger is %s" % proxy.get_state_text())
		check_near(proxy.get_proxy_position().y, 0.01, 0.002, "finger on %s" % floor.get_child(0))
		var waited: float = world.get_statistics().trees_wait_s
		check(waited > 0.0 and waited < 60.0, "it waited for %s s" % waited)
		world.free()
		await frames(2)


func test_what_comes_with_a_large_floor_waits_for_it() -> void:
	var world := _real_world()
	add_child(world)
	check(await until(func() -> bool: return world.get_ticks() > 20, 10.0), "it does not tick")
	var chunk := Node3D.new()
	var body := _falling_box(Vector3(0.3, 0.05, 0.2))
	chunk.add_child(body)
	chunk.add_child(_large_floor(300, 10.0, true))
	world.add_child(chunk)
	var is_there := func() -> bool: return int(world.get_statistics().bodies) == 2
	check(await until(is_there, 60.0), "it is not built")
	var ticks := world.get_ticks()
	check(await until(func() -> bool: return world.get_ticks() > ticks + 300, 10.0), "it stands still")
	check_near(body.position.y, 0.05, 0.005, "height of the box")


func _script(source: String) -> GDScript:
	var script := GDScript.new()
	script.source_code = source
	script.reload()
	return script


## Each virtual method that a script can have, on every node: it must not replace what the node does itself.
func test_a_script_on_the_world_leaves_it_running() -> void:
	var world := _real_world()
	world.set_script(
		_script(
			"extends HapticWorld\nvar seen := 0\nfunc _process(_d):\n\tseen += 1\nfunc _ready():\n\tpass\n"
		)
	)
	world.add_child(_falling_box(Vector3.ZERO))
	add_child(world)
	await frames(30)
	check(world.get_ticks() > 0, "it does not tick")
	var body := world.get_node("Box") as RigidBody3D
	check(await until(func() -> bool: return body.position.y < -0.01, 5.0), "nothing falls")
	check(world.get("seen") > 0, "its script is not called")


func test_a_script_that_stops_a_worlds_processing_leaves_it_running() -> void:
	var world := _real_world()
	world.add_child(_falling_box(Vector3.ZERO))
	add_child(world)
	world.set_process(false)
	var body := world.get_node("Box") as RigidBody3D
	check(await until(func() -> bool: return body.position.y < -0.01, 5.0), "nothing falls")


func test_a_script_on_a_device_leaves_it_the_mouse() -> void:
	var world := _real_world(Vector3.ZERO)
	add_child(world)
	var camera := Camera3D.new()
	camera.position = Vector3(0, 0, 1)
	world.add_child(camera)
	camera.make_current()
	var device := HapticDevice.new()
	device.driver = HapticDevice.DRIVER_MOUSE
	device.set_script(
		_script("extends HapticDevice\nvar seen := 0\nfunc _unhandled_input(_e):\n\tseen += 1\n")
	)
	world.add_child(device)
	await frames(5)
	var before := device.get_hand_position() if device.has_method("get_hand_position") else Vector3.ZERO
	for i in 10:
		var event := InputEventMouseMotion.new()
		event.position = Vector2(100 + 10 * i, 100)
		Input.parse_input_event(event)
		await frames(1)
	await frames(10)
	check(device.get("seen") > 0, "its script is not called")
	check(device.get_hand_position() != before, "the hand does not follow the mouse")


func test_a_child_falls_freely_below_a_body_at_rest() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -9.8, 0)
	add_floor(world).scale = Vector3(0.2, 1, 0.2)
	var parent := _falling_box(Vector3(0, 0.05, 0))
	var child := _falling_box(Vector3(0.5, 0.45, 0))
	parent.add_child(child)
	world.add_child(parent)
	var alone := _falling_box(Vector3(-0.5, 0.5, 0))
	world.add_child(alone)
	for _frame in 60:
		world.advance(1.0 / 60.0)
	check_near(child.global_position.y, alone.global_position.y, 1e-3, "child")
	check(alone.position.y < -4.0, "the one alone is at %s" % alone.position)


func test_a_child_thrown_from_a_spinning_body_flies_on() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -9.8, 0)
	world.add_child(_falling_box(Vector3(50, 0, 0)))
	var parent := _falling_box(Vector3.ZERO)
	parent.angular_velocity = Vector3(0, 0, 5)
	parent.angular_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	var child := _falling_box(Vector3(0.5, 0, 0))
	child.linear_velocity = Vector3(1, 0, 0)
	child.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	parent.add_child(child)
	var grandchild := _falling_box(Vector3(0, 0.5, 0))
	grandchild.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	child.add_child(grandchild)
	world.add_child(parent)
	for _frame in 60:
		world.advance(1.0 / 60.0)
	check_near(child.global_position.x, 1.5, 0.01, "child")
	check_near(grandchild.global_position.x, 0.5, 0.01, "grandchild")


func _nudged(world: HapticWorld, body: RigidBody3D, seconds: float, nudge: Callable) -> float:
	var begin := world.get_time()
	while world.get_time() - begin < seconds:
		nudge.call(body)
		if world.clock == HapticWorld.CLOCK_STEPPED:
			world.advance(1.0 / 60.0)
		else:
			await get_tree().process_frame
	return world.get_time() - begin


## What a script writes is one coordinate, or one of the speed: the others go on as they were.
func test_a_body_that_a_script_nudges_falls_on() -> void:
	var nudges := {
		"position": func(body: RigidBody3D) -> void: body.position.x += 0.001,
		"speed": func(body: RigidBody3D) -> void: body.linear_velocity.x += 0.01,
		"turn": func(body: RigidBody3D) -> void: body.rotate_y(0.01),
		"spin": func(body: RigidBody3D) -> void: body.angular_velocity.y += 0.01,
	}
	for clock: HapticWorld.Clock in [HapticWorld.CLOCK_STEPPED, HapticWorld.CLOCK_REAL_TIME]:
		for what: String in nudges:
			var world := _real_world()
			world.clock = clock
			var nudged := _falling_box(Vector3.ZERO)
			var alone := _falling_box(Vector3(10, 0, 0))
			world.add_child(nudged)
			world.add_child(alone)
			add_child(world)
			await _nudged(world, nudged, 0.7, nudges[what])
			check_near(
				nudged.position.y, alone.position.y, 0.01, "%s nudged, clock %d: height" % [what, clock]
			)
			check(alone.position.y < -1.0, "it falls to %s" % alone.position)
			world.free()
			await frames(1)


func test_a_body_that_is_put_somewhere_and_thrown_is_there() -> void:
	var world := _real_world()
	var body := _falling_box(Vector3.ZERO)
	world.add_child(body)
	add_child(world)
	check(await until(func() -> bool: return body.position.y < -3.0, 10.0), "it does not fall")
	body.position = Vector3(0, 1, 0)
	body.linear_velocity = Vector3.ZERO
	await frames(2)
	check(body.position.y > 0.95 and body.position.y <= 1.0, "it is at %s" % body.position)


func test_a_body_that_turns_is_not_made_anew() -> void:
	var world := add_world()
	var body := with_shape(StaticBody3D.new(), box(Vector3(0.2, 0.2, 0.2)), Vector3.ZERO)
	body.scale = Vector3(2, 1, 2)
	body.physics_material_override = material(500.0)
	world.add_child(body)
	var proxy := add_hand(world, path(Vector3(0, 0.2, 0), Vector3(0, 0.105, 0), 0.1))
	proxy.contact_ended.connect(func(_body: Variant) -> void: _ended += 1)
	proxy.contact_started.connect(func(_body: Variant) -> void: _started += 1)
	world.advance(0.2)
	check(proxy.is_touching(), "it is not touched")
	for _i in 4000:
		body.rotate_y(0.01)
		world.advance(TICK)
	check_equal(_started, 1, "contacts that started")
	check_equal(_ended, 0, "contacts that ended")
	check(
		body.basis.get_scale().distance_to(Vector3(2, 1, 2)) > 2e-5,
		"the basis has not drifted: %s" % (body.basis.get_scale() - Vector3(2, 1, 2))
	)


func test_a_followed_mesh_that_changes_in_place_is_felt() -> void:
	for kind in 2:
		var world := add_world()
		var body := StaticBody3D.new()
		body.physics_material_override = material(500.0)
		var drawn := MeshInstance3D.new()
		drawn.name = "Drawn"
		var cube := BoxMesh.new()
		cube.size = Vector3(0.1, 0.1, 0.1)
		var arrays := ArrayMesh.new()
		arrays.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, cube.get_mesh_arrays())
		drawn.mesh = cube if kind == 0 else arrays
		body.add_child(drawn)
		var touched := HapticMesh.new()
		touched.mesh_instance = NodePath("../Drawn")
		body.add_child(touched)
		world.add_child(body)
		var proxy := add_hand(world, path(Vector3(0, 0.2, 0), Vector3(0, 0.055, 0), 0.1))
		world.advance(0.2)
		check_near(proxy.get_proxy_position().y, 0.06, 1e-3, "proxy before")
		cube.size = Vector3(0.1, 0.16, 0.1)
		if kind == 1:
			arrays.clear_surfaces()
			arrays.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, cube.get_mesh_arrays())
		await frames(2)
		world.advance(0.1)
		check_near(proxy.get_proxy_position().y, 0.09, 1e-3, "proxy on the larger box, %s" % drawn.mesh)
		world.free()


func _count(node: Node) -> void:
	node.connect("contact_started", func(_body: Node) -> void: _started += 1)
	node.connect("contact_ended", func(body: Node) -> void: _ended += 1 if body != null else 100)


func test_a_contact_ends_with_its_body() -> void:
	var ways := {
		"free": func(body: Node) -> void: body.free(),
		"queue_free": func(body: Node) -> void: body.queue_free(),
		"the scene": func(body: Node) -> void: body.get_parent().free(),
		"taken out": func(body: Node) -> void: body.get_parent().remove_child(body),
	}
	for way: String in ways:
		var world := add_world()
		var scene := Node3D.new()
		world.add_child(scene)
		var body := with_shape(StaticBody3D.new(), box(Vector3.ONE), Vector3(0, -0.5, 0))
		scene.add_child(body)
		var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, 0.005, 0), 0.05))
		_count(proxy)
		world.advance(0.1)
		check_equal(_started, 1, "contacts that started, %s" % way)
		ways[way].call(body)
		await frames(2)
		world.advance(0.01)
		check_equal(_ended, 1, "contacts that ended, %s" % way)
		if way == "taken out":
			body.free()
		world.free()
		_started = 0
		_ended = 0


func test_a_tools_contact_ends_with_its_body() -> void:
	var world := add_world()
	var body := with_shape(StaticBody3D.new(), box(Vector3.ONE), Vector3(0, -0.5, 0))
	world.add_child(body)
	add_device(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.02, 0), 0.05))
	var tool := HapticTool.new()
	tool.mesh = BoxMesh.new()
	(tool.mesh as BoxMesh).size = Vector3(0.05, 0.05, 0.05)
	tool.device = NodePath("../Device")
	world.add_child(tool)
	_count(tool)
	world.advance(0.2)
	check_equal(_started, 1, "contacts that started")
	body.free()
	await frames(1)
	world.advance(0.01)
	check_equal(_ended, 1, "contacts that ended")
