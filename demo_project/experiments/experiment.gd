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
## --link.NAME=VALUE    a property of the scene's MMTLink, or of its resources as in link.conditions.delay.
##                      With --link.scenario=2 or 4 this is one side of a teleoperation: the operator's hand
##                      waits until it knows all bodies of the far side, and the duration counts from there;
##                      the far side stays until the operator has gone
## --device.NAME=VALUE  a property of the scene's HapticDevice
## --corrects=touch     the model is left as it is until it is touched
## --inputs=1           all that enters the loop goes to CASE_inputs.tactus, the images of a camera to
##                      CASE_images.oni and how it was played to CASE_settings.json: with these the output
##                      is a bundle
## --watch=1            it is drawn as it is played
## --camera.NAME=VALUE  a property of the scene's DepthSensor
## --replay=BUNDLE      instead of all this: plays it again, see replay.gd
## --launch=form        instead of all this: the launcher; --launch=now: what it does, without its form
##                      (../launcher/launch.gd)

const Quietly := preload("res://experiments/quietly.gd")
const Replay := preload("res://experiments/replay.gd")

const FRAMES_PER_SECOND := 60

## To find the far side, in seconds.
const LONGEST_MEETING := 30.0

var _link_options := {}
var _device_options := {}
var _way: HapticPath
var _options := {
	"scene": "res://gallery/static_testbed/static_testbed.tscn",
	"output": "user://",
	"case": "",
	"duration": "10",
	"clock": "real",
	"warmup": "0.5",
	"baseline": "0",
	"screenshots": "",
	"processor": "",
	"corrects": "always",
	"inputs": "0",
	"watch": "0",
}
var _camera_options := {}
var _stops := false


## Returns the exit code of the program: 0 when all was written.
func run(arguments: PackedStringArray) -> int:
	if arguments[0].begins_with("--replay="):
		return Replay.run(arguments)
	if arguments[0] == "--launch=form":
		var launcher := (load("res://launcher/launcher.tscn") as PackedScene).instantiate()
		add_child(launcher)
		await launcher.tree_exited
		return 0
	if arguments[0] == "--launch=now":
		var launch: Node = load("res://launcher/run.gd").new()
		add_child(launch)
		return await launch.run(arguments)
	for argument in arguments:
		var words := argument.trim_prefix("--").split("=", true, 1)
		if words.size() != 2 or not _take(words[0], words[1]):
			return _fail(
				"'%s' is not understood: the options are --%s=…" % [argument, "=…, --".join(_options.keys())]
			)
	if _options.case == "":
		_options.case = _options.scene.get_file().get_basename()
	var packed := load(_options.scene) as PackedScene
	if packed == null:
		return _fail("the scene '%s' cannot be loaded" % _options.scene)
	var scene := packed.instantiate()
	var code := await _run_scene(scene)
	Quietly.free_containers(scene)
	scene.free()
	return code


func _take(option: String, value: String) -> bool:
	var name := option.substr(option.find(".") + 1).replace(".", ":")
	match option.get_slice(".", 0):
		"link":
			_link_options[name] = JSON.parse_string(value)
		"device":
			_device_options[name] = JSON.parse_string(value)
		"camera":
			_camera_options[name] = JSON.parse_string(value)
		_:
			if not _options.has(option):
				return false
			_options[option] = value
	return true


## Before its time is over.
func stop() -> void:
	_stops = true


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
	if _options.inputs == "1":
		_record_inputs(scene, world)
	if _options.processor != "":
		world.processor = int(_options.processor)
	var link := _first(scene, "MMTLink") as MMTLink
	if link == null and not _link_options.is_empty():
		return _fail("the scene '%s' has no MMTLink" % _options.scene)
	_give_own_resources(link)
	_set_all(link, _link_options)
	var device := _first(scene, "HapticDevice") as HapticDevice
	_set_all(device, _device_options)
	_set_all(_first(scene, "DepthSensor"), _camera_options)
	if _is_operator(link):
		_way = device.path
		device.path = _rest_at(_way.sample(0.0))
	recorder.csv_path = _file(".csv")
	recorder.trace_path = "" if stepped or _is_networked(link) else _file("_trace.json")
	recorder.autostart = true
	add_child(scene)
	if not recorder.is_recording():
		return _fail("nothing can be recorded in '%s'" % _options.output)
	if _is_networked(link) and not await _meet(link, device):
		return _fail("the far side was not met: %s" % link.get_state_text())
	await _play(world, link, stepped)
	# Before the recorder stops: writing its files takes a while, in which the loop goes on.
	var statistics := world.get_statistics()
	var periods := {
		"loop": world.get_period_distribution(), "baseline": world.get_baseline_period_distribution()
	}
	if _is_networked(link):
		statistics["link"] = link.get_statistics()
	recorder.stop()
	statistics["recorded_rows"] = recorder.get_rows()
	statistics["lost_rows"] = recorder.get_lost_rows()
	for problem in world.get_problems():
		printerr(problem)
	remove_child(scene)
	var written := _write("_statistics.json", statistics) and _write("_periods.json", periods)
	if _options.inputs == "1":
		written = _write("_settings.json", _settings()) and written
	return 0 if written else 1


## Of the world that is played, and of those beside it, which it meets inside of the scene.
func _record_inputs(scene: Node, played: HapticWorld) -> void:
	for world: HapticWorld in scene.find_children("*", "HapticWorld", true, false):
		var of_whom := "" if world == played else "_" + String(world.name).to_snake_case()
		world.inputs_path = _file(of_whom + "_inputs.tactus")
	var camera := _first(scene, "DepthSensor") as DepthSensor
	if camera != null:
		camera.images_path = _file("_images.oni")


## How it was played, for whoever finds the bundle.
func _settings() -> Dictionary:
	return {
		"options": _options,
		"link": _link_options,
		"device": _device_options,
		"camera": _camera_options,
		"godot": Engine.get_version_info().string,
		"machine": "%s, %s" % [OS.get_processor_name(), OS.get_distribution_name()],
		"utc": Time.get_datetime_string_from_system(true),
	}


## Options change nothing that another scene shares.
func _give_own_resources(link: MMTLink) -> void:
	if link != null:
		link.conditions = link.conditions.duplicate() if link.conditions != null else NetworkConditions.new()
		link.tuning = link.tuning.duplicate() if link.tuning != null else TeleopTuning.new()


func _set_all(node: Node, properties: Dictionary) -> void:
	for name: String in properties:
		node.set_indexed(name, properties[name])


func _is_networked(link: MMTLink) -> bool:
	return link != null and link.scenario != MMTLink.SCENARIO_SINGLE


func _is_operator(link: MMTLink) -> bool:
	return _is_networked(link) and link.side == MMTLink.SIDE_OPERATOR


func _rest_at(place: Vector3) -> HapticPath:
	var way := HapticPath.new()
	way.form = HapticPath.FORM_POINTS
	way.points_positions = PackedVector3Array([place, place])
	way.points_times = PackedFloat64Array([0.0, 1.0])
	return way


## Both sides hear each other, and the operator knows what there is; then the hand sets out.
func _meet(link: MMTLink, device: HapticDevice) -> bool:
	var bodies := link.get_parent().find_children("*", "PhysicsBody3D", true, false).size()
	var deadline := Time.get_ticks_msec() + int(LONGEST_MEETING * 1000.0)
	while not link.is_peer_connected() or link.get_statistics().objects < bodies:
		if Time.get_ticks_msec() > deadline or link.get_state() == MMTLink.STATE_LEFT:
			return false
		await get_tree().process_frame
	if _way != null:
		device.path = _way
	return true


func _is_over(world: HapticWorld, link: MMTLink, begin: float) -> bool:
	if _stops:
		return true
	if _is_networked(link) and link.side == MMTLink.SIDE_TELEOPERATOR:
		return link.get_state() in [MMTLink.STATE_LOST, MMTLink.STATE_LEFT]
	return world.get_time() - begin >= float(_options.duration)


func _play(world: HapticWorld, link: MMTLink, stepped: bool) -> void:
	var screenshots := Array(_options.screenshots.split_floats(",", false))
	var warmup := float(_options.warmup)
	var begin := world.get_time()
	var waits_for_touch: bool = _options.corrects == "touch"
	var correction := link.correction_scheme if waits_for_touch else MMTLink.CORRECTION_NONE
	if waits_for_touch:
		link.correction_scheme = MMTLink.CORRECTION_NONE
	var proxy := _first(world, "ProxyPointer") as ProxyPointer
	# Nobody looks until a picture is taken, and a processor that draws is slow.
	RenderingServer.render_loop_enabled = _options.watch == "1"
	while not _is_over(world, link, begin):
		await get_tree().process_frame
		if stepped:
			world.advance(1.0 / FRAMES_PER_SECOND)
		elif warmup > 0.0 and world.get_time() - begin >= warmup:
			world.reset_statistics()
			warmup = 0.0
		if waits_for_touch and proxy.is_touching():
			waits_for_touch = false
			link.correction_scheme = correction
		if not screenshots.is_empty() and world.get_time() >= screenshots[0]:
			await _take_screenshot(screenshots.pop_front())
	RenderingServer.render_loop_enabled = true


func _take_screenshot(time: float) -> void:
	if DisplayServer.get_name() == "headless":
		return
	RenderingServer.render_loop_enabled = true
	await RenderingServer.frame_post_draw
	RenderingServer.render_loop_enabled = _options.watch == "1"
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
