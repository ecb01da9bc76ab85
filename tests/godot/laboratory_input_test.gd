extends "nodes_case.gd"
## What an experiment in Godot is asked: nothing that cannot be is played, what was played is written down,
## and nothing that was there before is lost.

const Experiment := preload("res://experiments/experiment.gd")
const Replay := preload("res://experiments/replay.gd")
const Launch := preload("res://launcher/launch.gd")
const Run := preload("res://launcher/run.gd")
const Sides := preload("res://experiments/sides.gd")
const BOX := "res://gallery/dynamic_testbed/dynamic_testbed.tscn"
const NONSENSE := ["nan", "inf", "-9", "1e300", "", "abc", "5O", "10s", "1_0"]

var _folder := ProjectSettings.globalize_path("user://laboratory_%d" % OS.get_process_id())


func _exit_tree() -> void:
	if DirAccess.dir_exists_absolute(_folder):
		remove_folder(_folder)


func _run(more: Array) -> int:
	var experiment := Experiment.new()
	add_child(experiment)
	var words := ["--scene=" + BOX, "--output=" + _folder, "--case=hand", "--clock=stepped", "--duration=0.1"]
	for word: String in more:
		words = words.filter(
			func(one: String) -> bool: return one.get_slice("=", 0) != word.get_slice("=", 0)
		)
	var code: int = await experiment.run(PackedStringArray(words + more))
	experiment.queue_free()
	return code


func _files() -> Array:
	return Array(DirAccess.get_files_at(_folder)) + Array(DirAccess.get_directories_at(_folder))


func test_nonsense_is_refused_and_nothing_is_written() -> void:
	for option: String in [
		"duration", "warmup", "processor", "baseline", "inputs", "watch", "screenshots", "clock"
	]:
		for value: String in NONSENSE:
			check_equal(
				await _run(["--%s=%s" % [option, value]]), Experiment.REFUSED, "%s=%s" % [option, value]
			)
	for word: String in [
		"--secnds=2",
		"--clock=Stepped",
		"--scene=res://nothing.tscn",
		"--case=../hand",
		"duration=2",
		"--duration",
		"--camera.source=1",
		"--device.colour=3",
		"--link.conditions.dely=0.1",
		"--link.conditions.delay.far=1"
	]:
		check_equal(await _run([word]), Experiment.REFUSED, word)
	# An empty one would be the project's own folder.
	for word: String in ["--output=", "--case="]:
		check_equal(await _run([word]), Experiment.REFUSED, word)
	check(Launch.new().take(PackedStringArray(["--output="])) != "", "a launch without a folder")
	var form := Launch.new()
	form.chosen.output = ""
	check("choose a folder" in form.problem(), "a form without a folder: '%s'" % form.problem())
	check_equal(await _run(["--warmup=0", "--warmup=0"]), Experiment.REFUSED, "an option that is given twice")
	check(not DirAccess.dir_exists_absolute(_folder) or _files().is_empty(), "left: %s" % [_files()])


func test_a_picture_that_cannot_be_taken_is_refused() -> void:
	for asked: Array in [
		["0.05", "nothing is drawn with --headless"], ["5,0.05", "the run ends at --duration=0.1"]
	]:
		var experiment := Experiment.new()
		var said := experiment._take(PackedStringArray(["--duration=0.1", "--screenshots=" + asked[0]]))
		check(asked[1] in said, "--screenshots=%s: '%s'" % [asked[0], said])
		experiment.free()
		check_equal(await _run(["--screenshots=" + asked[0]]), Experiment.REFUSED, asked[0])
	check(not DirAccess.dir_exists_absolute(_folder), "a folder is left")


func test_a_property_that_refuses_its_value_ends_the_run() -> void:
	expect_error("was refused, the old value stays")
	check_equal(await _run(["--link.conditions.loss=5"]), Experiment.REFUSED, "a loss of 5")
	check_equal(await _run(["--link.conditions.delay=-1"]), Experiment.REFUSED, "a delay below 0")
	check_equal(await _run(["--device.force_limit=nan"]), Experiment.REFUSED, "a limit that is no number")
	for word: String in [
		"--link.conditions.delay=-0.000001",
		"--link.scenario=1.000001",
		"--link.conditions.seed=9007199254740993"
	]:
		check_equal(await _run([word]), Experiment.REFUSED, word)
	check(_files().is_empty(), "left: %s" % [_files()])


func test_what_was_played_is_written_down() -> void:
	check_equal(
		await _run(["--inputs=1", "--link.conditions.loss=0.25", "--device.force_limit=7"]), 0, "exit code"
	)
	check_equal(await _run(["--link.conditions.jitter=0.0001234567891"]), 0, "part of a nanosecond")
	var settings: Dictionary = JSON.parse_string(
		FileAccess.get_file_as_string(_folder.path_join("hand_settings.json"))
	)
	check_equal(settings.played, {"link.conditions.loss": 0.25, "device.force_limit": 7.0}, "played")
	check_equal(settings.options.duration, 0.1, "duration")
	for part: String in settings.parts:
		var path := _folder.path_join(part)
		check_equal(FileAccess.get_sha256(path), settings.parts[part].sha256, "hash of " + part)
	check_equal(settings.sides, ["hand"], "sides")


func test_a_second_run_of_the_same_name_loses_nothing() -> void:
	check_equal(await _run([]), 0, "exit code")
	var before := FileAccess.get_sha256(_folder.path_join("hand.csv"))
	check_equal(await _run(["--duration=0.2"]), 0, "exit code")
	check_equal(FileAccess.get_sha256(_folder.path_join("hand.csv")), before, "the first one's rows")
	check(FileAccess.file_exists(_folder.path_join("hand_2.csv")), "the second one has no file")


func test_a_bundle_that_lacks_a_part_is_not_the_same() -> void:
	check_equal(await _run(["--inputs=1"]), 0, "exit code")
	var again := ["--replay=" + _folder, "--output=" + _folder.path_join("again=1")]
	check_equal(
		Replay.run(PackedStringArray(again)), Replay.SAME, "the whole bundle, into a path with an equals sign"
	)
	check(FileAccess.file_exists(_folder.path_join("again=1/hand.csv")), "its rows are elsewhere")
	for part: String in ["hand.csv", "hand_statistics.json", "hand_settings.json"]:
		DirAccess.rename_absolute(_folder.path_join(part), _folder.path_join("kept"))
		check_equal(Replay.run(PackedStringArray(again)), Replay.DAMAGED, "without " + part)
		DirAccess.rename_absolute(_folder.path_join("kept"), _folder.path_join(part))
	var rows := FileAccess.get_file_as_string(_folder.path_join("hand.csv"))
	for itself: String in [_folder, _folder + "/", _folder.path_join("again=1/..")]:
		var over := ["--replay=" + _folder, "--output=" + itself]
		check_equal(Replay.run(PackedStringArray(over)), Replay.DAMAGED, "into the bundle itself, " + itself)
		check_equal(FileAccess.get_file_as_string(_folder.path_join("hand.csv")), rows, "its rows")
	DirAccess.make_dir_absolute(_folder.path_join("hand.unfinished"))
	check_equal(Replay.run(PackedStringArray(again)), Replay.DAMAGED, "of a run that was killed")
	DirAccess.remove_absolute(_folder.path_join("hand.unfinished"))
	var path := _folder.path_join("hand_settings.json")
	var text := FileAccess.get_file_as_string(path)
	FileAccess.open(path, FileAccess.WRITE).store_string(
		text.replace('"sides": [', '"sides": [ "environment",')
	)
	check_equal(Replay.run(PackedStringArray(again)), Replay.DAMAGED, "without its second side")


func test_the_launcher_refuses_by_type_unit_and_range() -> void:
	for option: String in ["scenario", "seconds", "local_port", "delay", "jitter", "loss", "watch"]:
		for value: String in NONSENSE:
			var said := Launch.new().take(PackedStringArray(["--%s=%s" % [option, value]]))
			check("--%s=%s is refused: it must be a" % [option, value] in said, said)
	for word: String in ["--driver=DRIVER_X", "--correction=CORRECTION_MASKED", "--side=far", "--colour=red"]:
		check(Launch.new().take(PackedStringArray([word])) != "", word)


func test_a_former_name_of_an_option_works_and_names_the_new_one() -> void:
	var launch := Launch.new()
	expect_error("--delay_ms is --delay now. The old name still works")
	check_equal(launch.take(PackedStringArray(["--scenario=4", "--delay_ms=40"])), "", "with the former name")
	check_equal(launch.chosen.delay, 40.0, "delay")
	expect_error("--delay_ms is --delay now")
	var twice := launch.take(PackedStringArray(["--scenario=4", "--delay_ms=40", "--delay=50"]))
	check_equal(twice, "--delay is given twice: say it once", "both")


func test_the_launcher_refuses_what_the_scenario_would_not_play() -> void:
	for words: Array in [
		["--scenario=1", "--delay=40"],
		["--loss=0.1"],
		["--scenario=1", "--correction=CORRECTION_NONE"],
		["--scenario=3", "--key_file=/key"],
		["--scenario=5", "--side=operator"],
		["--scenario=4", "--camera=SOURCE_CAMERA"]
	]:
		var launch := Launch.new()
		var said := launch.take(PackedStringArray(words))
		check("is refused: scenario" in said, "%s: '%s'" % [words, said])
		check_equal(launch.chosen, Launch.new().chosen, "what is chosen")
	for words: Array in [
		["--scenario=2", "--delay=40", "--side=operator"], ["--scenario=5", "--camera=SOURCE_CAMERA"]
	]:
		check_equal(Launch.new().take(PackedStringArray(words)), "", "%s" % [words])


func test_each_launch_has_a_folder_of_its_own() -> void:
	DirAccess.make_dir_recursive_absolute(_folder)
	var first := Run._own_folder(_folder.path_join("bundle"))
	FileAccess.open(first.path_join("hand.csv"), FileAccess.WRITE).store_string("rows")
	var second := Run._own_folder(_folder.path_join("bundle"))
	check(first != second and second.ends_with("bundle_2"), "both are %s" % second)


func test_model_errors_are_read_by_name_kind_and_range() -> void:
	expect_error("model_errors")
	var link := MMTLink.new()
	add_child(link)
	var right := {"Box": {"mass": 1.2, "rotation": [1, 0, 0, 0.17], "move": [0.0, 0.01, 0.0]}}
	link.model_errors = right
	for wrong: Dictionary in [
		{"Box": {"mas": 1.2}},
		{"Box": {"mass": "1.2"}},
		{"Box": {"mass": -1.0}},
		{"Box": {"mass": NAN}},
		{"Box": {"move": [0.0, 0.1]}},
		{"Box": {"turn": [1, 0, 0]}},
		{"Box": {"rotation": [1, 0, 0, NAN]}},
		{"Box": {"move": 0.1}},
		{"Box": 1.2},
	]:
		link.model_errors = wrong
		check_equal(link.model_errors, right, "after %s" % [wrong])


func test_two_recorders_do_not_write_over_each_other() -> void:
	expect_error("is being written by another recording")
	DirAccess.make_dir_recursive_absolute(_folder)
	var recorders: Array[HapticRecorder] = []
	for path: String in [_folder.path_join("rows.csv"), _folder.path_join("other/../rows.csv")]:
		var recorder := HapticRecorder.new()
		recorder.csv_path = path
		recorder.autostart = false
		add_child(recorder)
		recorders.append(recorder)
	check(recorders[0].start(), "the first one does not start")
	check(not recorders[1].start(), "the second one starts")
	check("another recording" in recorders[1].get_state_text(), recorders[1].get_state_text())
	check(recorders[0].get_state_text().begins_with("it has no proxy"), recorders[0].get_state_text())
	recorders[0].stop()
	check(recorders[1].start(), "it does not start when the first one has stopped")
	recorders[1].stop()


func test_a_side_by_itself_refuses_what_there_is_not() -> void:
	expect_error("was refused, the old value stays")
	var link := MMTLink.new()
	add_child(link)
	for right: String in ["--side=1", "--remote_address=10.0.0.1", "--local_port=47001"]:
		check_equal(Sides.set_property(link, right), "", right)
	check_equal(link.local_port, 47001, "port")
	for wrong: String in ["--sied=1", "--local_port=abc", "--local_port=70000", "side=1", "--side"]:
		check(Sides.set_property(link, wrong) != "", wrong)
