@tool
extends RefCounted
## The words that a person sees, and which of them are beyond their view, cut, or over others. Words are
## labels of the window, of views within it and of the scene, texts of buttons, and what plots write.

const Plot := preload("res://addons/tactus/overlay/plot.gd")
## What letters leave free within their line, in pixels.
const SLACK := 3.0


static func faults(scene: Node) -> PackedStringArray:
	var found := PackedStringArray()
	var words := _words(scene)
	for i in words.size():
		if not (words[i].within as Rect2).grow(1.0).encloses(words[i].area):
			found.append("'%s' is beyond its view: %s" % [words[i].text, words[i].area])
		for j in i:
			if words[i].area.grow(-SLACK).intersects(words[j].area.grow(-SLACK)):
				found.append("'%s' is over '%s'" % [words[i].text, words[j].text])
	for button: Button in scene.find_children("*", "Button", true, false):
		if button.is_visible_in_tree() and _needs(button) > button.size.x + 1.0:
			found.append("'%s' is cut" % button.text)
	for label: Label in scene.find_children("*", "Label", true, false):
		if label.is_visible_in_tree() and label.get_visible_line_count() < label.get_line_count():
			found.append("'%s' is cut" % label.text)
	for plot: Control in scene.find_children("*", "Control", true, false):
		if plot.has_method("words") and plot.is_visible_in_tree() and not _has_title(plot):
			found.append("the title '%s' is cut" % plot.get("title"))
	return found


static func _has_title(plot: Control) -> bool:
	return (plot.call("words") as Array).any(
		func(word: Dictionary) -> bool: return (word.text as String).contains(plot.get("title") as String)
	)


## The width of a button that shows all of its text.
static func _needs(button: Button) -> float:
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
static func _words(scene: Node) -> Array[Dictionary]:
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
			_add_plot(words, plot)
	return words


## It cuts off what is beyond it.
static func _add_plot(words: Array[Dictionary], plot: Control) -> void:
	var onto_canvas := plot.get_global_transform_with_canvas()
	for word: Dictionary in plot.call("words"):
		var before := words.size()
		_add_word(words, plot, word.text, onto_canvas * _area_in_plot(word, plot.get_theme_default_font()))
		for added: Dictionary in words.slice(before):
			added.within = _onto_window(plot.get_viewport()) * onto_canvas * Rect2(Vector2.ZERO, plot.size)


static func _add_word(words: Array[Dictionary], node: Node, text: String, area: Rect2) -> void:
	var view := node.get_viewport()
	if _is_seen(view):
		var onto_window := _onto_window(view)
		var whole := Rect2(Vector2.ZERO, view.get_visible_rect().size)
		words.append({text = text, area = onto_window * area, within = onto_window * whole})


static func _is_seen(view: Viewport) -> bool:
	if view == view.get_tree().root:
		return true
	var container := view.get_parent() as SubViewportContainer
	return container != null and container.is_visible_in_tree() and _is_seen(container.get_viewport())


## From places in a view that is seen.
static func _onto_window(view: Viewport) -> Transform2D:
	if view == view.get_tree().root:
		return Transform2D.IDENTITY
	var container := view.get_parent() as SubViewportContainer
	var stretch := container.size / view.get_visible_rect().size
	return (
		_onto_window(container.get_viewport())
		* container.get_global_transform_with_canvas()
		* Transform2D.IDENTITY.scaled(stretch)
	)


## Of its letters, which may be less than the label.
static func _area_of(label: Label) -> Rect2:
	var area := Rect2()
	for line in label.text.length():
		var letter := label.get_character_bounds(line)
		area = letter if line == 0 else area.merge(letter)
	return area


static func _area_in_plot(word: Dictionary, font: Font) -> Rect2:
	var extent := font.get_string_size(word.text, HORIZONTAL_ALIGNMENT_LEFT, -1, Plot.FONT_SIZE)
	return Rect2(word.at - Vector2(0, font.get_ascent(Plot.FONT_SIZE)), extent)


static func _area_in_space(label: Label3D, camera: Camera3D) -> Rect2:
	var box := label.get_aabb()
	var area := Rect2()
	var to_camera := Transform3D(camera.global_basis, label.global_position)
	var frame := to_camera if label.billboard != BaseMaterial3D.BILLBOARD_DISABLED else label.global_transform
	for i in 8:
		var corner := camera.unproject_position(frame * box.get_endpoint(i))
		area = Rect2(corner, Vector2.ZERO) if i == 0 else area.expand(corner)
	return area
