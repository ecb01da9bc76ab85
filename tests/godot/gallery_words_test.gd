extends "nodes_case.gd"
## The words of the gallery in three sizes of the window: none is beyond it, cut, or over others.

const Gallery := preload("res://gallery/gallery.gd")
const Stepping := preload("res://gallery/stage/stepping.gd")
## A small laptop's, the project's, and one that is wider than the project's.
const SIZES: Array[Vector2i] = [Vector2i(1024, 600), Vector2i(1280, 720), Vector2i(1920, 1080)]
const SECONDS := 1.0
const FRAME := 0.04
## What letters leave free within their line, in pixels.
const SLACK := 3.0


func test_no_words_are_cut_or_over_others() -> void:
	# Without a window Godot rests after each frame.
	var rest := OS.low_processor_usage_mode_sleep_usec
	OS.low_processor_usage_mode_sleep_usec = 1
	var root := get_tree().root
	var before := root.size
	for scene_name: String in Gallery.SCENES:
		var scene := (load(Gallery.path_of(scene_name)) as PackedScene).instantiate()
		var worlds := Stepping.hold(scene)
		add_child(scene)
		for _i in roundi(SECONDS / FRAME):
			Stepping.advance(worlds, FRAME)
			await get_tree().process_frame
		for size in SIZES:
			root.size = size
			await frames(3)
			for found in _faults(scene):
				check(false, "%s at %s: %s" % [scene_name, size, found])
		scene.free()
		await frames(1)
	root.size = before
	OS.low_processor_usage_mode_sleep_usec = rest


func test_words_over_others_and_beyond_the_window_are_found() -> void:
	var scene := Node.new()
	for at: Vector2 in [Vector2(100, 100), Vector2(110, 105), Vector2(-20, 300)]:
		var label := Label.new()
		label.text = "some words"
		label.position = at
		scene.add_child(label)
	add_child(scene)
	await frames(2)
	var found := _faults(scene)
	check_equal(found.size(), 2, "faults: %s" % [found])
	scene.free()


func _faults(scene: Node) -> PackedStringArray:
	var faults := PackedStringArray()
	var words := _words(scene)
	var window := get_tree().root.get_visible_rect()
	for i in words.size():
		if not window.grow(1.0).encloses(words[i].area):
			faults.append("'%s' is beyond the window: %s" % [words[i].text, words[i].area])
		for j in i:
			if words[i].area.grow(-SLACK).intersects(words[j].area.grow(-SLACK)):
				faults.append("'%s' is over '%s'" % [words[i].text, words[j].text])
	for button: Button in scene.find_children("*", "Button", true, false):
		if button.is_visible_in_tree() and _needs(button) > button.size.x + 1.0:
			faults.append("'%s' is cut" % button.text)
	return faults


## The width of a button that shows all of its text.
func _needs(button: Button) -> float:
	var copy := button.duplicate(0) as Button
	copy.clip_text = false
	copy.text_overrun_behavior = TextServer.OVERRUN_NO_TRIMMING
	if copy is OptionButton:
		(copy as OptionButton).fit_to_longest_item = false
	copy.custom_minimum_size = Vector2.ZERO
	button.get_parent().add_child(copy)
	var width := copy.get_combined_minimum_size().x
	copy.free()
	return width


## Each text that is seen, and where: {text, area}.
func _words(scene: Node) -> Array[Dictionary]:
	var words: Array[Dictionary] = []
	for label: Label in scene.find_children("*", "Label", true, false):
		if label.is_visible_in_tree() and not label.text.is_empty() and _is_of_the_window(label):
			words.append({text = label.text, area = _area_of(label)})
	for label: Label3D in scene.find_children("*", "Label3D", true, false):
		var camera := label.get_viewport().get_camera_3d()
		if (
			label.is_visible_in_tree()
			and camera != null
			and not camera.is_position_behind(label.global_position)
		):
			words.append({text = label.text, area = _area_in_space(label, camera)})
	return words


func _is_of_the_window(label: Label) -> bool:
	return label.get_viewport() == get_tree().root


## Of its letters, which may be less than the label.
func _area_of(label: Label) -> Rect2:
	var area := Rect2()
	for line in label.text.length():
		var letter := label.get_character_bounds(line)
		area = letter if line == 0 else area.merge(letter)
	return label.get_global_transform_with_canvas() * area


func _area_in_space(label: Label3D, camera: Camera3D) -> Rect2:
	var box := label.get_aabb()
	var area := Rect2()
	var to_camera := Transform3D(camera.global_basis, label.global_position)
	var frame := to_camera if label.billboard != BaseMaterial3D.BILLBOARD_DISABLED else label.global_transform
	for i in 8:
		var corner := camera.unproject_position(frame * box.get_endpoint(i))
		area = Rect2(corner, Vector2.ZERO) if i == 0 else area.expand(corner)
	return area
