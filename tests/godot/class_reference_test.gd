extends "test_case.gd"
## What the editor shows of the extension's classes beside their reference.

const ADDON := "res://addons/tactus"
## Registered as such: neither the editor nor the reference shows them.
const INTERNAL := [&"BodyWatch", &"InputWatch"]


func _classes() -> PackedStringArray:
	var found := PackedStringArray()
	for name in ClassDB.get_class_list():
		var is_own := ClassDB.class_get_api_type(name) == ClassDB.API_EXTENSION
		if is_own and name not in INTERNAL and not name.begins_with("Binding"):
			found.append(name)
	return found


func test_every_class_has_an_icon_of_the_editors_size() -> void:
	var description := ConfigFile.new()
	check_equal(description.load(ADDON.path_join("tactus.gdextension")), OK, "reading the description")
	var classes := _classes()
	check(classes.size() >= 15, "only %s are there" % classes)
	for name in classes:
		var path: String = description.get_value("icons", name, "")
		check(not path.is_empty(), name + " has no icon")
		var icon := load(ADDON.path_join(path)) as Texture2D
		check(icon != null and icon.get_size() == Vector2(16, 16), name + "'s icon cannot be shown")
