extends "nodes_case.gd"
## Forces in closed form that need no script, and what a scene gives a hand besides.


func _add_force(above: Node, form: HapticForce.Form) -> HapticForce:
	var effect := HapticEffect.new()
	effect.formula = HapticForce.new()
	effect.formula.form = form
	above.add_child(effect)
	return effect.formula


func test_a_spring_needs_no_script() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3(-0.05, 0, 0), Vector3(0.05, 0, 0)))
	_add_force(proxy, HapticForce.FORM_SPRING).stiffness = 150.0
	world.advance(0.3)
	for _i in 100:
		world.advance(TICK)
		check_near(proxy.get_force(), -150.0 * proxy.get_hand_position(), 1e-4, "force")
	check_equal((proxy.get_child(-1) as HapticEffect).get_state_text(), "working", "state")
	check_equal(world.get_problems(), PackedStringArray(), "problems")


func test_a_force_moves_with_the_node_above_it() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var knob := Node3D.new()
	world.add_child(knob)
	var wall := _add_force(knob, HapticForce.FORM_WALL)
	wall.stiffness = 100.0
	wall.damping = 0.0
	(knob.get_child(0) as HapticEffect).proxy = NodePath("../../Proxy")
	knob.position = Vector3(0, 0.02, 0)
	world.advance(0.5)
	check_near(proxy.get_force(), Vector3(0, 2, 0), 1e-4, "wall above the hand")
	knob.transform = Transform3D(Basis(Vector3.BACK, PI / 2), Vector3(-0.01, 0, 0))
	world.advance(0.01)
	world.advance(0.5)
	check_near(proxy.get_force(), Vector3(-1, 0, 0), 1e-4, "wall that was turned")


func test_one_that_cannot_be_says_so() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var force := _add_force(proxy, HapticForce.FORM_CONSTANT)
	force.direction = Vector3.ZERO
	expect_error("direction")
	world.advance(0.1)
	check(
		(proxy.get_child(-1) as HapticEffect).get_state_text().contains("direction"), "it says what is wrong"
	)
	check_equal(proxy.get_force(), Vector3.ZERO, "force")


func test_a_scene_gives_a_hand_a_force_besides() -> void:
	var world := add_world()
	add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var device: HapticDevice = world.get_node("Device")
	device.applied_force = Vector3(0, 0, 1.5)
	world.advance(0.2)
	world.advance(0.1)
	check_near(device.get_force(), Vector3(0, 0, 1.5), 1e-4, "force")
	expect_error("applied_force = (0.0, nan, 0.0) was refused")
	device.applied_force = Vector3(0, NAN, 0)
	check_near(device.applied_force, Vector3(0, 0, 1.5), 1e-6, "what is no number is refused")
