extends "nodes_case.gd"
## The words of the gallery in three sizes of the window, without and with the overlay: none is beyond it,
## cut, or over others.

const Figures := preload("res://addons/tactus/overlay/figures.gd")
const Gallery := preload("res://gallery/gallery.gd")
const Plot := preload("res://addons/tactus/overlay/plot.gd")
const SeenWords := preload("seen_words.gd")
const Stepping := preload("res://gallery/stage/stepping.gd")
## A small laptop's, the project's, and one that is wider than the project's.
const SIZES: Array[Vector2i] = [Vector2i(1024, 600), Vector2i(1280, 720), Vector2i(1920, 1080)]
const SECONDS := 1.0
const FRAME := 0.04


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
			for found in SeenWords.faults(scene):
				check(false, "%s at %s: %s" % [scene_name, size, found])
			await _show_overlay(scene, true)
			for found in SeenWords.faults(scene):
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
			for found in SeenWords.faults(launcher):
				check(false, "scenario %d at %s: %s" % [card.get_index() + 1, size, found])
	check_equal(launcher._launch.chosen.scenario, 5, "scenario of the last card")
	launcher.free()
	root.size = before


## With all that it can show, where the editor has a window of 1440 pixels.
func test_no_words_of_the_editors_panel_are_cut_or_over_others() -> void:
	var panel := (load("res://addons/tactus/editor/dock.tscn") as PackedScene).instantiate() as Control
	add_child(panel)
	panel.size = Vector2(866, 600)
	var figures: Dictionary = _figures_of_everything()
	figures.links["Scene/MMTLink"].round_trip_ms = 101.5
	for second in 3:
		figures.time = second
		panel.call("show_figures", figures)
		panel.call("show_histograms", {"Scene/HapticWorld": PackedInt32Array([0, 3, 1])})
		figures.devices["Scene/HapticDevice"].energy_mj = -1236.0
		figures.links["Scene/MMTLink"].corrections += 1
	await frames(4)
	var plots := panel.find_children("*", "Control", true, false).filter(
		func(one: Control) -> bool: return one.has_method("words") and one.is_visible_in_tree()
	)
	check_equal(plots.size(), 8, "plots")
	for found in SeenWords.faults(panel):
		check(false, found)


func _figures_of_everything() -> Dictionary:
	var scene := (load("res://gallery/delay_lab/delay_lab.tscn") as PackedScene).instantiate()
	add_child(scene)
	var all := Figures.new().of(get_tree())
	scene.free()
	var named := {"time": 0.0, "sensors": {}}
	for kind: String in ["worlds", "devices", "links", "pointers"]:
		var node: String = {
			"worlds": "HapticWorld", "devices": "HapticDevice", "links": "MMTLink", "pointers": "ProxyPointer"
		}[kind]
		named[kind] = {"Scene/" + node: (all[kind] as Dictionary).values()[0]}
	return named


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
	var found := SeenWords.faults(scene)
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
	var found := SeenWords.faults(scene)
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
	var found := SeenWords.faults(scene)
	check(not found.is_empty() and "a curve" in str(found), "faults: %s" % [found])
	scene.free()


func _label(text: String, at: Vector2) -> Label:
	var label := Label.new()
	label.text = text
	label.position = at
	return label
