extends "nodes_case.gd"
## Bodies that Godot's own physics moves, with a damped surface: what a game does to them under a pressing
## hand is felt in small steps.

const SPEEDUP := 16
const DAMPING := 5.0
# Within a tick, besides what the spring follows of a body at about 1 m/s (unit: newtons).
const LARGEST_STEP := 0.5
const OF_SPRING := 0.5


func _exit_tree() -> void:
	Engine.physics_ticks_per_second = 60
	Engine.time_scale = 1.0
	Engine.max_physics_steps_per_frame = 8


func _damped() -> HapticMaterial:
	var result := material(500.0)
	result.damping = DAMPING
	return result


## The largest change of the force within a tick, in the second after the change.
func _largest_step(frames_a_second: int, change: Callable) -> float:
	Engine.physics_ticks_per_second = frames_a_second * SPEEDUP
	Engine.time_scale = SPEEDUP
	Engine.max_physics_steps_per_frame = 8 * SPEEDUP
	await get_tree().physics_frame
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	world.authority = HapticWorld.AUTHORITY_GODOT
	add_child(world)
	world.default_material = _damped()
	add_floor(world).physics_material_override = _damped()
	var block := with_shape(RigidBody3D.new(), box(Vector3.ONE * 0.1), Vector3(0, 0.05, 0)) as RigidBody3D
	block.mass = 0.5
	block.can_sleep = false
	block.physics_material_override = _damped()
	world.add_child(block)
	add_hand(world, path(Vector3(0.01, 0.3, 0.01), Vector3(0.01, 0.1, 0.01), 0.5))
	var device := world.get_node("Device") as HapticDevice
	var pressed := frames_a_second * 3 / 2
	var largest := 0.0
	for frame in pressed + frames_a_second:
		if frame == pressed:
			check(device.get_displayed_force().y > 2.0, "pressed with %s" % device.get_displayed_force())
			change.call(world, block)
			largest = 0.0
		await get_tree().physics_frame
		for _tick in 1000 / frames_a_second:
			var before := device.get_displayed_force()
			world.advance(TICK)
			largest = maxf(largest, device.get_displayed_force().distance_to(before))
	world.free()
	return largest


func _check_change(change: Callable, what: String, of_spring := 0.0) -> void:
	for rate: int in [60, 120]:
		var step: float = await _largest_step(rate, change)
		check(step < LARGEST_STEP + of_spring, "%s at %d Hz: %s N in a tick" % [what, rate, step])


func test_a_body_that_is_put_elsewhere() -> void:
	var up := func(_world: Node, block: Node3D) -> void: block.global_position.y += 0.01
	await _check_change(up, "one centimeter up", OF_SPRING)
	var turned := func(_world: Node, block: Node3D) -> void: block.global_rotation.z += 0.1
	await _check_change(turned, "turned", OF_SPRING)


func test_a_body_that_is_set_going() -> void:
	for speed: float in [-0.5, 0.5]:
		var throw := func(_world: Node, block: RigidBody3D) -> void: block.linear_velocity.y = speed
		await _check_change(throw, "%s m/s" % speed, OF_SPRING)


func test_a_body_that_is_struck() -> void:
	var strike := func(_world: Node, block: RigidBody3D) -> void:
		block.apply_central_impulse(Vector3(0, 0.4, 0))
	await _check_change(strike, "struck", OF_SPRING)


func test_a_body_that_loses_its_floor() -> void:
	await _check_change(func(w: Node, _b: Node) -> void: w.get_node("Floor").free(), "freed", 0.1)
	await _check_change(func(w: Node, _b: Node) -> void: w.get_node("Floor").position.y -= 0.1, "away", 0.1)


func test_a_body_that_grows() -> void:
	for size: Vector3 in [Vector3(0.2, 0.1, 0.2), Vector3(0.1, 0.104, 0.1), Vector3(0.1, 0.09, 0.1)]:
		var grow := func(_world: Node, block: Node) -> void: block.get_node("Shape").shape.size = size
		await _check_change(grow, "%s" % size, OF_SPRING)
