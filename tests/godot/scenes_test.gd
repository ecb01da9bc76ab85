extends "nodes_case.gd"
## The scenes of the demo project.

const FOLDER := "user://scenes_test"


func _record(scene_path: String, seconds: float, file: String) -> Dictionary:
	var scene := (load(scene_path) as PackedScene).instantiate()
	var world: HapticWorld = scene.get_node("HapticWorld")
	var recorder: HapticRecorder = world.get_node("HapticRecorder")
	world.clock = HapticWorld.CLOCK_STEPPED
	recorder.csv_path = FOLDER.path_join(file)
	recorder.autostart = true
	add_child(scene)
	for _i in roundi(seconds * 60.0):
		world.advance(1.0 / 60.0)
	recorder.stop()
	var result := {
		"rows": recorder.get_rows(),
		"lost": recorder.get_lost_rows(),
		"problems": world.get_problems(),
		"text": FileAccess.get_file_as_string(recorder.csv_path)
	}
	scene.free()
	return result


func _columns(text: String) -> Dictionary:
	var lines := text.strip_edges().split("\n")
	var names := lines[0].split(",")
	var columns := {}
	for name in names:
		columns[name] = PackedFloat64Array()
	for i in range(1, lines.size()):
		var words := lines[i].split(",")
		for k in names.size():
			columns[names[k]].append(float(words[k]))
	return columns


func _largest_force(columns: Dictionary) -> float:
	var largest := 0.0
	for i in columns.force_x.size():
		largest = maxf(largest, Vector3(columns.force_x[i], columns.force_y[i], columns.force_z[i]).length())
	return largest


func test_the_static_testbed_is_touched_with_a_few_newtons() -> void:
	var run := _record("res://gallery/static_testbed/static_testbed.tscn", 10.0, "static.csv")
	check_equal(run.rows, 10000, "rows")
	check_equal(run.lost, 0, "lost rows")
	check_equal(run.problems.size(), 0, "problems")
	check(run.text.begins_with("time_us,force_x,force_y,force_z,object_x,object_y,object_z,"), "columns")
	var columns := _columns(run.text)
	var largest := _largest_force(columns)
	check(largest > 3.0 and largest < 15.0, "the largest force is %s N" % largest)
	for i in columns.proxy_y.size():
		check(columns.proxy_y[i] > 0.01 - 1e-6, "the proxy is in the ground in row %d" % i)


func test_two_runs_of_the_dynamic_testbed_are_the_same_bytes() -> void:
	var first := _record("res://gallery/dynamic_testbed/dynamic_testbed.tscn", 6.0, "first.csv")
	var second := _record("res://gallery/dynamic_testbed/dynamic_testbed.tscn", 6.0, "second.csv")
	check_equal(first.rows, 6000, "rows")
	check(first.text == second.text, "they differ")
	var columns := _columns(first.text)
	check(absf(columns.object_x[5999] - columns.object_x[0]) > 0.1, "the box was not pushed")
	check(columns.ran_us == columns.time_us, "a stepped tick runs when it is due")


func test_every_scene_of_the_experiments_plays() -> void:
	for file in DirAccess.get_files_at("res://experiments"):
		if file.get_extension() == "tscn":
			var run := _record("res://experiments".path_join(file), 1.0, "any.csv")
			check_equal(run.problems.size(), 0, "%s: %s" % [file, run.problems])
			check_equal(run.rows, 1000, file + " rows")


func test_the_recorder_writes_trace_events_of_the_stages() -> void:
	var scene := (load("res://gallery/dynamic_testbed/dynamic_testbed.tscn") as PackedScene).instantiate()
	var world: HapticWorld = scene.get_node("HapticWorld")
	var recorder: HapticRecorder = world.get_node("HapticRecorder")
	recorder.csv_path = FOLDER.path_join("traced.csv")
	recorder.trace_path = FOLDER.path_join("trace.json")
	recorder.autostart = true
	var before := Time.get_unix_time_from_system() * 1e6
	add_child(scene)
	check(await until(func() -> bool: return world.get_ticks() > 200, 10.0), "it does not tick")
	await frames(2)
	recorder.stop()
	var columns := _columns(FileAccess.get_file_as_string(recorder.csv_path))
	var after := Time.get_unix_time_from_system() * 1e6
	check(
		columns.time_us[0] >= before - 2000.0 and columns.time_us[-1] <= after + 2000.0,
		(
			"the rows are not of now: %s … %s, not in %s … %s"
			% [columns.time_us[0], columns.time_us[-1], before, after]
		)
	)
	check_near(columns.time_us[100] - columns.time_us[0], 100_000.0, 1.5, "a hundred ticks (µs)")
	var early := 0
	var uneven := 0
	for row in range(1, columns.time_us.size()):
		early += 1 if columns.ran_us[row] < columns.time_us[row] else 0
		uneven += 1 if columns.ran_us[row] - columns.ran_us[row - 1] != 1000.0 else 0
	check_equal(early, 0, "ticks that ran before they were due")
	check(uneven > 0, "ran_us is the schedule")
	var events: Array = JSON.parse_string(FileAccess.get_file_as_string(recorder.trace_path))
	var names := {}
	for event: Dictionary in events:
		names[event.name] = true
	for stage in ["tick", "read device", "move proxy", "step physics", "append record"]:
		check(names.has(stage), "there is no stage '%s' in %s" % [stage, names.keys()])


func test_statistics_have_the_figures_of_the_report() -> void:
	var world := HapticWorld.new()
	world.measure_baseline = true
	add_child(world)
	check(await until(func() -> bool: return world.get_ticks() > 100, 5.0), "it does not tick")
	var figures := world.get_statistics()
	for name in [
		"tick_period_p50_us",
		"tick_period_p90_us",
		"tick_period_p99_us",
		"tick_period_p999_us",
		"tick_period_max_us",
		"tick_compute_p50_us",
		"tick_compute_p99_us",
		"tick_compute_max_us",
		"missed_deadlines",
		"mean_period_us",
		"baseline_period_p99_us",
		"awake_bodies",
		"realtime"
	]:
		check(figures.has(name), "there is no " + name)
	var periods := world.get_period_distribution()
	check_equal(periods.period_us.size(), periods.share.size(), "steps of the distribution")
	check_near(periods.share[-1], 1.0, 1e-12, "the last share")


func test_the_recorder_says_what_it_lacks() -> void:
	var world := add_world()
	var recorder := HapticRecorder.new()
	recorder.proxy = NodePath("../Nothing")
	recorder.csv_path = FOLDER.path_join("nothing.csv")
	world.add_child(recorder)
	check(recorder.get_problems()[0].contains("set 'proxy' anew"), "no warning")
	expect_error("is not a ProxyPointer or a HapticTool of the scene")
	world.advance(0.01)
	check_equal(recorder.get_rows(), 0, "rows")


func test_a_recorder_that_a_script_starts_needs_no_path_before() -> void:
	var world := add_world()
	add_hand(world, null)
	var recorder := HapticRecorder.new()
	recorder.proxy = NodePath("../Proxy")
	world.add_child(recorder)
	check(recorder.get_problems()[0].contains("writes nothing"), "no warning with autostart")
	recorder.autostart = false
	check_equal(Array(recorder.get_problems()), [], "warnings without autostart")
	expect_error("it has no file to write: set 'csv_path'")
	check(not recorder.start(), "it started without a file")


func test_a_file_that_cannot_be_written_is_said() -> void:
	var recorder := HapticRecorder.new()
	recorder.csv_path = "/proc/nowhere/file.csv"
	add_child(recorder)
	check(not recorder.is_recording(), "it says that it records")


func test_the_path_of_the_thesis_is_a_circle_of_ten_seconds_through_the_ground() -> void:
	var way: HapticPath = load("res://paths/thesis_path.tres")
	check_near(way.get_duration(), 10.0, 1e-9, "duration")
	var lowest := 1.0
	for i in 1000:
		var point := way.sample(i * 0.01)
		check_near(Vector2(point.x, point.z).length(), way.circle_radius, 1e-6, "distance from the axis")
		lowest = minf(lowest, point.y)
	check(lowest < 0.0, "it does not go through the ground")
	check_near(way.sample(10.0), way.sample(0.0), 1e-6, "end")
	check_near(way.sample_velocity(2.0), (way.sample(2.001) - way.sample(1.999)) / 0.002, 1e-3, "velocity")
	check(way.create_line_mesh().get_faces().size() > 0, "there is no line to draw")


func test_a_path_along_a_curve_goes_at_an_even_speed() -> void:
	var way := HapticPath.new()
	way.form = HapticPath.FORM_CURVE
	check("\n".join(way.get_problems()).contains("set 'curve'"), str(way.get_problems()))
	check_equal(way.get_duration(), 0.0, "duration without a curve")
	way.curve = Curve3D.new()
	way.curve.add_point(Vector3.ZERO, Vector3.ZERO, Vector3(0.1, 0, 0))
	way.curve.add_point(Vector3(0.2, 0.1, 0), Vector3(-0.1, 0, 0))
	way.curve.bake_interval = 0.002
	way.curve_speed = 0.05
	check_equal(Array(way.get_problems()), [], "problems")
	var seconds := way.get_duration()
	check_near(seconds * 0.05, way.curve.get_baked_length(), 1e-3, "length")
	for i in 20:
		var time := seconds * (i + 0.5) / 20.0
		check_near(way.sample_velocity(time).length(), 0.05, 1e-4, "speed at %s s" % time)
		check_near(
			way.curve.get_closest_point(way.sample(time)), way.sample(time), 2e-4, "place on the curve"
		)
	check_near(way.sample(seconds), Vector3(0.2, 0.1, 0), 1e-6, "end")
	check(way.create_line_mesh().get_faces().size() > 0, "there is no line to draw")
