extends "nodes_case.gd"
## What scripts do to nodes in their own signals and with values that make no sense: nothing breaks, and what
## is refused is said.


## A hand that presses the floor a twentieth of a second from now on.
func _pressed(world: HapticWorld) -> ProxyPointer:
	add_floor(world)
	return add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.05))


func _real_time() -> HapticWorld:
	var world := HapticWorld.new()
	world.gravity = Vector3.ZERO
	add_child(world)
	return world


# --- in their own signals


func test_a_world_taken_out_in_its_status() -> void:
	var world := _real_time()
	# More pairs than a world of so few bodies has set aside.
	world.max_bodies = 60
	for i in 50:
		var body := with_shape(RigidBody3D.new(), sphere(0.5), Vector3(i * 0.01, 0, 0))
		world.add_child(body)
	var seen := [0]
	world.status_reported.connect(
		func(_flags: int, _text: String) -> void:
			seen[0] += 1
			if world.is_inside_tree():
				remove_child(world)
	)
	check(await until(func() -> bool: return seen[0] > 0, 10.0), "no status was reported")
	await frames(3)
	check(not world.is_running(), "it runs outside the tree")
	world.free()


func test_a_world_taken_out_as_it_stops_does_not_run_on() -> void:
	var world := _real_time()
	_pressed(world)
	world.stopped.connect(
		func() -> void:
			if world.is_inside_tree():
				remove_child(world)
	)
	world.tick_rate = 500
	await frames(3)
	check(not world.is_inside_tree() and not world.is_running(), "it runs outside the tree")
	world.free()


func test_a_world_freed_in_a_contact() -> void:
	for real_time: bool in [true, false]:
		var world := _real_time() if real_time else add_world()
		var proxy := _pressed(world)
		var id := world.get_instance_id()
		proxy.contact_started.connect(func(_body: Node3D) -> void: instance_from_id(id).queue_free())
		if not real_time:
			world.advance(0.1)
		check(await until(func() -> bool: return not is_instance_id_valid(id), 5.0), "it was not freed")


func test_a_world_freed_at_once_in_a_contact() -> void:
	var world := _real_time()
	var proxy := _pressed(world)
	var id := world.get_instance_id()
	# The proxy goes with its world while it sends the signal: Godot survives that, and disapproves.
	expect_error("while a signal is being emitted from it")
	proxy.contact_started.connect(func(_body: Node3D) -> void: instance_from_id(id).free())
	check(await until(func() -> bool: return not is_instance_id_valid(id), 5.0), "it was not freed")


func test_proxies_freed_while_their_world_restarts() -> void:
	var world := add_world()
	var first := _pressed(world)
	var second := ProxyPointer.new()
	second.device = NodePath("../Device")
	world.add_child(second)
	world.advance(0.1)
	check(first.is_touching() and second.is_touching(), "they do not touch")
	var id := second.get_instance_id()
	first.contact_ended.connect(
		func(_body: Node3D) -> void:
			if is_instance_id_valid(id):
				instance_from_id(id).free()
	)
	world.tick_rate = 500
	await frames(2)
	check(not is_instance_id_valid(id), "the second was not freed")
	world.advance(0.1)
	check(first.is_touching(), "the first touches no more")


func test_a_started_world_may_be_set_and_restarts_no_more_than_asked() -> void:
	var world := _real_time()
	var starts := [0]
	world.started.connect(
		func() -> void:
			starts[0] += 1
			world.tick_rate = 500
	)
	world.tick_rate = 250
	await frames(4)
	check_equal(world.tick_rate, 500, "tick rate")
	# The start that is told of on entering the tree, the one at 250 Hz, the one at 500 Hz.
	check(starts[0] <= 3, "it started %d times" % starts[0])
	var before: int = starts[0]
	world.tick_rate = 500
	world.max_bodies = world.max_bodies
	world.processor = world.processor
	world.realtime_priority = world.realtime_priority
	world.lock_memory = world.lock_memory
	world.measure_baseline = world.measure_baseline
	world.clock = world.clock
	await frames(3)
	check_equal(starts[0], before, "starts by values that are no other ones")


func test_a_link_freed_or_restarted_in_its_own_signals() -> void:
	var worlds: Array[HapticWorld] = [add_world(), add_world()]
	var links: Array[MMTLink] = []
	for i in 2:
		worlds[i].name = "World%d" % i
		var link := MMTLink.new()
		link.name = "Link"
		link.scenario = MMTLink.SCENARIO_MMT
		link.side = i
		worlds[i].add_child(link)
		links.append(link)
	for i in 2:
		links[i].partner = NodePath("../../World%d/Link" % (1 - i))
	links[0].peer_connected.connect(func() -> void: worlds[0].tick_rate = 500)
	links[1].peer_connected.connect(func() -> void: worlds[1].remove_child(links[1]))
	await frames(2)
	for i in 100:
		worlds[0].advance(TICK)
		worlds[1].advance(TICK)
	await frames(2)
	check(not links[1].is_inside_tree(), "it never heard the other side")
	check_equal(worlds[0].tick_rate, 500, "tick rate")
	links[1].free()


func test_a_body_that_frees_things_while_it_is_moved() -> void:
	var mover := GDScript.new()
	mover.source_code = """extends RigidBody3D
var victim: Node
func _notification(what: int) -> void:
	if what == NOTIFICATION_LOCAL_TRANSFORM_CHANGED and victim != null and victim.is_inside_tree():
		var gone := victim
		victim = null
		gone.get_parent().remove_child(gone)
		gone.queue_free()
"""
	mover.reload()
	for what: String in ["Proxy", "Device", "Other", "World"]:
		var world := add_world()
		world.gravity = Vector3(0, -9.81, 0)
		_pressed(world)
		var other := with_shape(RigidBody3D.new(), sphere(0.1), Vector3(1, 2, 0))
		other.name = "Other"
		world.add_child(other)
		var body := with_shape(RigidBody3D.new(), sphere(0.1), Vector3(0.5, 1, 0))
		body.set_script(mover)
		body.set_notify_local_transform(true)
		world.add_child(body)
		world.advance(0.05)
		body.set("victim", world if what == "World" else world.get_node(what))
		if what == "Device":
			expect_error("is not a HapticDevice")
		world.advance(0.05)
		if is_instance_valid(world) and world.is_inside_tree():
			world.advance(0.05)
			remove_child(world)
			world.queue_free()
		await frames(2)


# --- with values that make no sense


func test_what_is_none_of_an_enum_is_refused() -> void:
	for one: Array in [
		[add_world(), "clock", 7],
		[HapticDevice.new(), "driver", 99],
		[ProxyPointer.new(), "force_law", 9],
		[HapticMaterial.new(), "preset", 17],
		[HapticPath.new(), "form", -1],
		[HapticPath.new(), "points_interpolation", 5],
	]:
		var object: Object = one[0]
		var before: Variant = object.get(one[1])
		expect_error("%s = %s was refused" % [one[1], one[2]])
		object.set(one[1], one[2])
		check_equal(object.get(one[1]), before, one[1])
		if object is Node and not object.is_inside_tree():
			object.free()


func test_time_cannot_be_advanced_past_its_end() -> void:
	var world := add_world()
	for seconds: float in [1e300, INF, NAN, -1.0, 3601.0]:
		expect_error("The time to advance must be between 0 and 3,600 s")
		check_equal(world.advance(seconds), 0, "ticks")
	check_equal(world.advance(0.1), 100, "ticks after that")


func _says(world: HapticWorld, text: String) -> void:
	expect_error(text)
	world.advance(0.01)
	var said := world.get_problems()
	check(not said.is_empty() and text in "\n".join(said), "'%s' is not said: %s" % [text, said])


func test_a_body_whose_place_is_no_place() -> void:
	for place: Vector3 in [Vector3(NAN, 0, 0), Vector3(0, INF, 0)]:
		var world := add_world()
		var body := add_floor(world)
		world.advance(0.01)
		body.position = place
		_says(world, "not made of finite numbers")
		body.position = Vector3(0, -0.1, 0)
		world.advance(0.01)
		check_equal(world.get_problems().size(), 0, "problems once it is back")
		remove_child(world)
		world.free()


func test_a_body_too_far_or_too_large() -> void:
	for one: Array in [
		[Transform3D(Basis(), Vector3(0, 1e12, 0)), "farther from the origin"],
		[Transform3D(Basis().scaled(Vector3.ONE * 1e20), Vector3.ZERO), "scaled"],
	]:
		for before: bool in [true, false]:
			var world := add_world()
			var body := with_shape(StaticBody3D.new(), box(Vector3.ONE))
			if before:
				body.transform = one[0]
			world.add_child(body)
			if not before:
				world.advance(0.01)
				body.transform = one[0]
			_says(world, one[1])
			remove_child(world)
			world.free()


func test_a_device_whose_place_is_no_place() -> void:
	var world := add_world()
	var proxy := _pressed(world)
	world.advance(0.1)
	var device: HapticDevice = world.get_node("Device")
	device.position.x = NAN
	expect_error("not made of finite numbers")
	world.advance(0.01)
	check(device.get_state_text().contains("not made of finite numbers"), device.get_state_text())
	check(not proxy.is_touching(), "it touches with a hand that is nowhere")
	device.position.x = 0.0
	world.advance(0.2)
	check(device.is_device_connected(), "the device does not come back")


func test_a_device_of_another_world() -> void:
	var here := add_world()
	var there := add_world()
	there.name = "There"
	add_floor(here)
	var proxy := add_hand(there, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.05))
	there.remove_child(proxy)
	here.add_child(proxy)
	proxy.device = NodePath("../../There/Device")
	expect_error("belongs to another HapticWorld")
	here.advance(0.1)
	check(proxy.get_state_text().contains("belongs to another HapticWorld"), proxy.get_state_text())
	check("belongs to another HapticWorld" in "\n".join(proxy.get_problems()), "no warning")


func test_a_preset_keeps_what_was_there_before() -> void:
	var own := material(432.0)
	own.friction = 0.45
	own.magnet_force = 1.5
	var steps: Array[HapticMaterial.Preset] = [
		HapticMaterial.PRESET_ICE, HapticMaterial.PRESET_STEEL, HapticMaterial.PRESET_CUSTOM
	]
	for preset in steps:
		own.preset = preset
		check_equal(own.preset, preset, "preset")
	check_near(own.stiffness, 432.0, 0.0, "stiffness")
	check_near(own.friction, 0.45, 1e-6, "friction")
	check_near(own.magnet_force, 1.5, 0.0, "force of the magnet")
	own.preset = HapticMaterial.PRESET_ICE
	own.stiffness = 999.0
	own.preset = HapticMaterial.PRESET_CUSTOM
	own.preset = HapticMaterial.PRESET_ICE
	check_near(own.stiffness, 999.0, 0.0, "stiffness of the changed ice")
	# As the editor takes back: every value as it was, in the order that it was changed in, backwards.
	own.stiffness = 2000.0
	own.preset = HapticMaterial.PRESET_CUSTOM
	check_near(own.stiffness, 432.0, 0.0, "stiffness after all is taken back")


func test_two_complaints_with_the_same_hash_are_both_said() -> void:
	var world := add_world()
	# Godot's 32-bit hash h(i + 1) = 33 h(i) + c gives any two texts that differ in these alone the same sum.
	for name: String in ["Ab", "BA"]:
		var body := StaticBody3D.new()
		body.name = name
		world.add_child(body)
		expect_error("%s: it has no shape" % body.get_path())
	world.advance(0.01)
