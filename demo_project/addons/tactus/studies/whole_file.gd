extends RefCounted
## A text file that is there as a whole, or as it was before.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded")


## Empty, or why it was not written: then the file of before is as it was. The text counts as written only
## when it has been read back.
static func write(path: String, text: String) -> String:
	var partial := path + ".partial"
	var file := FileAccess.open(partial, FileAccess.WRITE)
	if file == null:
		return _not_written(path, error_string(FileAccess.get_open_error()))
	file.store_string(text)
	file.close()
	var code := ERR_FILE_CANT_WRITE
	if FileAccess.get_file_as_string(partial) == text:
		code = DirAccess.rename_absolute(
			ProjectSettings.globalize_path(partial), ProjectSettings.globalize_path(path)
		)
		if code == OK:
			return ""
	DirAccess.remove_absolute(ProjectSettings.globalize_path(partial))
	return _not_written(path, "is the disk full?" if code == ERR_FILE_CANT_WRITE else error_string(code))


static func _not_written(path: String, why: String) -> String:
	return "'%s' could not be written (%s)" % [path, why]
