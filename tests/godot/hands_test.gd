extends "nodes_case.gd"
## Hands that have no device of their own: keys, a gamepad, a node of the scene.


func _device(world: HapticWorld, driver: HapticDevice.Driver) -> HapticDevice:
	var device := HapticDevice.new()
	device.name = "Device"
	device.driver = driver
	world.add_child(device)
	return device


func _key(code: Key, pressed: bool) -> void:
	var event := InputEventKey.new()
	event.physical_keycode = code
	event.keycode = code
	event.pressed = pressed
	Input.parse_input_event(event)
	Input.flush_buffered_events()


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
	_key(KEY_RIGHT, true)
	await _play(world, 60)
	_key(KEY_RIGHT, false)
	# The camera looks along -x: right is -z. At the end of its reach it goes no farther.
	check_near(device.get_hand_position(), Vector3(0, 0, -0.1), 1e-4, "to the right")
	await _play(world, 10)
	check_near(device.get_hand_position(), Vector3(0, 0, -0.1), 1e-4, "let go")
	_key(KEY_SPACE, true)
	await _play(world, 2)
	check_equal(device.get_buttons(), 1, "space")
	_key(KEY_SPACE, false)


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


func test_a_hand_without_its_node_says_so() -> void:
	var device := HapticDevice.new()
	device.driver = HapticDevice.DRIVER_NODE
	check(device.get_state_text().contains("set 'target' to a Node3D"), device.get_state_text())
	var warnings := "\n".join(device.get_warnings())
	check(warnings.contains("set 'target'"), warnings)
	device.free()


func test_what_another_driver_needs_is_not_shown() -> void:
	var device := HapticDevice.new()
	for driver: int in [HapticDevice.DRIVER_KEYBOARD, HapticDevice.DRIVER_GAMEPAD, HapticDevice.DRIVER_NODE]:
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
