extends "link_case.gd"
## Touch over a network: the operator's world and the far one, in one process and in stepped time.


func test_the_two_sides_find_each_other() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	_advance(0.2)
	check_equal(_here.get_state(), MMTLink.STATE_CONNECTED, "state: " + _here.get_state_text())
	check_equal(_there.get_state(), MMTLink.STATE_CONNECTED, "state: " + _there.get_state_text())


## The robot's table lies 10 mm below the middle.
func test_a_robot_goes_where_the_hand_is_and_the_table_it_meets_is_felt() -> void:
	await _connect(MMTLink.SCENARIO_DIRECT_ROBOT)
	add_hand(_operator, path(Vector3.ZERO, Vector3(0.01, -0.02, 0), 0.5))
	var robot := HapticDevice.new()
	robot.name = "Device"
	robot.driver = HapticDevice.DRIVER_EMULATED_ROBOT
	_far.add_child(robot)
	var tip := ProxyPointer.new()
	tip.device = NodePath("../Device")
	_far.add_child(tip)
	_advance(2.0)
	check_equal(_here.get_state(), MMTLink.STATE_CONNECTED, "state: " + _here.get_state_text())
	var at := robot.get_hand_position()
	check_near(at.x, 0.01, 0.003, "x of the robot")
	check(at.y < -0.01 and at.y > -0.018, "y of the robot is %s" % at.y)
	check(_felt(_operator).y > 2.0, "the hand feels %s" % _felt(_operator))


func test_the_model_is_filled_from_the_far_side_and_touched_at_once() -> void:
	await _connect(MMTLink.SCENARIO_MMT, 0.1)
	add_floor(_far, STIFFNESS)
	_add_hands()
	var found := []
	_here.object_discovered.connect(func(name: String, node: Node3D) -> void: found.append([name, node]))
	_advance(0.5)
	check_equal(found.size(), 1, "discovered objects")
	check_equal(found[0][0], "Floor", "name")
	check_near(found[0][1].position, Vector3(0, -0.1, 0), 1e-6, "place of its picture")
	_advance(0.1)
	# The proxy's sphere rests on the floor, its centre a radius above: the hand is 2 cm from it.
	check_near(_felt(_operator), Vector3(0, 10.0 * 0.8, 0), 1e-3, "force, limited to 8 N, without any delay")
	_advance(0.2)
	check_near((_far.get_node("Proxy") as ProxyPointer).get_force().y, 10.0, 1e-3, "force at the other side")


func test_a_body_of_the_scene_shows_the_far_one_of_the_same_name() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	for world: HapticWorld in [_operator, _far]:
		var body := with_shape(RigidBody3D.new(), box(Vector3.ONE * 0.1)) as RigidBody3D
		body.name = "Box"
		world.add_child(body)
	_add_hands()
	var mine: RigidBody3D = _operator.get_node("Box")
	var shown := []
	_here.object_discovered.connect(func(_name: String, node: Node3D) -> void: shown.append(node))
	(_far.get_node("Box") as RigidBody3D).position = Vector3(0.3, 0, 0)
	(_far.get_node("Box") as RigidBody3D).linear_velocity = Vector3(0.1, 0, 0)
	(_far.get_node("Box") as RigidBody3D).linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	_advance(0.5)
	# The far world is one tick of 0.1 mm behind.
	check_near(mine.position, (_far.get_node("Box") as RigidBody3D).position, 2e-4, "place of the twin")
	check_equal(shown, [mine], "what shows it")


func test_traditional_touch_is_felt_one_delay_later() -> void:
	await _connect(MMTLink.SCENARIO_DIRECT, 0.1)
	add_floor(_far, STIFFNESS)
	_add_hands()
	_advance(0.5 + 0.1)
	var proxy: ProxyPointer = _operator.get_node("Proxy")
	check_near(_felt(_operator), Vector3.ZERO, 1e-9, "force before the other side has answered")
	check(not proxy.is_touching(), "it touches before the other side has answered")
	_advance(0.15)
	check_near(_felt(_operator).y, 8.0, 1e-3, "force when it has")
	check(proxy.is_touching(), "it does not touch when the other side has answered")
	check_near(proxy.get_contacts()[0].point, Vector3.ZERO, 1e-3, "point of contact")
	check_near(proxy.get_contacts()[0].normal, Vector3.UP, 1e-6, "normal")
	check_near(_here.get_statistics().round_trip_s, 0.1, 0.003, "round trip (s)")


func test_the_same_scene_goes_from_one_scenario_to_the_next_while_it_runs() -> void:
	await _connect(MMTLink.SCENARIO_DIRECT, 0.1)
	for world: HapticWorld in [_far, _operator]:
		add_floor(world, STIFFNESS)
	_add_hands()
	for scenario: MMTLink.Scenario in [
		MMTLink.SCENARIO_DIRECT,
		MMTLink.SCENARIO_MMT,
		MMTLink.SCENARIO_LOCAL,
		MMTLink.SCENARIO_MMT,
		MMTLink.SCENARIO_DIRECT
	]:
		for link: MMTLink in [_here, _there]:
			link.scenario = scenario
		(_operator.get_node("Device") as HapticDevice).path = _down_after(0.5)
		_advance(0.4)
		check_near(_felt(_operator), Vector3.ZERO, 1e-9, "force above the floor, scenario %d" % scenario)
		_advance(0.4)
		check_near(_felt(_operator).y, 8.0, 1e-3, "force of scenario %d" % scenario)
		var wanted := MMTLink.STATE_OFF if scenario == MMTLink.SCENARIO_LOCAL else MMTLink.STATE_CONNECTED
		check_equal(_here.get_state(), wanted, "state: " + _here.get_state_text())


func test_every_property_may_change_while_a_body_is_pressed() -> void:
	await _connect(MMTLink.SCENARIO_MMT, 0.05)
	add_floor(_far, STIFFNESS)
	_add_hands(0.3)
	_advance(1.0)
	var changes := {}
	for part: String in ["conditions", "tuning"]:
		var values: Resource = _here.get(part)
		for property in values.get_property_list():
			var name := "%s:%s" % [part, property.name]
			if not property.usage & PROPERTY_USAGE_STORAGE:
				continue
			if property.type == TYPE_FLOAT:
				changes[name] = float(values.get(property.name)) * 0.5
			elif property.hint == PROPERTY_HINT_ENUM:
				changes[name] = 1
	changes.merge({"control_scheme": 1, "correction_scheme": 1})
	check(changes.size() > 33, "only %d properties are found" % changes.size())
	for name: String in changes:
		for link: MMTLink in [_here, _there]:
			link.set_indexed(name, changes[name])
		_advance(0.01)
		check_near(_felt(_operator).y, 8.0, 1e-3, "force after the change of " + name)


func test_bad_values_are_refused_and_the_old_ones_stay() -> void:
	var link := MMTLink.new()
	link.conditions = MMTNetworkConditions.new()
	link.tuning = MMTTuning.new()
	add_child(link)
	for wrong: Array in [
		["conditions:delay", -1.0],
		["conditions:delay", NAN],
		["conditions:delay", "long"],
		["conditions:loss", 1.5],
		["conditions:jitter_shape", 4],
		["conditions:clock_drift", 0.1],
		["conditions:seed", -1],
		["local_port", 70000],
		["remote_port", -1],
		["tuning:state_interval", 0],
		["tuning:repeated_samples", 17],
		["tuning:repeated_samples", 1.5],
		["tuning:stealth_window", 0.0],
		["tuning:derivation", 6],
		["control_scheme", 4],
		["correction_scheme", -1],
		["scenario", 6],
		["side", 7],
	]:
		var before: Variant = link.get_indexed(wrong[0])
		expect_error("%s = %s was refused" % [wrong[0].get_slice(":", wrong[0].count(":")), wrong[1]])
		link.set_indexed(wrong[0], wrong[1])
		check(link.get_indexed(wrong[0]) == before, "%s took %s" % wrong)
	link.conditions.jitter_shape = MMTNetworkConditions.JITTER_TRACE
	link.conditions.trace_file = "res://nothing.txt"
	check(link.get_problems()[-1].contains("there is no file"), "no warning about the trace")
	link.queue_free()


func test_links_share_their_conditions() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	_there.conditions = _here.conditions
	_here.conditions.delay = 0.05
	add_floor(_far, STIFFNESS)
	_add_hands(0.1)
	_advance(1.0)
	check_near(_here.get_statistics().round_trip_s, 0.1, 0.02, "round trip")
	var seen := [0]
	_here.tuning.changed.connect(func() -> void: seen[0] += 1)
	_here.tuning.derivation = MMTTuning.DERIVATION_VELOCITY
	_here.tuning.derivation = MMTTuning.DERIVATION_VELOCITY
	check_equal(seen[0], 1, "changes that were told")


## Two operators at one environment, which has an MMTLink and a pointer for each.
func test_several_operators_touch_one_environment() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	var guest := add_world()
	guest.name = "Guest"
	var at_guest := _link(guest, MMTLink.SIDE_OPERATOR, MMTLink.SCENARIO_MMT)
	var to_guest := _link(_far, MMTLink.SIDE_TELEOPERATOR, MMTLink.SCENARIO_MMT)
	to_guest.name = "ToGuest"
	at_guest.partner = NodePath("../../Far/ToGuest")
	to_guest.partner = NodePath("../../Guest/Link")
	add_floor(_far, STIFFNESS)
	_add_hands()
	add_hand(guest, _down_after(0.5))
	var second := ProxyPointer.new()
	second.name = "Second"
	_far.add_child(second)
	second.radius = 0.01
	second.device = NodePath("../Device")
	await frames(2)
	for _tick in 900:
		for world: HapticWorld in [_operator, guest, _far]:
			world.advance(TICK)
	for link: MMTLink in [_here, at_guest, _there, to_guest]:
		check_equal(link.get_state(), MMTLink.STATE_CONNECTED, link.get_state_text())
		check_equal(link.get_problems().size(), 0, "warnings: %s" % link.get_problems())
	for world: HapticWorld in [_operator, guest]:
		check_near(_felt(world), Vector3(0, 8, 0), 1e-3, "force at " + world.name)
	check_near((_far.get_node("Proxy") as ProxyPointer).get_force().y, 10.0, 1e-3, "the first one's hand")
	check_near(second.get_force().y, 10.0, 1e-3, "the guest's hand")
	await frames(1)
	var others := {_here: second, at_guest: _far.get_node("Proxy")}
	for link: MMTLink in others:
		var ghosts := link.get_ghosts()
		check_equal(ghosts.size(), 1, "ghosts at " + link.get_parent().name)
		if ghosts.size() == 1:
			var other: ProxyPointer = others[link]
			check_near(ghosts[0].position, other.get_proxy_position(), 2e-4, "the other's fingertip")
			check_near(ghosts[0].radius, other.radius, 1e-6, "its radius")
			check(ghosts[0].touching, "it touches")
	check_equal(_seen_balls(_here).size(), 1, "ghosts that are seen")
	_seen_balls(_here)[0].free()  # a script may
	for world: HapticWorld in [_operator, guest, _far]:
		world.advance(TICK)
	await frames(1)
	check_equal(_seen_balls(_here).size(), 1, "ghosts that are seen again")
	_seen_balls(_here)[0].free()
	_here.show_ghosts = false
	check_equal(_seen_balls(_here).size(), 0, "ghosts that are seen when none are asked for")
	check_equal(_there.get_ghosts().size(), 0, "ghosts at the other side")


func _seen_balls(link: MMTLink) -> Array[Node]:
	return link.get_children(true).filter(
		func(child: Node) -> bool: return child is MeshInstance3D and (child as MeshInstance3D).visible
	)


func test_a_link_says_what_it_lacks() -> void:
	var lonely := MMTLink.new()
	add_child(lonely)
	check(
		lonely.get_problems()[0].contains("no HapticWorld above it"),
		"without a world: %s" % lonely.get_problems()
	)
	var world := add_world()
	var first := _link(world, MMTLink.SIDE_OPERATOR, MMTLink.SCENARIO_MMT)
	var second := _link(world, MMTLink.SIDE_OPERATOR, MMTLink.SCENARIO_MMT)
	check(second.get_problems()[0].contains("another MMTLink"), "two of them: %s" % second.get_problems())
	check_equal(second.get_state(), MMTLink.STATE_FAILED, "state of the second")
	check(second.get_state_text().contains("remove one of the two"), second.get_state_text())
	check_equal(first.get_problems().size(), 0, "warnings of the first")
	expect_error("absolute path of a file outside of the project")
	first.key_file = "res://key"
	check_equal(first.key_file, "", "a key in the project")
	first.local_port = 5000
	first.remote_port = 5000
	check(first.get_problems()[0].contains("different ports"), "ports: %s" % first.get_problems())
	first.partner = NodePath("../../Nothing")
	check(first.get_problems()[0].contains("is not an MMTLink"), "partner: %s" % first.get_problems())
	world.position.x = 1.0
	check_equal(first.get_problems().size(), 1, "a moved world is none: %s" % first.get_problems())
	world.scale = Vector3.ONE * 2.0
	check(first.get_problems()[-1].contains("is scaled"), "scaled world: %s" % first.get_problems())


func test_partners_of_the_same_side_stay_apart() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	_there.side = MMTLink.SIDE_OPERATOR
	_advance(0.2)
	for link: MMTLink in [_here, _there]:
		check_equal(link.get_state(), MMTLink.STATE_FAILED, "state")
		check(link.get_state_text().contains("plays the same side"), link.get_state_text())


func test_a_far_side_that_vanishes_leaves_no_force_and_moves_nothing() -> void:
	for scenario: MMTLink.Scenario in [MMTLink.SCENARIO_DIRECT, MMTLink.SCENARIO_MMT]:
		await _connect(scenario, 0.02)
		add_floor(_far, STIFFNESS)
		_add_hands(0.3)
		_advance(0.6)
		check_near(_felt(_operator).y, 8.0, 1e-3, "force before")
		var lost := [0]
		_here.peer_lost.connect(func() -> void: lost[0] += 1)
		for _tick in 1500:
			_operator.advance(TICK)
		check_equal(_here.get_state(), MMTLink.STATE_LOST, "state: " + _here.get_state_text())
		check_equal(lost[0], 1, "peer_lost")
		var wanted := 0.0 if scenario == MMTLink.SCENARIO_DIRECT else 8.0
		check_near(_felt(_operator).y, wanted, 1e-3, "force when nobody answers")
		_operator.free()
		_far.free()


func test_a_far_side_that_restarts_is_met_again_with_its_bodies() -> void:
	await _connect(MMTLink.SCENARIO_MMT, 0.02)
	add_floor(_far, STIFFNESS)
	_add_hands(0.3)
	_advance(0.6)
	var restarts := [0]
	_here.peer_restarted.connect(func() -> void: restarts[0] += 1)
	_far.max_bodies = 512  # starts it anew
	_advance(1.0)
	check_equal(restarts[0], 1, "peer_restarted")
	check_equal(_here.get_state(), MMTLink.STATE_CONNECTED, "state: " + _here.get_state_text())
	check_equal(_here.get_statistics().objects, 1, "objects")


func test_a_body_that_comes_and_goes_at_the_far_side_comes_and_goes_here() -> void:
	await _connect(MMTLink.SCENARIO_MMT, 0.02)
	_advance(0.3)
	var floor_body := add_floor(_far, STIFFNESS)
	_advance(0.3)
	check_equal(_here.get_statistics().objects, 1, "objects")
	var removed := []
	_here.object_removed.connect(func(name: String) -> void: removed.append(name))
	floor_body.free()
	_advance(0.3)
	check_equal(removed, ["Floor"], "removed")
	await frames(1)
	check_equal(_operator.find_children("*", "MeshInstance3D", true, false).size(), 0, "pictures")


func test_what_an_experiment_makes_wrong_about_the_model_is_corrected() -> void:
	await _connect(MMTLink.SCENARIO_MMT, 0.05)
	_here.model_errors = {"Floor": {"move": [0, -0.01, 0]}}
	_here.correction_scheme = MMTLink.CORRECTION_NONE
	add_floor(_far, STIFFNESS)
	_add_hands(0.3)
	await frames(1)
	_advance(1.0)
	check_near(_felt(_operator).y, 5.0, 1e-3, "force of the wrong model")
	_here.correction_scheme = MMTLink.CORRECTION_MASKED_DIRECTION
	_advance(5.0)
	check_near(_felt(_operator).y, 8.0, 0.02, "force of the corrected model")
	check(
		_here.get_statistics().correction_force_step_max_n < 0.02,
		"a step of %s N" % _here.get_statistics().correction_force_step_max_n
	)


func test_a_wrong_rotation_of_the_model_is_in_radians() -> void:
	await _connect(MMTLink.SCENARIO_MMT, 0.05)
	_here.correction_scheme = MMTLink.CORRECTION_NONE
	add_floor(_far, STIFFNESS)
	_add_hands(0.3)
	# The former word is in degrees.
	for wrong: Dictionary in [{"rotation": [0, 0, 1, 0.1]}, {"turn": [0, 0, 1, rad_to_deg(0.1)]}]:
		_here.model_errors = {"Floor": wrong}
		await frames(1)
		_advance(1.0)
		check_near(_felt(_operator).angle_to(Vector3.UP), 0.1, 1e-3, "tilt of the force with %s" % wrong)


func test_a_history_that_is_shorter_than_the_delay_is_told() -> void:
	await _connect(MMTLink.SCENARIO_MMT, 0.4)
	_here.history = 0.2
	add_floor(_far)
	var body := with_shape(RigidBody3D.new(), box(0.1 * Vector3.ONE), Vector3(1, 0.05, 0)) as RigidBody3D
	_far.add_child(body)
	_add_hands()
	_advance(2.0)
	body.linear_velocity = Vector3(0.3, 0, 0)
	_advance(3.0)
	check_equal(_here.get_state(), MMTLink.STATE_CONNECTED, "state")
	var text := _here.get_state_text()
	check("history is 0.20 s" in text and "set 'history'" in text, "it says: %s" % text)
	check(_here.get_statistics().states_beyond_history > 0, "none is counted")
	_here.history = 0.6
	_advance(5.0)
	check_equal(_here.get_state_text(), "connected", "with a history that is longer")


func test_two_runs_are_the_same_to_the_bit() -> void:
	var forces: Array[PackedVector3Array] = []
	for run in 2:
		await _connect(MMTLink.SCENARIO_MMT, 0.05)
		for link: MMTLink in [_here, _there]:
			link.conditions.jitter = 0.01
			link.conditions.loss = 0.2
		add_floor(_far, STIFFNESS)
		_add_hands(0.3)
		var one := PackedVector3Array()
		for _tick in 600:
			_advance(TICK)
			one.append(_felt(_operator))
		forces.append(one)
		_operator.free()
		_far.free()
	check(forces[0] == forces[1], "they differ")
	check(forces[0][599].length() > 1.0, "nothing is felt")


func test_what_has_no_body_in_the_scene_gets_a_picture_of_its_form() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	var capsule := CapsuleShape3D.new()
	capsule.radius = 0.1
	capsule.height = 0.4
	var cylinder := CylinderShape3D.new()
	cylinder.radius = 0.1
	cylinder.height = 0.3
	var hull := ConvexPolygonShape3D.new()
	hull.points = PackedVector3Array([Vector3.ZERO, Vector3.RIGHT, Vector3.UP, Vector3.BACK])
	var triangles := ConcavePolygonShape3D.new()
	triangles.set_faces(PackedVector3Array([Vector3.ZERO, Vector3.RIGHT, Vector3.BACK]))
	var heights := HeightMapShape3D.new()
	heights.map_width = 3
	heights.map_depth = 4
	heights.map_data = PackedFloat32Array([0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0, 0, 0])
	var sizes := {
		sphere(0.2): Vector3(0.4, 0.4, 0.4),
		box(Vector3(0.1, 0.2, 0.3)): Vector3(0.1, 0.2, 0.3),
		capsule: Vector3(0.2, 0.4, 0.2),
		cylinder: Vector3(0.2, 0.3, 0.2),
		hull: Vector3.ONE,
		triangles: Vector3(1, 0, 1),
		heights: Vector3(2, 0.5, 3),
		WorldBoundaryShape3D.new(): Vector3(20, 0, 20),
	}
	var found := {}
	_here.object_discovered.connect(func(name: String, node: Node3D) -> void: found[name] = node)
	for shape: Shape3D in sizes:
		var body := with_shape(StaticBody3D.new(), shape)
		body.name = shape.get_class()
		_far.add_child(body)
	_advance(1.0)
	for shape: Shape3D in sizes:
		check(found.has(shape.get_class()), shape.get_class() + " is not found")
		var picture: MeshInstance3D = found[shape.get_class()].get_child(0)
		check_near(picture.mesh.get_aabb().size, sizes[shape], 0.01, "size of " + shape.get_class())
