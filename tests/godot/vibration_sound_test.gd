extends "nodes_case.gd"
## What a hand touches as vibration and sound (HapticVibrationSound).


func _tapping_world(floor_stiffness: float) -> HapticVibrationSound:
	var world := add_world()
	add_floor(world, floor_stiffness)
	var tip := add_hand(world, path(Vector3(0, 0.045, 0), Vector3(0, 0.005, 0), 0.2))
	var feedback := HapticVibrationSound.new()
	feedback.steady_share = 0.0
	tip.add_child(feedback)
	return feedback


func _strongest(feedback: HapticVibrationSound, seconds: float) -> Vector2:
	var strongest := Vector2.ZERO
	for _i in roundi(seconds * 100.0):
		var proxy: ProxyPointer = feedback.get_parent()
		(proxy.get_parent() as HapticWorld).advance(0.01)
		await frames(1)
		var now := feedback.get_motor_levels()
		strongest = Vector2(maxf(strongest.x, now.x), maxf(strongest.y, now.y))
	return strongest


func test_a_touch_vibrates_and_a_harder_one_more() -> void:
	var soft := _tapping_world(200.0)
	var hard := _tapping_world(4000.0)
	check_equal(await _strongest(hard, 0.1), Vector2.ZERO, "before the touch")
	await _strongest(soft, 0.1)
	var by_soft := await _strongest(soft, 0.2)
	var by_hard := await _strongest(hard, 0.2)
	check(by_soft.length() > 0.02, "soft: %s" % by_soft)
	check(by_hard.y > 3.0 * by_soft.y, "hard: %s, soft: %s" % [by_hard, by_soft])
	await _strongest(hard, 0.5)
	check(hard.get_motor_levels().length() < 1e-3, "a hand at rest: %s" % hard.get_motor_levels())
	hard.steady_share = 0.5
	await _strongest(hard, 0.05)
	check(hard.get_motor_levels().x > 0.4, "pressing: %s" % hard.get_motor_levels())
	hard.vibration = false
	await _strongest(hard, 0.05)
	check_equal(hard.get_motor_levels(), Vector2.ZERO, "switched off")


func test_a_touch_is_heard_where_it_is() -> void:
	var feedback := _tapping_world(1000.0)
	await _strongest(feedback, 0.3)
	var players := feedback.get_children(true)
	check_equal(players.size(), 1, "players")
	var player: AudioStreamPlayer3D = players[0]
	check(player.playing, "it does not play")
	var tip: ProxyPointer = feedback.get_parent()
	check_near(player.global_position, tip.get_proxy_position(), 1e-4, "where it is heard")
	feedback.sound = false
	feedback.volume_db = -20.0
	await _strongest(feedback, 0.05)


## Godot's audio thread plays a sound on for a moment after its node has gone, and needs its stream until
## then.
func test_a_sound_that_ends_with_its_node_stops_no_audio() -> void:
	for _i in 8:
		var feedback := _tapping_world(1000.0)
		await _strongest(feedback, 0.2)
		feedback.get_parent().get_parent().free()
		await frames(3)
		check(AudioServer.get_time_since_last_mix() < 0.5, "the audio thread stands still")


func test_feedback_comes_and_goes_while_the_world_runs() -> void:
	var feedback := _tapping_world(1000.0)
	var tip: ProxyPointer = feedback.get_parent()
	var world: HapticWorld = tip.get_parent()
	await _strongest(feedback, 0.3)
	tip.remove_child(feedback)
	world.advance(0.05)
	check_equal(feedback.get_motor_levels(), Vector2.ZERO, "outside of the scene")
	tip.add_child(feedback)
	feedback.steady_share = 1.0
	await _strongest(feedback, 0.05)
	check(feedback.get_motor_levels().x > 0.1, "back again: %s" % feedback.get_motor_levels())
	world.tick_rate = 2000
	await _strongest(feedback, 0.5)
	check(feedback.get_motor_levels().x > 0.1, "after a restart: %s" % feedback.get_motor_levels())
	feedback.free()
	world.advance(0.05)


func test_more_listeners_than_there_is_room_for_are_told() -> void:
	var feedback := _tapping_world(1000.0)
	expect_error("eight recorders and feedbacks listen to this world already")
	for _i in 8:
		var other := HapticVibrationSound.new()
		other.sound = false
		feedback.get_parent().add_child(other)
	await _strongest(feedback, 0.05)


func test_feedback_that_is_off_is_given_no_ticks() -> void:
	var feedback := _tapping_world(1000.0)
	var others: Array[HapticVibrationSound] = []
	for _i in 8:
		var other := HapticVibrationSound.new()
		other.sound = false
		other.vibration = false
		feedback.get_parent().add_child(other)
		others.append(other)
	await _strongest(feedback, 0.1)
	feedback.vibration = false
	feedback.sound = false
	others[7].vibration = true
	others[7].steady_share = 0.5
	await _strongest(others[7], 0.3)
	check(others[7].get_motor_levels().x > 0.1, "switched on: %s" % others[7].get_motor_levels())


## Godot's mixer lets go of a sound some time after its player has gone.
func _the_mixer_is_done() -> void:
	for node in get_children():
		node.queue_free()
	await until(func() -> bool: return false, 0.3)


func test_feedback_without_a_proxy_says_so() -> void:
	var world := add_world()
	var feedback := HapticVibrationSound.new()
	world.add_child(feedback)
	expect_error("there is no ProxyPointer or HapticTool in its world")
	await frames(2)
	world.advance(0.01)
	check("\n".join(feedback.get_problems()).contains("is silent"), str(feedback.get_problems()))
	await _the_mixer_is_done()
