extends SceneTree
## Runs one scene for a time and writes down what happened.
##
##     godot --headless --path demo_project --script res://experiments/run_experiment.gd -- KEY=VALUE …
##
## --scene=PATH         a scene with a HapticWorld and, below it, a HapticRecorder
## --output=FOLDER      where CASE.csv, CASE_trace.json, CASE_statistics.json and CASE_periods.json go
## --case=NAME          what the files are called; the scene's name where it is missing
## --duration=SECONDS   of the loop's own time; 10 where it is missing
## --clock=real         the haptic thread ticks; --clock=stepped: this script does, and the same run gives the same bytes
## --warmup=SECONDS     until statistics count, in real time; 0.5 where it is missing
## --baseline=1         a bare loop that only sleeps runs beside, for comparison
## --processor=NUMBER   of the haptic thread, as in HapticWorld; the scene's where it is missing
## --screenshots=1,2.5  saves CASE_1.png, CASE_2.5.png at these times; needs a screen
##
## Exit code 0 when all was written.

const FRAMES_PER_SECOND := 60

var _options := {
	"scene": "res://static_testbed.tscn", "output": "user://", "case": "", "duration": "10", "clock": "real",
	"warmup": "0.5", "baseline": "0", "screenshots": "",
	"processor": "",
}


func _initialize() -> void:
	for argument in OS.get_cmdline_user_args():
		var words := argument.trim_prefix("--").split("=", true, 1)
		if words.size() != 2 or not _options.has(words[0]):
			_fail("'%s' is not understood: the options are --%s=…" % [argument, "=…, --".join(_options.keys())])
			return
		_options[words[0]] = words[1]
	if _options.case == "":
		_options.case = _options.scene.get_file().get_basename()
	await process_frame  # the root enters the tree after this method
	_run()


func _fail(message: String) -> void:
	printerr("run_experiment: ", message, ".")
	quit(1)


func _file(ending: String) -> String:
	return _options.output.path_join(_options.case + ending)


func _run() -> void:
	var packed := load(_options.scene) as PackedScene
	if packed == null:
		_fail("the scene '%s' cannot be loaded" % _options.scene)
		return
	var scene := packed.instantiate()
	var world := _first(scene, "HapticWorld") as HapticWorld
	var recorder := _first(scene, "HapticRecorder") as HapticRecorder
	if world == null or recorder == null:
		_fail("the scene '%s' needs a HapticWorld and a HapticRecorder" % _options.scene)
		return
	var stepped: bool = _options.clock == "stepped"
	Engine.max_fps = 0 if stepped else FRAMES_PER_SECOND
	world.clock = HapticWorld.CLOCK_STEPPED if stepped else HapticWorld.CLOCK_REAL_TIME
	world.measure_baseline = _options.baseline == "1"
	if _options.processor != "":
		world.processor = int(_options.processor)
	recorder.csv_path = _file(".csv")
	recorder.trace_path = "" if stepped else _file("_trace.json")
	recorder.autostart = true
	root.add_child(scene)
	if not recorder.is_recording():
		_fail("nothing can be recorded in '%s'" % _options.output)
		return
	await _play(world, stepped)
	# Before the recorder stops: writing its files takes a while, in which the loop goes on.
	var statistics := world.get_statistics()
	var periods := {
		"loop": world.get_period_distribution(), "baseline": world.get_baseline_period_distribution()
	}
	recorder.stop()
	statistics["recorded_rows"] = recorder.get_rows()
	statistics["lost_rows"] = recorder.get_lost_rows()
	var problems := world.get_problems()
	_write("_statistics.json", statistics)
	_write("_periods.json", periods)
	root.remove_child(scene)
	scene.free()
	for problem in problems:
		printerr(problem)
	quit(0)


func _play(world: HapticWorld, stepped: bool) -> void:
	var screenshots := Array(_options.screenshots.split_floats(",", false))
	var duration := float(_options.duration)
	var warmup := float(_options.warmup)
	# Nobody looks until a picture is taken, and a processor that draws is slow.
	RenderingServer.render_loop_enabled = false
	while world.get_time() < duration:
		await process_frame
		if stepped:
			world.advance(1.0 / FRAMES_PER_SECOND)
		elif warmup > 0.0 and world.get_time() >= warmup:
			world.reset_statistics()
			warmup = 0.0
		if not screenshots.is_empty() and world.get_time() >= screenshots[0]:
			await _take_screenshot(screenshots.pop_front())


func _take_screenshot(time: float) -> void:
	if DisplayServer.get_name() == "headless":
		return
	RenderingServer.render_loop_enabled = true
	await RenderingServer.frame_post_draw
	RenderingServer.render_loop_enabled = false
	root.get_texture().get_image().save_png(_file("_%s.png" % String.num(time)))


func _write(ending: String, content: Dictionary) -> void:
	var file := FileAccess.open(_file(ending), FileAccess.WRITE)
	if file == null:
		_fail("'%s' cannot be written" % _file(ending))
		return
	file.store_string(JSON.stringify(content, "  ", true, true) + "\n")


func _first(node: Node, kind: String) -> Node:
	if node.is_class(kind):
		return node
	for child in node.get_children():
		var found := _first(child, kind)
		if found != null:
			return found
	return null
