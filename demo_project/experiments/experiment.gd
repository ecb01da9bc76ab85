extends Node
## Runs one scene for a time and writes down what happened. The main scene starts it when called with options:
##
##     godot --headless --path demo_project -- --KEY=VALUE …
##     tactus.x86_64 --headless -- --KEY=VALUE …
##
## --scene=PATH         a scene with a HapticWorld and, below it, a HapticRecorder
## --output=FOLDER      where CASE.csv, CASE_trace.json, CASE_statistics.json and CASE_periods.json go
## --case=NAME          what the files are called; the scene's name where it is missing
## --duration=SECONDS   of the loop's own time; 10 where it is missing
## --clock=real         the haptic thread ticks
## --clock=stepped      this node makes the ticks, and the same run gives the same bytes
## --warmup=SECONDS     until statistics count, in real time; 0.5 where it is missing
## --baseline=1         a bare loop that only sleeps runs beside, for comparison
## --processor=NUMBER   the one on which the haptic thread stays; see HapticWorld.processor
## --screenshots=1,2.5  saves CASE_1.png, CASE_2.5.png at these times; needs a screen

const FRAMES_PER_SECOND := 60

var _options := {
	"scene": "res://static_testbed.tscn",
	"output": "user://",
	"case": "",
	"duration": "10",
	"clock": "real",
	"warmup": "0.5",
	"baseline": "0",
	"screenshots": "",
	"processor": "",
}


## Returns the exit code of the program: 0 when all was written.
func run(arguments: PackedStringArray) -> int:
	for argument in arguments:
		var words := argument.trim_prefix("--").split("=", true, 1)
		if words.size() != 2 or not _options.has(words[0]):
			return _fail(
				"'%s' is not understood: the options are --%s=…" % [argument, "=…, --".join(_options.keys())]
			)
		_options[words[0]] = words[1]
	if _options.case == "":
		_options.case = _options.scene.get_file().get_basename()
	var packed := load(_options.scene) as PackedScene
	if packed == null:
		return _fail("the scene '%s' cannot be loaded" % _options.scene)
	var scene := packed.instantiate()
	var code := await _run_scene(scene)
	scene.free()
	return code


func _fail(message: String) -> int:
	printerr("experiment: ", message, ".")
	return 1


func _file(ending: String) -> String:
	return _options.output.path_join(_options.case + ending)


func _run_scene(scene: Node) -> int:
	var world := _first(scene, "HapticWorld") as HapticWorld
	var recorder := _first(scene, "HapticRecorder") as HapticRecorder
	if world == null or recorder == null:
		return _fail("the scene '%s' needs a HapticWorld and a HapticRecorder" % _options.scene)
	var stepped: bool = _options.clock == "stepped"
	Engine.max_fps = 0 if stepped else FRAMES_PER_SECOND
	world.clock = HapticWorld.CLOCK_STEPPED if stepped else HapticWorld.CLOCK_REAL_TIME
	world.measure_baseline = _options.baseline == "1"
	if _options.processor != "":
		world.processor = int(_options.processor)
	recorder.csv_path = _file(".csv")
	recorder.trace_path = "" if stepped else _file("_trace.json")
	recorder.autostart = true
	add_child(scene)
	if not recorder.is_recording():
		return _fail("nothing can be recorded in '%s'" % _options.output)
	await _play(world, stepped)
	# Before the recorder stops: writing its files takes a while, in which the loop goes on.
	var statistics := world.get_statistics()
	var periods := {
		"loop": world.get_period_distribution(), "baseline": world.get_baseline_period_distribution()
	}
	recorder.stop()
	statistics["recorded_rows"] = recorder.get_rows()
	statistics["lost_rows"] = recorder.get_lost_rows()
	for problem in world.get_problems():
		printerr(problem)
	remove_child(scene)
	return 0 if _write("_statistics.json", statistics) and _write("_periods.json", periods) else 1


func _play(world: HapticWorld, stepped: bool) -> void:
	var screenshots := Array(_options.screenshots.split_floats(",", false))
	var duration := float(_options.duration)
	var warmup := float(_options.warmup)
	# Nobody looks until a picture is taken, and a processor that draws is slow.
	RenderingServer.render_loop_enabled = false
	while world.get_time() < duration:
		await get_tree().process_frame
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
	get_viewport().get_texture().get_image().save_png(_file("_%s.png" % String.num(time)))


func _write(ending: String, content: Dictionary) -> bool:
	var file := FileAccess.open(_file(ending), FileAccess.WRITE)
	if file == null:
		_fail("'%s' cannot be written" % _file(ending))
		return false
	return file.store_string(JSON.stringify(content, "  ", true, true) + "\n")


func _first(node: Node, kind: String) -> Node:
	if node.is_class(kind):
		return node
	for child in node.get_children():
		var found := _first(child, kind)
		if found != null:
			return found
	return null
