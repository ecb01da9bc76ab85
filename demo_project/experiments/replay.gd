extends RefCounted
## Plays a bundle again and says whether the same comes of it. The main scene does when called so:
##
##     godot --headless --path demo_project -- --replay=BUNDLE [--output=FOLDER]
##     tactus.x86_64 --headless -- --replay=BUNDLE [--output=FOLDER]
##
## BUNDLE is a folder in which an experiment has left CASE_inputs.tactus, one for each of its sides. Of each,
## CASE.csv is written into FOLDER anew, the bytes that the bundle has, and CASE_replay.json says what came of
## it. FOLDER is BUNDLE/replay where it is missing.

enum { SAME, DIFFERENT, DAMAGED }

const WholeFile := preload("res://addons/tactus/studies/whole_file.gd")
const OptionWords := preload("res://addons/tactus/studies/option_words.gd")
const INPUTS := "_inputs.tactus"
const SETTINGS := "_settings.json"
## Of a recording's own time, in one go (unit: seconds).
const A_WHILE := 60.0


## Returns the exit code of the program: 0 when everything was the same, 1 when something was not or a part is
## another one than was recorded, 2 when there was nothing, a part was missing, or not all of it could be
## played.
static func run(arguments: PackedStringArray) -> int:
	var words := OptionWords.new()
	words.declared = {"replay": OptionWords.text(), "output": OptionWords.text()}
	var wrong := words.read(arguments)
	if not wrong.is_empty():
		printerr("replay: ", wrong, ".")
		return DAMAGED
	var bundle: String = words.values.get("replay", "")
	var output: String = words.values.get("output", "")
	if output.is_empty():
		output = bundle.path_join("replay")
	var sides := Array(DirAccess.get_files_at(bundle)).filter(
		func(file: String) -> bool: return file.ends_with(INPUTS)
	)
	if sides.is_empty():
		printerr("replay: '%s' is no bundle: no file of it ends in %s." % [bundle, INPUTS])
		return DAMAGED
	if _is_same_folder(bundle, output):
		printerr("replay: --output=%s is the bundle itself: what is played would replace it." % output)
		return DAMAGED
	var worst := SAME
	for file: String in sides:
		worst = maxi(worst, play(bundle, file.trim_suffix(INPUTS), output))
	for changed in _changed(bundle):
		printerr("replay: its part %s is not the one that was recorded." % changed)
		worst = maxi(worst, DIFFERENT)
	for missing in _missing(bundle):
		printerr("replay: ", missing, ".")
		worst = maxi(worst, DAMAGED)
	return worst


## Also by another path, such as one with a link: a file that is written into one is seen in the other.
static func _is_same_folder(one: String, other: String) -> bool:
	var mark := ".is_same_%d" % OS.get_process_id()
	DirAccess.make_dir_recursive_absolute(other)
	if DirAccess.make_dir_absolute(other.path_join(mark)) != OK:
		return (
			ProjectSettings.globalize_path(one).simplify_path()
			== ProjectSettings.globalize_path(other).simplify_path()
		)
	var found := DirAccess.dir_exists_absolute(one.path_join(mark))
	DirAccess.remove_absolute(other.path_join(mark))
	return found


## What the bundle should have, as each of its sides has listed it, and has not.
static func _missing(bundle: String) -> PackedStringArray:
	var missing := PackedStringArray()
	for folder in DirAccess.get_directories_at(bundle):
		if folder.ends_with(".unfinished"):
			missing.append(
				"%s was not ended: it was killed, or it is still being played" % folder.get_basename()
			)
	for file in DirAccess.get_files_at(bundle):
		if file.ends_with(INPUTS) and not _is_listed(bundle, file):
			missing.append("no CASE%s lists %s: what belongs to it is not known" % [SETTINGS, file])
		if file.ends_with(SETTINGS):
			missing.append_array(_missing_of(bundle, file))
	return missing


## The parts whose hash is not that of their list.
static func _changed(bundle: String) -> PackedStringArray:
	var changed := PackedStringArray()
	for file in DirAccess.get_files_at(bundle):
		var parts: Dictionary = (
			_settings_of(bundle, file).get("parts", {}) if file.ends_with(SETTINGS) else {}
		)
		for part: String in parts:
			var path := bundle.path_join(part)
			var listed: Variant = parts[part].get("sha256") if parts[part] is Dictionary else null
			if FileAccess.file_exists(path) and FileAccess.get_sha256(path) != listed:
				changed.append(part)
	return changed


## Empty where the file has no list of the parts.
static func _settings_of(bundle: String, file: String) -> Dictionary:
	# An object of its own says nothing where it cannot read.
	var json := JSON.new()
	if json.parse(FileAccess.get_file_as_string(bundle.path_join(file))) != OK:
		return {}
	var settings: Variant = json.data
	return settings if settings is Dictionary and settings.get("parts") is Dictionary else {}


static func _missing_of(bundle: String, settings_file: String) -> PackedStringArray:
	var missing := PackedStringArray()
	var settings := _settings_of(bundle, settings_file)
	if settings.is_empty():
		return PackedStringArray(["%s has no list of the parts" % settings_file])
	for side: String in settings.get("sides", []):
		if not FileAccess.file_exists(bundle.path_join(side + SETTINGS)):
			missing.append("its side '%s' is missing" % side)
	for part: String in settings.parts:
		if not FileAccess.file_exists(bundle.path_join(part)):
			missing.append("its part %s is missing" % part)
	return missing


static func _is_listed(bundle: String, inputs: String) -> bool:
	for file in DirAccess.get_files_at(bundle):
		if file.ends_with(SETTINGS) and _settings_of(bundle, file).get("parts", {}).has(inputs):
			return true
	return false


## One side of a bundle.
static func play(bundle: String, side: String, output: String) -> int:
	var replay := HapticReplay.new()
	var rows := bundle.path_join(side + ".csv")
	var played_rows := output.path_join(side + ".csv")
	DirAccess.make_dir_recursive_absolute(output)
	if not replay.open(bundle.path_join(side + INPUTS), played_rows):
		return DAMAGED
	while not replay.is_over():
		replay.play(A_WHILE)
	var report := replay.get_report()
	# The rows are in their file.
	replay = null
	report["rows"] = _compared(rows, played_rows, report.problem == "")
	var path := output.path_join(side + "_replay.json")
	var text := JSON.stringify(report, "  ", true, true) + "\n"
	var problem := WholeFile.write(path, text)
	if not problem.is_empty():
		printerr("replay: ", problem, ".")
		return DAMAGED
	print("%s: %s" % [side, _in_words(report)])
	if not report.same or report.rows == "different":
		return DIFFERENT
	if report.ticks == 0:
		return DAMAGED
	return SAME if report.problem == "" else DAMAGED


## Of what could not all be played there are the first ones only.
static func _compared(then: String, now: String, whole: bool) -> String:
	if not FileAccess.file_exists(then):
		return "missing"
	var all := FileAccess.get_file_as_bytes(then)
	var played := FileAccess.get_file_as_bytes(now)
	return "same" if all == played or (not whole and all.slice(0, played.size()) == played) else "different"


static func _in_words(report: Dictionary) -> String:
	var words := "%d ticks, " % report.ticks
	if report.ticks == 0:
		words += "there is nothing to compare"
	elif report.same:
		words += "bit-exact, %s" % report.outcome
	else:
		words += "from tick %d on not the same" % report.first_different
	if report.rows == "different":
		words += "; its rows are not those of the bundle"
	if report.problem != "":
		words += "; not all of it could be played: %s" % report.problem
	return words
