extends Node
## Carries out a launch: its first side here, where it can be watched, the other one in a process of its own.
## What they leave in one folder is a bundle.

signal finished(message: String)

const Experiment := preload("res://experiments/experiment.gd")
const Launch := preload("res://launcher/launch.gd")
const Plots := preload("res://launcher/plots.gd")

## For the peer to end by itself (unit: seconds).
const LONGEST_END := 10.0

var folder := ""
var _experiment: Experiment


## Called with options and nobody to look: returns the exit code of the program.
func run(arguments: PackedStringArray) -> int:
	var launch := Launch.new()
	launch.chosen.watch = 0
	var problem := launch.take(arguments)
	if not problem.is_empty():
		printerr("launch: ", problem, ".")
		return Experiment.REFUSED
	return await start(launch)


## Ends when all sides have; the bundle is in `folder` then.
func start(launch: Launch) -> int:
	folder = _own_folder(ProjectSettings.globalize_path(launch.chosen.output))
	if folder.is_empty():
		printerr("launch: '%s' cannot be made: choose another folder." % launch.chosen.output)
		return 1
	launch.chosen.output = folder
	var sides := launch.sides()
	var names := sides.keys()
	var peer := _start_process(sides[names[1]]) if names.size() > 1 else -1
	_experiment = Experiment.new()
	add_child(_experiment)
	var code := await _experiment.run(sides[names[0]])
	_experiment.queue_free()
	_experiment = null
	if peer >= 0 and not await _has_ended(peer):
		OS.kill(peer)
		printerr("launch: the other side did not end.")
		code = 1
	for side: String in names:
		var problem := Plots.draw(folder, side)
		if not problem.is_empty():
			printerr("launch: ", problem, ".")
			code = 1
	finished.emit("The bundle is in %s" % folder if code == 0 else "It failed: the output says why")
	return code


## Where nothing is yet: a bundle never takes the place of another one. Empty where none can be made.
static func _own_folder(asked: String) -> String:
	var place := asked.trim_suffix("/")
	var number := 1
	while true:
		var found := place if number == 1 else "%s_%d" % [place, number]
		DirAccess.make_dir_recursive_absolute(found.get_base_dir())
		var code := DirAccess.make_dir_absolute(found)
		if code == OK or (code == ERR_ALREADY_EXISTS and _is_empty(found)):
			return found
		if code != ERR_ALREADY_EXISTS:
			return ""
		number += 1
	return ""


static func _is_empty(place: String) -> bool:
	return DirAccess.get_files_at(place).is_empty() and DirAccess.get_directories_at(place).is_empty()


## Before its time is over; the bundle is as long as it has lasted.
func stop() -> void:
	if _experiment != null:
		_experiment.stop()


func _start_process(options: PackedStringArray) -> int:
	var arguments := PackedStringArray(["--headless"])
	if not OS.has_feature("template"):
		arguments.append_array(["--path", ProjectSettings.globalize_path("res://")])
	arguments.append("--")
	arguments.append_array(options)
	return OS.create_process(OS.get_executable_path(), arguments)


func _has_ended(process: int) -> bool:
	var deadline := Time.get_ticks_msec() + int(LONGEST_END * 1000.0)
	while OS.is_process_running(process):
		if Time.get_ticks_msec() > deadline:
			return false
		await get_tree().process_frame
	return OS.get_process_exit_code(process) == 0
