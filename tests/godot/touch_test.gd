extends "nodes_case.gd"
## Touch through the nodes, in stepped time: the numbers are exact to what single precision lets through.


func test_advance_makes_the_ticks_of_its_time_and_keeps_the_rest() -> void:
	var world := add_world()
	check_equal(world.advance(0.0104), 10, "ticks")
	check_equal(world.advance(0.0006), 1, "ticks")
	for _i in 60:
		world.advance(1.0 / 60.0)
	check_equal(world.get_ticks(), 1011, "ticks in all")


func test_a_world_of_250_hertz_makes_250_ticks_a_second() -> void:
	var world := add_world()
	world.tick_rate = 250
	check_equal(world.advance(1.0), 250, "ticks")


func test_the_proxy_rests_on_the_floor_and_the_force_follows_hookes_law() -> void:
	var world := add_world()
	add_floor(world, 500.0)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0)))
	world.advance(1.5)
	check_near(proxy.get_proxy_position(), Vector3(0, 0.01, 0), 1e-6, "proxy")
	check_near(proxy.get_hand_position(), Vector3(0, -0.01, 0), 1e-6, "hand")
	check_near(proxy.get_force(), Vector3(0, 10.0, 0), 1e-3, "force")
	check_near(proxy.global_position, proxy.get_proxy_position(), 1e-6, "the node's place")
	check_equal(proxy.get_state_text(), "touching", "state")


func test_what_the_scene_asks_for_and_what_is_left_of_it() -> void:
	var world := add_world()
	add_floor(world)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3.ZERO))
	var device: HapticDevice = proxy.get_node(proxy.device)
	check_equal(device.get_capabilities(), {}, "capabilities before the first tick")
	device.force_limit = 2.0
	world.advance(1.2)
	check_near(device.get_requested_force(), Vector3(0, 5.0, 0), 1e-6, "asked for")
	check_near(device.get_force(), Vector3(0, 2.0, 0), 1e-6, "given")
	check_equal(device.get_capabilities()["has_motors"], false, "motors")
	check_equal(device.get_capabilities()["max_force"], INF, "largest force")


func test_a_path_ends_and_begins_again() -> void:
	var world := add_world()
	var device := add_device(world, path(Vector3.ZERO, Vector3(0.1, 0, 0), 0.5))
	var ends := [0]
	device.path_finished.connect(func() -> void: ends[0] += 1)
	world.advance(0.25)
	check_near(device.get_path_time(), 0.249, 1e-6, "time on the path")
	check_equal(ends[0], 0, "ends at half the way")
	world.advance(1.0)
	check_equal(ends[0], 1, "ends")
	device.restart_path()
	check_equal(device.get_path_time(), 0.0, "time after a restart")
	world.advance(0.1)
	check_near(device.get_hand_position(), Vector3(0.0198, 0, 0), 1e-6, "place on the way again")
	world.advance(1.0)
	check_equal(ends[0], 2, "ends of both rounds")
	device.path = path(Vector3.ZERO, Vector3(0.1, 0, 0), 0.5)
	world.advance(0.1)
	check_near(device.get_path_time(), 0.099, 1e-6, "time on another path")


func test_a_path_that_repeats_never_ends() -> void:
	var world := add_world()
	var way := HapticPath.new()
	way.circle_turn_time = 0.1
	var device := add_device(world, way)
	device.path_finished.connect(func() -> void: check(false, "it has no end"))
	world.advance(1.0)
	check_near(device.get_path_time(), 0.999, 1e-6, "time on the path")


func test_the_smoothed_law_ends_at_the_same_force() -> void:
	var world := add_world()
	add_floor(world, 400.0)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0)))
	proxy.force_law = ProxyPointer.FORCE_LAW_SMOOTHED
	world.advance(1.5)
	check_near(proxy.get_force(), Vector3(0, 8.0, 0), 1e-3, "force")


func test_moving_turning_and_scaling_the_device_carries_the_hand_along() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3(0.1, 0, 0), Vector3(0.2, 0, 0)))
	var device: HapticDevice = world.get_node("Device")
	device.transform = Transform3D(Basis(Vector3.UP, PI / 2).scaled(Vector3(2, 2, 2)), Vector3(1, 2, 3))
	world.advance(1.2)
	check_near(proxy.get_hand_position(), Vector3(1, 2, 3) + Vector3(0, 0, -0.4), 1e-5, "hand")
	check_near(device.get_hand_position(), proxy.get_hand_position(), 1e-6, "the device's hand")


func test_a_held_clutch_keeps_the_hand_in_place() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3(0.1, 0, 0)))
	var device: HapticDevice = world.get_node("Device")
	world.advance(0.5)
	device.clutch = true
	world.advance(0.25)
	check_near(proxy.get_hand_position().x, 0.05, 1e-3, "hand while held")
	device.clutch = false
	world.advance(0.5)
	check_near(proxy.get_hand_position().x, 0.075, 1e-3, "hand after letting go")


func test_the_device_is_given_at_most_its_limit() -> void:
	var world := add_world()
	add_floor(world, 1000.0)
	add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0)))
	var device: HapticDevice = world.get_node("Device")
	device.force_limit = 3.0
	var limited := [0]
	device.force_limited.connect(func() -> void: limited[0] += 1)
	world.advance(1.5)
	await get_tree().process_frame
	check_near(device.get_force(), Vector3(0, 3, 0), 1e-4, "force on the device")
	check(limited[0] >= 1, "nobody was told that the force was limited")


func test_without_its_button_a_device_is_given_no_force() -> void:
	var world := add_world()
	add_floor(world, 1000.0)
	add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0)))
	var device: HapticDevice = world.get_node("Device")
	device.dead_man_buttons = 2
	world.advance(1.5)
	check_near(device.get_force(), Vector3.ZERO, 0.0, "force without the button")
	check(device.get_state_text().contains("button"), device.get_state_text())
	device.dead_man_buttons = 0
	world.advance(0.1)
	check(device.get_force().y > 1.0, "no force without a dead-man button")


func test_layers_that_the_mask_leaves_out_are_not_touched() -> void:
	var world := add_world()
	add_floor(world).collision_layer = 2
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0)))
	proxy.collision_mask = 1
	world.advance(1.2)
	check(not proxy.is_touching(), "it touches layer 2")


func test_the_hand_pushes_a_rigid_body_and_gravity_holds_it_down() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -9.81, 0)
	add_floor(world)
	var body := with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.1, 0.1)), Vector3(0, 0.05, 0)) as RigidBody3D
	body.mass = 0.2
	world.add_child(body)
	add_hand(world, path(Vector3(-0.15, 0.05, 0), Vector3(0.05, 0.05, 0), 2.0))
	world.advance(2.5)
	check(body.position.x > 0.08, "it did not move: %s" % body.position)
	check_near(body.position.y, 0.05, 2e-3, "height")


func test_a_rigid_body_falls_as_physics_says() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -10, 0)
	var body := with_shape(RigidBody3D.new(), sphere(0.05), Vector3(0, 5, 0)) as RigidBody3D
	body.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	body.linear_damp = 0.0
	world.add_child(body)
	world.advance(0.5)
	check_near(body.position.y, 5.0 - 0.5 * 10.0 * 0.25, 4e-3, "height")
	check_near(body.linear_velocity, Vector3(0, -5, 0), 0.011, "velocity")


func test_two_proxies_may_share_a_device_and_differ() -> void:
	var world := add_world()
	add_floor(world, 500.0)
	var first := add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.0, 0)), 0.01)
	var second := ProxyPointer.new()
	second.device = NodePath("../Device")
	second.radius = 0.02
	world.add_child(second)
	world.advance(1.2)
	check_near(first.get_force().y, 5.0, 1e-3, "first")
	check_near(second.get_force().y, 10.0, 1e-3, "second")


func test_the_mouse_puts_the_hand_under_the_pointer() -> void:
	var world := add_world()
	var proxy := add_hand(world, null)
	var device: HapticDevice = world.get_node("Device")
	device.driver = HapticDevice.DRIVER_MOUSE
	var camera := Camera3D.new()
	camera.position = Vector3(0, 0, 1)
	add_child(camera)
	camera.make_current()
	world.advance(TICK)
	device.aim_mouse(camera.unproject_position(Vector3(0.1, 0.05, 0)))
	world.advance(1.0)
	check_near(proxy.get_hand_position(), Vector3(0.1, 0.05, 0), 1e-3, "hand")
	device.aim_mouse(camera.unproject_position(Vector3(0.1, 0.05, 0)), 0.5)
	world.advance(1.0)
	check_near(proxy.get_hand_position(), Vector3(0.15, 0.075, -0.5), 2e-3, "hand after the wheel")


func test_a_simulated_arm_is_pushed_back_and_changes_where_it_is() -> void:
	var world := add_world()
	add_floor(world, 500.0)
	var proxy := add_hand(world, path(Vector3(0, 0.03, 0), Vector3(0, -0.03, 0), 0.5))
	var device: HapticDevice = world.get_node("Device")
	device.driver = HapticDevice.DRIVER_SIMULATED_ARM
	device.force_limit = 20.0
	world.advance(3.0)
	# At rest the muscles' spring and the floor's share the way: 150 (y + 0.03) = 500 (0.01 - y).
	check_near(device.get_hand_position().y, 0.5 / 650.0, 1e-5, "where the two springs balance (m)")
	check_near(proxy.get_force().y, 500.0 * (0.01 - 0.5 / 650.0), 5e-3, "force (N)")
	var before := device.get_hand_position().y
	device.arm_stiffness = 300.0
	world.advance(TICK)
	check_near(device.get_hand_position().y, before, 1e-4, "place just after it has become stiffer (m)")
	world.advance(3.0)
	check_near(device.get_hand_position().y, -4.0 / 800.0, 1e-5, "where they balance then (m)")
	for wrong: Array in [["arm_mass", 0.0], ["arm_damping", -1.0], ["arm_stiffness", NAN]]:
		expect_error("%s = %s was refused" % wrong)
		device.set(wrong[0], wrong[1])


## Both stand in the tree before either runs.
func test_a_hand_belongs_to_the_world_above_it_also_while_that_is_to_start_yet() -> void:
	var scene := Node3D.new()
	var worlds: Array[HapticWorld] = [HapticWorld.new(), HapticWorld.new()]
	for world in worlds:
		world.clock = HapticWorld.CLOCK_STEPPED
		scene.add_child(world)
	add_floor(worlds[0])
	var pushed := (
		with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.1, 0.1)), Vector3(0, 0.05, 0)) as RigidBody3D
	)
	worlds[0].add_child(pushed)
	var proxy := add_hand(worlds[1], path(Vector3(-0.2, 0.05, 0), Vector3(0.2, 0.05, 0), 0.5))
	expect_error("nothing in it can be touched")
	add_child(scene)
	for _i in 60:
		for world in worlds:
			world.advance(1.0 / 60.0)
	check_near(pushed.position, Vector3(0, 0.05, 0), 1e-3, "a box of the other world")
	check_near(proxy.get_force(), Vector3.ZERO, 1e-6, "force")
