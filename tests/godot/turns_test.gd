extends "nodes_case.gd"
## In real time a frame looks at few bodies: what has changed is noticed all the same.

const COUNT := 200

var _world: HapticWorld
var _bodies: Array[CollisionObject3D] = []


func _start(make: Callable) -> void:
	_world = HapticWorld.new()
	_world.gravity = Vector3.ZERO
	add_child(_world)
	for i in COUNT:
		var body := with_shape(make.call(), sphere(0.2), Vector3(i, 0, 0))
		_bodies.append(body)
		_world.add_child(body)
	var device := HapticDevice.new()
	device.name = "Device"
	device.path = path(Vector3.ZERO, Vector3.ZERO)
	_world.add_child(device)
	await until(func() -> bool: return _world.get_statistics().get("bodies", 0) == COUNT, 5.0)
	await frames(5)


## A fingertip that stands above the body with this number, ten millimetres deep in where it would be pressed.
func _press(i: int) -> ProxyPointer:
	var device: HapticDevice = _world.get_node("Device")
	device.path = path(Vector3(i, 0.5, 0), Vector3(i, 0.2, 0), 0.1)
	var tip := ProxyPointer.new()
	tip.device = NodePath("../Device")
	_world.add_child(tip)
	return tip


func test_a_body_that_is_moved_is_elsewhere_in_the_next_frames() -> void:
	await _start(func() -> Node: return StaticBody3D.new())
	_bodies[150].position = Vector3(150, 5, 0)
	await frames(3)
	var tip := _press(150)
	await until(func() -> bool: return false, 0.4)
	check(not tip.is_touching(), "it is still where it was")


func test_a_changed_shape_is_felt_in_the_next_frames() -> void:
	await _start(func() -> Node: return StaticBody3D.new())
	var shape: SphereShape3D = (_bodies[120].get_node("Shape") as CollisionShape3D).shape
	shape.radius = 0.05
	await frames(3)
	var tip := _press(120)
	await until(func() -> bool: return false, 0.4)
	check(not tip.is_touching(), "it is as large as it was")


func test_layers_and_disabled_shapes_are_noticed_within_two_seconds() -> void:
	await _start(func() -> Node: return StaticBody3D.new())
	for what: String in ["collision_layer", "disabled", "gone"]:
		var i: int = {"collision_layer": 30, "disabled": 90, "gone": 140}[what]
		var tip := _press(i)
		check(await until(tip.is_touching, 3.0), "%s: it does not touch at first" % what)
		match what:
			"collision_layer":
				_bodies[i].collision_layer = 0
			"disabled":
				(_bodies[i].get_node("Shape") as CollisionShape3D).disabled = true
			"gone":
				_bodies[i].queue_free()
		check(await until(func() -> bool: return not tip.is_touching(), 2.0), "%s is not noticed" % what)
		tip.queue_free()
		await frames(2)


func test_a_body_that_nobody_touches_has_its_turn() -> void:
	await _start(func() -> Node: return RigidBody3D.new())
	_bodies[199].mass = 4.0
	(_bodies[77] as RigidBody3D).constant_force = Vector3(0, 1, 0)
	var moves := func() -> bool: return _bodies[77].position.y > 0.01
	check(await until(moves, 5.0), "a constant force is not noticed")


func test_a_thrown_body_flies_within_a_few_frames() -> void:
	await _start(func() -> Node: return RigidBody3D.new())
	(_bodies[60] as RigidBody3D).linear_velocity = Vector3(0, 1, 0)
	await frames(8)
	await until(func() -> bool: return false, 0.1)
	check(_bodies[60].position.y > 0.02, "it did not move: %s" % _bodies[60].position)


func test_a_body_that_moves_is_moved_and_thrown_by_scripts() -> void:
	await _start(func() -> Node: return RigidBody3D.new())
	var body := _bodies[60] as RigidBody3D
	body.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	body.linear_velocity = Vector3(0, 0.5, 0)
	var flies := func() -> bool: return body.position.y > 0.05
	check(await until(flies, 2.0), "it does not fly")
	body.linear_velocity = Vector3(0, 0, 0.5)
	var turns := func() -> bool: return body.position.z > 0.05
	check(await until(turns, 1.0), "a speed given on the way is lost: %s" % body.linear_velocity)
	body.position = Vector3(0, 7, 0)
	await frames(6)
	check(body.position.y > 6.9 and body.position.x < 0.1, "it is back on its way: %s" % body.position)
	body.linear_velocity = Vector3(NAN, 0, 0)
	await frames(6)
	check(body.linear_velocity.is_finite(), "its speed is no number: %s" % body.linear_velocity)
	body.linear_velocity = Vector3.ZERO
	await until(func() -> bool: return false, 0.7)
	body.position = Vector3(0, 9, 0)
	await frames(6)
	check_near(body.position.y, 9.0, 0.1, "moved after it had come to rest")


func test_a_changed_material_is_felt_in_the_next_frames() -> void:
	await _start(func() -> Node: return StaticBody3D.new())
	var look := material(400.0)
	(_bodies[50] as StaticBody3D).physics_material_override = look
	var tip := _press(50)
	check(
		await until(func() -> bool: return absf(tip.get_force().y - 4.0) < 0.1, 3.0),
		"force: %s" % tip.get_force()
	)
	look.stiffness = 800.0
	check(
		await until(func() -> bool: return absf(tip.get_force().y - 8.0) < 0.1, 0.5),
		"force: %s" % tip.get_force()
	)


func test_bodies_that_come_and_go() -> void:
	await _start(func() -> Node: return StaticBody3D.new())
	var late := with_shape(StaticBody3D.new(), sphere(0.2), Vector3(-5, 0, 0))
	_world.add_child(late)
	var tip := _press(-5)
	check(await until(tip.is_touching, 2.0), "a body that came late is not there")
	_world.remove_child(late)
	check(await until(func() -> bool: return not tip.is_touching(), 0.5), "it is still there")
	add_child(late)
	late.reparent(_world, false)
	await frames(2)
	check_equal(_world.get_statistics().bodies, COUNT + 1, "bodies")
