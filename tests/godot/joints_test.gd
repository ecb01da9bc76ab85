extends "nodes_case.gd"
## Godot's joint nodes, carried out by the world, with limits that mean what they mean to Godot.


## A body that nothing pulls; `frozen` ones hold the other end of a joint.
func _block(world: HapticWorld, name_of_it: String, at: Vector3, frozen := false) -> RigidBody3D:
	var body := with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.1, 0.1)), at) as RigidBody3D
	body.name = name_of_it
	body.freeze = frozen
	body.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	body.angular_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	world.add_child(body)
	return body


func _joined(world: HapticWorld, joint: Joint3D, a: String, b: String) -> void:
	joint.name = "Joint"
	joint.node_a = NodePath("../" + a) if a != "" else NodePath()
	joint.node_b = NodePath("../" + b) if b != "" else NodePath()
	world.add_child(joint)


## Where a body that is driven at this speed ends: its way along x.
func _slid(joint: Joint3D, speed: float) -> float:
	var world := add_world()
	_block(world, "A", Vector3.ZERO, true)
	var b := _block(world, "B", Vector3(0, 0.5, 0))
	_joined(world, joint, "A", "B")
	for _i in 1200:
		b.linear_velocity = Vector3(speed, 0, 0)
		world.advance(TICK)
	var way := b.position.x
	world.free()
	return way


## How far a body that is driven at this speed turns about the axis.
func _turned(joint: Joint3D, axis: Vector3, speed: float, a := "A") -> float:
	var world := add_world()
	_block(world, "A", Vector3.ZERO, true)
	var b := _block(world, "B", Vector3.ZERO)
	b.collision_layer = 0
	b.collision_mask = 0
	_joined(world, joint, a, "B")
	for _i in 40:
		b.angular_velocity = axis * speed
		world.advance(0.05)
	var turn := b.basis.get_rotation_quaternion()
	var angle := turn.get_angle() * signf(turn.get_axis().dot(axis))
	world.free()
	return angle


func _hinge(lower: float, upper: float) -> HingeJoint3D:
	var joint := HingeJoint3D.new()
	joint.set_flag(HingeJoint3D.FLAG_USE_LIMIT, true)
	joint.set_param(HingeJoint3D.PARAM_LIMIT_LOWER, lower)
	joint.set_param(HingeJoint3D.PARAM_LIMIT_UPPER, upper)
	return joint


func test_a_hinge_turns_within_its_limits_as_in_godot() -> void:
	check_near(_turned(_hinge(-0.2, 0.8), Vector3.BACK, 1.0), 0.2, 0.02, "angle one way")
	check_near(_turned(_hinge(-0.2, 0.8), Vector3.BACK, -1.0), -0.8, 0.02, "angle the other way")
	check_near(_turned(_hinge(-0.2, 0.8), Vector3.BACK, 1.0, ""), 0.8, 0.02, "angle against the world")


func test_a_hinge_turns_about_nothing_else() -> void:
	check_near(_turned(_hinge(-0.2, 0.8), Vector3.UP, 1.0), 0.0, 0.02, "angle")


func test_a_slider_slides_within_its_limits() -> void:
	for speed: float in [1.0, -1.0]:
		var joint := SliderJoint3D.new()
		joint.set_param(SliderJoint3D.PARAM_LINEAR_LIMIT_LOWER, -0.2)
		joint.set_param(SliderJoint3D.PARAM_LINEAR_LIMIT_UPPER, 0.8)
		check_near(_slid(joint, speed), 0.8 if speed > 0.0 else -0.2, 0.01, "way")


func test_a_joint_of_six_axes_keeps_to_each_limit() -> void:
	for speed: float in [1.0, -1.0]:
		var joint := Generic6DOFJoint3D.new()
		joint.set_param_x(Generic6DOFJoint3D.PARAM_LINEAR_LOWER_LIMIT, -0.2)
		joint.set_param_x(Generic6DOFJoint3D.PARAM_LINEAR_UPPER_LIMIT, 0.8)
		check_near(_slid(joint, speed), 0.8 if speed > 0.0 else -0.2, 0.01, "way")
		joint = Generic6DOFJoint3D.new()
		joint.set_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_LOWER_LIMIT, -0.2)
		joint.set_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_UPPER_LIMIT, 0.8)
		check_near(_turned(joint, Vector3.UP, speed), 0.2 if speed > 0.0 else -0.8, 0.02, "angle")


func test_a_pin_holds_a_pendulum() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -9.81, 0)
	var b := _block(world, "B", Vector3(0.5, 0, 0))
	_joined(world, PinJoint3D.new(), "", "B")
	var lowest := 0.0
	for _i in 100:
		world.advance(0.01)
		check_near(b.position.length(), 0.5, 1e-3, "distance from the pin")
		lowest = minf(lowest, b.position.y)
	check(lowest < -0.49, "it swings down to %s m" % lowest)


func test_a_motor_turns_a_hinge_as_in_godot() -> void:
	var world := add_world()
	_block(world, "A", Vector3.ZERO, true)
	var b := _block(world, "B", Vector3(0, 0, 0.3))
	var joint := HingeJoint3D.new()
	joint.set_flag(HingeJoint3D.FLAG_ENABLE_MOTOR, true)
	joint.set_param(HingeJoint3D.PARAM_MOTOR_TARGET_VELOCITY, 2.0)
	joint.set_param(HingeJoint3D.PARAM_MOTOR_MAX_IMPULSE, 10.0)
	_joined(world, joint, "A", "B")
	world.advance(0.5)
	check_near(b.angular_velocity, Vector3(0, 0, -2.0), 0.02, "angular velocity")


func test_a_limit_changed_while_running_holds() -> void:
	var world := add_world()
	_block(world, "A", Vector3.ZERO, true)
	var b := _block(world, "B", Vector3(0, 0.5, 0))
	var joint := SliderJoint3D.new()
	joint.set_param(SliderJoint3D.PARAM_LINEAR_LIMIT_UPPER, 0.1)
	_joined(world, joint, "A", "B")
	for _i in 800:
		b.linear_velocity = Vector3(0.5, 0, 0)
		world.advance(TICK)
	check_near(b.position.x, 0.1, 0.01, "way before")
	joint.set_param(SliderJoint3D.PARAM_LINEAR_LIMIT_UPPER, 0.3)
	for _i in 800:
		b.linear_velocity = Vector3(0.5, 0, 0)
		world.advance(TICK)
	# It counts from where the bodies were first joined, not from where they were when it changed.
	check_near(b.position.x, 0.3, 0.01, "way after")


func test_a_joint_that_goes_lets_go_and_one_that_comes_holds() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -9.81, 0)
	var b := _block(world, "B", Vector3(0, 0.5, 0))
	_joined(world, PinJoint3D.new(), "", "B")
	world.get_node("Joint").position = Vector3(0, 0.5, 0)
	world.advance(0.3)
	check_near(b.position, Vector3(0, 0.5, 0), 1e-3, "place while it is held")
	world.get_node("Joint").free()
	b.sleeping = false
	b.linear_velocity = Vector3(0, -0.01, 0)
	world.advance(0.3)
	check(b.position.y < 0.2, "it does not fall: %s" % b.position)


func test_a_body_made_anew_stays_joined() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -9.81, 0)
	var b := _block(world, "B", Vector3(0.3, 0, 0))
	_joined(world, PinJoint3D.new(), "", "B")
	world.advance(0.1)
	b.mass = 3.0
	b.get_node("Shape").shape.size = Vector3(0.2, 0.1, 0.1)
	for _i in 50:
		world.advance(0.01)
		check_near(b.position.length(), 0.3, 2e-3, "distance from the pin")


func test_a_door_on_a_hinge_is_pushed_open() -> void:
	var world := add_world()
	var door := (
		with_shape(RigidBody3D.new(), box(Vector3(0.3, 0.4, 0.02)), Vector3(0.15, 0, 0)) as RigidBody3D
	)
	door.name = "Door"
	door.mass = 0.5
	world.add_child(door)
	var joint := HingeJoint3D.new()
	joint.rotation = Vector3(PI / 2, 0, 0)
	_joined(world, joint, "", "Door")
	add_hand(world, path(Vector3(0.25, 0, -0.05), Vector3(0.25, 0, 0.1), 1.0))
	world.advance(1.2)
	check_near(Vector2(door.position.x, door.position.z).length(), 0.15, 2e-3, "distance from the hinge")
	check(door.position.z > 0.04, "it was not opened: %s" % door.position)
	check_near(door.position.y, 0.0, 1e-3, "height")


func test_joints_that_join_nothing_are_named() -> void:
	var world := add_world()
	_block(world, "B", Vector3.ZERO)
	_joined(world, PinJoint3D.new(), "Nobody", "B")
	expect_error("its node_a '../Nobody' is not a body of the scene")
	world.advance(TICK)
	check_equal(world.get_problems().size(), 1, "problems")
	check(" ".join(world._list_warnings()).contains("'Joint' does not join"), "no configuration warning")


func test_joints_of_other_kinds_are_named() -> void:
	var world := add_world()
	_block(world, "B", Vector3.ZERO)
	_joined(world, ConeTwistJoint3D.new(), "", "B")
	expect_error("a ConeTwistJoint3D is not carried out: use a PinJoint3D")
	world.advance(TICK)
	check_equal(world.get_problems().size(), 1, "problems")


func _check_quiet(world: HapticWorld) -> void:
	world.advance(TICK)
	check_equal(world.get_problems(), PackedStringArray(), "problems")


## Any warning of the running game fails this test. The editor still warns of a joint that is left empty.
func test_a_game_that_empties_a_joint_is_told_nothing() -> void:
	var world := add_world()
	var a := _block(world, "A", Vector3.ZERO)
	_block(world, "B", Vector3(0.5, 0, 0))
	add_floor(world).position.y = -2.0
	var joint := PinJoint3D.new()
	_joined(world, joint, "", "")
	_check_quiet(world)
	check(" ".join(world._list_warnings()).contains("joins nothing"), "no configuration warning")
	joint.node_a = NodePath("../A")
	joint.node_b = NodePath("../B")
	_check_quiet(world)
	joint.node_a = NodePath()
	_check_quiet(world)
	joint.node_b = NodePath()
	_check_quiet(world)
	joint.node_a = NodePath("../A")
	_check_quiet(world)
	joint.node_a = NodePath()
	joint.node_b = NodePath("../Floor")
	_check_quiet(world)
	joint.node_a = NodePath("../A")
	_check_quiet(world)
	a.free()
	_check_quiet(world)


func test_godot_carries_out_every_joint_of_bodies_that_it_moves() -> void:
	var world := add_world()
	world.authority = HapticWorld.AUTHORITY_GODOT
	_block(world, "B", Vector3.ZERO)
	_joined(world, ConeTwistJoint3D.new(), "", "B")
	var six := Generic6DOFJoint3D.new()
	six.set_flag_x(Generic6DOFJoint3D.FLAG_ENABLE_LINEAR_SPRING, true)
	_joined(world, six, "", "B")
	_check_quiet(world)
	check(not " ".join(world._list_warnings()).contains("does not join"), "a configuration warning")
