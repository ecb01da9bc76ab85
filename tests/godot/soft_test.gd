extends "nodes_case.gd"
## Meshes that give under the hand, in stepped time.


func _block(cells := 5) -> HapticSoftBody:
	var mesh := BoxMesh.new()
	mesh.size = Vector3.ONE * 0.08
	mesh.subdivide_width = cells - 1
	mesh.subdivide_height = cells - 1
	mesh.subdivide_depth = cells - 1
	var soft := HapticSoftBody.new()
	soft.mesh = mesh
	soft.cells = cells
	soft.stiffness = 1e4
	soft.damping = 0.01
	soft.held = AABB(Vector3(-1, -1.04, -1), Vector3(2, 1.001, 2))
	return soft


func _body_of(soft: HapticSoftBody, body: CollisionObject3D = StaticBody3D.new()) -> CollisionObject3D:
	soft.name = "Soft"
	body.add_child(soft)
	return body


func _highest(soft: HapticSoftBody) -> float:
	var highest := -INF
	for place in soft.get_surface():
		highest = maxf(highest, place.y)
	return highest


func test_a_block_gives_by_as_much_as_it_is_pressed_and_comes_back() -> void:
	var world := add_world()
	var soft := _block()
	world.add_child(_body_of(soft))
	var proxy := add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.03, 0)))
	world.advance(1.5)
	check(proxy.is_touching(), "nothing is touched")
	check(proxy.get_proxy_position().y < 0.045, "it does not give: %s" % proxy.get_proxy_position())
	check(proxy.get_proxy_position().y > 0.031, "the hand is in it")
	check(proxy.get_force().y > 0.2, "nothing is felt: %s" % proxy.get_force())
	check_equal(Array(soft.get_problems()), [], "problems")
	check_equal(soft.get_element_count(), 125 + 3 * 5 * 5 * 6, "cells and faces")
	check_equal(world.get_problems().size(), 0, "problems")
	var away: HapticPath = path(Vector3(0, 0.03, 0), Vector3(0, 0.2, 0))
	(world.get_node("Device") as HapticDevice).path = away
	world.advance(3.0)
	check(absf(_highest(soft) - 0.04) < 1e-4, "shape is not back: %s" % _highest(soft))


func test_a_tool_presses_a_block_and_feels_it() -> void:
	var world := add_world()
	var soft := _block()
	world.add_child(_body_of(soft))
	add_device(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.04, 0)))
	var tool := HapticTool.new()
	var brick := BoxMesh.new()
	brick.size = Vector3(0.05, 0.02, 0.05)
	tool.mesh = brick
	world.add_child(tool)
	world.advance(1.5)
	check_equal(tool.get_state_text(), "touching", "state")
	check(tool.global_position.y < 0.0485, "the block does not give: %s" % tool.global_position)
	check(tool.global_position.y > 0.0405, "the hand is in it: %s" % tool.global_position)
	check(tool.get_force().y > 1.0, "nothing is felt: %s" % tool.get_force())


func test_a_cloth_between_its_corners_bears_the_hand() -> void:
	var world := add_world()
	var mesh := PlaneMesh.new()
	mesh.size = Vector2.ONE * 0.2
	mesh.subdivide_width = 9
	mesh.subdivide_depth = 9
	var soft := HapticSoftBody.new()
	soft.mesh = mesh
	soft.form = HapticSoftBody.FORM_SHEET
	soft.stiffness = 2e5
	soft.thickness = 0.0005
	soft.held_vertices = PackedInt32Array([0, 10, 110, 120])
	world.add_child(_body_of(soft))
	var proxy := add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, -0.03, 0)))
	world.advance(1.5)
	check(proxy.is_touching(), "it has been passed")
	check(proxy.get_proxy_position().y > -0.03, "it bears nothing: %s" % proxy.get_proxy_position())
	check_equal(world.get_problems().size(), 0, "problems")


func test_a_ball_that_is_not_held_falls_on_the_ground() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -9.81, 0)
	var ground := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	shape.shape = WorldBoundaryShape3D.new()
	ground.add_child(shape)
	world.add_child(ground)
	var mesh := SphereMesh.new()
	mesh.radius = 0.04
	mesh.height = 0.08
	mesh.radial_segments = 16
	mesh.rings = 8
	var soft := HapticSoftBody.new()
	soft.mesh = mesh
	soft.cells = 4
	soft.stiffness = 3e4
	soft.damping = 0.01
	var body := _body_of(soft)
	body.position = Vector3(0, 0.1, 0)
	world.add_child(body)
	add_hand(world, path(Vector3(0, 1, 0), Vector3(0, 1.01, 0)))
	world.advance(2.0)
	var lowest := INF
	for place in soft.get_surface():
		lowest = minf(lowest, place.y + 0.1)
	check(absf(lowest) < 1e-3, "it lies at %s" % lowest)


func test_tetrahedra_can_be_given() -> void:
	var world := add_world()
	var soft := HapticSoftBody.new()
	soft.points = PackedVector3Array(
		[Vector3(-0.1, 0, -0.1), Vector3(0.1, 0, -0.1), Vector3(0, 0, 0.1), Vector3(0, 0.1, 0)]
	)
	soft.tetrahedra = PackedInt32Array([3, 0, 1, 2])
	soft.held = AABB(Vector3(-1, -0.01, -1), Vector3(2, 0.02, 2))
	world.add_child(_body_of(soft))
	var proxy := add_hand(world, path(Vector3(0, 0.2, 0), Vector3(0, 0.09, 0)))
	world.advance(1.2)
	check_equal(Array(soft.get_problems()), [], "problems")
	check(proxy.is_touching(), "nothing is touched")


func test_what_cannot_give_says_why_and_the_rest_goes_on() -> void:
	var world := add_world()
	var open := HapticSoftBody.new()
	open.mesh = PlaneMesh.new()
	var none := HapticSoftBody.new()
	var turned := HapticSoftBody.new()
	turned.points = PackedVector3Array([Vector3.ZERO, Vector3.RIGHT, Vector3.UP, Vector3.BACK])
	turned.tetrahedra = PackedInt32Array([0, 2, 1, 3])
	var nonsense := HapticSoftBody.new()
	nonsense.points = PackedVector3Array([Vector3(NAN, 0, 0), Vector3.RIGHT, Vector3.UP, Vector3.BACK])
	nonsense.tetrahedra = PackedInt32Array([0, 1, 2, 3])
	var one := HapticSoftBody.new()
	one.points = PackedVector3Array([Vector3.ZERO])
	one.tetrahedra = PackedInt32Array([0, 0, 0, 0])
	var large := _block(32)
	var thrown := _block()
	var words := {
		open: "open",
		none: "mesh",
		turned: "inside out",
		nonsense: "vertex 0",
		one: "flat",
		large: "fewer",
		thrown: "StaticBody3D"
	}
	for soft: HapticSoftBody in words:
		world.add_child(_body_of(soft, RigidBody3D.new() if soft == thrown else StaticBody3D.new()))
	world.add_child(_body_of(_block()))
	var proxy := add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.03, 0)))
	world.advance(1.5)
	for soft: HapticSoftBody in words:
		check(
			words[soft] in "\n".join(soft.get_problems()),
			"no '%s' in: %s" % [words[soft], soft.get_problems()]
		)
		check(not soft.get_problems().is_empty(), "no warning of %s" % words[soft])
	check(proxy.is_touching(), "the sound one is not touched")


func test_another_stiffness_is_another_feeling() -> void:
	var forces: Array[float] = []
	for stiffness: float in [3e3, 3e4]:
		var world := add_world()
		var soft := _block()
		world.add_child(_body_of(soft))
		var proxy := add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.035, 0)))
		world.advance(0.1)
		soft.stiffness = stiffness
		world.advance(1.5)
		forces.append(proxy.get_force().y)
		world.free()
	check(forces[1] > 1.5 * forces[0], "forces %s" % [forces])


## The path leads over all three in each of its rounds, and the box stays on the sponge.
func test_what_is_made_otherwise_while_it_is_pressed_keeps_the_finger() -> void:
	var changes := {"stiffness": 4e4, "damping": 0.02, "density": 3000.0, "poisson_ratio": 0.4}
	for property: String in changes:
		var world := add_world()
		var soft := _block()
		world.add_child(_body_of(soft))
		var proxy := add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.03, 0)))
		world.advance(1.5)
		var ended := []
		proxy.contact_ended.connect(func(body: Node) -> void: ended.append(body))
		var before := _highest(soft)
		soft.set(property, changes[property])
		var force := proxy.get_force()
		for i in 100:
			world.advance(0.01)
			await get_tree().process_frame
			check(proxy.is_touching(), "%s: the finger is let go after %d" % [property, i])
			check(proxy.get_force().distance_to(force) <= 10 * 0.5, "%s: %s" % [property, proxy.get_force()])
			force = proxy.get_force()
		check_equal(ended.size(), 0, "%s: ended" % property)
		check(before > 0.03 and proxy.get_force().y > 0.1, "%s: %s" % [property, proxy.get_force()])
		world.free()


func test_the_scene_of_things_that_give_plays_round_after_round() -> void:
	var scene := add_scene("res://gallery/soft/soft.tscn")
	var world: HapticWorld = scene.get_node("HapticWorld")
	var proxy: ProxyPointer = world.get_node("ProxyPointer")
	var touched := {}
	proxy.contact_started.connect(func(body: Node3D) -> void: touched[body.name] = true)
	for number in 2:
		touched.clear()
		for _i in 14 * 60:
			world.advance(1.0 / 60.0)
		for name: StringName in [&"Sponge", &"Ball", &"Cloth"]:
			check(touched.has(name), "round %d: touched were %s" % [number, touched.keys()])
	var box: RigidBody3D = world.get_node("Box")
	check(box.global_position.y > 0.08, "the box has left the sponge: %s" % box.global_position)
	scene.free()
