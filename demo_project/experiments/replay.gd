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

const INPUTS := "_inputs.tactus"
## Of a recording's own time, in one go (unit: seconds).
const A_WHILE := 60.0


## Returns the exit code of the program: 0 when everything was the same, 1 when something was not, 2 when
## there was nothing or not all of it could be played.
static func run(arguments: PackedStringArray) -> int:
	var bundle := _value(arguments, "replay")
	var output := _value(arguments, "output")
	if output.is_empty():
		output = bundle.path_join("replay")
	var worst := SAME
	var found := 0
	for file in DirAccess.get_files_at(bundle):
		if file.ends_with(INPUTS):
			found += 1
			worst = maxi(worst, play(bundle, file.trim_suffix(INPUTS), output))
	if found == 0:
		printerr("replay: '%s' is no bundle: no file of it ends in %s." % [bundle, INPUTS])
		return DAMAGED
	return worst


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
	var file := FileAccess.open(output.path_join(side + "_replay.json"), FileAccess.WRITE)
	file.store_string(JSON.stringify(report, "  ", true, true) + "\n")
	print("%s: %s" % [side, _in_words(report)])
	if not report.same or report.rows == "different":
		return DIFFERENT
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
	if report.same:
		words += "the same to the bit, %s" % report.outcome
	else:
		words += "from tick %d on not the same" % report.first_different
	if report.rows == "different":
		words += "; its rows are not those of the bundle"
	if report.problem != "":
		words += "; not all of it could be played: %s" % report.problem
	return words


static func _value(arguments: PackedStringArray, option: String) -> String:
	for argument in arguments:
		if argument.begins_with("--%s=" % option):
			return argument.get_slice("=", 1)
	return ""
