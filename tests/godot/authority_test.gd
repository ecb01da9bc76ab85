extends "nodes_case.gd"
## Worlds of which Godot's own physics moves the bodies.

const FRAME := 1.0 / 60.0
const SPEEDUP := 8


class Jumper:
	extends RigidBody3D
	var frames := 0
	var integrated := 0

	func _physics_process(_delta: float) -> void:
		frames += 1
		if frames % 90 == 30:
			apply_central_impulse(Vector3(0.2, 3, 0))

	func _integrate_forces(_state: PhysicsDirectBodyState3D) -> void:
		integrated += 1


class Walker:
	extends CharacterBody3D

	func _physics_process(delta: float) -> void:
		velocity = Vector3(0.8, velocity.y - 9.8 * delta, 0)
		move_and_slide()


## What a game has, and what it counts: a vehicle, a stack, an area, a character, a body with a script.
class Game:
	extends Node3D
	var signals := {"entered": 0, "exited": 0, "slept": 0, "hit": 0}
	var jumper := Jumper.new()
	var walker := Walker.new()
	var vehicle := VehicleBody3D.new()
	var stack: Array[RigidBody3D] = []

	func count(what: String) -> void:
		signals[what] += 1

	func build(case: Node) -> void:
		var ground := StaticBody3D.new()
		add_child(case.with_shape(ground, case.box(Vector3(200, 1, 200)), Vector3(0, -0.5, 0)))
		for i in 4:
			var block := RigidBody3D.new()
			block.sleeping_state_changed.connect(count.bind("slept"))
			stack.append(block)
			add_child(case.with_shape(block, case.box(Vector3.ONE * 0.4), Vector3(0, 0.21 + 0.41 * i, 0)))
		var area := Area3D.new()
		area.body_entered.connect(count.bind("entered").unbind(1))
		area.body_exited.connect(count.bind("exited").unbind(1))
		add_child(case.with_shape(area, case.box(Vector3(1, 2, 1)), Vector3(-3, 1, 2)))
		add_child(case.with_shape(walker, case.box(Vector3(0.4, 1, 0.4)), Vector3(-6, 0.52, 2)))
		jumper.contact_monitor = true
		jumper.max_contacts_reported = 4
		jumper.body_entered.connect(count.bind("hit").unbind(1))
		add_child(case.with_shape(jumper, case.box(Vector3.ONE * 0.3), Vector3(0, 0.2, -4)))
		vehicle.mass = 40
		vehicle.can_sleep = false
		for at in [
			Vector3(-0.4, -0.2, 0.6),
			Vector3(0.4, -0.2, 0.6),
			Vector3(-0.4, -0.2, -0.6),
			Vector3(0.4, -0.2, -0.6)
		]:
			var wheel := VehicleWheel3D.new()
			wheel.position = at
			wheel.wheel_radius = 0.2
			wheel.use_as_traction = true
			wheel.suspension_stiffness = 60.0
			wheel.damping_compression = 4.0
			wheel.damping_relaxation = 6.0
			vehicle.add_child(wheel)
			wheel.engine_force = 20.0
		add_child(case.with_shape(vehicle, case.box(Vector3(0.8, 0.3, 1.6)), Vector3(6, 0.6, 0)))

	func places() -> Dictionary:
		var found := {"jumper": jumper.position, "walker": walker.position, "vehicle": vehicle.position}
		for i in stack.size():
			found["block %d" % i] = stack[i].position
		return found


## Faster than the clock: as many frames of the same length in less time.
func _hurry(fast: bool, frames_a_second := 60) -> void:
	Engine.physics_ticks_per_second = frames_a_second * (SPEEDUP if fast else 1)
	Engine.time_scale = SPEEDUP if fast else 1
	Engine.max_physics_steps_per_frame = 8 * (SPEEDUP if fast else 1)


## `above`: a world, or what stands in for one.
func _play(above: Node, game: Game, seconds: float) -> void:
	await get_tree().physics_frame
	var world := above as HapticWorld
	game.build(self)
	above.add_child(game)
	for _i in int(seconds / FRAME):
		await get_tree().physics_frame
		if world != null:
			world.advance(FRAME)


## A space of Godot's physics for itself, where bodies get the same numbers in every run. In one that has had
## bodies before, Jolt itself leaves the stack up to 4 mm elsewhere.
func _add_space() -> SubViewport:
	var space := SubViewport.new()
	space.own_world_3d = true
	space.render_target_update_mode = SubViewport.UPDATE_DISABLED
	add_child(space)
	return space


func test_a_game_goes_on_as_without() -> void:
	_hurry(true)
	var alone := Game.new()
	await _play(_add_space(), alone, 10.0)
	var places := alone.places()
	var signals := alone.signals.duplicate()
	var integrated := alone.jumper.integrated
	alone.get_parent().queue_free()
	await get_tree().physics_frame
	var world := add_godot_world()
	world.reparent(_add_space())
	add_hand(world, path(Vector3(0, 3, 3), Vector3(1, 3, 3)))
	var game := Game.new()
	await _play(world, game, 10.0)
	_hurry(false)
	for what: String in places:
		check_near(game.places()[what], places[what], 0.001, what)
	check_equal(game.signals, signals, "signals")
	check_equal(game.jumper.integrated, integrated, "calls of _integrate_forces")
	check(absf(game.vehicle.position.z) > 5.0, "the vehicle drives to %s" % game.vehicle.position)
	check(signals.entered == 2 and signals.exited == 1 and signals.hit > 3, "signals: %s" % signals)
	check_equal(world.get_problems(), PackedStringArray(), "problems")


## For four seconds; forces of each tick of 4 ms or less, which are as many at any rate.
func _push_box(world: HapticWorld, frames_a_second: int, told_mass := 0.0) -> Dictionary:
	var slippery := material(500.0)
	slippery.friction = 0.4
	slippery.damping = 10.0
	add_floor(world).physics_material_override = slippery
	var block := with_shape(RigidBody3D.new(), box(Vector3.ONE * 0.1), Vector3(0, 0.05, 0)) as RigidBody3D
	block.mass = 0.5
	block.physics_material_override = slippery
	block.can_sleep = false
	world.add_child(block)
	if told_mass > 0.0:
		block.mass = 4.0
		PhysicsServer3D.body_set_param(block.get_rid(), PhysicsServer3D.BODY_PARAM_MASS, told_mass)
	var proxy := add_hand(world, path(Vector3(-0.1, 0.05, 0), Vector3(0.1, 0.05, 0), 2.0))
	var device: HapticDevice = world.get_node("Device")
	device.path.points_times = PackedFloat64Array([1.0, 3.0])
	var forces := PackedVector3Array()
	for _i in 4 * frames_a_second:
		await get_tree().physics_frame
		for _tick in 600 / frames_a_second:
			world.advance(1.0 / 600.0)
			forces.append(proxy.get_force())
	return {"forces": forces, "place": block.position}


func test_a_hand_pushes_what_godot_moves() -> void:
	_hurry(true)
	var own := add_world()
	own.gravity = Vector3(0, -9.8, 0)
	var there := await _push_box(own, 60)
	own.queue_free()
	for frames_a_second: int in {30: 0.2, 60: 0.1, 120: 0.1}:
		_hurry(true, frames_a_second)
		await get_tree().physics_frame
		var world := add_godot_world()
		var here := await _push_box(world, frames_a_second)
		world.queue_free()
		# While it slides; how hard a hand is held that rests depends on the last millimeter.
		var error := 0.0
		for i in range(900, 1800):
			error += (there.forces[i] as Vector3).distance_to(here.forces[i]) / 900
		check(
			error < {30: 0.2, 60: 0.1, 120: 0.1}[frames_a_second], "%d Hz: %.3f N" % [frames_a_second, error]
		)
		check_near((here.place as Vector3).x, (there.place as Vector3).x, 0.002, "place")
		check((here.place as Vector3).x > 0.15, "it went to %s" % here.place)
	_hurry(false)


func test_a_mass_told_to_the_physics_server_is_the_mass_that_is_felt() -> void:
	_hurry(true)
	var world := add_godot_world()
	var plain := await _push_box(world, 60)
	world.free()
	world = add_godot_world()
	var told := await _push_box(world, 60, 0.5)
	_hurry(false)
	var most := 0.0
	for i in (plain.forces as PackedVector3Array).size():
		most = maxf(most, (plain.forces[i] as Vector3).distance_to(told.forces[i]))
	check(most < 0.05, "%.3f N" % most)


func test_a_scripts_push_reaches_godots_body() -> void:
	var world := add_godot_world()
	var block := with_shape(RigidBody3D.new(), box(Vector3.ONE * 0.1), Vector3(0, 5, 0)) as RigidBody3D
	block.gravity_scale = 0.0
	block.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	world.add_child(block)
	await get_tree().physics_frame
	world.advance(FRAME)
	world.apply_central_impulse(block, Vector3(2, 0, 0))
	await get_tree().physics_frame
	await get_tree().physics_frame
	check_near(block.linear_velocity, Vector3(2, 0, 0), 1e-5, "speed")
	check_near(world.get_linear_velocity(block), Vector3(2, 0, 0), 1e-5, "speed as the world has it")


func _scripted(source: String) -> RigidBody3D:
	var script := GDScript.new()
	script.source_code = "extends RigidBody3D\n" + source
	script.reload()
	var body := with_shape(RigidBody3D.new(), sphere(0.1)) as RigidBody3D
	body.set_script(script)
	return body


## What each of these makes of a world that chooses by itself.
func _chosen(nodes: Array[Node], comes_later := false) -> HapticWorld.Authority:
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	if comes_later:
		add_child(world)
		world.advance(FRAME)
	for node in nodes:
		world.add_child(node)
	if not comes_later:
		add_child(world)
	else:
		world.advance(FRAME)
	var chosen := world.get_authority_in_use()
	world.free()
	return chosen


func test_the_choice_by_itself() -> void:
	var godots: Array[Callable] = [
		func() -> Node: return VehicleWheel3D.new(),
		func() -> Node: return GridMap.new(),
		func() -> Node: return PhysicalBone3D.new(),
		func() -> Node: return _scripted("func _integrate_forces(_state) -> void:\n\tpass\n"),
		func() -> Node: return _scripted("func kick() -> void:\n\tapply_central_impulse(Vector3.UP)\n"),
		func() -> Node:
			var csg := CSGBox3D.new()
			csg.use_collision = true
			return csg,
		func() -> Node:
			var area := Area3D.new()
			area.body_entered.connect(func(_body: Node) -> void: pass)
			return area,
		func() -> Node:
			var body := RigidBody3D.new()
			body.contact_monitor = true
			return body,
	]
	var ours: Array[Callable] = [
		func() -> Node: return with_shape(RigidBody3D.new(), sphere(0.1)),
		func() -> Node: return with_shape(StaticBody3D.new(), sphere(0.1)),
		func() -> Node: return Area3D.new(),
		func() -> Node: return CSGBox3D.new(),
		func() -> Node:
			return _scripted("func kick(world, other) -> void:\n\tworld.apply_central_impulse(other)\n"),
	]
	for later: bool in [false, true]:
		for i in godots.size():
			var made: Array[Node] = [godots[i].call()]
			check_equal(_chosen(made, later), HapticWorld.AUTHORITY_GODOT, "%d, later %s" % [i, later])
		for i in ours.size():
			var made: Array[Node] = [ours[i].call()]
			check_equal(_chosen(made, later), HapticWorld.AUTHORITY_HAPTIC, "ours %d, later %s" % [i, later])
	var with_link: Array[Node] = [GridMap.new(), MMTLink.new()]
	(with_link[1] as MMTLink).scenario = MMTLink.SCENARIO_MMT
	check_equal(_chosen(with_link), HapticWorld.AUTHORITY_HAPTIC, "with a link")


## Its parent connects the signal when the world has begun with the bodies in its own hands: nothing is lost.
func test_a_choice_that_is_made_late_loses_no_motion() -> void:
	var places: Array[Vector3] = []
	for with_world: bool in [false, true]:
		await get_tree().physics_frame
		var world := HapticWorld.new() if with_world else Node3D.new()
		if with_world:
			world.clock = HapticWorld.CLOCK_STEPPED
		var ball := with_shape(RigidBody3D.new(), sphere(0.1), Vector3(0, 2, 0)) as RigidBody3D
		ball.linear_velocity = Vector3(1, 2, 3)
		ball.angular_velocity = Vector3(0, 4, 0)
		var area := Area3D.new()
		world.add_child(ball)
		world.add_child(area)
		add_child(world)
		area.body_entered.connect(func(_body: Node) -> void: pass)
		for _i in 30:
			await get_tree().physics_frame
		places.append(ball.position)
		if with_world:
			check_equal((world as HapticWorld).get_authority_in_use(), HapticWorld.AUTHORITY_GODOT, "choice")
		world.free()
	check_equal(places[1], places[0], "place")
	check(places[0].x > 0.3, "it went to %s" % places[0])


func test_a_soft_body_without_a_mesh_is_said() -> void:
	var world := add_godot_world()
	var soft := SoftBody3D.new()
	soft.name = "Soft"
	world.add_child(soft)
	add_hand(world, path(Vector3(0, 0.1, 0), Vector3.ZERO))
	expect_error("a SoftBody3D without a mesh of indexed triangles is not felt")
	for _i in 3:
		await get_tree().physics_frame
		world.advance(FRAME)
	check("\n".join(world.get_problems()).contains("Soft"), "%s" % world.get_problems())


## A vehicle comes while a hand presses: nothing is taken from the hand, and Godot takes over once it has let
## go.
func test_a_choice_waits_for_the_hand() -> void:
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	world.default_material = material(500.0)
	add_child(world)
	add_floor(world)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, 0.0, 0), 0.2))
	var device := world.get_node("Device") as HapticDevice
	for _i in 30:
		await get_tree().physics_frame
		world.advance(FRAME)
	check_near(device.get_displayed_force(), Vector3(0, 5, 0), 1e-3, "pressed with")
	expect_error("Godot's own physics is to move its bodies, because")
	world.add_child(VehicleWheel3D.new())
	var largest := 0.0
	for _i in 500:
		var before := device.get_displayed_force()
		world.advance(0.001)
		largest = maxf(largest, before.distance_to(device.get_displayed_force()))
	check(proxy.is_touching(), "it touches nothing")
	check(largest < 0.01, "%s N in a tick" % largest)
	check_equal(world.get_authority_in_use(), HapticWorld.AUTHORITY_HAPTIC, "while it presses")
	device.position.y = 0.1
	for _i in 30:
		await get_tree().physics_frame
		world.advance(FRAME)
	check_equal(world.get_authority_in_use(), HapticWorld.AUTHORITY_GODOT, "after it")
	largest = 0.0
	for i in 1000:
		if i % 16 == 0:
			await get_tree().physics_frame
		device.position.y = maxf(0.0, device.position.y - 2e-4)
		var before := device.get_displayed_force()
		world.advance(0.001)
		largest = maxf(largest, before.distance_to(device.get_displayed_force()))
	check_near(device.get_displayed_force(), Vector3(0, 5, 0), 1e-2, "pressed again with")
	check(largest < 0.5, "%s N in a tick" % largest)
