@tool
extends "test_case.gd"
## The addon's plugin in the editor itself: gizmos and their handles, undo, and the dock.

const ADDON := "res://addons/tactus"
## Nodes in space that have no extent of their own, or are not for the editor.
const WITHOUT_EXTENT := ["HapticVibrationSound", "BodyWatch", "InputWatch"]

static var _edited := 0


## Opens a scene of these nodes in the editor; returns its root.
func _edit(nodes: Array[Node3D]) -> Node3D:
	var root := Node3D.new()
	root.name = "Edited"
	var world := HapticWorld.new()
	world.name = "HapticWorld"
	root.add_child(world)
	world.owner = root
	for node in nodes:
		world.add_child(node)
		node.owner = root
	var packed := PackedScene.new()
	packed.pack(root)
	root.free()
	# One that is open already would not be read again.
	_edited += 1
	var file := "res://edited_%d.tscn" % _edited
	ResourceSaver.save(packed, file)
	EditorInterface.open_scene_from_path(file)
	var is_open := func() -> bool:
		var edited := EditorInterface.get_edited_scene_root()
		return edited != null and edited.scene_file_path == file
	check(await until(is_open, 10.0), "the editor does not open the scene")
	await frames(4)
	return EditorInterface.get_edited_scene_root()


func _named(node: Node3D, called: String) -> Node3D:
	node.name = called
	return node


func _gizmo(node: Node3D) -> EditorNode3DGizmo:
	for gizmo: Node3DGizmo in node.get_gizmos():
		var of_editor := gizmo as EditorNode3DGizmo
		if of_editor != null and of_editor.get_plugin().get_script() != null:
			return of_editor
	return null


func test_every_node_with_an_extent_has_a_gizmo() -> void:
	var nodes: Array[Node3D] = []
	for name in ClassDB.get_class_list():
		if ClassDB.class_get_api_type(name) != ClassDB.API_EXTENSION or name in WITHOUT_EXTENT:
			continue
		if ClassDB.class_get_api_type(ClassDB.get_parent_class(name)) == ClassDB.API_EXTENSION:
			continue  # the former name of its parent
		if (
			ClassDB.is_parent_class(name, "Node3D")
			and name != "HapticWorld"
			and not name.begins_with("Binding")
		):
			nodes.append(_named(ClassDB.instantiate(name), name))
	check(nodes.size() >= 5, "there are only %s" % [nodes])
	var root := await _edit(nodes)
	check(_gizmo(root.get_node("HapticWorld")) != null, "HapticWorld has no gizmo")
	for node: Node3D in root.get_node("HapticWorld").get_children():
		check(_gizmo(node) != null, "%s has no gizmo" % node.name)


## A camera that looks along -z at the place, so that the middle of its picture is there.
func _camera(at: Vector3) -> Camera3D:
	var view := SubViewport.new()
	view.size = Vector2i(200, 200)
	add_child(view)
	var camera := Camera3D.new()
	camera.position = at + Vector3(0, 0, 1)
	view.add_child(camera)
	return camera


## Drags a handle so that it is in the middle of a picture whose middle is that place.
func _drag(node: Node3D, id: int, to: Vector3) -> void:
	var gizmo := _gizmo(node)
	var plugin := gizmo.get_plugin()
	var before: Variant = plugin._get_handle_value(gizmo, id, false)
	plugin._set_handle(gizmo, id, false, _camera(to), Vector2(100, 100))
	plugin._commit_handle(gizmo, id, false, before, false)


func _undo(node: Object) -> void:
	var manager := EditorInterface.get_editor_undo_redo()
	manager.get_history_undo_redo(manager.get_object_history_id(node)).undo()


func _handle(node: Node3D, called: String) -> int:
	var gizmo := _gizmo(node)
	for id in 16:
		if (
			gizmo.get_plugin().grips(node).size() > id
			and gizmo.get_plugin()._get_handle_name(gizmo, id, false) == called
		):
			return id
	check(false, "%s has no handle '%s'" % [node.name, called])
	return 0


func test_a_fingertips_radius_is_dragged_and_undone() -> void:
	var root := await _edit([_named(ProxyPointer.new(), "Tip")])
	var tip: ProxyPointer = root.get_node("HapticWorld/Tip")
	_drag(tip, _handle(tip, "radius"), Vector3(0.03, 0, 0))
	check_near(tip.radius, 0.03, 1e-6, "radius")
	_undo(tip)
	check_near(tip.radius, 0.01, 1e-9, "radius undone")


func test_what_a_soft_body_is_held_by_is_dragged_by_its_faces() -> void:
	var soft := HapticSoftBody.new()
	soft.held = AABB(Vector3(-0.1, -0.1, -0.1), Vector3(0.2, 0.05, 0.2))
	var root := await _edit([_named(soft, "Soft")])
	soft = root.get_node("HapticWorld/Soft")
	check(_gizmo(soft).get_plugin().grips(soft).size() == 6, "a handle for each face")
	_drag(soft, 2, Vector3(0, 0.02, 0))
	check_near(soft.held.end.y, 0.02, 1e-6, "its upper face")
	_drag(soft, 3, Vector3(0, 0.5, 0))
	check_near(soft.held.size.y, 0.001, 1e-6, "its lower face stays below")
	_undo(soft)
	check_near(soft.held.position.y, -0.1, 1e-6, "undone")


func test_a_workspace_is_made_larger_by_its_faces() -> void:
	var device := HapticDevice.new()
	device.driver = HapticDevice.DRIVER_FALCON
	var steered := HapticDevice.new()
	steered.driver = HapticDevice.DRIVER_KEYBOARD
	var root := await _edit([_named(device, "Falcon"), _named(steered, "Keys")])
	device = root.get_node("HapticWorld/Falcon")
	var half := device.get_workspace_radius()
	check(half > 0.01, "its workspace is %s m" % half)
	_drag(device, 0, Vector3(2.0 * half, 0, 0))
	check_near(device.scale, 2.0 * Vector3.ONE, 1e-4, "scale")
	_undo(device)
	check_near(device.scale, Vector3.ONE, 1e-6, "scale undone")
	steered = root.get_node("HapticWorld/Keys")
	_drag(steered, _handle(steered, "reach"), Vector3(0.3, 0, 0))
	check_near(steered.steering_reach, 0.3, 1e-4, "reach")


func test_points_of_paths_curves_and_guides_are_dragged() -> void:
	var device := HapticDevice.new()
	device.path = HapticPath.new()
	device.path.form = HapticPath.FORM_POINTS
	device.path.points_positions = PackedVector3Array([Vector3.ZERO, Vector3(0.1, 0, 0)])
	device.position = Vector3(0, 0.1, 0)
	var along := HapticDevice.new()
	along.path = HapticPath.new()
	along.path.form = HapticPath.FORM_CURVE
	along.path.curve = Curve3D.new()
	along.path.curve.add_point(Vector3.ZERO)
	along.path.curve.add_point(Vector3(0.1, 0, 0))
	var tip := ProxyPointer.new()
	tip.guide = HapticGuide.new()
	tip.guide.points = PackedVector3Array([Vector3.ZERO, Vector3(0.2, 0, 0)])
	tip.position = Vector3(0, 0, 0.5)
	var root := await _edit([_named(device, "Points"), _named(along, "Curve"), _named(tip, "Tip")])
	device = root.get_node("HapticWorld/Points")
	_drag(device, _handle(device, "point 1"), Vector3(0.15, 0.2, 0))
	check_near(device.path.points_positions[1], Vector3(0.15, 0.1, 0), 1e-5, "point of the path")
	_undo(device.path)
	check_near(device.path.points_positions[1], Vector3(0.1, 0, 0), 1e-6, "point undone")
	along = root.get_node("HapticWorld/Curve")
	_drag(along, _handle(along, "point_1/position"), Vector3(0.1, 0.05, 0))
	check_near(along.path.curve.get_point_position(1), Vector3(0.1, 0.05, 0), 1e-5, "point of the curve")
	check_near(
		along.path.get_duration(), Vector3(0.1, 0.05, 0).length() / along.path.curve_speed, 1e-4, "duration"
	)
	tip = root.get_node("HapticWorld/Tip")
	_drag(tip, _handle(tip, "guide's point 1"), Vector3(0.2, 0.1, 0))
	check_near(tip.guide.points[1], Vector3(0.2, 0.1, 0), 1e-5, "point of the guide")


func test_a_tools_grasp_and_a_cameras_support_are_dragged() -> void:
	var tool := HapticTool.new()
	tool.mesh = BoxMesh.new()
	var sensor := HapticDepthSensor.new()
	sensor.active = false
	sensor.knows_support = true
	sensor.position = Vector3(0, 0.7, 0)
	sensor.rotation.x = -0.5 * PI
	var root := await _edit([_named(tool, "Tool"), _named(sensor, "Sensor")])
	tool = root.get_node("HapticWorld/Tool")
	_drag(tool, 0, Vector3(0, 0.1, 0))
	check_near(tool.grasp_position, Vector3(0, -0.1, 0), 1e-5, "grasp")
	sensor = root.get_node("HapticWorld/Sensor")
	_drag(sensor, _handle(sensor, "height of the support"), Vector3(0, 0.2, 0))
	check_near(sensor.support_height, 0.2, 1e-4, "height of the support")


func test_errors_of_the_model_are_seen_as_ghosts() -> void:
	var box := RigidBody3D.new()
	var look := MeshInstance3D.new()
	look.mesh = BoxMesh.new()
	var root := await _edit([_named(box, "Box")])
	box = root.get_node("HapticWorld/Box")
	box.add_child(look)
	var link := MMTLink.new()
	link.scenario = MMTLink.SCENARIO_MMT
	root.get_node("HapticWorld").add_child(link)
	var plugin := _gizmo(root.get_node("HapticWorld")).get_plugin()
	check_equal(plugin.lines(root.get_node("HapticWorld")).size(), 0, "lines without an error")
	link.model_errors = {"Box": {"move": [0.5, 0, 0]}}
	var lines: PackedVector3Array = plugin.lines(root.get_node("HapticWorld"))
	check_equal(lines.size(), 24, "ends of the ghost's edges")
	var middle := Vector3.ZERO
	for point in lines:
		middle += point / lines.size()
	check_near(middle, Vector3(0.5, 0, 0), 1e-6, "middle of the ghost")


func test_the_dock_shows_what_a_scene_says() -> void:
	var dock: Control = load(ADDON.path_join("editor/dock.tscn")).instantiate()
	add_child(dock)
	var figures := {"time": 1.0, "worlds": {}, "links": {}, "devices": {}, "pointers": {}, "sensors": {}}
	figures.worlds["Scene/HapticWorld"] = {
		"period_us": 1000.0,
		"ticks": 1000,
		"work_p50_us": 10.0,
		"work_p99_us": 20.0,
		"period_p99_us": 1010.0,
		"missed": 0,
		"bodies": 3,
		"awake": 1
	}
	figures.devices["Scene/HapticDevice"] = {"text": "working", "force_n": 0.5, "energy_mj": 0.1}
	dock.show_figures(figures)
	check(dock.get_node("%Panel").visible, "the panel is hidden")
	check(dock.get_node("%Panel").get_node("%Said").text.contains("3 bodies, 1 awake"), "what is said")
	check(
		dock.get_node("%Panel").get_node("%Said").text.contains("HapticDevice: working"), "the device's state"
	)
	dock.end()
	check(not dock.get_node("%Panel").visible, "the panel is still there")
	dock.scan()
	check(
		dock.get_node("%Found").text.contains("mouse and keyboard"),
		"it says: " + dock.get_node("%Found").text
	)


func _tools() -> PopupMenu:
	var tools: PopupMenu = load(ADDON.path_join("editor/tools.gd")).new(
		EditorInterface.get_editor_undo_redo()
	)
	add_child(tools)
	return tools


func test_the_first_page_starts_what_its_buttons_say() -> void:
	var tools := _tools()
	var page: AcceptDialog = tools.Welcome.new(tools)
	add_child(page)
	var called := []
	for button: Button in page.find_children("*", "Button", true, false):
		if button.text in ["Close", "Cancel", "OK"]:
			continue
		called.append(button.text)
		for connection: Dictionary in button.pressed.get_connections():
			button.pressed.disconnect(connection.callable)
	for wanted: String in [
		"Touch something", "Add a rig", "Check my machine", "Open the gallery", "Read the reference"
	]:
		check(wanted in called, wanted + " is missing")
	await frames(2)
	var least := page.get_contents_minimum_size()
	check(least.x < 700.0 and least.y < 500.0, "the page is %s" % least)
	page.free()


func test_every_item_of_the_menu_has_its_method() -> void:
	var tools := _tools()
	check_equal(tools.item_count, tools.ITEMS.size(), "items")
	for item: Array in tools.ITEMS:
		check(tools.has_method(item[2]), item[0])


func test_the_first_page_shows_once_for_a_project() -> void:
	var settings := EditorInterface.get_editor_settings()
	settings.set_project_metadata("tactus", "has_shown_welcome", null)
	var tools := _tools()
	check(tools.Welcome.is_new(), "a new project's is not due")
	tools.welcome()
	await frames(2)
	check(not tools.Welcome.is_new(), "it would show again")


func test_a_rig_is_added_once_and_undone() -> void:
	var root := await _edit([])
	check(_tools().add_rig(root).contains("has a HapticWorld already"), "a second world")
	root.get_node("HapticWorld").free()
	check_equal(_tools().add_rig(root), "", "why not")
	check(root.get_node_or_null("HapticRig/HapticWorld/HapticDevice") != null, "there is no hand")
	check_equal(root.get_node("HapticRig").owner, root, "owner")
	_undo(root)
	check(root.get_node_or_null("HapticRig") == null, "the rig is still there")


func test_what_is_selected_becomes_touchable_and_is_undone() -> void:
	var root := await _edit([])
	root.get_node("HapticWorld").free()
	var body := StaticBody3D.new()
	body.position = Vector3(1, 2, 3)
	var picture := MeshInstance3D.new()
	picture.mesh = BoxMesh.new()
	for node: Node3D in [_named(body, "Body"), _named(picture, "Picture")]:
		root.add_child(node)
		node.owner = root
	check(not _tools().make_touchable(root, [] as Array[Node]).is_empty(), "nothing is selected")
	check(not _tools().make_touchable(root, [root] as Array[Node]).is_empty(), "the root")
	check_equal(_tools().make_touchable(root, [body, picture] as Array[Node]), "", "why not")
	check_equal(body.get_parent().get_class(), "HapticWorld", "parent of the body")
	check_near(body.global_position, Vector3(1, 2, 3), 1e-6, "place")
	check(body.physics_material_override is HapticMaterial, "material of the body")
	check(picture.get_node("Touched").get_node("HapticMesh").mesh == picture.mesh, "touched mesh")
	for node: Node in [body, picture, picture.get_node("Touched"), picture.get_node("Touched/HapticMesh")]:
		check_equal(node.owner, root, "owner of %s" % node.name)
	_undo(root)
	check_equal(body.get_parent(), root, "parent after undo")
	check(body.physics_material_override == null, "material after undo")
	check(picture.get_node_or_null("Touched") == null, "body of the mesh after undo")
	check(root.get_node_or_null("HapticWorld") == null, "world after undo")
