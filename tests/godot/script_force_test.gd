extends "nodes_case.gd"
## Forces that scripts compute.

const SPRING := 100.0


class Spring:
	extends HapticEffect
	var calls := 0

	func _get_force(hand: Vector3, _velocity: Vector3, _time: float) -> Vector3:
		calls += 1
		return -SPRING * hand


class Slow:
	extends HapticEffect

	func _get_force(_hand: Vector3, _velocity: Vector3, _time: float) -> Vector3:
		OS.delay_msec(10)
		return Vector3.UP


class Wrong:
	extends HapticEffect
	var answer: Variant = "up"

	func _get_force(_hand: Vector3, _velocity: Vector3, _time: float) -> Variant:
		return answer


class Sudden:
	extends HapticEffect

	func _get_force(_hand: Vector3, _velocity: Vector3, _time: float) -> Vector3:
		get_parent().get_node("Proxy").queue_free()
		queue_free()
		return Vector3.UP


class Airstream:
	extends HapticEffect
	var seen := Vector3.ZERO
	var asked_at := -1.0

	func _get_force(_hand: Vector3, velocity: Vector3, time: float) -> Vector3:
		# First of all it is asked about the hand itself.
		if time > 0.3 and time != asked_at:
			seen = velocity
		asked_at = time
		return -2.0 * velocity


func _add(world: HapticWorld, effect: HapticEffect) -> HapticEffect:
	effect.proxy = NodePath("../Proxy")
	effect.time_budget = 1.0
	world.add_child(effect)
	return effect


func _advance(world: HapticWorld, seconds: float) -> void:
	for _i in int(seconds * 60.0):
		world.advance(1.0 / 60.0)


func test_a_script_makes_a_force_field_that_is_felt_at_every_tick() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3(-0.05, 0, 0), Vector3(0.05, 0, 0)))
	var effect := _add(world, Spring.new())
	_advance(world, 0.25)
	for _i in 200:
		world.advance(TICK)
		check_near(proxy.get_force(), -SPRING * proxy.get_hand_position(), 0.02, "force")
	check(effect.calls >= 7 * 15, "it was asked %d times" % effect.calls)
	check_equal(effect.get_state_text(), "working", "state")


func test_a_script_that_is_too_slow_is_switched_off_and_says_so() -> void:
	expect_error("more than its budget")
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var effect := _add(world, Slow.new())
	effect.time_budget = 0.005
	var said := []
	effect.switched_off.connect(func(reason: String) -> void: said.append(reason))
	_advance(world, 0.5)
	check(not effect.enabled, "it is still on")
	check_equal(said.size(), 1, "times that it was said")
	check(effect.get_state_text().contains("budget of 5"), effect.get_state_text())
	_advance(world, 0.3)
	check_equal(proxy.get_force(), Vector3.ZERO, "force")
	effect.time_budget = 1.0
	effect.enabled = true
	_advance(world, 0.2)
	check_equal(effect.get_state_text(), "working", "state after it was switched on again")


func test_one_frame_that_is_far_too_slow_is_enough() -> void:
	expect_error("more than its budget")
	var world := add_world()
	add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var effect := _add(world, Slow.new())
	effect.time_budget = 0.0001
	_advance(world, 1.0 / 60.0)
	check(not effect.enabled, "it is still on")


func test_what_is_no_force_switches_it_off() -> void:
	for answer: Variant in ["up", null, Vector3(NAN, 0, 0), Vector3(0, INF, 0)]:
		expect_error("it is switched off")
		var world := add_world()
		add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
		var effect := _add(world, Wrong.new())
		effect.answer = answer
		_advance(world, 0.1)
		check(not effect.enabled, "%s was taken for a force" % answer)
		world.free()


func test_a_script_knows_how_fast_the_hand_goes() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3(0.1, 0, 0)))
	var effect := _add(world, Airstream.new())
	_advance(world, 0.6)
	check_near(effect.seen, Vector3(0.1, 0, 0), 0.005, "velocity")
	check_near(proxy.get_force(), Vector3(-0.2, 0, 0), 0.02, "force")


func test_a_script_may_free_whatever_it_likes() -> void:
	var world := add_world()
	add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	_add(world, Sudden.new())
	_advance(world, 0.1)
	await frames(2)
	_advance(world, 0.1)
	check(not world.has_node("Proxy"), "the proxy is still there")


func test_what_is_missing_is_said() -> void:
	var world := add_world()
	add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var effect := HapticEffect.new()
	world.add_child(effect)
	effect.proxy = NodePath("../Nowhere")
	check(effect.get_state_text().contains("set 'proxy' anew"), effect.get_state_text())
	effect.proxy = NodePath()
	check(effect.get_state_text().contains("no method '_get_force'"), effect.get_state_text())
	effect.enabled = false
	check_equal(effect.get_state_text(), "off", "state")


class Push:
	extends HapticEffect
	var force := Vector3.ZERO
	var threads := {}

	func _get_force(_hand: Vector3, _velocity: Vector3, _time: float) -> Vector3:
		threads[OS.get_thread_caller_id()] = true
		return force


func test_what_several_say_of_one_hand_adds_up() -> void:
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	for force: Vector3 in [Vector3.RIGHT, Vector3.UP]:
		(_add(world, Push.new()) as Push).force = force
	_advance(world, 0.3)
	check_near(proxy.get_force(), Vector3(1, 1, 0), 1e-4, "force")


## The loop feels it in real time, but it is the main thread that runs the script.
func test_a_script_runs_on_the_main_thread_alone() -> void:
	var world := HapticWorld.new()
	world.gravity = Vector3.ZERO
	add_child(world)
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var effect := _add(world, Push.new()) as Push
	effect.force = Vector3.UP
	for _i in 600:
		await frames(1)
		if proxy.get_force().y > 0.5:
			break
	check(proxy.get_force().y > 0.5, "it was not felt: %s" % effect.get_state_text())
	check_equal(effect.threads.keys(), [OS.get_main_thread_id()], "threads that ran it")


class Ender:
	extends HapticEffect

	func _get_force(_hand: Vector3, _velocity: Vector3, _time: float) -> Vector3:
		var world := get_parent()
		if world.get_parent() != null:
			world.get_parent().remove_child(world)
		return Vector3.UP


func test_a_script_may_stop_the_world() -> void:
	var world := add_world()
	add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	_add(world, Ender.new())
	_advance(world, 1.0 / 60.0)
	check(not world.is_inside_tree(), "the world is still there")
	world.free()
