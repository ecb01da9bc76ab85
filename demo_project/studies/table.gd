extends RefCounted
## One row a trial, as the table of a sweep has one row a run (docs/experiments.md): its number, its factors
## with their units, its seed, what was answered. A row is in the file as soon as it is there.

var _file: FileAccess
var _columns := PackedStringArray()
var _rows := 0


## Empty where rows can be written, or why not.
func open(path: String) -> String:
	DirAccess.make_dir_recursive_absolute(ProjectSettings.globalize_path(path).get_base_dir())
	_file = FileAccess.open(path, FileAccess.WRITE)
	return "" if _file != null else "'%s' cannot be written: choose another folder" % path


## The first one says which columns there are.
func add(values: Dictionary) -> void:
	_rows += 1
	if _columns.is_empty():
		_columns = PackedStringArray(values.keys())
		_store(PackedStringArray(["run"]) + _columns)
	var cells := PackedStringArray([str(_rows)])
	for column in _columns:
		var value: Variant = values.get(column, "")
		cells.append(str(int(value)) if value is bool else str(value))
	_store(cells)
	_file.flush()


func _store(cells: PackedStringArray) -> void:
	_file.store_csv_line(cells)
