extends "nodes_case.gd"
## Every node says what it does and what is wrong with it in the same words.

## With a state that the code knows, beside its text.
const WITH_STATE := [
	"HapticWorld",
	"HapticRecorder",
	"HapticDevice",
	"ProxyPointer",
	"HapticTool",
	"HapticEffect",
	"HapticVibrationSound",
	"MMTLink",
	"HapticDepthSensor"
]
## Parts of a body or of a joint: they neither start nor stop, and what keeps them from acting is a problem.
const WITHOUT_STATE := ["HapticMesh", "HapticSoftBody", "HapticJointDrive"]


func _classes_of(base: String) -> PackedStringArray:
	var found := PackedStringArray()
	for name in ClassDB.get_class_list():
		if (
			ClassDB.class_get_api_type(name) != ClassDB.API_EXTENSION
			or not ClassDB.is_parent_class(name, base)
		):
			continue
		var is_former := ClassDB.class_get_api_type(ClassDB.get_parent_class(name)) == ClassDB.API_EXTENSION
		var is_internal: bool = name in ["BodyWatch", "InputWatch"] or name.begins_with("Binding")
		if not is_former and not is_internal:
			found.append(name)
	return found


func test_every_node_lists_its_problems_and_states() -> void:
	var nodes := _classes_of("Node")
	check(nodes.size() > 10, "there are only %s" % [nodes])
	for name in nodes:
		check(ClassDB.class_has_method(name, "get_problems", true), name + " has no get_problems()")
		check(
			(name in WITH_STATE) != (name in WITHOUT_STATE), name + " is in none of the two lists, or in both"
		)
	for name in WITHOUT_STATE:
		check(not ClassDB.class_has_method(name, "get_state", true), name + " has a state")
	for name: String in WITH_STATE:
		check(ClassDB.class_has_method(name, "get_state", true), name + " has no get_state()")
		check(ClassDB.class_has_method(name, "get_state_text", true), name + " has no get_state_text()")
		check(ClassDB.class_has_signal(name, "state_changed"), name + " has no signal state_changed")
	for name in _classes_of("Resource"):
		if ClassDB.class_has_method(name, "get_problem", true):
			check(ClassDB.class_has_method(name, "get_problems", true), name + " has no get_problems()")


func test_a_hand_tells_its_states() -> void:
	var world := add_world()
	add_floor(world)
	var proxy := add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.005, 0), 0.5))
	var device: HapticDevice = proxy.get_node(proxy.device)
	var told := []
	proxy.state_changed.connect(
		func(state: int, text: String) -> void: told.append(["proxy", state, text == proxy.get_state_text()])
	)
	device.state_changed.connect(func(state: int, _text: String) -> void: told.append(["device", state]))
	check(proxy.get_state() != ProxyPointer.STATE_WORKING, "the pointer works before a tick")
	world.advance(0.6)
	check_equal(proxy.get_state(), ProxyPointer.STATE_WORKING, proxy.get_state_text())
	check_equal(device.get_state(), HapticDevice.STATE_WORKING, device.get_state_text())
	check(told.has(["proxy", ProxyPointer.STATE_WORKING, true]), "told: %s" % [told])
	check(told.has(["device", HapticDevice.STATE_WORKING]), "told: %s" % [told])
	var contact: Dictionary = proxy.get_contacts()[0]
	check(contact.collider == world.get_node("Floor") and contact.collider == contact.body, "collider")
	check_equal(contact.position, contact.point, "position")
	told.clear()
	expect_error("its 'collision_mask' is empty")
	proxy.collision_mask = 0
	world.advance(0.02)
	check_equal(told, [["proxy", ProxyPointer.STATE_FAILED, true]], "told")
	check(
		proxy.get_problems()[0].contains("'collision_mask' is empty"), "problems: %s" % proxy.get_problems()
	)


func test_a_world_tells_its_states() -> void:
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	var told := []
	world.state_changed.connect(func(state: int, text: String) -> void: told.append([state, text]))
	check_equal(world.get_state(), HapticWorld.STATE_OFF, world.get_state_text())
	add_floor(world)
	add_child(world)
	world.advance(TICK)
	check_equal(world.get_state(), HapticWorld.STATE_WORKING, world.get_state_text())
	check_equal(told, [[HapticWorld.STATE_WORKING, "working"]], "told")
	var inner := HapticWorld.new()
	expect_error("it stands inside another HapticWorld")
	world.add_child(inner)
	check_equal(inner.get_state(), HapticWorld.STATE_FAILED, inner.get_state_text())
	check(inner.get_problems()[0].contains("inside another one"), "problems: %s" % inner.get_problems())
	inner.free()
	remove_child(world)
	check_equal(world.get_state(), HapticWorld.STATE_OFF, world.get_state_text())
	await frames(1)
	check_equal(told[-1], [HapticWorld.STATE_OFF, "off"], "told at last")
	world.free()


func test_a_world_in_real_time_waits_while_the_tree_is_paused() -> void:
	var world := HapticWorld.new()
	world.process_mode = Node.PROCESS_MODE_PAUSABLE
	add_child(world)
	var works := func() -> bool: return world.get_state() == HapticWorld.STATE_WORKING
	check(await until(works, 10.0), world.get_state_text())
	get_tree().paused = true
	await get_tree().process_frame
	check_equal(world.get_state(), HapticWorld.STATE_WAITING, "state")
	check_equal(world.get_state_text(), "paused", "text")
	get_tree().paused = false
	check(await until(works, 10.0), world.get_state_text())
	world.free()


func test_a_recorder_tells_its_states() -> void:
	var world := add_world()
	add_floor(world)
	var proxy := add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.05, 0), 0.1))
	var recorder := HapticRecorder.new()
	recorder.autostart = false
	recorder.proxy_node = null
	world.add_child(recorder)
	var told := []
	recorder.state_changed.connect(func(state: int, _text: String) -> void: told.append(state))
	check_equal(recorder.get_state(), HapticRecorder.STATE_OFF, recorder.get_state_text())
	expect_error("it has no file to write")
	recorder.start()
	check_equal(recorder.get_state(), HapticRecorder.STATE_FAILED, recorder.get_state_text())
	check(recorder.get_problems()[-1].contains("no file to write"), "problems: %s" % recorder.get_problems())
	recorder.csv_path = "user://states_test.csv"
	recorder.proxy_node = proxy
	check(recorder.start(), "it does not start")
	check_equal(recorder.get_state(), HapticRecorder.STATE_WAITING, recorder.get_state_text())
	world.advance(0.02)
	world.advance(0.02)
	check_equal(recorder.get_state(), HapticRecorder.STATE_WORKING, recorder.get_state_text())
	recorder.stop()
	await frames(1)
	check_equal(recorder.get_state(), HapticRecorder.STATE_OFF, recorder.get_state_text())
	check_equal(Array(recorder.get_problems()), [], "problems")
	var expected := [
		HapticRecorder.STATE_FAILED,
		HapticRecorder.STATE_WAITING,
		HapticRecorder.STATE_WORKING,
		HapticRecorder.STATE_OFF
	]
	check_equal(told, expected, "told")


func test_queries_answer_in_the_words_of_godot() -> void:
	var world := add_world()
	var ground := add_floor(world)
	world.advance(0.01)
	var hit := world.intersect_ray(Vector3(0, 1, 0), Vector3(0, -1, 0), 1)
	check_equal(hit.collider, ground, "collider")
	check_equal(hit.body, ground, "the key of before")
	check_near(hit.position, Vector3.ZERO, 1e-9, "position")
	check_near(hit.normal, Vector3.UP, 1e-9, "normal")


func test_what_follows_a_proxy_tells_its_states() -> void:
	var world := add_world()
	add_floor(world)
	var proxy := add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0, 0.05, 0), 0.1))
	var script := GDScript.new()
	script.source_code = """extends HapticEffect

func _get_force(_position: Vector3, _velocity: Vector3, _time: float) -> Variant:
	return Vector3.UP if not has_meta("broken") else NAN
"""
	check_equal(script.reload(), OK, "compiling")
	var effect := HapticEffect.new()
	effect.set_script(script)
	var sound := HapticVibrationSound.new()
	sound.sound = false
	var told := []
	effect.state_changed.connect(func(state: int, _text: String) -> void: told.append(state))
	world.add_child(effect)
	proxy.add_child(sound)
	world.advance(0.1)
	await frames(2)
	check_equal(sound.get_state(), HapticVibrationSound.STATE_WORKING, sound.get_state_text())
	sound.vibration = false
	check_equal(sound.get_state(), HapticVibrationSound.STATE_OFF, sound.get_state_text())
	expect_error("has not answered with a Vector3")
	effect.set_meta("broken", true)
	world.advance(0.1)
	await frames(2)
	check_equal(told, [HapticEffect.STATE_WORKING, HapticEffect.STATE_FAILED], "told")
	effect.enabled = true
	effect.enabled = false
	check_equal(effect.get_state(), HapticEffect.STATE_OFF, effect.get_state_text())
