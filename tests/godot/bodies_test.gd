extends "nodes_case.gd"
## The ordinary properties of Godot's bodies, honoured by the world.

const G := 10.0


func _falling_world() -> HapticWorld:
	var world := add_world()
	world.gravity = Vector3(0, -G, 0)
	return world


## A ball without damping.
func _ball(world: HapticWorld, at: Vector3, radius := 0.05) -> RigidBody3D:
	var body := with_shape(RigidBody3D.new(), sphere(radius), at) as RigidBody3D
	body.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	body.angular_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	world.add_child(body)
	return body


func test_gravity_scale_also_while_running() -> void:
	var world := _falling_world()
	var half := _ball(world, Vector3.ZERO)
	half.gravity_scale = 0.5
	var none := _ball(world, Vector3(1, 0, 0))
	none.gravity_scale = 0.0
	world.advance(0.2)
	check_near(half.linear_velocity.y, -0.5 * G * 0.2, 0.02, "speed at half the gravity")
	check_near(none.position.y, 0.0, 1e-6, "place without gravity")
	half.gravity_scale = -0.5
	world.advance(0.2)
	check_near(half.linear_velocity.y, 0.0, 0.02, "speed after as long upwards")


func test_damping_replaces_or_adds_to_that_of_the_project() -> void:
	var world := add_world()
	var replaced := _ball(world, Vector3.ZERO)
	replaced.linear_damp = 2.0
	var combined := _ball(world, Vector3(0, 1, 0))
	combined.linear_damp_mode = RigidBody3D.DAMP_MODE_COMBINE
	combined.linear_damp = 2.0
	var spinning := _ball(world, Vector3(0, 2, 0))
	spinning.angular_damp = 3.0
	replaced.linear_velocity = Vector3(1, 0, 0)
	combined.linear_velocity = Vector3(1, 0, 0)
	spinning.angular_velocity = Vector3(0, 1, 0)
	world.advance(0.5)
	check_near(replaced.linear_velocity.x, exp(-2.0 * 0.5), 2e-3, "speed, replaced")
	check_near(combined.linear_velocity.x, exp(-2.1 * 0.5), 2e-3, "speed, combined")
	check_near(spinning.angular_velocity.y, exp(-3.0 * 0.5), 2e-3, "spin")


func test_bodies_collide_where_a_mask_holds_the_others_layer() -> void:
	var world := _falling_world()
	add_floor(world).collision_layer = 4
	world.get_node("Floor").collision_mask = 0
	var through := _ball(world, Vector3(-0.3, 0.06, 0))
	through.collision_mask = 1
	var held := _ball(world, Vector3(0.3, 0.06, 0))
	held.collision_mask = 4
	world.advance(0.5)
	check(through.position.y < -0.5, "it does not fall through: %s" % through.position)
	check_near(held.position.y, 0.05, 1e-3, "height of the one that is held")
	through.collision_mask = 4
	held.collision_mask = 1
	held.sleeping = false
	held.linear_velocity = Vector3(0, -0.01, 0)
	world.advance(0.5)
	check(held.position.y < -0.5, "it does not fall after its mask has changed: %s" % held.position)


func test_freeze_modes_stand_still_or_push() -> void:
	var world := add_world()
	var kinematic := _ball(world, Vector3.ZERO)
	kinematic.freeze_mode = RigidBody3D.FREEZE_MODE_KINEMATIC
	kinematic.freeze = true
	var free := _ball(world, Vector3(0.11, 0, 0))
	world.advance(0.01)
	for _i in 20:
		kinematic.position.x += 0.005
		world.advance(0.01)
	check(free.position.x > 0.19, "it was not pushed: %s" % free.position)
	check_near(kinematic.position, Vector3(0.1, 0, 0), 1e-5, "place of the frozen one")


func test_a_centre_of_mass_of_its_own_tips_a_box() -> void:
	for shift: float in [0.0, 0.08]:
		var world := _falling_world()
		var table := with_shape(StaticBody3D.new(), box(Vector3(0.1, 0.1, 0.5)), Vector3(0, -0.05, 0))
		world.add_child(table)
		var bar := (
			with_shape(RigidBody3D.new(), box(Vector3(0.3, 0.02, 0.1)), Vector3(0, 0.01, 0)) as RigidBody3D
		)
		bar.center_of_mass_mode = RigidBody3D.CENTER_OF_MASS_MODE_CUSTOM
		bar.center_of_mass = Vector3(shift, 0, 0)
		world.add_child(bar)
		world.advance(0.3)
		var tilt := absf(bar.basis.get_euler().z)
		check((tilt > 0.1) == (shift > 0.0), "shifted by %s m it tilts by %s" % [shift, tilt])
		world.free()


func test_inertia_of_its_own_turns_slower() -> void:
	var spins := []
	for inertia: float in [0.0, 0.1]:
		var world := add_world()
		var body := with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.1, 0.1))) as RigidBody3D
		body.inertia = Vector3.ONE * inertia
		body.add_constant_torque(Vector3(0, 0.01, 0))
		world.add_child(body)
		world.advance(0.5)
		spins.append(body.angular_velocity.y)
		world.free()
	# A cube of 1 kg and 0.1 m has 1/600 kg m²; both are damped by a tenth a second.
	check_near(spins[0], 0.01 * 600.0 * 0.5 * 0.976, 0.02, "spin of the shape's inertia")
	check_near(spins[1], 0.1 * 0.5 * 0.976, 1e-3, "spin of its own inertia")


func test_continuous_detection_stops_a_fast_ball_at_a_thin_wall() -> void:
	var ends := []
	for continuous: bool in [false, true]:
		var world := add_world()
		world.add_child(with_shape(StaticBody3D.new(), box(Vector3(0.002, 1, 1)), Vector3(0.5, 0, 0)))
		var ball := _ball(world, Vector3.ZERO, 0.005)
		ball.continuous_cd = continuous
		ball.linear_velocity = Vector3(90, 0, 0)
		world.advance(0.05)
		ends.append(ball.position.x)
		world.free()
	check(ends[0] > 1.0, "without it the ball stops: %s" % ends[0])
	check(ends[1] < 0.5, "with it the ball passes: %s" % ends[1])


func test_locked_axes_and_rotation() -> void:
	var world := _falling_world()
	var held := _ball(world, Vector3.ZERO)
	held.axis_lock_linear_y = true
	var upright := _ball(world, Vector3(1, 0, 0))
	upright.lock_rotation = true
	upright.angular_velocity = Vector3(0, 5, 0)
	world.advance(0.2)
	check_near(held.position.y, 0.0, 1e-6, "height of the one that may not fall")
	check_near(upright.basis.get_euler(), Vector3.ZERO, 1e-4, "turn of the one that may not turn")


func test_a_compound_of_scaled_and_shifted_shapes_is_one_body() -> void:
	var world := _falling_world()
	add_floor(world, 500.0)
	var dumbbell := RigidBody3D.new()
	for side: float in [-1.0, 1.0]:
		var end := CollisionShape3D.new()
		end.shape = sphere(0.05)
		end.position = Vector3(0.2 * side, 0, 0)
		end.scale = Vector3.ONE * 1.5
		dumbbell.add_child(end)
	var rod := CollisionShape3D.new()
	rod.shape = box(Vector3(0.4, 0.02, 0.02))
	dumbbell.add_child(rod)
	dumbbell.position = Vector3(0, 0.1, 0)
	world.add_child(dumbbell)
	world.advance(1.0)
	check_near(dumbbell.position.y, 0.075, 1e-3, "it lies on its ends")
	var proxy := add_hand(world, path(Vector3(0.2, 0.3, 0), Vector3(0.2, 0.155, 0), 0.1))
	world.advance(0.3)
	check_near(proxy.get_proxy_position().y, 0.16, 1e-3, "proxy on an end")


func test_a_body_scaled_while_running_is_touched_and_collides_at_its_new_size() -> void:
	var world := _falling_world()
	add_floor(world, 500.0)
	var block := (
		with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.1, 0.1)), Vector3(0, 0.05, 0)) as RigidBody3D
	)
	world.add_child(block)
	world.advance(0.2)
	block.get_node("Shape").scale = Vector3(1, 2, 1)
	block.position.y = 0.11
	world.advance(0.5)
	check_near(block.position.y, 0.1, 1e-3, "height of the taller one")
	var proxy := add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0, 0.208, 0), 0.1))
	world.advance(0.3)
	check_near(proxy.get_proxy_position().y, 0.21, 1e-3, "proxy on it")


func test_a_constant_force_and_torque_act_on_a_body() -> void:
	var world := add_world()
	var body := _ball(world, Vector3.ZERO)
	body.mass = 2.0
	body.constant_force = Vector3(4, 0, 0)
	world.advance(0.5)
	check_near(body.linear_velocity.x, 1.0, 5e-3, "speed")
	body.constant_force = Vector3.ZERO
	world.advance(0.5)
	check_near(body.linear_velocity.x, 1.0, 5e-3, "speed after the force has gone")


func test_velocities_set_by_a_script_act_at_once() -> void:
	var world := add_world()
	var body := _ball(world, Vector3.ZERO)
	world.advance(0.01)
	body.linear_velocity = Vector3(0, 2, 0)
	body.angular_velocity = Vector3(1, 0, 0)
	world.advance(0.1)
	check_near(body.position.y, 0.2, 5e-3, "place")
	check_near(body.basis.get_euler().x, 0.1, 5e-3, "turn")


func test_friction_and_bounce_between_bodies() -> void:
	var ways := []
	for friction: float in [0.0, 0.8]:
		var world := _falling_world()
		add_floor(world).physics_material_override.friction = friction
		var block := with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.1, 0.1)), Vector3(-0.5, 0.05, 0))
		block.linear_velocity = Vector3(1, 0, 0)
		world.add_child(block)
		world.advance(0.5)
		ways.append(block.position.x)
		world.free()
	check(ways[0] > -0.1 and ways[1] < -0.4, "places after sliding: %s" % [ways])
	var bouncing := _falling_world()
	add_floor(bouncing).physics_material_override.bounce = 0.8
	var ball := _ball(bouncing, Vector3(0, 0.55, 0))
	bouncing.advance(0.4)
	check(ball.linear_velocity.y > 1.0, "it does not bounce: %s" % ball.linear_velocity)


# A large inertia about one axis keeps a body upright. No body has it, but it is felt and falls all the same.
func test_an_impossible_inertia_is_named_and_keeps_the_body_upright() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -9.81, 0)
	var body := with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.1, 0.1))) as RigidBody3D
	body.name = "Upright"
	body.inertia = Vector3(1000, 0.01, 0.01)
	body.add_constant_torque(Vector3(0.1, 0, 0))
	world.add_child(body)
	world.advance(0.5)
	check(body.position.y < -1.0, "it moves, to %s" % body.position)
	check(body.angular_velocity.length() < 1e-3, "it stays upright: %s" % body.angular_velocity)
	var problems := "\n".join(world.get_problems())
	check("Upright" in problems and "no body has the inertia" in problems, "named: %s" % problems)
	world.free()


func test_mass_and_inertia_of_the_library() -> void:
	var world := add_world()
	var speeds := []
	for use: bool in [false, true]:
		var body := RigidBody3D.new()
		body.position.y = 3.0 * speeds.size()
		body.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
		body.angular_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
		body.constant_force = Vector3(0.6, 0, 0)
		body.constant_torque = Vector3(0, 0.001, 0)
		# What collides is far larger than what is touched and weighed.
		with_shape(body, box(Vector3(1, 1, 1)), body.position)
		var mesh := HapticMesh.new()
		mesh.library_mesh = "cube"
		mesh.use_library_mass = use
		body.add_child(mesh)
		world.add_child(body)
		world.advance(0.5)
		speeds.append([body.linear_velocity.x, body.angular_velocity.y])
		world.remove_child(body)
		body.free()
	check_near(speeds[0][0], 0.3, 2e-3, "speed of 1 kg")
	check_near(speeds[1][0], 0.5, 3e-3, "speed of the library's 0.6 kg")
	# A box of 1 m and 1 kg has 1/6 kg m²; the library's cube of 0.1 m has 0.6/600.
	check_near(speeds[0][1], 0.001 * 6.0 * 0.5, 1e-4, "spin of the box")
	check_near(speeds[1][1], 0.001 * 1000.0 * 0.5, 1e-2, "spin of the library's cube")


func test_a_scaled_library_mesh_weighs_what_its_size_says() -> void:
	var world := add_world()
	var body := RigidBody3D.new()
	body.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	body.constant_force = Vector3(4.8, 0, 0)
	var mesh := HapticMesh.new()
	mesh.library_mesh = "cube"
	mesh.use_library_mass = true
	mesh.scale = Vector3(2, 2, 2)
	body.add_child(mesh)
	world.add_child(body)
	world.advance(0.5)
	check_near(body.linear_velocity.x, 0.5, 3e-3, "speed of 4.8 kg")


func test_a_body_that_is_too_light_for_its_surface_says_so() -> void:
	var world := add_world()
	for mass: float in [0.003, 0.005]:
		var ball := RigidBody3D.new()
		ball.name = "Feather" if mass < 0.004 else "Pebble"
		ball.mass = mass
		ball.position.x = 100.0 * mass
		var material := HapticMaterial.new()
		material.stiffness = 1000.0
		material.damping = 3.0
		ball.physics_material_override = material
		var shape := CollisionShape3D.new()
		shape.shape = SphereShape3D.new()
		shape.shape.radius = 0.01
		ball.add_child(shape)
		world.add_child(ball)
	expect_error("its mass of 0.003 kg is too small")
	world.advance(0.1)
	var problems := "\n".join(world.get_problems())
	check(problems.contains("Feather") and problems.contains("at least 0.004 kg"), problems)
	check(not problems.contains("Pebble"), problems)
	check("\n".join(world._list_warnings()).contains("'Feather'"), "no configuration warning")


func test_a_mesh_without_a_mass_in_the_library_says_so() -> void:
	var mesh := HapticMesh.new()
	mesh.use_library_mass = true
	mesh.mesh = BoxMesh.new()
	check(" ".join(mesh.get_problems()).contains("gives its body no mass"), "no warning")
	mesh.free()
