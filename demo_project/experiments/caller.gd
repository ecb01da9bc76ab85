extends RefCounted
## The words behind the program's name, with paths as their writer means them.

## Options that name a file or a folder.
const PATHS: Array[String] = ["output", "replay", "key_file"]
const HELP: Array[String] = ["--help", "-h"]
const USAGE := """tactus                                       the gallery
tactus SCENE                                 a scene of the gallery, res://gallery/NAME/NAME.tscn
tactus -- --launch=form                      the launcher
tactus -- --launch=now --NAME=VALUE …        what it does, without its form
tactus -- --scene=SCENE --NAME=VALUE …       one scene for a time, its files in --output=FOLDER
tactus -- --replay=BUNDLE [--output=FOLDER]  a run that has left its inputs, again
A wrong NAME is answered with those that there are. In the clone, ./run app stands for tactus."""


## Where Godot is started with --path, it leaves the caller's folder for that of the project. The shell keeps
## the caller's in PWD.
static func path(given: String) -> String:
	var folder := OS.get_environment("PWD")
	if given.is_empty() or not given.is_relative_path() or not DirAccess.dir_exists_absolute(folder):
		return given
	return folder.path_join(given).simplify_path()


## The same options, those that name a path with a whole one.
static func words(given: PackedStringArray) -> PackedStringArray:
	var found := PackedStringArray()
	for word in given:
		var parts := word.split("=", true, 1)
		if parts.size() == 2 and parts[0].trim_prefix("--") in PATHS:
			word = "%s=%s" % [parts[0], path(parts[1])]
		found.append(word)
	return found


static func asks_for_help(given: PackedStringArray) -> bool:
	return HELP.any(func(word: String) -> bool: return word in given)


## Why nothing may be written where these words say; empty where it may.
static func problem(given: PackedStringArray) -> String:
	var project := ProjectSettings.globalize_path("res://").simplify_path()
	for word in words(given):
		if not word.begins_with("--output="):
			continue
		var folder := word.trim_prefix("--output=")
		var is_within := not project.is_empty() and (folder.simplify_path() + "/").begins_with(project + "/")
		if is_within or folder.begins_with("res://"):
			return (
				"%s is inside the Godot project, which would import and export it: choose a folder outside"
				% word
			)
	return ""
