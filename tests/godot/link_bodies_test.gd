extends "link_case.gd"
## What shows the bodies of the far side: their names, and nodes that go and come.


## Freed here it gets a picture, and a new body of that name shows it again; contacts name what shows it.
func test_a_body_that_is_freed_here_is_shown_by_what_comes_in_its_place() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	for world: HapticWorld in [_operator, _far]:
		add_floor(world, STIFFNESS)
	_add_hands(0.3)
	await frames(1)
	_advance(1.0)
	var proxy: ProxyPointer = _operator.get_node("Proxy")
	check_equal(proxy.get_contacts()[0]["body"], _operator.get_node("Floor"), "what is touched")
	var others := _operator.find_children("*", "MeshInstance3D", true, false).size()
	_operator.get_node("Floor").free()
	_advance(0.1)
	await frames(1)
	_advance(0.1)
	check_equal(_operator.find_children("*", "MeshInstance3D", true, false).size(), others + 1, "pictures")
	check(proxy.get_contacts()[0]["body"] != null, "what is touched has no node")
	check(_felt(_operator).y > 4.0, "it is felt as before: %s" % _felt(_operator))
	var shown := []
	_here.object_discovered.connect(func(_name: String, node: Node3D) -> void: shown.append(node))
	for picture: Node in _operator.find_children("Floor*", "Node3D", true, false):
		picture.name = "Picture"
	var again := add_floor(_operator, STIFFNESS)
	_advance(0.1)
	await frames(1)
	_advance(0.1)
	check_equal(shown, [again], "what shows it")
	check_equal(proxy.get_contacts()[0]["body"], again, "what is touched")
	check_equal(_operator.find_children("*", "MeshInstance3D", true, false).size(), others, "pictures")


func test_a_far_body_with_another_name_or_parent_is_told() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	var floor_body := add_floor(_far, STIFFNESS)
	_advance(0.5)
	var names := []
	_here.object_discovered.connect(func(name: String, _node: Node3D) -> void: names.append(name))
	floor_body.name = "Ground"
	_advance(0.5)
	var room := Node3D.new()
	room.name = "Room"
	_far.add_child(room)
	floor_body.reparent(room)
	await frames(1)
	_advance(0.5)
	check_equal(names, ["Ground", "Room/Ground"], "names")
	check_equal(_here.get_statistics().objects, 1, "objects")


## Before the world has noticed: it has no path then, and Godot would complain.
func test_a_far_body_that_is_taken_out_of_the_tree_is_gone_and_comes_back() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	var floor_body := add_floor(_far, STIFFNESS)
	_advance(0.5)
	var names := []
	_here.object_discovered.connect(func(name: String, _node: Node3D) -> void: names.append(name))
	_far.remove_child(floor_body)
	_advance(0.5)
	await frames(1)
	_advance(0.5)
	check_equal(_here.get_statistics().objects, 0, "objects while it is away")
	_far.add_child(floor_body)
	await frames(1)
	_advance(0.5)
	check_equal(names, ["Floor"], "names")


func test_a_model_that_is_described_slowly_is_touched_once_it_is_whole() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	_there.conditions.rate = 64_000.0
	add_floor(_far, STIFFNESS)
	for i in 40:
		var other := with_shape(StaticBody3D.new(), sphere(0.01), Vector3(1.0 + 0.1 * i, 0, 0))
		_far.add_child(other)
	for world: HapticWorld in [_operator, _far]:
		var last := with_shape(StaticBody3D.new(), sphere(0.01), Vector3(0, 1, 0))
		last.name = "Last"
		world.add_child(last)
	_add_hands(0.0)
	await frames(2)
	var seconds_held := 0.0
	for _step in 200:
		_advance(0.01)
		await frames(1)
		if _here.is_peer_connected() and not _here.get_statistics().model_complete:
			check_near(_felt(_operator), Vector3.ZERO, 0.0, "force of a model that is not whole")
			if _here.get_statistics().objects > 0:
				check(_here.get_state_text().contains("touch nothing until"), _here.get_state_text())
				check_equal(
					_operator.get_problems(), PackedStringArray(), "problems of what is still to come"
				)
				seconds_held += 0.01
	check(seconds_held > 0.1, "the description takes %f s" % seconds_held)
	check(_here.get_statistics().model_complete, "the model is whole at the end")
	check_equal(_here.get_state_text(), "connected", "text")


func test_a_body_that_only_the_operator_has_is_named() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	for world: HapticWorld in [_operator, _far]:
		add_floor(world, STIFFNESS)
	var alone := with_shape(StaticBody3D.new(), box(Vector3.ONE * 0.1))
	alone.name = "Alone"
	_operator.add_child(alone)
	await frames(1)
	_advance(0.5)
	var problems := "\n".join(_operator.get_problems())
	check(problems.contains("Alone") and problems.contains("other side does not have"), problems)
	check(not problems.contains("Floor"), problems)


func _place_in(world: HapticWorld, name: String) -> Vector3:
	return world.to_local((world.get_node(name) as Node3D).global_position)


## Both sides touch the same floor beside the same box, and one of the two worlds is moved, in so many frames.
func _move_while_touching(scenario: MMTLink.Scenario, moves_far: bool, to: Transform3D, steps: int) -> void:
	await _connect(scenario)
	for world: HapticWorld in [_operator, _far]:
		add_floor(world, STIFFNESS)
		var block := with_shape(RigidBody3D.new(), box(Vector3.ONE * 0.1), Vector3(0.3, 0.05, 0))
		block.name = "Block"
		world.add_child(block)
	_far.gravity = Vector3(0, -9.81, 0)
	_add_hands(0.3)
	await frames(1)
	_advance(1.0)
	var moved: HapticWorld = _far if moves_far else _operator
	for step in steps:
		moved.global_transform = Transform3D.IDENTITY.interpolate_with(to, (step + 1.0) / steps)
		_advance(0.01)
		await frames(1)
	for _step in 10:
		_advance(0.1)
		await frames(1)
	# A far hand that begins inside a body presses nothing there, until it has left it.
	(_operator.get_node("Device") as HapticDevice).path = path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0))
	for _step in 15:
		_advance(0.1)
		await frames(1)
	check_equal(_here.get_state(), MMTLink.STATE_CONNECTED, "state of the link")
	for world: HapticWorld in [_operator, _far]:
		check_near(_place_in(world, "Proxy"), Vector3(0, 0.01, 0), 1e-3, "the proxy in %s" % world.name)
		check_near(_place_in(world, "Block"), Vector3(0.3, 0.05, 0), 1e-3, "the block in %s" % world.name)
		var felt: Vector3 = (world.get_node("Proxy") as ProxyPointer).get_force()
		check_near(felt.length(), 10.0, 0.1, "the force in %s" % world.name)


func test_a_far_world_that_jumps_is_touched_as_before() -> void:
	await _move_while_touching(MMTLink.SCENARIO_MMT, true, Transform3D(Basis(), Vector3(1, 0.5, 2)), 1)


func test_a_far_world_that_is_turned_is_touched_as_before() -> void:
	var turned := Basis(Vector3.UP, 1.0)
	await _move_while_touching(MMTLink.SCENARIO_MMT, true, Transform3D(turned, Vector3(1, 0, 0)), 1)


func test_a_far_world_that_was_moved_for_a_while_is_touched_as_before() -> void:
	await _move_while_touching(MMTLink.SCENARIO_MMT, true, Transform3D(Basis(), Vector3(1, 0.5, 2)), 30)


func test_an_operator_that_is_moved_touches_as_before() -> void:
	await _move_while_touching(MMTLink.SCENARIO_MMT, false, Transform3D(Basis(), Vector3(1, 0.5, 2)), 1)


func test_a_far_world_that_jumps_is_touched_directly_as_before() -> void:
	await _move_while_touching(MMTLink.SCENARIO_DIRECT, true, Transform3D(Basis(), Vector3(1, 0.5, 2)), 1)


## The problems of the far side's link.
func _untransmitted() -> String:
	return "; ".join(_there.get_problems())


## The operator's model has neither of them: the far side says so, the operator's side and one without a
## model do not.
func test_what_is_not_transmitted_of_a_body_is_said() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	var material_there := add_floor(_far, STIFFNESS).physics_material_override as HapticMaterial
	check_equal(_untransmitted(), "", "of a floor that is transmitted whole")
	material_there.shaft_friction = 20.0
	check(_untransmitted().contains("'shaft_friction' of the material of 'Floor'"), _untransmitted())
	material_there.force_curve = Curve.new()
	check(_untransmitted().contains("'force_curve', 'shaft_friction' of"), _untransmitted())
	check_equal(_here.get_problems().size(), 0, "said by the operator's side")
	_there.scenario = MMTLink.SCENARIO_DIRECT
	check_equal(_untransmitted(), "", "where forces travel, and no model")
	_there.scenario = MMTLink.SCENARIO_MMT
	material_there.force_curve = null
	material_there.shaft_friction = 0.0
	var hinge := HingeJoint3D.new()
	_far.add_child(hinge)
	check_equal(_untransmitted(), "", "of a hinge")
	var drive := HapticJointDrive.new()
	drive.name = "Detents"
	hinge.add_child(drive)
	check(_untransmitted().contains("Detents' is not transmitted"), _untransmitted())
