extends "nodes_case.gd"
## What the inspector and the configuration warnings say of these nodes.


func _extension_classes() -> Array[StringName]:
	var classes: Array[StringName] = []
	for name in ClassDB.get_class_list():
		if ClassDB.class_get_api_type(name) == ClassDB.API_EXTENSION and not name.begins_with("Binding"):
			classes.append(name)
	return classes


## As Godot takes such a hint apart: at the commas, and each entry at its colon.
func test_every_enum_of_the_inspector_has_its_entries() -> void:
	var seen := 0
	for type in _extension_classes():
		for property in ClassDB.class_get_property_list(type, true):
			if property.hint != PROPERTY_HINT_ENUM or property.type != TYPE_INT:
				continue
			seen += 1
			var enumeration: String = String(property.class_name).get_slice(".", 1)
			var constants := ClassDB.class_get_enum_constants(type, enumeration, true)
			var names := {}
			for constant in constants:
				names.get_or_add(ClassDB.class_get_integer_constant(type, constant), constant)
			var values: Array = names.keys()
			var shared := _shared_words(names.values())
			var entries: PackedStringArray = property.hint_string.split(",")
			check_equal(entries.size(), values.size(), "entries of %s.%s" % [type, property.name])
			for i in mini(entries.size(), values.size()):
				var parts := entries[i].split(":")
				check_equal(parts.size(), 2, "parts of '%s' in %s.%s" % [entries[i], type, property.name])
				check(parts[0].strip_edges() != "", "no name in '%s' in %s" % [entries[i], type])
				check(parts[1].is_valid_int() and int(parts[1]) == values[i], "value of '%s'" % entries[i])
				var words: String = names[values[i]].trim_prefix(shared).replace("_", "")
				check_equal(
					_as_constant(parts[0], values[i]), words, "entry of %s.%s" % [type, property.name]
				)
	check(seen >= 8, "only %d enums" % seen)


## What all of them begin with, up to an underscore.
func _shared_words(names: Array) -> String:
	var shared: String = names[0]
	for name: String in names:
		while not name.begins_with(shared):
			shared = shared.left(-1)
	return shared.left(shared.rfind("_") + 1)


## An entry of the inspector as the end of a constant's name.
## It may begin with its own value, and connect words by "and".
func _as_constant(entry: String, value: int) -> String:
	return entry.trim_prefix("%d " % value).replace(" and ", " ").to_upper().replace(" ", "").replace("-", "")


func _felt_body(at: Vector3) -> StaticBody3D:
	var body := with_shape(StaticBody3D.new(), box(Vector3.ONE), at) as StaticBody3D
	body.physics_material_override = material(500.0)
	return body


func _world_with_body() -> HapticWorld:
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	world.add_child(_felt_body(Vector3.ZERO))
	return world


func _warnings(world: HapticWorld) -> String:
	return "\n".join(world._list_warnings())


func test_a_world_that_is_the_root_of_its_scene_warns_of_nothing() -> void:
	var root := _world_with_body()
	get_tree().root.add_child(root)
	check_equal(_warnings(root), "", "warnings of a root")
	root.free()
	var child := _world_with_body()
	add_child(child)
	check_equal(_warnings(child), "", "warnings of a child")
	child.free()


func test_a_world_that_is_an_instance_warns_of_nothing() -> void:
	var world := _world_with_body()
	for node in world.find_children("*", "", true, false):
		node.owner = world
	var packed := PackedScene.new()
	packed.pack(world)
	world.free()
	var scene := Node3D.new()
	for i in 2:
		scene.add_child(packed.instantiate())
	add_child(scene)
	for one: HapticWorld in scene.get_children():
		check_equal(_warnings(one), "", "warnings of an instance")


func test_a_body_outside_is_warned_of() -> void:
	var scene := Node3D.new()
	var world := _world_with_body()
	scene.add_child(world)
	var outside := _felt_body(Vector3(5, 0, 0))
	outside.name = "Lonely"
	scene.add_child(outside)
	add_child(scene)
	check(_warnings(world).contains("'Lonely'"), "it says: " + _warnings(world))
	scene.remove_child(outside)
	scene.remove_child(world)
	outside.add_child(world)
	scene.add_child(outside)
	check(_warnings(world).contains("'Lonely'"), "with the body above, it says: " + _warnings(world))


func _scripts(folder: String) -> PackedStringArray:
	var found := PackedStringArray()
	for file in DirAccess.get_files_at(folder):
		if file.ends_with(".gd"):
			found.append(folder.path_join(file))
	for below in DirAccess.get_directories_at(folder):
		found.append_array(_scripts(folder.path_join(below)))
	return found


## A project may make every one of Godot's warnings an error, also for its addons.
func test_the_addons_scripts_load_with_every_warning_as_an_error() -> void:
	const PREFIX := "debug/gdscript/warnings/"
	var before := {}
	for property in ProjectSettings.get_property_list():
		var name: String = property.name
		if name.begins_with(PREFIX):
			before[name] = ProjectSettings.get_setting(name)
			if property.type == TYPE_INT:
				ProjectSettings.set_setting(name, 2)
	check(before.size() > 30, "only %d warnings" % before.size())
	ProjectSettings.set_setting(PREFIX + "directory_rules", {})
	await frames(2)
	var scripts := _scripts("res://addons/tactus")
	check(scripts.size() > 10, "only %d scripts" % scripts.size())
	for file in scripts:
		var script: GDScript = ResourceLoader.load(file, "", ResourceLoader.CACHE_MODE_IGNORE)
		check(script != null and script.can_instantiate(), "%s does not load" % file)
	for name: String in before:
		ProjectSettings.set_setting(name, before[name])
	await frames(2)


## What a script draws of a scene is made again when the scene is opened: it is not stored with it.
func test_what_looks_draw_is_not_stored() -> void:
	var line := MeshInstance3D.new()
	line.set_script(load("res://looks/line_look.gd"))
	line.set("line", path(Vector3.ZERO, Vector3.ONE))
	var library := MeshInstance3D.new()
	library.set_script(load("res://looks/library_look.gd"))
	library.set("library_mesh", HapticMesh.get_library_names()[0])
	for look: MeshInstance3D in [line, library]:
		check(look.mesh != null, "nothing is drawn")
		var packed := PackedScene.new()
		packed.pack(look)
		check_equal(ResourceSaver.save(packed, "user://look.tscn"), OK, "saving")
		check(not FileAccess.get_file_as_string("user://look.tscn").contains("ArrayMesh"), "it is stored")
		look.free()
