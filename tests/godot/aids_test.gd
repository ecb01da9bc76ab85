extends "nodes_case.gd"
## What acts on a hand beside surfaces, for pointers and for tools; guides that go along with nodes; buttons,
## needles and knobs.

const FOLDER := "user://aids_test"


func _bar() -> BoxMesh:
	var mesh := BoxMesh.new()
	mesh.size = Vector3(0.2, 0.02, 0.02)
	return mesh


## A tool in a hand that stands still.
func _add_tool(world: HapticWorld, at: Vector3) -> HapticTool:
	add_device(world, path(at, at))
	var tool := HapticTool.new()
	tool.name = "Tool"
	tool.mesh = _bar()
	tool.device = NodePath("../Device")
	world.add_child(tool)
	return tool


func _spring() -> HapticForce:
	var force := HapticForce.new()
	force.form = HapticForce.FORM_SPRING
	return force


func _effect_below(node: Node3D, hand: Node3D) -> HapticEffect:
	var effect := HapticEffect.new()
	node.add_child(effect)
	effect.proxy = effect.get_path_to(hand)
	return effect


func test_a_tool_feels_an_effect_and_a_guide() -> void:
	var world := add_world()
	var tool := _add_tool(world, Vector3(0.01, 0, 0))
	var spring := HapticEffect.new()
	spring.formula = _spring()
	tool.add_child(spring)
	world.advance(0.3)
	check_equal(spring.get_state_text(), "working", "state")
	check_near(tool.get_force(), Vector3(-2, 0, 0), 1e-6, "force of the effect")
	var guide := HapticGuide.new()
	guide.form = HapticGuide.FORM_POINT
	guide.mode = HapticGuide.MODE_HOLD
	guide.points = PackedVector3Array([Vector3(0.01, 0.01, 0)])
	guide.stiffness = 300.0
	tool.guide = guide
	world.advance(0.3)
	check_near(tool.get_force(), Vector3(-2, 3, 0), 1e-6, "with the guide")
	check_equal(Array(tool.get_problems()), [], "problems")


func test_a_tool_feels_a_scripts_force() -> void:
	var world := add_world()
	var tool := _add_tool(world, Vector3.ZERO)
	var effect := HapticEffect.new()
	var script := GDScript.new()
	script.source_code = (
		"extends HapticEffect\n"
		+ "func _get_force(_hand: Vector3, _velocity: Vector3, _time: float) -> Vector3:\n"
		+ "\treturn Vector3(0, 1.5, 0)\n"
	)
	script.reload()
	effect.set_script(script)
	tool.add_child(effect)
	for _i in 40:
		world.advance(0.016)
		await frames(1)
	check_near(tool.get_force(), Vector3(0, 1.5, 0), 1e-3, "force")


func test_a_recorder_writes_the_ticks_of_a_tool() -> void:
	DirAccess.make_dir_recursive_absolute(FOLDER)
	var world := add_world()
	var tool := _add_tool(world, Vector3(0.01, 0, 0))
	tool.add_child(HapticEffect.new())
	(tool.get_child(-1) as HapticEffect).formula = _spring()
	world.advance(0.3)
	var recorder := HapticRecorder.new()
	recorder.autostart = false
	recorder.csv_path = FOLDER.path_join("tool.csv")
	world.add_child(recorder)
	recorder.proxy_node = tool
	check_equal(recorder.proxy_node, tool, "what is recorded")
	check(recorder.start(), "it does not start")
	world.advance(0.1)
	await frames(2)
	recorder.stop()
	check_equal(recorder.get_rows(), 100, "rows")
	check_equal(Array(recorder.get_problems()), [], "problems")
	var rows := FileAccess.get_file_as_string(recorder.csv_path).strip_edges().split("\n")
	var names := rows[0].split(",")
	var values := rows[-1].split(",")
	check_near(float(values[names.find("force_x")]), -2.0, 1e-6, "force")


func test_a_guide_moves_with_its_node() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var frame := Node3D.new()
	world.add_child(frame)
	var effect := _effect_below(frame, proxy)
	var guide := HapticGuide.new()
	guide.form = HapticGuide.FORM_LINE
	guide.mode = HapticGuide.MODE_HOLD
	guide.points = PackedVector3Array([Vector3.ZERO, Vector3(0.1, 0, 0)])
	guide.stiffness = 300.0
	effect.guide = guide
	world.advance(0.2)
	check_near(proxy.get_force(), Vector3.ZERO, 1e-6, "force on the line")
	frame.position = Vector3(0.05, 0.01, 0)
	world.advance(0.2)
	check_near(proxy.get_force(), Vector3(0, 3, 0), 1e-4, "force beside it")
	frame.rotation.z = PI / 2.0
	world.advance(0.2)
	check_near(proxy.get_force(), Vector3(15, 0, 0), 1e-3, "force where it stands upright")
	frame.scale = Vector3(2, 2, 2)
	guide.points = PackedVector3Array([Vector3(0, 0, 0.01), Vector3(0.1, 0, 0.01)])
	world.advance(0.5)
	check_near(proxy.get_force(), Vector3(15, 0, 6), 1e-3, "force where it is twice as large")
	effect.enabled = false
	world.advance(0.3)
	check_near(proxy.get_force(), Vector3.ZERO, 1e-6, "force without it")


## A circle of 5 cm of four curved pieces, which 16 chords miss by 1 mm.
func test_a_guide_is_within_a_tenth_of_a_millimetre_of_its_curve() -> void:
	var curve := Curve3D.new()
	var handle := 0.05 * 4.0 / 3.0 * tan(PI / 8.0)
	for i in 5:
		var at := Vector3(0.05, 0, 0).rotated(Vector3.UP, i * PI / 2.0)
		var along := Vector3(0, 0, -handle).rotated(Vector3.UP, i * PI / 2.0)
		curve.add_point(at, -along, along)
	var guide := HapticGuide.new()
	guide.curve = curve
	check_equal(Array(guide.get_problems()), [], "problems")
	var worst := 0.0
	for piece in 4:
		for i in 200:
			var place := curve.sample(piece, i / 200.0)
			worst = maxf(worst, guide.get_place(place * 1.1).distance_to(place))
	# Beside the nearest place, and not off the curve, by what single precision and the chords make.
	var off := 0.0
	for i in 1000:
		var hand := Vector3(0.06, 0.01, 0).rotated(Vector3.UP, i * TAU / 1000.0)
		off = maxf(off, absf(Vector2(guide.get_place(hand).x, guide.get_place(hand).z).length() - 0.05))
	check(off < 1e-4, "%s mm off the curve" % (1e3 * off))
	check(worst < 2e-4, "%s mm from the nearest place" % (1e3 * worst))


func test_a_guide_of_many_points_leads_to_each() -> void:
	var guide := HapticGuide.new()
	var points := PackedVector3Array()
	for i in 1000:
		points.append(Vector3(1e-3 * i, 0.01 * sin(0.1 * i), 0))
	guide.points = points
	check_equal(Array(guide.get_problems()), [], "problems")
	check_near(guide.get_place(points[777]), points[777], 1e-6, "a place on it")


func test_a_forbidden_region_keeps_the_hand_out() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3(0, 0.02, 0), Vector3(0, 0.02, 0)))
	proxy.guide = HapticGuide.new()
	proxy.guide.form = HapticGuide.FORM_POINT
	proxy.guide.mode = HapticGuide.MODE_FORBID
	proxy.guide.points = PackedVector3Array([Vector3.ZERO])
	proxy.guide.range = 0.03
	proxy.guide.stiffness = 300.0
	world.advance(0.3)
	check_near(proxy.get_force(), Vector3(0, 3, 0), 1e-5, "force within the region")


func test_a_button_follows_its_curve() -> void:
	var curve := Curve.new()
	curve.max_domain = 4.0
	curve.max_value = 4.0
	for point: Vector2 in [Vector2(0, 0), Vector2(1, 2), Vector2(2, 1), Vector2(4, 3)]:
		curve.add_point(point, 0, 0, Curve.TANGENT_LINEAR, Curve.TANGENT_LINEAR)
	var look := material(2000.0)
	look.force_curve = curve
	for case: Array in [[0.0005, 1.0], [0.001, 2.0], [0.0015, 1.5], [0.002, 1.0], [0.005, 5.0]]:
		var world := add_world()
		add_floor(world).physics_material_override = look
		var depth: float = case[0]
		var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, 0.01 - depth, 0)))
		world.advance(1.2)
		check_near(proxy.get_force().y, case[1], 0.02, "force at %s mm" % (1e3 * depth))
		world.free()


func test_a_curve_that_is_no_force_is_said() -> void:
	var curve := Curve.new()
	curve.min_value = -1.0
	curve.add_point(Vector2(0, 0))
	curve.add_point(Vector2(1, -1))
	var look := material(500.0)
	look.force_curve = curve
	var world := add_world()
	add_floor(world).physics_material_override = look
	add_hand(world, path(Vector3(0, 0.05, 0), Vector3.ZERO))
	expect_error("'force_curve' of its HapticMaterial is not felt")
	world.advance(1.2)


func test_a_needle_tells_what_it_breaks_and_leaves() -> void:
	var look := material(1000.0)
	look.pop_through_force = 2.0
	look.shaft_friction = 50.0
	var world := add_world()
	add_floor(world).physics_material_override = look
	var way := path(Vector3(0, 0.02, 0), Vector3(0, -0.02, 0))
	way.points_positions = PackedVector3Array(
		[Vector3(0, 0.02, 0), Vector3(0, -0.02, 0), Vector3(0, 0.03, 0)]
	)
	way.points_times = PackedFloat64Array([0.0, 1.0, 2.0])
	var proxy := add_hand(world, way, 0.001)
	var events := []
	proxy.surface_broken.connect(
		func(body: Node3D, force: float) -> void: events.append([String(body.name), snappedf(force, 0.1)])
	)
	proxy.surface_left.connect(func(body: Node3D) -> void: events.append([String(body.name)]))
	world.advance(1.0)
	check_near(proxy.get_force(), Vector3(0, 50.0 * 0.02, 0), 0.02, "friction along the shaft")
	world.advance(1.5)
	check_equal(events, [["Floor", 2.0], ["Floor"]], "what was told")


func test_a_knob_rests_in_its_detents() -> void:
	var world := add_world()
	var knob := with_shape(RigidBody3D.new(), box(Vector3(0.03, 0.03, 0.02))) as RigidBody3D
	knob.name = "Knob"
	knob.mass = 0.04
	world.add_child(knob)
	var hinge := HingeJoint3D.new()
	world.add_child(hinge)
	hinge.node_a = hinge.get_path_to(knob)
	var drive := HapticJointDrive.new()
	drive.stiffness = 0.1
	drive.damping = 5e-4
	drive.pitch = deg_to_rad(30.0)
	drive.strength = 0.02
	hinge.add_child(drive)
	check_equal(Array(drive.get_problems()), [], "problems")
	world.advance(0.1)
	knob.angular_velocity = Vector3(0, 0, 60)
	world.advance(3.0)
	var angle := rad_to_deg(knob.rotation.z)
	check(absf(angle) > 20.0, "it has not turned: %s" % angle)
	check_near(angle, snappedf(angle, 30.0), 1.0, "angle")


func test_a_drive_rests_where_the_joints_limits_count() -> void:
	for rest: float in [0.3, -0.4]:
		var world := add_world()
		var knob := with_shape(RigidBody3D.new(), box(Vector3(0.03, 0.03, 0.02))) as RigidBody3D
		knob.mass = 0.04
		world.add_child(knob)
		var hinge := HingeJoint3D.new()
		hinge.set_flag(HingeJoint3D.FLAG_USE_LIMIT, true)
		hinge.set_param(HingeJoint3D.PARAM_LIMIT_LOWER, -0.5)
		hinge.set_param(HingeJoint3D.PARAM_LIMIT_UPPER, 0.5)
		world.add_child(hinge)
		hinge.node_a = hinge.get_path_to(knob)
		var drive := HapticJointDrive.new()
		drive.stiffness = 0.1
		drive.damping = 2e-3
		drive.rest = rest
		hinge.add_child(drive)
		world.advance(3.0)
		check_near(knob.rotation.z, rest, 0.01, "angle")
		world.free()


func test_a_drive_in_a_wrong_place_says_so() -> void:
	var world := add_world()
	var drive := HapticJointDrive.new()
	world.add_child(drive)
	check(drive.get_problems()[0].contains("directly below a HingeJoint3D"), "no problem")


## In the order in which a script may add them, each without what it needs.
func test_a_scene_of_a_guide_alone_that_a_script_builds_says_nothing() -> void:
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	var proxy := ProxyPointer.new()
	world.add_child(proxy)
	add_child(world)
	var guide := HapticGuide.new()
	guide.form = HapticGuide.FORM_POINT
	guide.points = PackedVector3Array([Vector3.ZERO])
	proxy.guide = guide
	var device := add_device(world, path(Vector3(0, 0.01, 0), Vector3(0, 0.01, 0)))
	proxy.device_node = device
	for _i in 20:
		world.advance(0.016)
		await frames(1)
	check_equal(Array(world.get_problems()), [], "problems of the world")
	check_equal(Array(proxy.get_problems()), [], "problems of the proxy")
	check_near(proxy.get_force(), Vector3(0, -200.0 * 0.01 * (1.0 - 0.01 / 0.03), 0), 1e-4, "force")


func test_a_tool_says_which_effects_of_a_surface_it_does_not_feel() -> void:
	var world := add_world()
	var look := material(500.0)
	look.pop_through_force = 2.0
	look.vibration_force = 1.0
	add_floor(world).physics_material_override = look
	var tool := _add_tool(world, Vector3(0, 0.1, 0))
	world.advance(0.2)
	var problems := "\n".join(tool.get_problems())
	check(problems.contains("pop_through_force") and problems.contains("vibration_force"), problems)


## More than a hand has room for are said where they are.
func test_an_effect_without_room_says_so() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var effects: Array[HapticEffect] = []
	for _i in 5:
		effects.append(_effect_below(proxy, proxy))
		effects[-1].guide = HapticGuide.new()
		effects[-1].guide.form = HapticGuide.FORM_POINT
		effects[-1].guide.points = PackedVector3Array([Vector3(0.01, 0, 0)])
	expect_error("four guides")
	world.advance(0.2)
	check_equal(effects[3].get_state_text(), "working", "the fourth")
	check(effects[4].get_state_text().contains("four guides"), effects[4].get_state_text())
	check_equal(effects[4].get_state(), HapticEffect.STATE_FAILED, "state")
	check_equal(effects[4].get_problems().size(), 1, "problems")
	effects[0].enabled = false
	world.advance(0.2)
	check_equal(effects[4].get_state_text(), "working", "with room")


func _needle(world: HapticWorld) -> Array[String]:
	var told: Array[String] = []
	var skin := material(800.0)
	skin.pop_through_force = 1.0
	var layer := with_shape(StaticBody3D.new(), box(Vector3(0.1, 0.02, 0.1)), Vector3(0, -0.01, 0))
	layer.name = "Layer"
	(layer as StaticBody3D).physics_material_override = skin
	world.add_child(layer)
	var needle := add_hand(world, path(Vector3(0, 0.02, 0), Vector3(0, -0.01, 0)))
	needle.surface_broken.connect(func(body: Node3D, _force: float) -> void: told.append("in " + body.name))
	needle.surface_left.connect(func(body: Node3D) -> void: told.append("out " + body.name))
	world.advance(1.2)
	check_equal(told, ["in Layer"], "before")
	return told


## A body that goes, and a needle that is switched off, are left as well.
func test_each_surface_that_is_broken_is_left_once() -> void:
	var world := add_world()
	var told := _needle(world)
	world.get_node("Layer").free()
	world.advance(0.1)
	check_equal(told, ["in Layer", "out Layer"], "without the body")
	world = add_world()
	told = _needle(world)
	var needle: ProxyPointer = world.find_children("*", "ProxyPointer", false, false)[0]
	needle.enabled = false
	world.advance(0.1)
	check_equal(told, ["in Layer", "out Layer"], "switched off")
	needle.enabled = true
	world.advance(0.1)
	check_equal(told, ["in Layer", "out Layer"], "switched on within it")
	world = add_world()
	told = _needle(world)
	needle = world.find_children("*", "ProxyPointer", false, false)[0]
	world.remove_child(needle)
	await frames(2)
	check_equal(told, ["in Layer", "out Layer"], "taken away")
	needle.free()


## Godot's physics knows nothing of drives.
func test_a_drive_says_that_godot_moves_its_bodies() -> void:
	var world := add_world()
	var body := with_shape(RigidBody3D.new(), sphere(0.05)) as RigidBody3D
	world.add_child(body)
	var hinge := HingeJoint3D.new()
	world.add_child(hinge)
	hinge.node_a = hinge.get_path_to(body)
	var drive := HapticJointDrive.new()
	drive.stiffness = 1.0
	hinge.add_child(drive)
	world.advance(0.01)
	check_equal(Array(drive.get_problems()), [], "of the haptic world's")
	world.authority = HapticWorld.AUTHORITY_GODOT
	await frames(2)
	check("\n".join(drive.get_problems()).contains("'authority' to Haptic"), str(drive.get_problems()))


## As scripts build scenes: the path of the file after add_child().
func test_a_recorder_starts_with_a_file_of_the_same_frame() -> void:
	DirAccess.make_dir_recursive_absolute(FOLDER)
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var recorder := HapticRecorder.new()
	world.add_child(recorder)
	recorder.csv_path = FOLDER.path_join("late.csv")
	recorder.proxy_node = proxy
	await frames(1)
	world.advance(0.1)
	await frames(2)
	check_equal(recorder.get_rows(), 100, "rows; " + recorder.get_state_text())
	recorder.stop()


func test_a_force_of_the_scene_needs_no_bodies() -> void:
	var world := add_world()
	add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	(world.get_node("Device") as HapticDevice).applied_force = Vector3(0, 1, 0)
	world.advance(0.1)
	world.advance(0.1)
	check_near((world.get_node("Device") as HapticDevice).get_force(), Vector3(0, 1, 0), 1e-6, "force")
