extends "nodes_case.gd"
## Hands that have no device of their own: keys, a gamepad, a node of the scene.


func _device(world: HapticWorld, driver: HapticDevice.Driver) -> HapticDevice:
	var device := HapticDevice.new()
	device.name = "Device"
	device.driver = driver
	world.add_child(device)
	return device


func _stick(axis: JoyAxis, value: float) -> void:
	var event := InputEventJoypadMotion.new()
	event.axis = axis
	event.axis_value = value
	Input.parse_input_event(event)
	Input.flush_buffered_events()


## The hand is led frame by frame, the ticks are the test's.
func _play(world: HapticWorld, count: int) -> void:
	for _i in count:
		await frames(1)
		world.advance(0.01)


func test_keys_move_the_hand_as_the_camera_sees_it() -> void:
	var world := add_world()
	var camera := Camera3D.new()
	camera.rotation_degrees = Vector3(0, 90, 0)
	world.add_child(camera)
	camera.make_current()
	var device := _device(world, HapticDevice.DRIVER_KEYBOARD)
	device.steering_speed = 1.0
	device.steering_reach = 0.1
	await _play(world, 2)
	check_near(device.get_hand_position(), Vector3.ZERO, 1e-9, "before a key is pressed")
	send_key(KEY_RIGHT, true)
	await _play(world, 60)
	send_key(KEY_RIGHT, false)
	# The camera looks along -x: right is -z. At the end of its reach it goes no farther.
	check_near(device.get_hand_position(), Vector3(0, 0, -0.1), 1e-4, "to the right")
	await _play(world, 10)
	check_near(device.get_hand_position(), Vector3(0, 0, -0.1), 1e-4, "let go")
	send_key(KEY_SPACE, true)
	await _play(world, 2)
	check_equal(device.get_buttons(), 1, "space")
	send_key(KEY_SPACE, false)


func test_a_stick_is_a_place_where_that_is_asked_for() -> void:
	expect_error("no gamepad is connected")
	var world := add_world()
	var device := _device(world, HapticDevice.DRIVER_GAMEPAD)
	device.steering = HapticDevice.STEERING_POSITION
	device.steering_reach = 0.3
	device.steering_dead_zone = 0.0
	await _play(world, 2)
	_stick(JOY_AXIS_LEFT_Y, -0.5)
	await _play(world, 60)
	check_near(device.get_hand_position(), Vector3(0, 0.15, 0), 1e-4, "half way up")
	_stick(JOY_AXIS_LEFT_Y, 0.0)
	await _play(world, 60)
	check_near(device.get_hand_position(), Vector3.ZERO, 1e-4, "let go")


func test_a_space_mouse_without_its_daemon_says_so() -> void:
	OS.set_environment("SPNAV_SOCKET", OS.get_user_data_dir().path_join("no_such_spacenavd"))
	expect_error("needs spacenavd")
	var world := add_world()
	var device := _device(world, HapticDevice.DRIVER_SPACE_MOUSE)
	await _play(world, 2)
	check(device.get_state_text().contains("apt-get install spacenavd"), device.get_state_text())
	check_near(device.get_hand_position(), Vector3.ZERO, 1e-9, "nobody moves it")
	OS.unset_environment("SPNAV_SOCKET")


func test_a_hand_that_cannot_tell_is_turned_as_its_node_and_given_no_torque() -> void:
	var world := add_world()
	var device := _device(world, HapticDevice.DRIVER_KEYBOARD)
	device.rotation_degrees = Vector3(0, 90, 0)
	device.applied_torque = Vector3(0, 0.1, 0)
	await _play(world, 2)
	check_near(device.get_hand_rotation() * Vector3.RIGHT, Vector3.FORWARD, 1e-6, "its right")
	check_equal(device.get_torque(), Vector3.ZERO, "torque without motors")
	expect_error("was refused")
	device.applied_torque = Vector3(0, NAN, 0)
	check_near(device.applied_torque, Vector3(0, 0.1, 0), 1e-6, "what is no number is refused")


func test_a_node_of_the_scene_leads_the_hand() -> void:
	var world := add_world()
	add_floor(world)
	var leader := Node3D.new()
	leader.name = "Leader"
	leader.position = Vector3(0.2, 0.05, 0)
	world.add_child(leader)
	var device := _device(world, HapticDevice.DRIVER_NODE)
	device.position = Vector3(1, 1, 1)
	device.scale = Vector3(2, 2, 2)
	device.target = NodePath("../Leader")
	var tip := ProxyPointer.new()
	world.add_child(tip)
	await _play(world, 2)
	check_near(device.get_hand_position(), leader.position, 1e-4, "it begins there")
	leader.position.y = -0.01
	await _play(world, 60)
	check_near(device.get_hand_position(), leader.position, 1e-4, "led into the floor")
	check_near(tip.get_force().y, 500.0 * 0.02, 2.1, "force")
	check(tip.is_touching(), tip.get_state_text())
	leader.free()
	expect_error("is not a Node3D of the scene")
	await _play(world, 2)
	check(not device.is_device_connected(), "nobody leads it")


## It begins turned as its node is, and follows it where a script advances without a frame between.
func test_a_node_leads_the_hand_without_frames() -> void:
	var world := add_world()
	var leader := Node3D.new()
	leader.rotation = Vector3(0.3, 0.4, 0.5)
	world.add_child(leader)
	var device := _device(world, HapticDevice.DRIVER_NODE)
	device.rotation.y = 1.0
	device.target_node = leader
	world.advance(0.001)
	check(device.get_hand_rotation().angle_to(leader.quaternion) < 1e-3, "turned at its beginning")
	leader.position = Vector3(0.1, 0.2, 0.3)
	leader.rotation.x = -0.5
	for _i in 100:
		world.advance(0.01)
	check_near(device.get_hand_position(), leader.position, 1e-4, "place")
	check(device.get_hand_rotation().angle_to(leader.quaternion) < 1e-3, "rotation")


func test_a_hand_without_its_node_says_so() -> void:
	var device := HapticDevice.new()
	device.driver = HapticDevice.DRIVER_NODE
	check(device.get_state_text().contains("set 'target' to a Node3D"), device.get_state_text())
	var warnings := "\n".join(device.get_problems())
	check(warnings.contains("set 'target'"), warnings)
	device.free()


## A hand that presses 5 mm deep.
func test_a_property_of_another_driver_leaves_the_hand_as_it_is() -> void:
	var world := add_world()
	add_floor(world, 1000.0)
	add_hand(world, path(Vector3(0, 0.02, 0), Vector3(0, 0.005, 0), 0.2))
	var device: HapticDevice = world.get_node("Device")
	world.advance(0.5)
	var pressing := device.get_force()
	check_near(pressing.length(), 5.0, 0.01, "force")
	var others := {
		"target": NodePath("../Floor"),
		"firmware": "res://none.bin",
		"device_id": "7",
		"gravity_compensation": 1.0,
		"table_height": 0.01,
		"robot_mass_error": 0.1,
		"robot_friction_error": 0.1,
	}
	for property: String in others:
		device.set(property, others[property])
		for _i in 3:
			world.advance(TICK)
			check_near(device.get_force(), pressing, 1e-6, "force after " + property)


func test_a_path_leaves_a_hand_as_it_is_that_follows_a_node() -> void:
	var world := add_world()
	add_floor(world, 1000.0)
	var leader := Node3D.new()
	world.add_child(leader)
	var device := _device(world, HapticDevice.DRIVER_NODE)
	device.target = device.get_path_to(leader)
	var tip := ProxyPointer.new()
	tip.device = NodePath("../Device")
	world.add_child(tip)
	leader.position.y = 0.02
	await _play(world, 2)
	leader.position.y = 0.005
	await _play(world, 60)
	var pressing := device.get_force()
	check(pressing.y > 1.0, "force %s" % pressing)
	device.path = path(Vector3.ZERO, Vector3.ONE)
	for _i in 3:
		world.advance(TICK)
		check_near(device.get_force(), pressing, 1e-6, "force")


func test_what_another_driver_needs_is_not_shown() -> void:
	var device := HapticDevice.new()
	for driver: int in [
		HapticDevice.DRIVER_KEYBOARD,
		HapticDevice.DRIVER_GAMEPAD,
		HapticDevice.DRIVER_SPACE_MOUSE,
		HapticDevice.DRIVER_NODE
	]:
		device.driver = driver
		var shown := []
		for property: Dictionary in device.get_property_list():
			if property.usage & PROPERTY_USAGE_EDITOR:
				shown.append(property.name)
		check_equal(
			"steering_speed" in shown, driver != HapticDevice.DRIVER_NODE, "speed, driver %d" % driver
		)
		check_equal("gamepad" in shown, driver == HapticDevice.DRIVER_GAMEPAD, "gamepad, driver %d" % driver)
		check_equal("target" in shown, driver == HapticDevice.DRIVER_NODE, "target, driver %d" % driver)
		check(not "path" in shown and not "wheel_step" in shown, "driver %d" % driver)
	device.free()


func _box_of(device: HapticDevice) -> MeshInstance3D:
	var pictures := device.get_children(true).filter(func(child: Node) -> bool: return child is Node3D)
	return pictures[0] if pictures.size() == 1 else null


func test_the_workspace_is_drawn_where_that_is_asked_for() -> void:
	var world := add_world()
	var device := _device(world, HapticDevice.DRIVER_KEYBOARD)
	device.steering_reach = 0.3
	check_equal(_box_of(device), null, "nobody asked for it")
	device.show_workspace = true
	var box := _box_of(device)
	check(box.visible, "it is not seen")
	check_near(box.scale, Vector3.ONE * 0.3, 1e-6, "as large as it reaches")
	check_near(box.mesh.get_aabb().size, Vector3.ONE * 2.01, 0.01, "a cube")
	device.steering_reach = 0.1
	check_near(box.scale, Vector3.ONE * 0.1, 1e-6, "as large as it reaches now")
	device.driver = HapticDevice.DRIVER_MOUSE
	check(not box.visible, "a mouse has no workspace")
	device.driver = HapticDevice.DRIVER_EMULATED_ROBOT
	await _play(world, 2)
	check(box.visible and box.scale.x > 0.01, "the robot has one: %s" % box.scale)
	device.show_workspace = false
	check(not box.visible, "nobody asks for it any more")


## A hand that goes 5 mm into the floor at 0.2 m/s.
func test_the_projects_limit_holds_for_every_device() -> void:
	const LIMIT := "tactus/safety/force_limit"
	check_equal(ProjectSettings.get_setting(LIMIT), 0.0, "the setting at first")
	var world := add_world()
	add_floor(world, 1000.0)
	var proxy := add_hand(world, path(Vector3(0, 0.02, 0), Vector3(0, 0.005, 0), 0.2))
	var device: HapticDevice = world.get_node("Device")
	world.advance(0.5)
	check_near(device.get_force().length(), 5.0, 0.01, "force without a limit of the project")
	ProjectSettings.set_setting(LIMIT, 1.5)
	for _i in 10:
		world.advance(0.1)
	check_near(device.get_force().length(), 1.5, 0.01, "force within it")
	device.force_limit = 0.5
	for _i in 10:
		world.advance(0.1)
	check_near(device.get_force().length(), 0.5, 0.01, "force within the device's own")
	ProjectSettings.set_setting(LIMIT, 0.0)
	check(proxy.is_touching(), "it does not touch")


## A ball flies through where each of them would be.
func test_a_hand_whose_device_is_not_there_is_nowhere() -> void:
	OS.set_environment("SPNAV_SOCKET", OS.get_user_data_dir().path_join("no_such_spacenavd"))
	var of_their_own := [
		HapticDevice.DRIVER_FORCE_DIMENSION, HapticDevice.DRIVER_OPENHAPTICS, HapticDevice.DRIVER_INVERSE3
	]
	for driver: int in [
		HapticDevice.DRIVER_FALCON,
		HapticDevice.DRIVER_FORCE_DIMENSION,
		HapticDevice.DRIVER_OPENHAPTICS,
		HapticDevice.DRIVER_INVERSE3,
		HapticDevice.DRIVER_GAMEPAD,
		HapticDevice.DRIVER_SPACE_MOUSE,
		HapticDevice.DRIVER_NODE,
	]:
		# One with a thread of its own may be plugged in at any time.
		if driver not in of_their_own:
			expect_error("Device: ")
		var world := add_world()
		var device := _device(world, driver)
		var tip := ProxyPointer.new()
		world.add_child(tip)
		await _play(world, 3)
		var ball := with_shape(RigidBody3D.new(), sphere(0.02), Vector3(-0.1, 0.005, 0)) as RigidBody3D
		ball.linear_velocity = Vector3(1, 0, 0)
		ball.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
		world.add_child(ball)
		world.advance(0.3)
		var said := "driver %d: %s" % [driver, device.get_state_text()]
		check(device.get_state() != HapticDevice.STATE_WORKING, said)
		check(not device.is_device_connected(), said)
		check(not tip.is_present() and not tip.is_touching(), "%s; %s" % [said, tip.get_state_text()])
		check_near(ball.position, Vector3(0.2, 0.005, 0), 2e-3, said)
		world.free()
	OS.unset_environment("SPNAV_SOCKET")


func test_a_pointer_that_is_switched_off_is_nowhere() -> void:
	var world := add_world()
	var tip := add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.1, 0)))
	world.advance(0.01)
	check(tip.is_present(), tip.get_state_text())
	tip.enabled = false
	world.advance(0.01)
	check(not tip.is_present(), tip.get_state_text())


## Trackers lose their place for a frame: the hand stays, and what it presses is pressed on.
func test_a_hand_stays_where_a_node_was_before_it_was_nowhere() -> void:
	var world := add_world()
	add_floor(world)
	var leader := Node3D.new()
	leader.name = "Leader"
	leader.position.y = 0.05
	world.add_child(leader)
	var device := _device(world, HapticDevice.DRIVER_NODE)
	device.target = NodePath("../Leader")
	var proxy := ProxyPointer.new()
	world.add_child(proxy)
	proxy.device = NodePath("../Device")
	await _play(world, 30)
	leader.position.y = -0.01
	await _play(world, 30)
	var pressed := device.get_displayed_force()
	var place := device.get_hand_position()
	check(pressed.y > 1.0, "pressed with %s" % pressed)
	expect_error("Device: it stays where it was")
	for far: float in [2e6, INF, NAN]:
		leader.position.x = far
		await _play(world, 2)
		check(
			device.get_state_text().contains("stays where it was"),
			"at %s m: %s" % [far, device.get_state_text()]
		)
		check_near(device.get_hand_position(), place, 1e-4, "hand")
		check_near(device.get_displayed_force(), pressed, 0.05, "force")
		leader.position.x = 0.0
		await _play(world, 2)
		check_equal(device.get_state_text(), "connected", "back")
