extends "nodes_case.gd"
## What changes while a world runs reaches the loop.


func _standing_on_the_floor(world: HapticWorld, stiffness: float) -> ProxyPointer:
	add_floor(world, stiffness)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1))
	world.advance(0.3)
	return proxy


func test_stiffness() -> void:
	var world := add_world()
	var proxy := _standing_on_the_floor(world, 500.0)
	check_near(proxy.get_force().y, 10.0, 1e-3, "before")
	world.get_node("Floor").physics_material_override.stiffness = 250.0
	world.advance(0.1)
	check_near(proxy.get_force().y, 5.0, 1e-3, "after")


func test_another_material() -> void:
	var world := add_world()
	var proxy := _standing_on_the_floor(world, 500.0)
	world.get_node("Floor").physics_material_override = material(100.0)
	world.advance(0.1)
	check_near(proxy.get_force().y, 2.0, 1e-3, "force")


func test_the_default_material() -> void:
	var world := add_world()
	var proxy := _standing_on_the_floor(world, 500.0)
	world.get_node("Floor").physics_material_override = null
	world.default_material = material(50.0)
	world.advance(0.1)
	check_near(proxy.get_force().y, 1.0, 1e-3, "force")


func test_a_shape_resource() -> void:
	var world := add_world()
	var proxy := _standing_on_the_floor(world, 500.0)
	world.get_node("Floor/Shape").shape.size = Vector3(2, 0.21, 2)
	world.advance(0.1)
	check_near(proxy.get_proxy_position().y, 0.015, 1e-5, "proxy")


func test_the_place_of_a_shape() -> void:
	var world := add_world()
	var proxy := _standing_on_the_floor(world, 500.0)
	world.get_node("Floor/Shape").position.y = -0.002
	world.advance(0.1)
	check_near(proxy.get_proxy_position().y, 0.008, 1e-5, "proxy")


func test_a_disabled_shape_lets_the_proxy_through() -> void:
	var world := add_world()
	var proxy := _standing_on_the_floor(world, 500.0)
	world.get_node("Floor/Shape").disabled = true
	world.advance(0.1)
	check_near(proxy.get_force(), Vector3.ZERO, 1e-6, "force")


func test_the_place_of_a_static_body() -> void:
	var world := add_world()
	var proxy := _standing_on_the_floor(world, 500.0)
	world.get_node("Floor").position.y += 0.003
	world.advance(0.1)
	check_near(proxy.get_proxy_position().y, 0.013, 1e-5, "proxy")


func test_a_moved_parent_moves_the_body() -> void:
	var world := add_world()
	var parent := Node3D.new()
	world.add_child(parent)
	parent.add_child(with_shape(StaticBody3D.new(), box(Vector3(2, 0.2, 2)), Vector3(0, -0.1, 0)))
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1))
	world.advance(0.3)
	parent.position.y = 0.004
	world.advance(0.1)
	check_near(proxy.get_proxy_position().y, 0.014, 1e-5, "proxy")


func test_a_body_that_comes_is_touched_and_one_that_goes_is_not() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, 0.05, 0), 0.1))
	world.advance(0.2)
	check(not proxy.is_touching(), "there is nothing to touch yet")
	var body := with_shape(StaticBody3D.new(), box(Vector3(2, 0.2, 2)), Vector3(0, -0.3, 0))
	world.add_child(body)
	world.advance(0.1)
	body.position.y = -0.05
	world.advance(0.1)
	check_near(proxy.get_force().y, 0.01 * 500.0, 1e-2, "force")
	body.free()
	world.advance(0.1)
	check_near(proxy.get_force(), Vector3.ZERO, 1e-6, "force without it")
	check_equal(int(world.get_statistics().bodies), 0, "bodies")


func test_a_body_moved_to_another_parent_of_the_world_stays_touchable() -> void:
	var world := add_world()
	var proxy := _standing_on_the_floor(world, 500.0)
	var parent := Node3D.new()
	world.add_child(parent)
	world.get_node("Floor").reparent(parent)
	world.advance(0.1)
	check_near(proxy.get_force().y, 10.0, 1e-2, "force")


func test_the_radius() -> void:
	var world := add_world()
	add_floor(world, 500.0)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 1.0))
	world.advance(0.1)
	proxy.radius = 0.02
	world.advance(1.0)
	check_near(proxy.get_proxy_position().y, 0.02, 1e-5, "proxy")


func test_a_teleported_rigid_body_is_there_at_once() -> void:
	var world := add_world()
	var body := with_shape(RigidBody3D.new(), sphere(0.05), Vector3.ZERO) as RigidBody3D
	world.add_child(body)
	world.advance(0.1)
	body.position = Vector3(1, 2, 3)
	world.advance(0.1)
	check_near(body.position, Vector3(1, 2, 3), 1e-6, "place")
	body.linear_velocity = Vector3(1, 0, 0)
	world.advance(0.1)
	check_near(body.position.x, 1.1, 2e-3, "place after it was set going")


func test_gravity() -> void:
	var world := add_world()
	var body := with_shape(RigidBody3D.new(), sphere(0.05)) as RigidBody3D
	world.add_child(body)
	world.advance(0.1)
	check_near(body.position, Vector3.ZERO, 1e-7, "place")
	world.gravity = Vector3(0, -10, 0)
	body.sleeping = false
	world.advance(0.1)
	check(body.position.y < -0.03, "it does not fall: %s" % body.position)


func test_a_frozen_body_stays_and_a_thawed_one_falls() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -10, 0)
	var body := with_shape(RigidBody3D.new(), sphere(0.05)) as RigidBody3D
	body.freeze = true
	world.add_child(body)
	world.advance(0.1)
	check_near(body.position, Vector3.ZERO, 1e-7, "place while frozen")
	body.freeze = false
	world.advance(0.1)
	check(body.position.y < -0.03, "it does not fall: %s" % body.position)


func test_mass_changes_what_a_push_does() -> void:
	var moved := []
	for mass: float in [0.1, 10.0]:
		var world := add_world()
		var body := with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.1, 0.1))) as RigidBody3D
		world.add_child(body)
		world.advance(0.01)
		body.mass = mass
		add_hand(world, path(Vector3(-0.1, 0, 0), Vector3(-0.05, 0, 0), 0.2))
		world.advance(0.3)
		moved.append(body.position.x)
		world.free()
	check(moved[0] > 5.0 * moved[1], "the light one went %s m, the heavy one %s m" % moved)


func test_an_animatable_body_carries_and_pushes() -> void:
	var world := add_world()
	var lift := with_shape(AnimatableBody3D.new(), box(Vector3(0.5, 0.1, 0.5)), Vector3(0, -0.05, 0))
	(lift as AnimatableBody3D).sync_to_physics = false
	world.add_child(lift)
	var load_on_it := (
		with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.1, 0.1)), Vector3(0, 0.05, 0)) as RigidBody3D
	)
	world.add_child(load_on_it)
	world.gravity = Vector3(0, -9.81, 0)
	for i in 50:
		lift.position.y += 0.002
		world.advance(0.01)
	check_near(load_on_it.position.y, 0.15, 3e-3, "height of the load")


func test_the_path_of_the_device() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	world.advance(0.1)
	world.get_node("Device").path = path(Vector3(1, 0, 0), Vector3(1, 0, 0))
	world.advance(0.1)
	check_near(proxy.get_hand_position(), Vector3(1, 0, 0), 1e-6, "hand")


func test_godots_own_physics_leaves_the_bodies_alone_and_gets_them_back() -> void:
	var world := add_world()
	var body := with_shape(RigidBody3D.new(), sphere(0.05), Vector3(0, 1, 0)) as RigidBody3D
	world.add_child(body)
	world.advance(0.01)
	for _i in 20:
		await get_tree().physics_frame
	check_near(body.position, Vector3(0, 1, 0), 1e-6, "place under the world")
	world.remove_child(body)
	add_child(body)
	for _i in 20:
		await get_tree().physics_frame
	world.advance(0.01)
	for _i in 20:
		await get_tree().physics_frame
	check(body.position.y < 0.99, "Godot does not move it again: %s" % body.position)


func test_the_clock_can_be_changed_while_running() -> void:
	var world := add_world()
	world.advance(0.01)
	world.clock = HapticWorld.CLOCK_REAL_TIME
	check(await until(func() -> bool: return world.get_ticks() > 50, 5.0), "it does not tick by itself")
	world.clock = HapticWorld.CLOCK_STEPPED
	await frames(2)
	check_equal(world.get_ticks(), 0, "ticks of the new run")
	check_equal(world.advance(0.01), 10, "ticks by hand")
