extends "nodes_case.gd"
## SoftBody3D nodes, which Godot's own physics moves and a hand feels. Runs with each of Godot's physics
## engines.

const FRAME := 1.0 / 60.0


func _soft_body(mesh: Mesh, held: Callable) -> SoftBody3D:
	var body := SoftBody3D.new()
	body.mesh = mesh
	body.total_mass = 1.0
	body.name = "Soft"
	var corners: PackedVector3Array = mesh.surface_get_arrays(0)[Mesh.ARRAY_VERTEX]
	for i in corners.size():
		if held.call(corners[i]):
			body.set_point_pinned(i, true)
	return body


## A cloth of 0.6 m that is pinned along its edges.
func _cloth() -> SoftBody3D:
	var mesh := PlaneMesh.new()
	mesh.size = Vector2(0.6, 0.6)
	mesh.subdivide_width = 15
	mesh.subdivide_depth = 15
	return _soft_body(mesh, func(at: Vector3) -> bool: return maxf(absf(at.x), absf(at.z)) > 0.29)


func _ball(held: Callable) -> SoftBody3D:
	var mesh := SphereMesh.new()
	mesh.radius = 0.2
	mesh.height = 0.4
	mesh.radial_segments = 24
	mesh.rings = 12
	var ball := _soft_body(mesh, held)
	ball.pressure_coefficient = 10.0
	return ball


## Where the vertices are, each as often as it has corners in the mesh.
func _vertices(body: SoftBody3D) -> PackedVector3Array:
	var vertices := PackedVector3Array()
	for i in body.mesh.surface_get_arrays(0)[Mesh.ARRAY_VERTEX].size():
		vertices.append(PhysicsServer3D.soft_body_get_point_global_position(body.get_physics_rid(), i))
	return vertices


## Below the hand, which comes from above: the highest vertex next to its axis.
func _top(body: SoftBody3D) -> float:
	var top := -INF
	for at in _vertices(body):
		if Vector2(at.x, at.z).length() < 0.05:
			top = maxf(top, at.y)
	return top


func _force(world: HapticWorld) -> Vector3:
	return (world.get_node("Device") as HapticDevice).get_displayed_force()


## Advances by `seconds`; the largest change of the hand's force in a tick.
func _play(world: HapticWorld, seconds: float) -> float:
	var largest := 0.0
	var time := 0.0
	var before := _force(world)
	for i in roundi(seconds / FRAME):
		await get_tree().physics_frame
		while time < (i + 1) * FRAME:
			world.advance(TICK)
			time += TICK
			largest = maxf(largest, (_force(world) - before).length())
			before = _force(world)
	return largest


## A hand above a soft body, which has come to rest.
func _above(body: SoftBody3D, height := 0.0) -> HapticWorld:
	var world := add_godot_world(material(500.0))
	body.position.y = height
	world.add_child(body)
	add_hand(world, path(Vector3(0, 0.8, 0), Vector3(0, 0.8, 0)))
	await _play(world, 3.0)
	return world


func _press(world: HapticWorld, body: SoftBody3D, depth := 0.03) -> void:
	var top := _top(body)
	var device := world.get_node("Device") as HapticDevice
	device.path = path(Vector3(0, top + 0.1, 0), Vector3(0, top - depth, 0))


func _check_touched(world: HapticWorld, body: SoftBody3D) -> void:
	var contacts := (world.get_node("Proxy") as ProxyPointer).get_contacts()
	check(not contacts.is_empty() and contacts[0].body == body, "touched: %s" % [contacts])
	check_equal(world.get_problems(), PackedStringArray(), "problems")


## What holds it is Godot's own physics: the force is what presses it in.
func test_a_cloth_yields_and_bears_the_hand() -> void:
	var cloth := _cloth()
	var world := await _above(cloth)
	var top := _top(cloth)
	_press(world, cloth)
	var change := await _play(world, 4.0)
	check(change < 0.5, "changed by %s N in a tick" % change)
	_check_touched(world, cloth)
	var force := _force(world).y
	check(force > 1.0 and force < 3.0, "pressed with %s N" % force)
	check(_top(cloth) < top - 0.005, "it yields from %s to %s" % [top, _top(cloth)])
	change = await _play(world, 1.0)
	check(change < 0.1, "held, it changed by %s N in a tick" % change)


func test_a_ball_is_felt() -> void:
	var ball := _ball(func(at: Vector3) -> bool: return at.y < -0.15)
	var world := await _above(ball, 0.2)
	_press(world, ball)
	var change := await _play(world, 3.0)
	check(change < 0.5, "changed by %s N in a tick" % change)
	_check_touched(world, ball)
	check(_force(world).y > 0.2, "pressed with %s" % _force(world))


## A hand strikes it where nothing else acts on it.
func test_a_push_arrives_once() -> void:
	var space := get_viewport().world_3d.space
	PhysicsServer3D.area_set_param(space, PhysicsServer3D.AREA_PARAM_GRAVITY, 0.0)
	var world := add_godot_world(material(500.0))
	var ball := _ball(func(_at: Vector3) -> bool: return false)
	ball.pressure_coefficient = 0.0
	ball.damping_coefficient = 0.0
	world.add_child(ball)
	add_hand(world, path(Vector3(-0.4, 0, 0), Vector3(-0.1, 0, 0)))
	var felt := 0.0
	var time := 0.0
	var places: Array[Vector3] = []
	for i in 90:
		await get_tree().physics_frame
		while time < (i + 1) * FRAME:
			world.advance(TICK)
			time += TICK
			felt -= _force(world).x * TICK
		var sum := Vector3.ZERO
		var seen := {}
		for at in _vertices(ball):
			if not seen.has(at):
				seen[at] = true
				sum += at
		places.append(sum / seen.size())
	PhysicsServer3D.area_set_param(space, PhysicsServer3D.AREA_PARAM_GRAVITY, 9.8)
	var speed := (places[-1].x - places[-11].x) / (10 * FRAME)
	check(felt > 0.2, "felt %s Ns" % felt)
	check_near(speed * ball.total_mass, felt, 0.05 * felt, "momentum")


## A light one bears no stiff spring at 60 frames a second.
func test_each_mass_is_pressed_calmly() -> void:
	for mass: float in [0.01, 0.3, 10.0]:
		var cloth := _cloth()
		cloth.total_mass = mass
		var world := await _above(cloth)
		_press(world, cloth)
		await _play(world, 4.0)
		var force := _force(world).y
		check(force > minf(mass, 1.0) and force < 8.1, "%s kg are pressed with %s N" % [mass, force])
		var change := await _play(world, 1.0)
		check(change < 0.1, "%s kg, held, changed by %s N in a tick" % [mass, change])
		world.free()


func test_whatever_a_game_does_to_it_the_hand_is_let_go_softly() -> void:
	var switch_off := func(body: SoftBody3D) -> void: body.process_mode = PROCESS_MODE_DISABLED
	var take_out := func(body: SoftBody3D) -> void: body.get_parent().remove_child(body)
	var free_it := func(body: SoftBody3D) -> void: body.free()
	var give_another := func(body: SoftBody3D) -> void: body.mesh = BoxMesh.new()
	for change: Callable in [switch_off, take_out, give_another, free_it]:
		var cloth := _cloth()
		var world := await _above(cloth)
		_press(world, cloth)
		await _play(world, 2.0)
		check(_force(world).y > 0.5, "pressed with %s" % _force(world))
		if change == give_another:
			expect_error("whose mesh was changed in the tree")
		change.call(cloth)
		var step := await _play(world, 0.5)
		check(step < 0.5, "the force changes by %s N in a tick" % step)
		world.free()
		if is_instance_valid(cloth):
			cloth.free()


## A box that lies on a cloth is pressed against it.
func test_what_lies_on_it_is_borne() -> void:
	var cloth := _cloth()
	var world := await _above(cloth)
	var body := with_shape(RigidBody3D.new(), box(Vector3(0.1, 0.02, 0.1))) as RigidBody3D
	body.position.y = _top(cloth) + 0.05
	body.mass = 0.3
	world.add_child(body)
	await _play(world, 2.0)
	if body.position.y < -0.3:
		return  # Godot Physics lets it through
	var device := world.get_node("Device") as HapticDevice
	var top := body.position.y + 0.01
	device.path = path(Vector3(0, top + 0.1, 0), Vector3(0, top - 0.005, 0))
	var change := await _play(world, 3.0)
	check(change < 0.5, "changed by %s N in a tick" % change)
	check(body.position.y > top - 0.1, "it is at %s" % body.position)


func test_what_cannot_be_felt_is_said() -> void:
	var world := add_godot_world(material(500.0))
	var large := PlaneMesh.new()
	large.subdivide_width = 120
	large.subdivide_depth = 120
	var big := SoftBody3D.new()
	big.name = "Big"
	big.mesh = large
	world.add_child(big)
	add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, -0.1, 0)))
	expect_error("vertices is not felt")
	await _play(world, 0.2)
	var problems := "\n".join(world.get_problems())
	check(problems.contains("Big") and problems.contains("vertices"), problems)
