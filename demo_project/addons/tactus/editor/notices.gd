@tool
extends EditorExportPlugin
## Lays the license of Tactus and those of the works in it beside every exported program.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

## By name in the addon's folder: name beside the program.
const FILES := {"LICENSE": "tactus_license.txt", "NOTICES.txt": "tactus_notices.txt"}


func _get_name() -> String:
	return "TactusNotices"


func _export_begin(_features: PackedStringArray, _is_debug: bool, path: String, _flags: int) -> void:
	var addon: String = (get_script() as Script).resource_path.get_base_dir().get_base_dir()
	var target := path.get_base_dir()
	if target.is_relative_path():
		target = ProjectSettings.globalize_path("res://").path_join(target)
	for file: String in FILES:
		var source := addon.path_join(file)
		if not FileAccess.file_exists(source):  # in a clone they are elsewhere
			continue
		var problem := DirAccess.copy_absolute(
			ProjectSettings.globalize_path(source), target.path_join(FILES[file])
		)
		if problem != OK:
			push_warning(
				"%s could not be written (%s): give it along yourself" % [FILES[file], error_string(problem)]
			)
