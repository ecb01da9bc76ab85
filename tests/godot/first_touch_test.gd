extends "nodes_case.gd"
## A first scene, made by somebody who has read nothing: it works, or something says what to do.


func _say(scene: Node, text: String, seconds := 0.2) -> void:
	expect_error(text)
	add_child(scene)
	for world in scene.find_children("*", "HapticWorld", true, false) + [scene]:
		if world is HapticWorld and world.is_running() and world.clock == HapticWorld.CLOCK_STEPPED:
			world.advance(seconds / 2.0)
			world.advance(seconds / 2.0)
	await until(func() -> bool: return false, 0.8)
	scene.queue_free()


func _stepped() -> HapticWorld:
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	world.gravity = Vector3.ZERO
	return world


func _device(way: HapticPath) -> HapticDevice:
	var device := HapticDevice.new()
	device.name = "Device"
	device.path = way
	return device


func _down() -> HapticPath:
	return path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1)


func test_the_mouse_moves_a_new_hand_and_a_path_where_there_is_one() -> void:
	var device := HapticDevice.new()
	check_equal(device.driver, HapticDevice.DRIVER_AUTOMATIC, "driver of a new device")
	var world := add_world()
	var camera := Camera3D.new()
	camera.position = Vector3(0, 0, 0.5)
	world.add_child(camera)
	world.add_child(device)
	world.advance(0.01)
	device.aim_mouse(get_viewport().get_visible_rect().size * 0.75)
	world.advance(0.5)
	var by_mouse := device.get_hand_position()
	check(by_mouse.x > 0.01 and by_mouse.y < -0.01, "the mouse does not move it: %s" % by_mouse)
	device.path = path(Vector3(0, 0.3, 0), Vector3(0, 0.3, 0), 0.1)
	world.advance(0.5)
	check_near(device.get_hand_position(), Vector3(0, 0.3, 0), 1e-3, "hand on the path")


func test_a_pointer_without_a_device_takes_the_nearest() -> void:
	var world := add_world()
	add_floor(world)
	for i in 2:
		var hand := Node3D.new()
		hand.name = "Hand%d" % i
		world.add_child(hand)
		var device := _device(path(Vector3(i, 0.05, 0), Vector3(i, -0.01, 0), 0.1))
		hand.add_child(device)
		var tip := ProxyPointer.new()
		tip.name = "Tip"
		(device if i == 1 else hand).add_child(tip)
	world.advance(0.3)
	for i in 2:
		var tip: ProxyPointer = world.get_node("Hand%d" % i).find_child("Tip", true, false)
		check_equal(tip.get_problems().size(), 0, "warnings: %s" % tip.get_problems())
		check_near(tip.get_hand_position().x, float(i), 1e-4, "place of hand %d" % i)


func test_the_rigs_work_as_they_are() -> void:
	for rig: String in ["HapticRig", "HapticRigTwoHands"]:
		var scene: Node3D = load("res://addons/tactus/%s.tscn" % rig).instantiate()
		var world: HapticWorld = scene.get_node("HapticWorld")
		world.clock = HapticWorld.CLOCK_STEPPED
		add_child(scene)
		await frames(1)
		for node in world.find_children("*", "", true, false) + [world]:
			if node.has_method("get_problems"):
				check_equal(node.get_problems().size(), 0, "%s: %s" % [node.name, node.get_problems()])
		check_equal(Array(world._list_warnings()), [], "warnings of the world")
		world.advance(0.1)
		var tips := world.find_children("*", "ProxyPointer", true, false)
		check_equal(tips.size(), 1 if rig == "HapticRig" else 2, "pointers")
		for tip: ProxyPointer in tips:
			check(tip.is_present() and not tip.is_touching(), "%s: %s" % [rig, tip.get_state_text()])
		var right: HapticDevice = tips[-1].get_parent()
		var below := world.get_viewport().get_camera_3d().unproject_position(Vector3(0.05, -0.03, 0.1))
		right.aim_mouse(below)
		world.advance(1.0)
		check(tips[-1].is_touching(), "%s: the mouse does not press: %s" % [rig, tips[-1].get_state_text()])
		scene.queue_free()
		await frames(1)


## The force is seen without a key and without a script.
func test_the_rig_shows_its_force() -> void:
	var scene: Node3D = load("res://addons/tactus/HapticRig.tscn").instantiate()
	var world: HapticWorld = scene.get_node("HapticWorld")
	world.clock = HapticWorld.CLOCK_STEPPED
	add_child(scene)
	await frames(1)
	var view: Node3D = world.get_node("HapticDevice/ProxyPointer/ForceView")
	var device: HapticDevice = world.get_node("HapticDevice")
	world.advance(0.1)
	await frames(2)
	check(not (view.get_node("%Arrow") as Node3D).visible, "an arrow without a force")
	var below := world.get_viewport().get_camera_3d().unproject_position(Vector3(0.05, -0.01, 0.1))
	device.aim_mouse(below)
	world.advance(1.0)
	await frames(2)
	var force := device.get_force()
	check(force.length() <= device.force_limit, "more than the device is given: %s" % force)
	var arrow: Node3D = view.get_node("%Arrow")
	check(force.length() > 0.1 and arrow.visible, "no arrow for %s" % force)
	check_near(arrow.global_basis.y, force.normalized(), 1e-4, "direction of the arrow")
	check_equal((view.get_node("%Words") as Label).text, "%.1f N" % force.length(), "words")


func test_without_a_world() -> void:
	var scene := Node3D.new()
	scene.add_child(HapticDevice.new())
	await _say(scene, "there is no HapticWorld: put one into the scene")


func test_a_pointer_without_any_device() -> void:
	var world := _stepped()
	world.add_child(ProxyPointer.new())
	await _say(world, "there is no HapticDevice in its world: add one")


func test_a_mouse_without_a_camera() -> void:
	var world := _stepped()
	world.add_child(HapticDevice.new())
	await _say(world, "the mouse needs a camera")


func test_a_mask_that_touches_nothing() -> void:
	for mask: int in [0, 4]:
		var world := _stepped()
		add_floor(world)
		var tip := add_hand(world, _down())
		tip.collision_mask = mask
		await _say(world, "'collision_mask'")


func test_a_hand_that_begins_inside_a_body() -> void:
	var world := _stepped()
	add_floor(world)
	add_hand(world, path(Vector3(0, -0.1, 0), Vector3(0, -0.1, 0), 1.0))
	await _say(world, "the hand began inside a body")


func test_a_fingertip_far_too_large_or_small() -> void:
	for radius: float in [30.0, 1e-6]:
		var world := _stepped()
		add_floor(world)
		add_hand(world, _down(), radius)
		await _say(world, "the proxy's radius")


func test_a_world_with_nothing_in_it() -> void:
	var scene := Node3D.new()
	var world := _stepped()
	scene.add_child(world)
	var outside := with_shape(StaticBody3D.new(), sphere(0.1))
	outside.name = "Outside"
	scene.add_child(outside)
	add_hand(world, _down())
	await _say(scene, "nothing in it can be touched")


func test_what_is_not_carried_over() -> void:
	for kind: String in ["CSGBox3D", "GridMap", "SoftBody3D", "PhysicalBone3D"]:
		var world := _stepped()
		world.authority = HapticWorld.AUTHORITY_HAPTIC
		add_floor(world)
		var node: Node = ClassDB.instantiate(kind)
		if kind == "CSGBox3D":
			node.use_collision = true
		world.add_child(node)
		await _say(world, "is not carried over")


func test_integrate_forces() -> void:
	var script := GDScript.new()
	script.source_code = "extends RigidBody3D\nfunc _integrate_forces(_state) -> void:\n\tpass\n"
	script.reload()
	var world := _stepped()
	world.authority = HapticWorld.AUTHORITY_HAPTIC
	var body := with_shape(RigidBody3D.new(), sphere(0.1))
	body.set_script(script)
	world.add_child(body)
	await _say(world, "_integrate_forces(), which is not called")


func test_impulses_and_forces_move_bodies() -> void:
	var world := add_world()
	var body := with_shape(RigidBody3D.new(), sphere(0.1)) as RigidBody3D
	body.mass = 2.0
	body.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	body.angular_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	world.add_child(body)
	world.advance(0.01)
	world.apply_central_impulse(body, Vector3(2, 0, 0))
	world.advance(0.01)
	check_near(world.get_linear_velocity(body), Vector3(1, 0, 0), 1e-4, "velocity after the impulse")
	world.apply_central_force(body, Vector3(0, 10, 0))
	world.advance(0.1)
	world.advance(0.1)
	check_near(world.get_linear_velocity(body), Vector3(1, 0.5, 0), 1e-3, "velocity after a frame's force")
	world.apply_torque_impulse(body, Vector3(0, 0.008, 0))
	world.advance(0.01)
	# A ball of 2 kg and 0.1 m: 2/5 m r² = 0.008 kg·m².
	check_near(world.get_angular_velocity(body), Vector3(0, 1, 0), 1e-3, "turning")
	world.apply_impulse(body, Vector3(0, 0, 0.08), Vector3(0.1, 0, 0))
	world.advance(0.01)
	check_near(
		world.get_angular_velocity(body), Vector3(0, 0, 0), 2e-3, "turning after an impulse beside the centre"
	)
	var still := add_floor(world)
	world.advance(0.01)
	expect_error("apply_central_impulse() did nothing: the body is no RigidBody3D")
	world.apply_central_impulse(still, Vector3.UP)
	expect_error("apply_impulse() did nothing: what it is given is not made of finite numbers")
	world.apply_impulse(body, Vector3(NAN, 0, 0))


func _warnings(of: Node) -> String:
	return " ".join(of._list_warnings() if of is HapticWorld else of.get_problems())


## The editor's warnings come from the same place, whether the scene runs or not.
func test_warnings_in_the_editor_name_what_the_scene_lacks() -> void:
	var world := _stepped()
	add_floor(world)
	var tip := add_hand(world, _down())
	var device: HapticDevice = world.get_node("Device")
	add_child(world)
	check_equal(_warnings(tip), "", "of a scene that works")
	check_equal(_warnings(device), "", "of its hand")
	tip.collision_mask = 4
	check(_warnings(tip).contains("'collision_mask' has no layer"), "mask: " + _warnings(tip))
	tip.collision_mask = 1
	for radius: float in [30.0, 1e-6]:
		tip.radius = radius
		check(_warnings(tip).contains("the proxy's radius"), "size: " + _warnings(tip))
	tip.radius = 0.01
	device.path = path(Vector3(0, -0.1, 0), Vector3(0, 0.1, 0))
	check(_warnings(tip).contains("its hand begins inside 'Floor'"), "inside: " + _warnings(tip))
	device.position.y = 0.3
	check_equal(_warnings(tip), "", "once it is out")
	device.driver = HapticDevice.DRIVER_PATH
	device.path = null
	check(_warnings(device).contains("set 'path' to a HapticPath"), "path: " + _warnings(device))
	device.free()
	check(_warnings(tip).contains("is not a HapticDevice"), "device: " + _warnings(tip))
	tip.device = NodePath()
	check(_warnings(tip).contains("there is no HapticDevice in its world"), "device: " + _warnings(tip))


func test_warnings_of_what_stands_outside() -> void:
	var scene := Node3D.new()
	var world := _stepped()
	scene.add_child(world)
	add_floor(world)
	var outside := with_shape(StaticBody3D.new(), sphere(0.1)) as StaticBody3D
	outside.name = "Outside"
	outside.physics_material_override = material(100.0)
	scene.add_child(outside)
	await _say(scene, "'Outside' has a HapticMaterial and is not felt", 0.4)
	scene = Node3D.new()
	var body := with_shape(StaticBody3D.new(), sphere(0.1))
	var mesh := HapticMesh.new()
	mesh.library_mesh = "cube"
	body.add_child(mesh)
	scene.add_child(body)
	await _say(scene, "its body stands outside of every HapticWorld")
	scene = Node3D.new()
	scene.add_child(HapticMesh.new())
	scene.get_child(0).library_mesh = "cube"
	await _say(scene, "it belongs to no body")


func test_a_recorder_without_a_world() -> void:
	var recorder := HapticRecorder.new()
	recorder.autostart = false
	var scene := Node3D.new()
	scene.add_child(recorder)
	add_child(scene)
	check(_warnings(recorder).contains("there is no HapticWorld"), _warnings(recorder))
	remove_child(scene)
	await _say(scene, "there is no HapticWorld: put one into the scene")


func test_a_control_that_takes_the_mouse() -> void:
	var scene := Node3D.new()
	var world := _stepped()
	scene.add_child(world)
	add_floor(world)
	world.add_child(Camera3D.new())
	var device := HapticDevice.new()
	world.add_child(device)
	var sheet := ColorRect.new()
	sheet.name = "Sheet"
	sheet.size = get_viewport().get_visible_rect().size
	scene.add_child(sheet)
	expect_error("'Sheet' lies over the view and takes the mouse")
	add_child(scene)
	var motion := InputEventMouseMotion.new()
	motion.position = Vector2(get_viewport().size) * 0.5
	motion.global_position = motion.position
	Input.parse_input_event(motion)
	await frames(3)
	world.advance(0.1)
	check(_warnings(device).contains("takes the mouse"), _warnings(device))
	sheet.mouse_filter = Control.MOUSE_FILTER_IGNORE
	await frames(2)
	check(not _warnings(device).contains("takes the mouse"), "it still warns")
