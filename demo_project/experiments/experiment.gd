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
## --screenshots=1,2.5  saves CASE_1.png, CASE_2.5.png at these times; needs a screen: refused with --headless
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
## --camera.NAME=VALUE  a property of the scene's HapticDepthSensor
## --sides=NAME,NAME    the cases that belong to the same bundle, this one among them
## --replay=BUNDLE      instead of all this: plays it again, see replay.gd
## --launch=form        instead of all this: the launcher; --launch=now: what it does, without its form
##                      (../launcher/launch.gd)
##
## What does not fit is refused with what is allowed (exit code 2). Where a file could not be kept, something
## of the scene does not work, or the far side was not met, the exit code is 1. Files of before stay: a second
## run of the same CASE is called CASE_2. While a run lasts, and after it was killed, there is a folder
## CASE.unfinished.

const OptionWords := preload("res://addons/tactus/studies/option_words.gd")
const WholeFile := preload("res://addons/tactus/studies/whole_file.gd")
const Quietly := preload("res://experiments/quietly.gd")
const Replay := preload("res://experiments/replay.gd")

const FRAMES_PER_SECOND := 60
## The exit code where something is asked for that there is not.
const REFUSED := 2

## Below it each whole number is a float of its own: the one that was written is the one that was read.
const LARGEST_WHOLE := 9007199254740992.0
## Relative: half a unit in the last place of 32 bits.
const FLOAT_PRECISION := 6e-8
const NANOSECOND := 1e-9

## To find the far side, in seconds.
const LONGEST_MEETING := 30.0

var _link_options := {}
var _device_options := {}
var _way: HapticPath
var _options := {
	"scene": "res://gallery/static_testbed/static_testbed.tscn",
	"output": "user://",
	"case": "",
	"duration": 10.0,
	"clock": "real",
	"warmup": 0.5,
	"baseline": false,
	"screenshots": PackedFloat64Array(),
	"processor": null,
	"corrects": "always",
	"inputs": false,
	"watch": false,
	"sides": PackedStringArray(),
}
var _camera_options := {}
## What the properties were after they had been set, by the words of the options.
var _played := {}
var _stops := false
var _has_ticked := false
var _problems := PackedStringArray()
## Of the files of this side.
var _endings := [".csv", "_trace.json", "_statistics.json", "_periods.json"]


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
	var problem := _take(arguments)
	if problem.is_empty() and not ResourceLoader.exists(_options.scene, "PackedScene"):
		problem = "--scene=%s is refused: there is no such scene" % _options.scene
	if not problem.is_empty():
		return _fail(problem, REFUSED)
	if _options.case == "":
		_options.case = _options.scene.get_file().get_basename()
	problem = _claim()
	if not problem.is_empty():
		return _fail(problem)
	var scene := (load(_options.scene) as PackedScene).instantiate()
	var code := await _run_scene(scene)
	Quietly.free_containers(scene)
	scene.free()
	if code == REFUSED or (code == 0 and _has_ticked):
		DirAccess.remove_absolute(_unfinished())
	return code


static func _declared() -> Dictionary:
	return {
		"scene": OptionWords.text(),
		"output": OptionWords.text(),
		"case": OptionWords.text(),
		"duration": OptionWords.number(0.001, 1e6, "s"),
		"clock": OptionWords.choice(["real", "stepped"]),
		"warmup": OptionWords.number(0.0, 1e6, "s"),
		"baseline": OptionWords.switch(),
		"screenshots": OptionWords.numbers(0.0, 1e6, "s"),
		"processor": OptionWords.whole(-2, 4095),
		"corrects": OptionWords.choice(["always", "touch"]),
		"inputs": OptionWords.switch(),
		"watch": OptionWords.switch(),
		"sides": {"type": TYPE_PACKED_STRING_ARRAY},
	}


## Empty, or what is wrong with the words.
func _take(arguments: PackedStringArray) -> String:
	var own := PackedStringArray()
	for argument in arguments:
		var option := argument.trim_prefix("--").get_slice("=", 0)
		var properties: Variant = (
			{"link": _link_options, "device": _device_options, "camera": _camera_options}
			. get(option.get_slice(".", 0))
		)
		if properties == null or not "." in option or not "=" in argument:
			own.append(argument)
			continue
		var name := option.substr(option.find(".") + 1).replace(".", ":")
		# An object of its own says nothing where it cannot read.
		var json := JSON.new()
		if properties.has(name):
			return "--%s is given twice: say it once" % option
		if json.parse(argument.substr(argument.find("=") + 1)) != OK or json.data == null:
			return '%s is refused: it must be a number, true, false, "text", […] or {…}' % argument
		properties[name] = json.data
	var words := OptionWords.new()
	words.declared = _declared()
	var problem := words.read(own)
	_options.merge(words.values, true)
	if problem.is_empty():
		problem = _problem_of_screenshots()
	if problem.is_empty() and (_options.case.contains("/") or _options.case.begins_with(".")):
		return "--case=%s is refused: it must be the name of a file" % _options.case
	return problem


## Why no picture can be taken of each of these times. When a side that stays until the other one goes, or
## that waits for it, ends its run, is known only then.
func _problem_of_screenshots() -> String:
	var times: PackedFloat64Array = _options.screenshots
	if times.is_empty():
		return ""
	times.sort()
	_options.screenshots = times
	if not _link_options.has("scenario") and times[-1] > _options.duration:
		return (
			"--screenshots=%s is refused: the run ends at --duration=%s (s)"
			% [String.num(times[-1]), String.num(_options.duration)]
		)
	if DisplayServer.get_name() == "headless":
		return "--screenshots is refused: nothing is drawn with --headless, start it without"
	return ""


## The folder, and in it a name that no file of before has. Empty, or why not.
func _claim() -> String:
	_options.output = ProjectSettings.globalize_path(_options.output)
	DirAccess.make_dir_recursive_absolute(_options.output)
	var asked: String = _options.case
	var number := 1
	while true:
		_options.case = asked if number == 1 else "%s_%d" % [asked, number]
		if not _is_taken():
			# Making a folder either succeeds or finds it: two programs never get the same name.
			var code := DirAccess.make_dir_absolute(_unfinished())
			if code == OK:
				break
			if code != ERR_ALREADY_EXISTS:
				return (
					"'%s' cannot be written (%s): choose another --output"
					% [_options.output, error_string(code)]
				)
		number += 1
	if number > 1:
		print("experiment: there is a %s already, this run is called %s." % [asked, _options.case])
	return ""


func _is_taken() -> bool:
	for ending: String in [".csv", "_statistics.json", "_settings.json", "_inputs.tactus"]:
		if FileAccess.file_exists(_file(ending)):
			return true
	return DirAccess.dir_exists_absolute(_unfinished())


func _unfinished() -> String:
	return _file(".unfinished")


## Before its time is over.
func stop() -> void:
	_stops = true


func _fail(message: String, code := 1) -> int:
	printerr("experiment: ", message, ".")
	return code


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
	world.measure_baseline = _options.baseline
	if _options.inputs:
		_record_inputs(scene, world)
	if _options.processor != null:
		world.processor = _options.processor
	var link := _first(scene, "MMTLink") as MMTLink
	_give_own_resources(link)
	var device := _first(scene, "HapticDevice") as HapticDevice
	for one: Array in [
		["link", link, _link_options],
		["device", device, _device_options],
		["camera", _first(scene, "HapticDepthSensor"), _camera_options]
	]:
		var problem := _set_all(one[0], one[1], one[2])
		if not problem.is_empty():
			return _fail(problem, REFUSED)
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
		return _fail("the other side was not met: %s" % link.get_state_text())
	await _play(world, link, stepped)
	_has_ticked = world.get_ticks() > 0
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
	var problems := world.get_problems()
	remove_child(scene)
	problems.append_array(_problems_of_files(scene, recorder))
	if not _has_ticked:
		problems.append("there was not one tick")
	for problem in problems:
		printerr(problem)
	var written := _write("_statistics.json", statistics) and _write("_periods.json", periods)
	if _options.inputs:
		written = _write("_settings.json", _settings()) and written
	return 0 if written and problems.is_empty() else 1


## Why a file is not whole. The worlds have stopped.
func _problems_of_files(scene: Node, recorder: HapticRecorder) -> PackedStringArray:
	var found := _problems
	for world: HapticWorld in scene.find_children("*", "HapticWorld", true, false):
		found.append(world.get_inputs_problem())
	if recorder.get_state() == HapticRecorder.STATE_FAILED:
		found.append(recorder.get_state_text())
	return PackedStringArray(Array(found).filter(func(text: String) -> bool: return not text.is_empty()))


## Of the world that is played, and of those beside it, which it meets inside of the scene.
func _record_inputs(scene: Node, played: HapticWorld) -> void:
	for world: HapticWorld in scene.find_children("*", "HapticWorld", true, false):
		var of_whom := "" if world == played else "_" + String(world.name).to_snake_case()
		world.inputs_path = _file(of_whom + "_inputs.tactus")
		_endings.append(of_whom + "_inputs.tactus")
	var camera := _first(scene, "HapticDepthSensor") as HapticDepthSensor
	if camera != null:
		camera.images_path = _file("_images.oni")
		_endings.append("_images.oni")


## How it was played, for whoever finds the bundle.
func _settings() -> Dictionary:
	return {
		"options": _options,
		"played": _played,
		"parts": _parts(),
		"sides": _options.sides if not _options.sides.is_empty() else PackedStringArray([_options.case]),
		"godot": Engine.get_version_info().string,
		"machine": "%s, %s" % [OS.get_processor_name(), OS.get_distribution_name()],
		"utc": Time.get_datetime_string_from_system(true),
	}


## Every file of this side, with its size and its hash.
func _parts() -> Dictionary:
	var parts := {}
	for ending in _endings:
		if FileAccess.file_exists(_file(ending)):
			parts[_file(ending).get_file()] = {
				"bytes": FileAccess.get_size(_file(ending)), "sha256": FileAccess.get_sha256(_file(ending))
			}
	return parts


## Options change nothing that another scene shares.
func _give_own_resources(link: MMTLink) -> void:
	if link != null:
		link.conditions = (
			link.conditions.duplicate() if link.conditions != null else MMTNetworkConditions.new()
		)
		link.tuning = link.tuning.duplicate() if link.tuning != null else MMTTuning.new()


## Empty, or what was refused: what the node has afterwards counts, not what it was given.
func _set_all(word: String, node: Node, properties: Dictionary) -> String:
	for name: String in properties:
		var option := "--%s.%s" % [word, name.replace(":", ".")]
		if node == null:
			return "%s is refused: the scene '%s' has nothing to set it at" % [option, _options.scene]
		var owner_of: Object = node
		for part in name.split(":"):
			if owner_of == null or not part in owner_of:
				return "%s is refused: there is no such property" % option
			owner_of = owner_of.get(part) if owner_of.get(part) is Object else null
		node.set_indexed(name, properties[name])
		var now: Variant = node.get_indexed(name)
		_played[option.trim_prefix("--")] = now
		if not _is_same(now, properties[name]):
			return "%s=%s is refused: it stays %s" % [option, JSON.stringify(properties[name]), now]
	return ""


## A number of JSON is a float; a property may be whole, have 32 bits, or count nanoseconds.
static func _is_same(now: Variant, asked: Variant) -> bool:
	if asked is float and now is int:
		return now == asked and absf(asked) < LARGEST_WHOLE
	if asked is float and now is float:
		return absf(now - asked) <= maxf(FLOAT_PRECISION * absf(asked), NANOSECOND)
	if asked is bool and (now is float or now is int):
		return false
	return JSON.stringify(now, "", true) == JSON.stringify(asked, "", true)


func _is_networked(link: MMTLink) -> bool:
	return link != null and link.scenario != MMTLink.SCENARIO_LOCAL


func _is_operator(link: MMTLink) -> bool:
	return _is_networked(link) and link.side == MMTLink.SIDE_OPERATOR


func _rest_at(place: Vector3) -> HapticPath:
	var way := HapticPath.new()
	way.form = HapticPath.FORM_POINTS
	way.points_positions = PackedVector3Array([place, place])
	way.points_times = PackedFloat64Array([0.0, 1.0])
	return way


## Both sides hear each other, and the operator's model is complete; then the hand sets out.
func _meet(link: MMTLink, device: HapticDevice) -> bool:
	var bodies := link.get_parent().find_children("*", "PhysicsBody3D", true, false).size()
	var deadline := Time.get_ticks_msec() + int(LONGEST_MEETING * 1000.0)
	while not link.is_peer_connected() or not _knows(link.get_statistics(), bodies):
		if Time.get_ticks_msec() > deadline or link.get_state() == MMTLink.STATE_LEFT:
			return false
		await get_tree().process_frame
	if _way != null:
		device.path = _way
	return true


## `bodies`: of the scene. Where the far side has none, its model is complete at once.
func _knows(statistics: Dictionary, bodies: int) -> bool:
	return statistics.objects >= bodies and statistics.get("model_complete", true)


func _is_over(world: HapticWorld, link: MMTLink, begin: float) -> bool:
	if _stops:
		return true
	if _is_networked(link) and link.side == MMTLink.SIDE_TELEOPERATOR:
		return link.get_state() in [MMTLink.STATE_LOST, MMTLink.STATE_LEFT]
	return world.get_time() - begin >= _options.duration


func _play(world: HapticWorld, link: MMTLink, stepped: bool) -> void:
	var screenshots := Array(_options.screenshots)
	var warmup: float = _options.warmup
	var begin := world.get_time()
	var waits_for_touch: bool = _options.corrects == "touch"
	var correction := link.correction_scheme if waits_for_touch else MMTLink.CORRECTION_NONE
	if waits_for_touch:
		link.correction_scheme = MMTLink.CORRECTION_NONE
	var proxy := _first(world, "ProxyPointer") as ProxyPointer
	# Nobody looks until a picture is taken, and a processor that draws is slow.
	RenderingServer.render_loop_enabled = _options.watch
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
	for time: float in screenshots:
		_problems.append("there is no picture of %s s: the run ended before" % String.num(time))


func _take_screenshot(time: float) -> void:
	RenderingServer.render_loop_enabled = true
	await RenderingServer.frame_post_draw
	RenderingServer.render_loop_enabled = _options.watch
	var path := _file("_%s.png" % String.num(time))
	if get_viewport().get_texture().get_image().save_png(path) != OK:
		_problems.append("'%s' could not be written: is the disk full?" % path)


func _write(ending: String, content: Dictionary) -> bool:
	var problem := WholeFile.write(_file(ending), JSON.stringify(content, "  ", true, true) + "\n")
	if not problem.is_empty():
		_fail(problem)
	return problem.is_empty()


func _first(node: Node, kind: String) -> Node:
	if node.is_class(kind):
		return node
	for child in node.get_children():
		var found := _first(child, kind)
		if found != null:
			return found
	return null
