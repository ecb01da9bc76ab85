extends "nodes_case.gd"
## A pause leaves the hand alone.


func _standing(world: HapticWorld) -> ProxyPointer:
	add_floor(world, 300.0)
	return add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1))


func test_pausing_the_tree_stops_the_real_time_loop() -> void:
	var world := HapticWorld.new()
	add_child(world)
	check(await until(func() -> bool: return world.get_ticks() > 50, 5.0), "it does not tick")
	get_tree().paused = true
	var ticks := world.get_ticks()
	await get_tree().create_timer(0.1).timeout
	check_equal(world.get_ticks(), ticks, "ticks while paused")
	get_tree().paused = false
	check(await until(func() -> bool: return world.get_ticks() > ticks + 50, 5.0), "it does not go on")


func test_pausing_leaves_the_device_without_a_force_and_unpausing_goes_on() -> void:
	var world := HapticWorld.new()
	world.gravity = Vector3.ZERO
	add_child(world)
	var proxy := _standing(world)
	var device: HapticDevice = world.get_node("Device")
	check(await until(func() -> bool: return device.get_force().y > 5.99, 5.0), "no force before the pause")
	get_tree().paused = true
	check_near(device.get_force(), Vector3.ZERO, 0.0, "force on the device while paused")
	check_near(proxy.get_force(), Vector3.ZERO, 0.0, "force of the proxy while paused")
	await get_tree().create_timer(0.1).timeout
	check_near(device.get_force(), Vector3.ZERO, 0.0, "force on the device after a while")
	get_tree().paused = false
	check(await until(func() -> bool: return device.get_force().y > 5.99, 5.0), "no force after the pause")


func test_a_paused_world_of_stepped_time_lets_go_of_the_device() -> void:
	var world := add_world()
	_standing(world)
	world.advance(0.3)
	var device: HapticDevice = world.get_node("Device")
	check_near(device.get_force().y, 6.0, 1e-3, "force before")
	world.process_mode = Node.PROCESS_MODE_DISABLED
	await frames(1)
	check_near(device.get_force(), Vector3.ZERO, 0.0, "force while disabled")
	world.process_mode = Node.PROCESS_MODE_INHERIT
	world.advance(TICK)
	check_near(device.get_force().y, 6.0, 1e-3, "force after")
