extends "nodes_case.gd"
## What has entered a world, played again.

var _folder := ProjectSettings.globalize_path("user://replay_%d" % OS.get_process_id())


func _init() -> void:
	DirAccess.make_dir_recursive_absolute(_folder)


func _exit_tree() -> void:
	for file in DirAccess.get_files_at(_folder):
		DirAccess.remove_absolute(_folder.path_join(file))
	DirAccess.remove_absolute(_folder)


func _path(file: String) -> String:
	return _folder.path_join(file)


func _record(world: HapticWorld, file: String) -> void:
	var recorder := HapticRecorder.new()
	recorder.proxy = NodePath("../Proxy")
	recorder.csv_path = _path(file + ".csv")
	world.add_child(recorder)


## A world that records from its start on.
func _add_recorded_world(file: String) -> HapticWorld:
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	world.inputs_path = _path(file + "_inputs.tactus")
	return world


func _replayed(file: String) -> Dictionary:
	var replay := HapticReplay.new()
	check(replay.open(_path(file + "_inputs.tactus"), _path(file + "_again.csv")), "it cannot be opened")
	while not replay.is_over():
		replay.play(10.0)
	return replay.get_report()


func _check_same(file: String, ticks: int) -> void:
	var report := _replayed(file)
	check_equal(report.problem, "", "problem")
	check_equal(report.ticks, ticks, "ticks")
	check(report.same, "it differs from tick %d on" % report.first_different)
	check_equal(
		FileAccess.get_sha256(_path(file + "_again.csv")), FileAccess.get_sha256(_path(file + ".csv")), "rows"
	)


func test_a_scene_that_changes_as_it_is_touched_gives_the_same_again() -> void:
	var world := _add_recorded_world("touch")
	add_child(world)
	add_floor(world)
	add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0.1, 0.0, 0)))
	_record(world, "touch")
	var ball := with_shape(RigidBody3D.new(), sphere(0.05), Vector3(0.1, 0.05, 0)) as RigidBody3D
	world.add_child(ball)
	for i in 60:
		world.advance(1.0 / 60.0)
		if i == 20:
			ball.mass = 0.3
			world.apply_central_impulse(ball, Vector3(0.2, 0, 0))
		elif i == 40:
			world.gravity = Vector3(0, -3, 0)
	var ticks := world.get_ticks()
	remove_child(world)
	world.free()
	_check_same("touch", ticks)


func test_so_does_one_in_real_time() -> void:
	var world := _add_recorded_world("real")
	world.clock = HapticWorld.CLOCK_REAL_TIME
	add_floor(world)
	add_hand(world, path(Vector3(0, 0.1, 0), Vector3(0.0, -0.02, 0), 0.3))
	_record(world, "real")
	add_child(world)
	check(await until(func() -> bool: return world.get_time() > 0.5, 10.0), "it does not tick")
	remove_child(world)
	world.free()
	var report := _replayed("real")
	check_equal(report.problem, "", "problem")
	check(report.ticks >= 500, "only %d ticks" % report.ticks)
	check(report.same, "it differs from tick %d on" % report.first_different)


func test_a_world_that_starts_anew_writes_beside_what_it_has_recorded() -> void:
	var world := _add_recorded_world("anew")
	add_child(world)
	add_floor(world)
	add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0.1, 0.0, 0)))
	_record(world, "anew")
	world.advance(0.05)
	world.tick_rate = 500
	world.advance(0.1)
	remove_child(world)
	world.free()
	check_equal(_replayed("anew").ticks, 50, "ticks of the first start")
	var second := HapticReplay.new()
	check(second.open(_path("anew_inputs_2.tactus")), "there is no second recording")
	check_equal(second.play(10.0), 50, "ticks of the second start")


func test_what_is_not_there_is_said() -> void:
	var replay := HapticReplay.new()
	expect_error("cannot be read")
	check(not replay.open(_path("nothing.tactus")), "it opens nothing")
	check(replay.is_over() and replay.play(1.0) == 0, "it plays nothing")


func test_a_folder_that_cannot_be_made_is_said_and_the_world_runs() -> void:
	expect_error("cannot be written")
	var world := _add_recorded_world("x")
	world.inputs_path = "/proc/nowhere/x.tactus"
	add_child(world)
	world.advance(0.01)
	check_equal(world.get_ticks(), 10, "ticks")


class Spring:
	extends HapticEffect

	func _get_force(hand: Vector3, velocity: Vector3, time: float) -> Vector3:
		return -100.0 * hand - 2.0 * velocity + Vector3.UP * sin(20.0 * time)


func test_a_replay_feels_what_a_script_has_said_without_it() -> void:
	var world := _add_recorded_world("effect")
	add_child(world)
	add_floor(world)
	var proxy := add_hand(world, path(Vector3(-0.05, 0.03, 0), Vector3(0.05, -0.005, 0)))
	_record(world, "effect")
	var effect := Spring.new()
	effect.time_budget = 1.0
	proxy.add_child(effect)
	for _i in 100:
		world.advance(0.01)
	check(proxy.get_force().length() > 3.0, "it was not felt: %s N" % proxy.get_force())
	remove_child(world)
	world.free()
	_check_same("effect", 1000)
