extends "link_case.gd"
## Bodies that come while a world runs: Godot's own physics has no part in them from then on, however many of
## its steps go by until the world builds them.


func _box_at(at: Vector3) -> RigidBody3D:
	var body := with_shape(RigidBody3D.new(), box(Vector3.ONE * 0.1), at) as RigidBody3D
	body.can_sleep = false
	return body


func _physics_frames(count: int) -> void:
	for _frame in count:
		await get_tree().physics_frame


func test_a_body_that_comes_does_not_fall_before_the_world_has_it() -> void:
	var world := add_world()
	world.advance(TICK)
	var body := _box_at(Vector3(0, 1, 0))
	world.add_child(body)
	await _physics_frames(12)
	world.advance(0.1)
	await frames(1)
	check_near(body.global_position, Vector3(0, 1, 0), 1e-6, "where it is")
	check_near(body.linear_velocity, Vector3.ZERO, 1e-6, "its velocity")


func test_a_body_that_comes_begins_with_the_velocity_that_it_was_given() -> void:
	var world := add_world()
	world.advance(TICK)
	var body := _box_at(Vector3(0, 1, 0))
	body.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	body.linear_velocity = Vector3(1, 0, 0)
	world.add_child(body)
	await _physics_frames(12)
	world.advance(0.1)
	await frames(1)
	check_near(body.global_position, Vector3(0.1, 1, 0), 2e-3, "where it is")


## It left before the world had built it: Godot's physics moves it as any other body.
func test_a_body_that_leaves_at_once_is_given_back() -> void:
	var world := add_world()
	world.advance(TICK)
	var body := _box_at(Vector3(0, 1, 0))
	world.add_child(body)
	body.reparent(self)
	await _physics_frames(12)
	check(body.global_position.y < 0.99, "it hangs at %s" % body.global_position)


## What has no shape cannot be touched, and is left to Godot.
func test_a_body_that_cannot_be_touched_is_given_back() -> void:
	var world := add_world()
	world.advance(TICK)
	var body := RigidBody3D.new()
	world.add_child(body)
	world.advance(TICK)
	await _physics_frames(12)
	check(body.global_position.y < -0.01, "it hangs at %s" % body.global_position)


func test_a_body_that_comes_to_an_operator_stays_until_it_leaves() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	_advance(0.2)
	var body := _box_at(Vector3(0, 1, 0))
	_operator.add_child(body)
	await _physics_frames(12)
	check_near(body.global_position, Vector3(0, 1, 0), 1e-6, "where it waits for its twin")
	body.reparent(self)
	await _physics_frames(12)
	check(body.global_position.y < 0.99, "it hangs at %s" % body.global_position)


## A far body that comes between two frames is what its model is: neither falls.
func test_a_body_that_comes_to_a_teleoperator_does_not_fall_in_the_model() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	_advance(0.2)
	var body := _box_at(Vector3(0, 1, 0))
	body.name = "Box"
	_far.add_child(body)
	await _physics_frames(12)
	for _step in 20:
		_advance(0.01)
		await frames(1)
	var shown: Node3D = _operator.get_node("Box")
	check_near(body.global_position, Vector3(0, 1, 0), 1e-4, "the far body")
	check_near(shown.global_position, Vector3(0, 1, 0), 1e-4, "its model")
