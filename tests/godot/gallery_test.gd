extends "nodes_case.gd"
## The gallery of the demo project: every scene of it plays, can be picked, and obeys the keys.

const Gallery := preload("res://gallery/gallery.gd")
const Stepping := preload("res://gallery/stage/stepping.gd")
const FOLDER := "res://gallery"
const SECONDS := 10.0
const FRAME := 0.04
## What a person waits for at most, in seconds.
const SOON := 10.0


## Errors and warnings of Godot, from whatever thread.
class Complaints:
	extends Logger
	var _said := PackedStringArray()
	var _mutex := Mutex.new()

	func _log_error(
		_function: String,
		file: String,
		line: int,
		code: String,
		rationale: String,
		_editor_notify: bool,
		_type: int,
		_backtraces: Array[ScriptBacktrace]
	) -> void:
		_mutex.lock()
		_said.append("%s (%s:%d)" % [rationale if not rationale.is_empty() else code, file, line])
		_mutex.unlock()

	func all() -> PackedStringArray:
		_mutex.lock()
		var said := _said.duplicate()
		_mutex.unlock()
		return said


## What the nodes of a scene have to complain about themselves.
func _warnings(scene: Node) -> PackedStringArray:
	var warnings := PackedStringArray()
	for node: Node in scene.find_children("*", "", true, false):
		if node.has_method("get_problems"):
			warnings.append_array(node.get_problems())
		if node is HapticWorld:
			warnings.append_array((node as HapticWorld)._list_warnings())
	return warnings


func _has_eyes() -> bool:
	return Array(DirAccess.get_files_at("res://addons/tactus/bin")).any(
		func(file: String) -> bool: return file.begins_with("libtactus_sensing.")
	)


func test_every_scene_plays_for_ten_seconds_without_a_complaint() -> void:
	# Without a window Godot rests after each frame.
	var rest := OS.low_processor_usage_mode_sleep_usec
	OS.low_processor_usage_mode_sleep_usec = 1
	for scene_name: String in Gallery.SCENES:
		var scene := (load(Gallery.path_of(scene_name)) as PackedScene).instantiate()
		if not _has_eyes() and not scene.find_children("*", "HapticDepthSensor").is_empty():
			scene.free()
			continue
		var complaints := Complaints.new()
		OS.add_logger(complaints)
		var worlds := Stepping.hold(scene)
		add_child(scene)
		for _i in roundi(SECONDS / FRAME):
			Stepping.advance(worlds, FRAME)
			await get_tree().process_frame
		var said := complaints.all() + _warnings(scene)
		check(said.is_empty(), "%s: %s" % [scene_name, said])
		for world in worlds:
			check_equal(world.get_ticks(), roundi(SECONDS / FRAME * 40), "%s: ticks" % scene_name)
		scene.free()
		await frames(1)
		OS.remove_logger(complaints)
	OS.low_processor_usage_mode_sleep_usec = rest


func test_every_folder_is_a_scene_of_the_menu_and_has_a_picture() -> void:
	for folder in DirAccess.get_directories_at(FOLDER):
		check(folder == "stage" or Gallery.SCENES.has(folder), "%s is not in the menu" % folder)
	for scene_name: String in Gallery.SCENES:
		check_equal(Gallery.name_of(Gallery.path_of(scene_name)), scene_name, "name")
		var picture := load(Gallery.picture_of(scene_name)) as Texture2D
		check(picture != null and picture.get_size() == Vector2(480, 270), "the picture of " + scene_name)
	check_equal(Gallery.name_of("res://main.tscn"), "", "name of a scene that is none of the gallery")


## Neither cut nor beyond the window, in the sizes of a small laptop, of the project and of a large screen.
func test_the_words_of_every_scene_fit() -> void:
	var rest := OS.low_processor_usage_mode_sleep_usec
	OS.low_processor_usage_mode_sleep_usec = 1
	for scene_name: String in Gallery.SCENES:
		var scene := (load(Gallery.path_of(scene_name)) as PackedScene).instantiate()
		Stepping.hold(scene)
		add_child(scene)
		var rows: Control = scene.get_node("Placard/%Rows")
		for size: Vector2 in [Vector2(1024, 600), Vector2(1280, 720), Vector2(1920, 1080)]:
			rows.set_anchors_preset(Control.PRESET_TOP_LEFT)
			# Lines are broken anew before their height is known.
			for _i in 3:
				rows.position = Vector2.ZERO
				rows.size = size
				await frames(1)
			for label: Label in rows.find_children("*", "Label", true, false):
				var area := Rect2(label.global_position, label.size)
				var window := Rect2(Vector2.ZERO, size)
				check(window.encloses(area), "%s at %s: %s is at %s" % [scene_name, size, label.name, area])
		scene.free()
		await frames(1)
	OS.low_processor_usage_mode_sleep_usec = rest


func test_a_scene_of_two_views_has_the_window_to_itself_without_words() -> void:
	for hides_first: bool in [true, false]:
		var scene := (load(Gallery.path_of("two_operators")) as PackedScene).instantiate() as Control
		add_child(scene)
		var placard: CanvasLayer = scene.get_node("Placard")
		if not hides_first:
			await frames(3)
			var between: Control = placard.get_node("%Rows/Space")
			check_near(scene.position.y, between.position.y, 12.0, "top below the words")
			check_near(scene.get_rect().end.y, between.get_rect().end.y, 12.0, "bottom above the words")
		placard.hide()
		await frames(3)
		check_equal(scene.get_rect(), get_tree().root.get_visible_rect(), "place")
		scene.free()


## It begins again with its scene, what it has pushed where it was; never while a person has the hand.
func test_a_path_that_leads_nowhere_begins_again() -> void:
	var menu := _menu()
	menu.open(Gallery.path_of("table_edge"), false)
	var before: Node = menu._scene
	var worlds: Array[HapticWorld] = [before.get_node("Placard").world]
	var box: RigidBody3D = worlds[0].find_children("*", "RigidBody3D", true, false)[0]
	var place := box.position
	worlds[0].clock = HapticWorld.CLOCK_STEPPED
	for _i in 60:
		if is_instance_valid(before) and not before.is_queued_for_deletion():
			worlds[0].advance(0.1)
		await frames(1)
	check(menu._scene != null and menu._scene != before, "it does not begin again")
	var again: Node = menu._scene
	check(not again.get_node("Placard").by_hand, "the hand is no longer the path's")
	box = again.get_node("Placard").world.find_children("*", "RigidBody3D", true, false)[0]
	check(box.position.distance_to(place) < 0.02, "the box is not back: %s" % box.position)
	menu.open(Gallery.path_of("table_edge"))
	var by_hand: Node = menu._scene
	by_hand.get_node("Placard").world.clock = HapticWorld.CLOCK_STEPPED
	for _i in 60:
		by_hand.get_node("Placard").world.advance(0.1)
		await frames(1)
	check(menu._scene == by_hand, "it begins again while a person has the hand")


## Those of the scenes whose bodies need no setting back; a person who looks later sees as much.
func test_hands_before_cameras_go_on_for_ever() -> void:
	for scene_name: String in ["point_cloud", "depth_camera"]:
		var scene := (load(Gallery.path_of(scene_name)) as PackedScene).instantiate()
		var path: HapticPath = scene.get_node("HapticWorld/HapticDevice").path
		for second in 60:
			var moved := path.sample(second).distance_to(path.sample(second + 2.0))
			check(moved > 1e-3, "%s rests from %d s on" % [scene_name, second])
		scene.free()


func test_the_menu_opens_each_scene_with_the_mouse_and_goes_back() -> void:
	var menu := _menu()
	var complaints := Complaints.new()
	OS.add_logger(complaints)
	for scene_name: String in Gallery.SCENES:
		menu.open(Gallery.path_of(scene_name))
		var world: HapticWorld = menu._scene.get_node("Placard").world
		check(await until(func() -> bool: return world.get_ticks() > 20, SOON), scene_name + " does not tick")
		var hand: HapticDevice = world.find_children("*", "HapticDevice", true, false)[-1]
		check_equal(hand.driver, HapticDevice.DRIVER_MOUSE, scene_name + "'s driver")
		menu.close()
		await frames(2)
	OS.remove_logger(complaints)
	for said in complaints.all():
		check(not said.contains("began inside"), said)


func _menu() -> Control:
	var menu: Control = (load("res://main.tscn") as PackedScene).instantiate()
	add_child(menu)
	return menu


func test_keys_change_hands_hide_words_begin_again_and_go_back() -> void:
	var menu := _menu()
	menu.open(Gallery.path_of("static_testbed"))
	var scene: Node = menu._scene
	var device: HapticDevice = scene.get_node("HapticWorld/HapticDevice")
	await press_key(KEY_TAB)
	check_equal(device.driver, HapticDevice.DRIVER_PATH, "driver after Tab")
	await press_key(KEY_TAB)
	check_equal(device.driver, HapticDevice.DRIVER_MOUSE, "driver after Tab again")
	var placard: CanvasLayer = scene.get_node("Placard")
	await press_key(KEY_H)
	check(not placard.visible, "the words are still there")
	await press_key(KEY_R)
	check(not is_instance_valid(scene) and menu._scene != null, "it did not begin again")
	await press_key(KEY_ESCAPE)
	check(menu._scene == null and menu.get_node("%Menu").visible, "it did not go back")


func test_the_menu_opens_the_launcher_and_comes_back() -> void:
	var menu := _menu()
	(menu.get_node("%Launch") as Button).pressed.emit()
	check(menu._launcher != null and not menu.get_node("%Menu").visible, "the launcher is not there")
	check((menu._launcher.get_node("%Back") as Button).visible, "there is no way back")
	await press_key(KEY_ESCAPE)
	check(menu._launcher == null and menu.get_node("%Menu").visible, "Escape does not lead back")
	check((menu.get_node("%Launch") as Button).has_focus(), "its button has lost the focus")
	menu.open_launcher()
	(menu._launcher.get_node("%Back") as Button).pressed.emit()
	check(menu._launcher == null, "its own button does not lead back")


## By hand the fingers follow the mouse's place, and close while the space bar is held.
func test_two_fingers_close_on_the_box() -> void:
	var scene := (load(Gallery.path_of("pinch")) as PackedScene).instantiate()
	scene.get_node("Placard").by_hand = true
	var worlds := Stepping.hold(scene)
	add_child(scene)
	var gap := func() -> float:
		var left: HapticDevice = worlds[0].get_node("LeftHand")
		var right: HapticDevice = worlds[0].get_node("RightHand")
		return right.get_hand_position().x - left.get_hand_position().x
	for _i in 30:
		Stepping.advance(worlds, 0.01)
		await frames(1)
	var before: float = gap.call()
	check_near(before, 2.0 * scene.get_node("Fingers").OPENED, 1e-3, "gap")
	send_key(KEY_SPACE, true)
	var closes := func() -> bool:
		Stepping.advance(worlds, 0.01)
		return gap.call() < 2.0 * scene.get_node("Fingers").CLOSED + 1e-3
	check(await until(closes, SOON), "they stay %s m apart" % gap.call())
	send_key(KEY_SPACE, false)
