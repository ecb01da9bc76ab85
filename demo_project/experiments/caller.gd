extends RefCounted
## The words behind the program's name, with paths as their writer means them.

const CallerPath := preload("res://addons/tactus/studies/caller_path.gd")

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


## The same options, those that name a path with a whole one.
static func words(given: PackedStringArray) -> PackedStringArray:
	var found := PackedStringArray()
	for word in given:
		var parts := word.split("=", true, 1)
		if parts.size() == 2 and parts[0].trim_prefix("--") in PATHS:
			word = "%s=%s" % [parts[0], CallerPath.whole(parts[1])]
		found.append(word)
	return found


static func asks_for_help(given: PackedStringArray) -> bool:
	return HELP.any(func(word: String) -> bool: return word in given)


## Why nothing may be written where these words say; empty where it may.
static func problem(given: PackedStringArray) -> String:
	for word in words(given):
		if word.begins_with("--output="):
			var found := CallerPath.problem(word.trim_prefix("--output="))
			if not found.is_empty():
				return found
	return ""
