@tool
extends EditorPlugin
## godot --editor --path FOLDER -- OUTPUT: takes pictures of the editor with the addon in it, and ends
## (tools/docs_pictures.py).
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const SIZE := Vector2i(1440, 900)
const TALL := Vector2i(1440, 1180)
const PLAYED := "res://gallery/static_testbed/static_testbed.tscn"
const PLAYED_SECONDS := 12.0
const BUTTON_WARNING := 5  # of the editor's tree of a scene
const FILMED := "res://gallery/still_life/still_life.tscn"
const FILM_SIZE := Vector2i(1152, 648)
const FILM_SECONDS := 600.0

var _folder := ""
var _made := 0
var _has_failed := false


func _ready() -> void:
	_folder = OS.get_cmdline_user_args()[0]
	while EditorInterface.get_resource_filesystem().is_scanning():
		await get_tree().process_frame
	await _resize(SIZE)
	await _run()
	print("FAILED" if _has_failed else "DONE")
	get_tree().quit()


func _run() -> void:
	await _welcome()
	await _open("res://addons/tactus/HapticRig.tscn")
	var root := EditorInterface.get_edited_scene_root()
	await _look(Vector3(0.02, 0.34, 0.5), Vector3(0, 0.03, -0.02))
	await _select(root.get_node("HapticWorld/HapticDevice"))
	await _save("editor_rig")
	await _resize(TALL)
	await _save_inspector("inspector_device")
	await _select(root.get_node("HapticWorld"))
	await _save_inspector("inspector_world")
	await _select(root.get_node("HapticWorld/HapticDevice/ProxyPointer"))
	await _save_inspector("inspector_pointer")
	EditorInterface.edit_resource(root.get_node("HapticWorld/Table").physics_material_override)
	await _frames(10)
	await _save_inspector("inspector_material")
	await _resize(SIZE)
	await _gizmos()
	await _warnings()
	await _help()
	await _panel()
	await _film()


## It shows by itself in a project that is new to the editor.
func _welcome() -> void:
	await _frames(30)
	var pages := get_tree().root.find_children("*", "AcceptDialog", true, false).filter(
		func(page: AcceptDialog) -> bool: return page.visible and page.title == "Welcome to Tactus"
	)
	if pages.size() != 1:
		_has_failed = true
		printerr("the first page shows %d times" % pages.size())
		return
	await _picture()
	_keep((pages[0] as AcceptDialog).get_texture().get_image(), "welcome")
	(pages[0] as AcceptDialog).hide()


func _gizmos() -> void:
	var device := HapticDevice.new()
	device.driver = HapticDevice.DRIVER_FALCON
	await _node_alone(device, "gizmo_device", Vector3(0.1, 0.09, 0.17))
	var led := HapticDevice.new()
	led.driver = HapticDevice.DRIVER_PATH
	led.path = load("res://paths/thesis_path.tres")
	await _node_alone(led, "gizmo_path", Vector3(0.3, 0.35, 0.6))
	var tool := HapticTool.new()
	var box := BoxShape3D.new()
	box.size = Vector3(0.04, 0.1, 0.02)
	var shape := CollisionShape3D.new()
	shape.name = "Shape"
	shape.shape = box
	tool.add_child(shape)
	await _node_alone(tool, "gizmo_tool", Vector3(0.1, 0.1, 0.2))
	var sensor := HapticDepthSensor.new()
	sensor.active = false
	sensor.position = Vector3(0, 0.7, 0.3)
	sensor.rotation.x = -0.35 * PI
	await _node_alone(sensor, "gizmo_sensor", Vector3(1.1, 0.9, 1.3), Vector3(0, 0.35, 0))
	var body := StaticBody3D.new()
	var mesh := HapticMesh.new()
	mesh.name = "HapticMesh"
	mesh.library_mesh = "torus"
	body.add_child(mesh)
	await _node_alone(body, "gizmo_mesh", Vector3(0.14, 0.15, 0.24))


## A scene of one node below a world, selected.
func _node_alone(node: Node3D, called: String, from: Vector3, at := Vector3.ZERO) -> void:
	var root := Node3D.new()
	root.name = called.to_pascal_case()
	var world := HapticWorld.new()
	world.name = "HapticWorld"
	root.add_child(world)
	world.owner = root
	node.name = node.get_class()
	world.add_child(node)
	for one: Node in [node] + node.find_children("*", "", true, false):
		one.owner = root
	await _open_new(root, called)
	var made := EditorInterface.get_edited_scene_root().get_node("HapticWorld").get_child(0)
	var inner := made.find_children("*", "HapticMesh", false, false)
	await _select(made if inner.is_empty() else inner[0])
	await _look(from, at)
	await _save(called)


## What cannot be touched is named beside it; a click on its sign says why.
func _warnings() -> void:
	var root := Node3D.new()
	root.name = "Warnings"
	var world := HapticWorld.new()
	world.name = "HapticWorld"
	world.authority = HapticWorld.AUTHORITY_HAPTIC
	root.add_child(world)
	for node: Node in [Area3D.new(), StaticBody3D.new(), GridMap.new(), ProxyPointer.new()]:
		node.name = node.get_class()
		world.add_child(node)
	for one: Node in root.find_children("*", "", true, false):
		one.owner = root
	await _open_new(root, "warnings")
	await _select(EditorInterface.get_edited_scene_root().get_node("HapticWorld"))
	await _frames(60)
	_click_warning("HapticWorld")
	await _frames(60)
	await _save_screen("warnings")
	for dialog: Node in get_tree().root.find_children("*", "AcceptDialog", true, false):
		(dialog as AcceptDialog).hide()


## In the tree of the scene.
func _click_warning(called: String) -> void:
	for tree: Tree in EditorInterface.get_base_control().find_children("*", "Tree", true, false):
		var item := tree.get_root()
		while item != null:
			if item.get_text(0) == called and item.get_button_by_id(0, BUTTON_WARNING) >= 0:
				tree.button_clicked.emit(item, 0, BUTTON_WARNING, MOUSE_BUTTON_LEFT)
				return
			item = item.get_next_in_tree()
	_has_failed = true
	printerr("%s has no warning" % called)


func _help() -> void:
	EditorInterface.set_main_screen_editor("Script")
	EditorInterface.get_script_editor().goto_help("class_name:HapticMaterial")
	await _frames(60)
	await _save("class_help")
	EditorInterface.set_main_screen_editor("3D")


func _panel() -> void:
	var dock: Control = null
	for found: Node in EditorInterface.get_base_control().find_children("*", "HBoxContainer", true, false):
		if found.get_script() == load("res://addons/tactus/editor/dock.gd"):
			dock = found
	await _open(PLAYED)
	await _look(Vector3(0.1, 0.5, 0.75), Vector3(0, 0, 0.05))
	make_bottom_panel_item_visible(dock)
	await _frames(20)
	await _save("panel_idle")
	EditorInterface.play_custom_scene(PLAYED)
	await get_tree().create_timer(1.0).timeout
	make_bottom_panel_item_visible(dock)  # the editor shows its output
	await get_tree().create_timer(PLAYED_SECONDS).timeout
	await _save_screen("panel_playing")
	EditorInterface.stop_playing_scene()
	await _frames(20)


## A scene is played in the editor's own view until all of its pictures are taken.
func _film() -> void:
	await _open(FILMED)
	await _select(EditorInterface.get_edited_scene_root().get_node("HapticWorld/HapticDevice"))
	await _resize(FILM_SIZE)
	EditorInterface.play_custom_scene("res://pictures/moving_scene.tscn")
	await get_tree().create_timer(5.0).timeout
	hide_bottom_panel()  # the editor shows its output
	await _frames(20)
	FileAccess.open(_folder.path_join("begin"), FileAccess.WRITE).close()
	var deadline := Time.get_ticks_msec() + int(FILM_SECONDS * 1000.0)
	while FileAccess.get_file_as_string(_folder.path_join("shown")) != "end":
		await get_tree().process_frame
		if Time.get_ticks_msec() > deadline:
			_has_failed = true
			printerr("the film is not done after %d s" % FILM_SECONDS)
			break
	EditorInterface.stop_playing_scene()
	await _frames(20)


func _open_new(root: Node, called: String) -> void:
	var packed := PackedScene.new()
	packed.pack(root)
	root.free()
	_made += 1
	var file := "res://%s_%d.tscn" % [called, _made]
	if ResourceSaver.save(packed, file) != OK:
		_has_failed = true
	await _open(file)


func _open(file: String) -> void:
	EditorInterface.open_scene_from_path(file)
	for _i in 300:
		var edited := EditorInterface.get_edited_scene_root()
		if edited != null and edited.scene_file_path == file:
			break
		await get_tree().process_frame
	EditorInterface.set_main_screen_editor("3D")
	await _frames(20)


func _select(node: Node) -> void:
	EditorInterface.get_selection().clear()
	EditorInterface.get_selection().add_node(node)
	EditorInterface.edit_node(node)
	await _frames(20)


## The editor moves its own view softly when a scene is opened; then it stays as it is put.
func _look(from: Vector3, at: Vector3) -> void:
	var camera := EditorInterface.get_editor_viewport_3d(0).get_camera_3d()
	for _i in 60:
		camera.global_transform = Transform3D(Basis.looking_at(at - from), from)
		camera.near = 0.01
		await _frames(1)


func _resize(size: Vector2i) -> void:
	get_window().mode = Window.MODE_WINDOWED
	get_window().position = Vector2i.ZERO
	get_window().size = size
	await _frames(20)


func _frames(count: int) -> void:
	for _i in count:
		EditorInterface.get_base_control().queue_redraw()
		await get_tree().process_frame


func _save(called: String) -> void:
	await _frames(5)
	_keep(await _picture(), called)


## With the scene that plays in the editor's view: another program, whose picture only the screen has.
func _save_screen(called: String) -> void:
	var file := FileAccess.open(_folder.path_join("shown.partial"), FileAccess.WRITE)
	file.store_string(called)
	file.close()
	DirAccess.rename_absolute(_folder.path_join("shown.partial"), _folder.path_join("shown"))
	while FileAccess.get_file_as_string(_folder.path_join("taken")) != called:
		await get_tree().process_frame


func _save_inspector(called: String) -> void:
	for section: Node in EditorInterface.get_inspector().find_children(
		"*", "EditorInspectorSection", true, false
	):
		section.call("unfold")
	await _frames(10)
	var inspector := EditorInterface.get_inspector().get_parent_control()
	var area := Rect2i(inspector.get_global_rect())
	_keep((await _picture()).get_region(area), called)


func _keep(picture: Image, called: String) -> void:
	var path := _folder.path_join(called + ".png")
	var code := picture.save_png(path)
	if code != OK:
		_has_failed = true
		printerr("'%s' could not be written (%s)" % [path, error_string(code)])
	print("PICTURE ", called)


func _picture() -> Image:
	EditorInterface.get_base_control().queue_redraw()
	await RenderingServer.frame_post_draw
	return get_tree().root.get_texture().get_image()
