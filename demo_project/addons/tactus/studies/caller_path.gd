extends RefCounted
## A path of the command line as its writer means it.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")


## Where Godot is started with --path, it leaves the caller's folder for that of the project. The shell keeps
## the caller's in PWD.
static func whole(given: String) -> String:
	var folder := OS.get_environment("PWD")
	if given.is_empty() or not given.is_relative_path() or not DirAccess.dir_exists_absolute(folder):
		return given
	return folder.path_join(given).simplify_path()


## Why nothing may be written there; empty where it may.
static func problem(path: String) -> String:
	var project := ProjectSettings.globalize_path("res://").simplify_path()
	var is_within := not project.is_empty() and (path.simplify_path() + "/").begins_with(project + "/")
	if not is_within and not path.begins_with("res://"):
		return ""
	return "%s is inside the Godot project, which would import and export it: choose a folder outside" % path
