extends RefCounted
## What one participant has answered in one run of a study: a folder that no other run writes into,
## FOLDER/STUDY/PARTICIPANT/run_3, with
##
##     STUDY_PARTICIPANT_3.csv    one row a trial, there as soon as it is answered
##     STUDY_PARTICIPANT_3.json   settings, seed, version, the meaning of the columns, and the results
##
## A run that was not finished goes on where it stopped (`begin`). A row counts only when it has been read
## back from the file.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")
@warning_ignore_start("integer_division", "incompatible_ternary", "shadowed_variable_base_class")

const WholeFile := preload("whole_file.gd")

## A participant's code: no name of a person, and nothing that a path could be confused by.
const CODE := "^[A-Za-z0-9_-]{1,32}$"
## A run whose lock has not been touched for so long has been left (unit: seconds).
const LOCK_LASTS := 10.0

var folder := ""
## The rows of before, where a run goes on: dictionaries by column, all texts.
var rows: Array[Dictionary] = []
## What the run was started with; see `about` of begin().
var about := {}
## See LOCK_LASTS (unit: seconds).
var lock_lasts := LOCK_LASTS

var _base := ""
var _columns := PackedStringArray()
var _written := ""
var _touches := 0


## Where `goes_on` holds, takes up the participant's last run with these settings if it was not finished; else
## begins a new one. `more` is kept in the run's JSON file. Empty, or why nothing can be kept.
func begin(
	place: String, study: String, participant: String, settings: Dictionary, more: Dictionary, goes_on: bool
) -> String:
	var wrong := code_problem(participant)
	if not wrong.is_empty():
		return wrong
	var all := place.path_join(study).path_join(participant)
	var code := DirAccess.make_dir_recursive_absolute(ProjectSettings.globalize_path(all))
	if code != OK and code != ERR_ALREADY_EXISTS:
		return "'%s' cannot be made (%s): choose another folder" % [all, error_string(code)]
	var number := _last_run(all)
	if number > 0 and goes_on:
		_name(all, study, participant, number)
		if _is_unfinished(settings) and _take_over():
			return _go_on()
	rows = []
	while true:
		number += 1
		# Making a folder either succeeds or finds it: two programs never get the same one.
		_name(all, study, participant, number)
		code = DirAccess.make_dir_absolute(ProjectSettings.globalize_path(folder))
		if code == OK:
			break
		if code != ERR_ALREADY_EXISTS:
			return "'%s' cannot be made (%s): choose another folder" % [folder, error_string(code)]
	touch()
	about = {"settings": settings, "finished": false}
	about.merge(more)
	return _write_about()


## Why that is no participant's code; empty where it is one.
static func code_problem(participant: String) -> String:
	if RegEx.create_from_string(CODE).search(participant) != null:
		return ""
	return "'%s' is no participant's code: 1 to 32 letters, digits, - and _, and no name" % participant


## One row; the first one says which columns there are. Empty, or why it was not kept.
func add(row: Dictionary) -> String:
	var text := ""
	if _columns.is_empty():
		_columns = PackedStringArray(row.keys())
		text = _line(_columns)
	var cells := PackedStringArray()
	for column in _columns:
		var value: Variant = row.get(column, "")
		cells.append(str(int(value)) if value is bool else str(value))
	text += _line(cells)
	if FileAccess.file_exists(_path(".csv")) and _rows_on_disk() != _written:
		return _not_kept("another program has changed it")
	var file := FileAccess.open(
		_path(".csv"), FileAccess.READ_WRITE if not _written.is_empty() else FileAccess.WRITE
	)
	if file == null:
		return _not_kept(error_string(FileAccess.get_open_error()))
	file.seek_end()
	file.store_string(text)
	file.close()
	if _rows_on_disk() != _written + text:
		return _not_kept("is the disk full?")
	_written += text
	touch()
	return ""


## The run is over. Empty, or why that was not kept.
func finish(results: Dictionary) -> String:
	about["finished"] = true
	about["results"] = results
	var problem := _write_about()
	leave()
	return problem


## This run is being answered: no other program goes on with it. At least every few seconds.
func touch() -> void:
	var file := FileAccess.open(_lock(), FileAccess.WRITE)
	if file != null:
		_touches += 1
		file.store_string("%d %d" % [OS.get_process_id(), _touches])


## Another program may go on with it.
func leave() -> void:
	if FileAccess.file_exists(_lock()):
		DirAccess.remove_absolute(_lock())


func csv_path() -> String:
	return _path(".csv")


func _name(all: String, study: String, participant: String, number: int) -> void:
	folder = all.path_join("run_%d" % number)
	_base = "%s_%s_%d" % [study, participant, number]


func _path(ending: String) -> String:
	return folder.path_join(_base + ending)


static func _last_run(all: String) -> int:
	var last := 0
	for name in DirAccess.get_directories_at(all):
		var number := name.trim_prefix("run_")
		if name.begins_with("run_") and number.is_valid_int():
			last = maxi(last, int(number))
	return last


func _lock() -> String:
	return ProjectSettings.globalize_path(folder.path_join(".lock"))


func _lock_text() -> String:
	return FileAccess.get_file_as_string(_lock()) if FileAccess.file_exists(_lock()) else ""


func _rows_on_disk() -> String:
	return FileAccess.get_file_as_string(_path(".csv"))


## Whether this program has the run's lock now, which no other one has then. A lock that is not old yet may
## have been left by a crash: whether it is touched again is waited for.
func _take_over() -> bool:
	var left := _lock_text()
	if left.begins_with("%d " % OS.get_process_id()):
		return false
	var deadline := Time.get_ticks_msec() + int(1e3 * lock_lasts)
	while Time.get_ticks_msec() < deadline and _lock_age() < lock_lasts:
		if _lock_text() not in [left, ""]:
			return false
		OS.delay_msec(20)
	# Making a folder either succeeds or finds it: of two programs that have waited one goes on.
	var claim := ProjectSettings.globalize_path(folder.path_join(".claim"))
	if DirAccess.make_dir_absolute(claim) != OK:
		return false
	var is_left := _lock_text() in [left, ""]
	if is_left:
		touch()
	DirAccess.remove_absolute(claim)
	return is_left


## Infinite where there is no lock (unit: seconds).
func _lock_age() -> float:
	if not FileAccess.file_exists(_lock()):
		return INF
	return Time.get_unix_time_from_system() - FileAccess.get_modified_time(_lock())


func _is_unfinished(settings: Dictionary) -> bool:
	var found: Variant = JSON.parse_string(FileAccess.get_file_as_string(_path(".json")))
	if not found is Dictionary or found.get("finished", true):
		return false
	# Numbers of JSON have one type: both go the same way.
	var same: bool = found.get("settings") == JSON.parse_string(JSON.stringify(settings, "", true, true))
	if same:
		about = found
	return same


## Reads the rows of before. A last row without its end was never told to be kept, and goes; one before it
## that is not whole is a damage that nothing is written over.
func _go_on() -> String:
	rows = []
	var whole := ""
	var text := FileAccess.get_file_as_string(_path(".csv"))
	for line in text.split("\n").slice(0, -1):
		var cells := _cells(line)
		if _columns.is_empty():
			_columns = cells
		elif cells.size() == _columns.size():
			var row := {}
			for i in cells.size():
				row[_columns[i]] = cells[i]
			rows.append(row)
		else:
			leave()
			return (
				"row %d of '%s' is damaged: mend it, or begin a new run with --goes_on=0"
				% [rows.size() + 1, csv_path()]
			)
		whole += line + "\n"
	_written = whole
	return "" if whole == text else _kept(WholeFile.write(_path(".csv"), whole))


func _write_about() -> String:
	return _kept(WholeFile.write(_path(".json"), JSON.stringify(about, "  ", true, true) + "\n"))


## The same, with what a participant's answers are worth then.
static func _kept(problem: String) -> String:
	return problem + ": the answers before this one are there" if problem != "" else ""


func _not_kept(why: String) -> String:
	return _kept("'%s' could not be written (%s)" % [_path(".csv"), why])


## As a spreadsheet reads it.
static func _line(cells: PackedStringArray) -> String:
	var quoted := PackedStringArray()
	for cell in cells:
		var text := cell.replace("\n", " ")
		var needs_quotes := "," in text or '"' in text
		quoted.append('"%s"' % text.replace('"', '""') if needs_quotes else text)
	return ",".join(quoted) + "\n"


static func _cells(line: String) -> PackedStringArray:
	var cells := PackedStringArray([""])
	var is_quoted := false
	for i in line.length():
		var letter := line[i]
		if letter == '"':
			is_quoted = not is_quoted
			# Two of them within quotes stand for one.
			if is_quoted and i > 0 and line[i - 1] == '"':
				cells[-1] += letter
		elif letter == "," and not is_quoted:
			cells.append("")
		else:
			cells[-1] += letter
	return cells
