@tool
extends "test_case.gd"
## A scene that the real editor plays, and what its dock shows of it.

const SeenWords := preload("seen_words.gd")
## As in the pictures of the documents.
const SIZE := Vector2i(1440, 900)


func _dock() -> Control:
	for control: Node in EditorInterface.get_base_control().find_children("*", "Container", true, false):
		if control.has_method("show_figures"):
			return control
	return null


func _bring_to_front(control: Control) -> void:
	var child: Node = control
	while child != null:
		var tabs := child.get_parent() as TabContainer
		if tabs != null:
			tabs.current_tab = tabs.get_tab_idx_from_control(child)
		if child is CanvasItem:
			(child as CanvasItem).show()
		child = child.get_parent()


## The dock is looked at before the scene is there, or only later.
func test_the_dock_shows_a_scene_that_is_played() -> void:
	var dock := _dock()
	check(dock != null, "there is no dock")
	if dock == null:
		return
	get_tree().root.size = SIZE
	for is_early: bool in [true, false]:
		EditorInterface.play_custom_scene("res://gallery/stack/stack.tscn")
		check(EditorInterface.is_playing_scene(), "nothing is played")
		# The editor opens its output when a scene begins.
		await frames(2 if is_early else 200)
		_bring_to_front(dock)
		await frames(2)
		check(dock.is_looked_at(), "the dock is not in view")
		var panel: Control = dock.get_node("%Panel")
		var shows := func() -> bool: return panel.visible and panel.get_node("%Said").text.contains("bodies")
		check(await until(shows, 60.0), "the dock stays empty (looked at early: %s)" % is_early)
		var has_counted := func() -> bool: return (panel.get_node("%Periods") as Control).visible
		check(await until(has_counted, 60.0), "there is no histogram")
		await frames(4)
		for found in SeenWords.faults(panel):
			check(false, "%s (the panel is %s)" % [found, panel.size])
		EditorInterface.stop_playing_scene()
		await until(func() -> bool: return not panel.visible, 10.0)


## The editor opens its output where a scene begins: a dock that was looked at is in front again.
func test_the_dock_stays_in_view_when_a_scene_begins() -> void:
	var dock := _dock()
	var panel: Control = dock.get_node("%Panel")
	for is_looked_at: bool in [true, false]:
		_bring_to_front(dock)
		if not is_looked_at:
			dock.get_parent_control().hide()
			dock.hide()
		await frames(2)
		EditorInterface.play_custom_scene("res://gallery/stack/stack.tscn")
		check(await until(func() -> bool: return panel.visible, 60.0), "the scene does not begin")
		await frames(20)
		check_equal(dock.is_looked_at(), is_looked_at, "in view")
		EditorInterface.stop_playing_scene()
		await until(func() -> bool: return not panel.visible, 10.0)


func _scenes(folder: String) -> PackedStringArray:
	var found := PackedStringArray()
	for file in DirAccess.get_files_at(folder):
		if file.ends_with(".tscn"):
			found.append(folder.path_join(file))
	for below in DirAccess.get_directories_at(folder):
		if not below.begins_with("."):
			found.append_array(_scenes(folder.path_join(below)))
	return found


## What scripts made into a scene for its look is not stored with it.
func test_a_scene_that_is_saved_is_as_small_as_it_was() -> void:
	var scenes := _scenes("res://gallery")
	scenes.append_array(_scenes("res://studies"))
	scenes.append_array(_scenes("res://experiments"))
	check(scenes.size() > 30, "only %d scenes" % scenes.size())
	for file in scenes:
		var scene: Node = (load(file) as PackedScene).instantiate(PackedScene.GEN_EDIT_STATE_MAIN)
		add_child(scene)
		await frames(2)
		var packed := PackedScene.new()
		packed.pack(scene)
		check_equal(ResourceSaver.save(packed, "user://saved.tscn"), OK, "saving")
		scene.queue_free()
		await frames(2)
		var before := FileAccess.get_file_as_bytes(file).size()
		var after := FileAccess.get_file_as_bytes("user://saved.tscn").size()
		check(after < before + before / 2 + 2000, "%s: %d bytes instead of %d" % [file, after, before])


## Its folder may be deleted without another step: no setting of the project names it but the list of plugins.
func test_the_plugin_leaves_nothing_in_the_settings_of_the_project() -> void:
	var enabled := EditorInterface.is_plugin_enabled("tactus")
	check(enabled, "the plugin is not enabled")
	for is_on: bool in [false, true]:
		EditorInterface.set_plugin_enabled("tactus", is_on)
		await frames(2)
		for setting in ProjectSettings.get_property_list():
			var value := str(ProjectSettings.get_setting(setting.name))
			if setting.name != "editor_plugins/enabled":
				check(not value.contains("res://addons/tactus/"), "%s is %s" % [setting.name, value])
