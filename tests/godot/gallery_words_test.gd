extends "nodes_case.gd"
## The words of the gallery in three sizes of the window, without and with the overlay: none is beyond it,
## cut, or over others. Words are labels of the window, of views within it and of the scene, and what plots
## write.

const Figures := preload("res://addons/tactus/overlay/figures.gd")
const Gallery := preload("res://gallery/gallery.gd")
const Plot := preload("res://addons/tactus/overlay/plot.gd")
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
			await _show_overlay(scene, true)
			for found in _faults(scene):
				check(false, "%s at %s with the overlay: %s" % [scene_name, size, found])
			await _show_overlay(scene, false)
		scene.free()
		await frames(1)
	root.size = before
	OS.low_processor_usage_mode_sleep_usec = rest


func test_no_words_of_the_launcher_are_cut_or_over_others() -> void:
	var root := get_tree().root
	var before := root.size
	var launcher := (load("res://launcher/launcher.tscn") as PackedScene).instantiate()
	add_child(launcher)
	for size in SIZES:
		root.size = size
		for card: Button in launcher.get_node("%Scenarios").get_children():
			card.button_pressed = true
			card.pressed.emit()
			await frames(3)
			for found in _faults(launcher):
				check(false, "scenario %d at %s: %s" % [card.get_index() + 1, size, found])
	check_equal(launcher._launch.chosen.scenario, 5, "scenario of the last card")
	launcher.free()
	root.size = before


## With what it shows after a while.
func _show_overlay(scene: Node, shown: bool) -> void:
	var overlay: CanvasLayer = scene.get_node("Placard/%Overlay")
	overlay.set("shown", shown)
	for _i in 6:
		if shown:
			overlay.get_node("%Panel").call("show_figures", Figures.new().of(get_tree()))
			overlay.call("_keep_within_window")
		await frames(1)


func test_words_over_others_and_beyond_the_window_are_found() -> void:
	var scene := Node.new()
	for at: Vector2 in [Vector2(100, 100), Vector2(110, 105), Vector2(-20, 300)]:
		scene.add_child(_label("some words", at))
	add_child(scene)
	await frames(2)
	var found := _faults(scene)
	check_equal(found.size(), 2, "faults: %s" % [found])
	scene.free()


## Where words of a view lie over others of the window, or beyond the view.
func test_words_of_views_within_the_window_are_seen() -> void:
	var scene := Node.new()
	var container := SubViewportContainer.new()
	container.stretch = true
	container.position = Vector2(300, 200)
	container.size = Vector2(200, 100)
	var view := SubViewport.new()
	container.add_child(view)
	scene.add_child(container)
	scene.add_child(_label("of the window", Vector2(310, 215)))
	view.add_child(_label("of a view", Vector2(10, 10)))
	view.add_child(_label("beyond it", Vector2(180, 60)))
	add_child(scene)
	await frames(2)
	var found := _faults(scene)
	check_equal(found.size(), 2, "faults: %s" % [found])
	check("of a view" in str(found) and "beyond it" in str(found), "faults: %s" % [found])
	scene.free()


func test_words_of_plots_are_seen() -> void:
	var scene := Node.new()
	var plot := Plot.new()
	plot.title = "force"
	plot.position = Vector2(100, 100)
	plot.size = Vector2(300, 80)
	scene.add_child(plot)
	scene.add_child(_label("some words", Vector2(110, 115)))
	add_child(scene)
	plot.add("a curve", 0.0, 1.0)
	await frames(2)
	var found := _faults(scene)
	check(not found.is_empty() and "a curve" in str(found), "faults: %s" % [found])
	scene.free()


func _label(text: String, at: Vector2) -> Label:
	var label := Label.new()
	label.text = text
	label.position = at
	return label


func _faults(scene: Node) -> PackedStringArray:
	var faults := PackedStringArray()
	var words := _words(scene)
	for i in words.size():
		if not (words[i].within as Rect2).grow(1.0).encloses(words[i].area):
			faults.append("'%s' is beyond its view: %s" % [words[i].text, words[i].area])
		for j in i:
			if words[i].area.grow(-SLACK).intersects(words[j].area.grow(-SLACK)):
				faults.append("'%s' is over '%s'" % [words[i].text, words[j].text])
	for button: Button in scene.find_children("*", "Button", true, false):
		if button.is_visible_in_tree() and _needs(button) > button.size.x + 1.0:
			faults.append("'%s' is cut" % button.text)
	for label: Label in scene.find_children("*", "Label", true, false):
		if label.is_visible_in_tree() and label.get_visible_line_count() < label.get_line_count():
			faults.append("'%s' is cut" % label.text)
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


## Each text that is seen: {text, area and the view that it is within: both in the window}.
func _words(scene: Node) -> Array[Dictionary]:
	var words: Array[Dictionary] = []
	for label: Label in scene.find_children("*", "Label", true, false):
		if label.is_visible_in_tree() and not label.text.is_empty():
			_add_word(words, label, label.text, label.get_global_transform_with_canvas() * _area_of(label))
	for label: Label3D in scene.find_children("*", "Label3D", true, false):
		var camera := label.get_viewport().get_camera_3d()
		if (
			label.is_visible_in_tree()
			and camera != null
			and not camera.is_position_behind(label.global_position)
		):
			_add_word(words, label, label.text, _area_in_space(label, camera))
	for plot: Control in scene.find_children("*", "Control", true, false):
		if plot.has_method("words") and plot.is_visible_in_tree():
			for word: Dictionary in plot.call("words"):
				_add_word(
					words, plot, word.text, plot.get_global_transform_with_canvas() * _area_in_plot(word)
				)
	return words


func _add_word(words: Array[Dictionary], node: Node, text: String, area: Rect2) -> void:
	var view := node.get_viewport()
	if _is_seen(view):
		var onto_window := _onto_window(view)
		var whole := Rect2(Vector2.ZERO, view.get_visible_rect().size)
		words.append({text = text, area = onto_window * area, within = onto_window * whole})


func _is_seen(view: Viewport) -> bool:
	if view == get_tree().root:
		return true
	var container := view.get_parent() as SubViewportContainer
	return container != null and container.is_visible_in_tree() and _is_seen(container.get_viewport())


## From places in a view that is seen.
func _onto_window(view: Viewport) -> Transform2D:
	if view == get_tree().root:
		return Transform2D.IDENTITY
	var container := view.get_parent() as SubViewportContainer
	var stretch := container.size / view.get_visible_rect().size
	return (
		_onto_window(container.get_viewport())
		* container.get_global_transform_with_canvas()
		* Transform2D.IDENTITY.scaled(stretch)
	)


## Of its letters, which may be less than the label.
func _area_of(label: Label) -> Rect2:
	var area := Rect2()
	for line in label.text.length():
		var letter := label.get_character_bounds(line)
		area = letter if line == 0 else area.merge(letter)
	return area


func _area_in_plot(word: Dictionary) -> Rect2:
	var font := ThemeDB.fallback_font
	var extent := font.get_string_size(word.text, HORIZONTAL_ALIGNMENT_LEFT, -1, Plot.FONT_SIZE)
	return Rect2(word.at - Vector2(0, font.get_ascent(Plot.FONT_SIZE)), extent)


func _area_in_space(label: Label3D, camera: Camera3D) -> Rect2:
	var box := label.get_aabb()
	var area := Rect2()
	var to_camera := Transform3D(camera.global_basis, label.global_position)
	var frame := to_camera if label.billboard != BaseMaterial3D.BILLBOARD_DISABLED else label.global_transform
	for i in 8:
		var corner := camera.unproject_position(frame * box.get_endpoint(i))
		area = Rect2(corner, Vector2.ZERO) if i == 0 else area.expand(corner)
	return area
