extends "nodes_case.gd"
## Worlds of which Godot's own physics moves the bodies, and a game that keeps no time and changes everything
## under the hand.

const FRAME := 1.0 / 60.0
# The hand rests 10 mm deep in 500 N/m.
const PRESSED := 5.0
# A force may change by no more within a tick: as the slowest of the blends has it, with room for the hand.
const LARGEST_STEP := 2.0


func _exit_tree() -> void:
	Engine.physics_ticks_per_second = 60
	Engine.time_scale = 1.0
	get_tree().paused = false
	get_tree().physics_interpolation = false


func _block(world: HapticWorld, at: Vector3, label := "Block") -> RigidBody3D:
	var block := with_shape(RigidBody3D.new(), box(Vector3.ONE * 0.1), at) as RigidBody3D
	block.name = label
	block.mass = 0.5
	block.can_sleep = false
	world.add_child(block)
	return block


## What the hand feels over some ticks.
class Felt:
	var last := Vector3.ZERO
	var largest := 0.0
	var largest_step := 0.0

	func take(force: Vector3) -> void:
		largest = maxf(largest, force.length())
		largest_step = maxf(largest_step, force.distance_to(last))
		last = force


func _ticks(world: HapticWorld, count: int, felt: Felt) -> void:
	for _i in count:
		world.advance(TICK)
		felt.take((world.get_node("Device") as HapticDevice).get_displayed_force())


## `frames`: ticks of the world after each of Godot's frames, over and over.
func _push(frames: PackedInt32Array, ticks_a_second := 60) -> Dictionary:
	Engine.physics_ticks_per_second = ticks_a_second
	await get_tree().physics_frame
	var world := add_godot_world(material(500.0))
	add_floor(world).physics_material_override.friction = 0.4
	var block := _block(world, Vector3(0, 0.05, 0))
	add_hand(world, path(Vector3(-0.1, 0.05, 0), Vector3(0.1, 0.05, 0), 2.0))
	var felt := Felt.new()
	var ticks := 0
	var i := 0
	while ticks < 3000:
		await get_tree().physics_frame
		await _ticks(world, frames[i % frames.size()], felt)
		ticks += frames[i % frames.size()]
		i += 1
	var result := {"place": block.position, "felt": felt}
	world.free()
	return result


func test_frames_that_come_late_and_in_bursts() -> void:
	var even := await _push([16, 17, 17])
	for frames: PackedInt32Array in [[50, 0, 0], [0, 0, 0, 0, 0, 100], [33, 0, 17, 16, 1, 33]]:
		var uneven := await _push(frames)
		var off: float = (uneven.place as Vector3).distance_to(even.place)
		check(off < 0.03, "%s: off by %.3f m" % [frames, off])
		check(uneven.felt.largest < even.felt.largest + 5.0, "%s: %s N" % [frames, uneven.felt.largest])


func test_any_number_of_frames_a_second() -> void:
	var even := await _push([16, 17, 17])
	for one: Array in [[30, PackedInt32Array([33, 33, 34])], [120, PackedInt32Array([8, 8, 9])]]:
		var other := await _push(one[1], one[0])
		var off: float = (other.place as Vector3).distance_to(even.place)
		check(off < 0.01, "%s Hz: off by %.4f m" % [one[0], off])


func test_physics_interpolation_changes_nothing() -> void:
	var without := await _push([16, 17, 17])
	get_tree().physics_interpolation = true
	var with_it := await _push([16, 17, 17])
	check_equal(with_it.place, without.place, "place")
	check_equal(with_it.felt.largest, without.felt.largest, "largest force")


## The rate of the frames changes while the hand pushes, and so does the time of the game.
func test_a_game_that_changes_its_time() -> void:
	var world := add_godot_world(material(500.0))
	add_floor(world).physics_material_override.friction = 0.4
	var block := _block(world, Vector3(0, 0.05, 0))
	add_hand(world, path(Vector3(-0.1, 0.05, 0), Vector3(0.1, 0.05, 0), 2.0))
	var felt := Felt.new()
	for part: Array in [
		[60, 1.0, 60], [30, 1.0, 30], [120, 1.0, 60], [60, 0.5, 60], [60, 2.0, 30], [60, 1.0, 60]
	]:
		Engine.physics_ticks_per_second = part[0]
		Engine.time_scale = part[1]
		for _frame: int in part[2]:
			await get_tree().physics_frame
			_ticks(world, roundi(1000.0 * part[1] / part[0]), felt)
	check(felt.largest < 12.0, "%s N" % felt.largest)
	check(block.position.is_finite() and block.position.x > 0.1, "the block is at %s" % block.position)
	check_near(block.position.y, 0.05, 0.01, "height")


## In real time a hand goes on as fast: it feels what is slow, and throws it not.
func test_slow_motion_throws_no_body() -> void:
	var world := add_godot_world(material(500.0))
	world.clock = HapticWorld.CLOCK_REAL_TIME
	add_floor(world)
	var block := _block(world, Vector3(0, 0.05, 0))
	var way := path(Vector3(-0.1, 0.05, 0), Vector3(0.1, 0.05, 0), 2.0)
	var proxy := add_hand(world, way)
	(world.get_node("Device") as HapticDevice).driver = HapticDevice.DRIVER_SIMULATED_ARM
	expect_error("hands feel its bodies and push none")
	var fastest := 0.0
	var touched := false
	Engine.time_scale = 0.1
	for _i in 180:
		await get_tree().physics_frame
		fastest = maxf(fastest, block.linear_velocity.length())
		touched = touched or proxy.is_touching()
	check(touched, "the hand feels nothing")
	check(fastest < 0.05, "the block goes with %s m/s" % fastest)
	check_near(block.position, Vector3(0, 0.05, 0), 0.005, "place of the block")


## The tree is paused while the hand presses: nothing is kept up for the body. A script may advance a world
## then, and a body that goes on in a pause is not moved by Godot either.
func test_a_pause_saves_up_no_impulse() -> void:
	for mode: ProcessMode in [PROCESS_MODE_PAUSABLE, PROCESS_MODE_ALWAYS]:
		for of_block: ProcessMode in [PROCESS_MODE_PAUSABLE, PROCESS_MODE_ALWAYS]:
			await _pause(mode, of_block)


func _pause(mode: ProcessMode, of_block: ProcessMode) -> void:
	var what := "world %s, block %s" % [mode, of_block]
	process_mode = PROCESS_MODE_ALWAYS
	var world := add_godot_world(material(500.0))
	world.process_mode = mode
	add_floor(world).physics_material_override.friction = 0.2
	var block := _block(world, Vector3(0, 0.05, 0))
	block.process_mode = of_block
	add_hand(world, path(Vector3(-0.1, 0.05, 0), Vector3(-0.05, 0.05, 0), 0.5))
	var felt := Felt.new()
	var fastest := 0.0
	for i in 90:
		get_tree().paused = i >= 30 and i < 60
		await get_tree().physics_frame
		_ticks(world, 17, felt)
		fastest = maxf(fastest, block.linear_velocity.length())
	check(fastest < 0.3, "%s: %s m/s" % [what, fastest])
	check(absf(block.position.x) < 0.02, "%s: the block is at %s" % [what, block.position])
	check(felt.largest < 12.0, "%s: %s N" % [what, felt.largest])
	check(felt.largest_step < 0.5, "%s: %s N in a tick" % [what, felt.largest_step])
	world.free()


## Each change happens while the hand presses down on the block. Whatever it is, the force stays within what
## the hand was pressed with, and does not jump.
func _change(change: Callable, stays_pressed: bool, what: String) -> void:
	var world := add_godot_world(material(500.0))
	add_floor(world)
	var block := _block(world, Vector3(0, 0.05, 0))
	var proxy := add_hand(world, path(Vector3(0.01, 0.3, 0.01), Vector3(0.01, 0.1, 0.01), 0.5))
	var felt := Felt.new()
	for i in 90:
		await get_tree().physics_frame
		_ticks(world, 17, felt)
	# Godot's own engines press bodies into each other.
	check_near(proxy.get_force(), Vector3(0, PRESSED, 0), 2.0, what + ": force before")
	felt.largest_step = 0.0
	change.call(world, block)
	for i in 60:
		await get_tree().physics_frame
		_ticks(world, 17, felt)
	check(felt.largest < PRESSED + 3.0, "%s: %s N" % [what, felt.largest])
	check(felt.largest_step < LARGEST_STEP, "%s: %s N in a tick" % [what, felt.largest_step])
	check_equal(proxy.is_touching(), stays_pressed, what + ": touches")
	world.free()


func test_a_body_is_freed_under_the_hand() -> void:
	await _change(func(_w: Node, block: Node) -> void: block.free(), false, "freed")


func test_a_body_is_reparented_under_the_hand() -> void:
	var beside := Node3D.new()
	var move := func(world: Node, block: Node) -> void:
		world.add_child(beside)
		block.reparent(beside)
	await _change(move, true, "reparented")


func test_a_body_leaves_the_world_under_the_hand() -> void:
	await _change(func(_w: Node, block: Node) -> void: block.reparent(self), false, "taken out")


func test_a_body_freezes_under_the_hand() -> void:
	var freeze := func(_w: Node, block: RigidBody3D) -> void: block.freeze = true
	await _change(freeze, true, "frozen")


func test_a_body_is_teleported_from_under_the_hand() -> void:
	var put := func(_w: Node, block: Node3D) -> void: block.global_position.x += 0.5
	await _change(put, false, "teleported")


func test_a_body_is_teleported_far_away_and_back() -> void:
	var put := func(_w: Node, block: RigidBody3D) -> void:
		block.freeze = true
		var here := block.global_position
		block.global_position.x += 20.0
		await get_tree().create_timer(0.3).timeout
		block.global_position = here
	await _change(put, true, "away and back")


func test_a_shape_grows_under_the_hand() -> void:
	var grow := func(_w: Node, block: Node) -> void:
		((block.get_node("Shape") as CollisionShape3D).shape as BoxShape3D).size = Vector3(0.12, 0.1, 0.12)
	await _change(grow, true, "grown")


func test_a_body_changes_its_layer_under_the_hand() -> void:
	var change := func(_w: Node, block: RigidBody3D) -> void: block.collision_layer = 1 << 5
	await _change(change, true, "on another layer")


func test_a_body_is_disabled_under_the_hand() -> void:
	var change := func(_w: Node, block: Node) -> void: block.process_mode = PROCESS_MODE_DISABLED
	await _change(change, false, "disabled")


## What Godot's own solver makes of a body for some frames, and then no more. The hand, which goes up and
## presses once more, feels the body again, and never more than its device may give.
func test_bodies_whose_engine_fails() -> void:
	var engine: String = ProjectSettings.get_setting("physics/3d/physics_engine")
	expect_error("must be normalized")
	expect_error("is not supported by Jolt" if engine == "Jolt Physics" else "Object went too far away")
	var none := Vector3(NAN, NAN, NAN)
	for broken: Array in [
		[PhysicsServer3D.BODY_STATE_LINEAR_VELOCITY, none],
		[PhysicsServer3D.BODY_STATE_ANGULAR_VELOCITY, none],
		[PhysicsServer3D.BODY_STATE_LINEAR_VELOCITY, Vector3(0, INF, 0)],
		[PhysicsServer3D.BODY_STATE_LINEAR_VELOCITY, Vector3(1e6, 0, 0)],
		[PhysicsServer3D.BODY_STATE_ANGULAR_VELOCITY, Vector3(0, 0, 1e6)],
		[PhysicsServer3D.BODY_STATE_TRANSFORM, Transform3D(Basis.IDENTITY, none)],
		[PhysicsServer3D.BODY_STATE_TRANSFORM, Transform3D(Basis(none, none, none), Vector3.ZERO)],
	]:
		await _fail(broken[0], broken[1])


func _fail(state: PhysicsServer3D.BodyState, value: Variant) -> void:
	var what := "state %s is %s" % [state, value]
	var world := add_godot_world(material(500.0))
	add_floor(world)
	var block := _block(world, Vector3(0, 0.05, 0))
	var up := Vector3(0.01, 0.3, 0.01)
	var down := Vector3(0.01, 0.1, 0.01)
	var way := path(up, down)
	way.points_positions = PackedVector3Array([up, down, down, up, down])
	way.points_times = PackedFloat64Array([0.0, 0.5, 2.0, 2.2, 2.6])
	var proxy := add_hand(world, way)
	var felt := Felt.new()
	var rested := Transform3D.IDENTITY
	for i in 180:
		await get_tree().physics_frame
		if i == 89:
			rested = block.global_transform
			check_near(proxy.get_force(), Vector3(0, PRESSED, 0), 2.0, what + ": force before")
		if i >= 90 and i < 95:
			PhysicsServer3D.body_set_state(block.get_rid(), state, value)
		elif i == 95:
			var server := PhysicsServer3D
			server.body_set_state(block.get_rid(), PhysicsServer3D.BODY_STATE_TRANSFORM, rested)
			server.body_set_state(block.get_rid(), PhysicsServer3D.BODY_STATE_LINEAR_VELOCITY, Vector3.ZERO)
			server.body_set_state(block.get_rid(), PhysicsServer3D.BODY_STATE_ANGULAR_VELOCITY, Vector3.ZERO)
		_ticks(world, 17, felt)
	var limit: float = (world.get_node("Device") as HapticDevice).force_limit
	check(is_finite(felt.largest) and felt.largest < limit + 0.01, "%s: %s N" % [what, felt.largest])
	check(felt.largest_step < LARGEST_STEP, "%s: %s N in a tick" % [what, felt.largest_step])
	if block.global_transform.is_finite():  # Godot Physics may keep what is no number
		check_near(proxy.get_force(), Vector3(0, PRESSED, 0), 2.0, what + ": force after")
	world.free()


## A body is where it is, wherever it was when hands were last close to it.
func test_no_ghost_stays_where_a_hand_has_left() -> void:
	var world := add_godot_world(material(500.0))
	var block := _block(world, Vector3(0, 0, 0))
	block.freeze_mode = RigidBody3D.FREEZE_MODE_KINEMATIC
	block.freeze = true
	var proxy := add_hand(world, path(Vector3(0.0, 0.058, 0), Vector3(0.0, 0.058, 0)))
	var device := world.get_node("Device") as Node3D
	for _i in 30:
		await get_tree().physics_frame
		world.advance(FRAME)
	device.position.y = 30.0
	for _i in 60:
		await get_tree().physics_frame
		world.advance(FRAME)
	block.global_position = Vector3(10, 0, 0)
	for _i in 10:
		await get_tree().physics_frame
		world.advance(FRAME)
	check_equal(world.intersect_ray(Vector3(10, 5, 0), Vector3(10, -5, 0)).get("body"), block, "in a query")
	check_equal(
		world.intersect_ray(Vector3(0, 5, 0), Vector3(0, -5, 0)).get("body"), null, "at the old place"
	)
	device.position.y = 0.0
	var touched := false
	for _i in 60:
		await get_tree().physics_frame
		world.advance(FRAME)
		touched = touched or proxy.is_touching()
	check_equal(touched, false, "touches where it was")
	device.position = Vector3(10, 0.2, 0)
	for i in 60:
		device.position.y = 0.0 if i > 30 else 0.2
		await get_tree().physics_frame
		world.advance(FRAME)
		touched = touched or proxy.is_touching()
	check_equal(touched, true, "touches where it is")
