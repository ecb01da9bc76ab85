extends "nodes_case.gd"
## The overlay that any scene can have, Godot's monitors, and what the editor's dock is told.

const Figures := preload("res://addons/tactus/overlay/figures.gd")
const Monitors := preload("res://addons/tactus/overlay/monitors.gd")
const PanelScript := preload("res://addons/tactus/overlay/panel.gd")
const Plot := preload("res://addons/tactus/overlay/plot.gd")
const Probe := preload("res://addons/tactus/overlay/probe.gd")
const SOON := 10.0


func _scene_in_real_time() -> Node:
	var scene: Node = (load("res://gallery/static_testbed/static_testbed.tscn") as PackedScene).instantiate()
	add_child(scene)
	return scene


func _overlay() -> CanvasLayer:
	var overlay: CanvasLayer = (load("res://addons/tactus/overlay/overlay.tscn") as PackedScene).instantiate()
	add_child(overlay)
	return overlay


func _drawings(scene: Node) -> Array[Node]:
	return scene.get_node("HapticWorld").get_children(true).filter(
		func(child: Node) -> bool:
			return child is MeshInstance3D and (child as MeshInstance3D).mesh is ImmediateMesh
	)


func test_an_overlay_shows_what_happens_and_hidden_does_nothing() -> void:
	var scene := _scene_in_real_time()
	var overlay := _overlay()
	await frames(3)
	check(not overlay.visible and not overlay.is_processing(), "it is not hidden at first")
	check(not overlay.get_node("%Drawing").is_processing(), "it draws while it is hidden")
	check_equal(_drawings(scene).size(), 0, "drawings")
	await press_key(overlay.key)
	check(overlay.visible, "its key does not show it")
	var rate: Control = overlay.get_node("%Panel").get_node("%Rate")
	var plots := func() -> bool:
		return rate._values.has("HapticWorld") and rate._values["HapticWorld"].size() > 3
	check(await until(plots, SOON), "the rate is not plotted: %s" % [rate._values])
	check(rate._values["HapticWorld"][-1] > 100.0, "ticks a second: %s" % [rate._values])
	check_equal(_drawings(scene).size(), 1, "drawings")
	check(overlay.get_node("%Panel").get_node("%Said").text.contains("2 bodies"), "what is said")
	await press_key(overlay.key)
	await frames(2)
	check(not overlay.visible and not overlay.is_processing(), "it is not hidden again")
	check_equal(_drawings(scene).size(), 0, "drawings that are left")


func test_a_trace_is_written_by_a_key() -> void:
	_scene_in_real_time()
	var overlay := _overlay()
	overlay.trace_seconds = 0.3
	await frames(2)
	var file: String = overlay.record_trace()
	check(file.ends_with(".json"), "it records into '%s'" % file)
	check_equal(overlay.record_trace(), "", "a second one at once")
	check(await until(func() -> bool: return FileAccess.file_exists(file), SOON), "there is no " + file)
	var ends := func() -> bool: return overlay.get_node("%Note").text.begins_with("Trace:")
	check(await until(ends, SOON), "it does not end")
	var events: Array = JSON.parse_string(FileAccess.get_file_as_string(file))
	check(
		events.any(func(event: Dictionary) -> bool: return event.name == "move proxy"), "no stage of a tick"
	)
	DirAccess.remove_absolute(file)


func test_a_trace_of_nothing_is_none() -> void:
	check_equal(_overlay().record_trace(), "", "file")


func test_godots_monitors_have_the_loop() -> void:
	_scene_in_real_time()
	Monitors.add(get_tree())
	Monitors.add(get_tree())
	Performance.get_custom_monitor("tactus/ticks_per_s")
	await until(func() -> bool: return false, 0.3)
	check(Performance.get_custom_monitor("tactus/ticks_per_s") > 100.0, "ticks a second")
	for name in [
		"work_p99_us", "period_p99_us", "missed_deadlines", "awake_bodies", "force_n", "round_trip_ms"
	]:
		check(Performance.get_custom_monitor("tactus/" + name) >= 0.0, name)
	Monitors.remove()
	check(not Performance.has_custom_monitor("tactus/force_n"), "a monitor is left")


func test_figures_are_plain_values_of_all_that_is_there() -> void:
	var scene: Node = (load("res://gallery/delay_lab/delay_lab.tscn") as PackedScene).instantiate()
	add_child(scene)
	await frames(3)
	var figures: Dictionary = Figures.new().of(get_tree())
	check_equal(figures.worlds.size(), 2, "worlds")
	check_equal(figures.links.size(), 2, "links")
	check_equal(figures.devices.size(), 2, "devices")
	check_equal(bytes_to_var(var_to_bytes(figures)), figures, "what another process gets")


func test_histograms_count_each_period_once() -> void:
	var scene := _scene_in_real_time()
	var world: HapticWorld = scene.get_node("HapticWorld")
	check(await until(func() -> bool: return world.get_ticks() > 300, SOON), "it does not tick")
	var figures := Figures.new()
	figures.of(get_tree())
	var first: PackedInt32Array = figures.histograms().values()[0]
	var counted := 0
	for count in first:
		check(count >= 0, "a count below 0: %s" % first)
		counted += count
	check(counted > 250, "periods: %d" % counted)
	await frames(2)
	var later := 0
	for count in figures.histograms().values()[0]:
		later += count
	check(later >= 0 and later < counted, "periods since: %d" % later)


func test_counts_lie_below_the_ends_of_bins() -> void:
	var distribution := {
		"period_us": PackedFloat64Array([900.0, 1000.0, 2000.0]), "share": PackedFloat64Array([0.1, 0.9, 1.0])
	}
	var below: PackedInt32Array = Figures.counts_below(distribution, 1000.0, 100)
	check_equal(below[0], 0, "up to 525 µs")
	check_equal(below[16], 10, "up to 925 µs")
	check_equal(below[20], 90, "up to 1025 µs")
	check_equal(below[-1], 100, "all")


func test_nodes_of_one_name_are_told_apart() -> void:
	var paths := ["Lab/Here/Bed/World", "Lab/There/Bed/World", "Lab/There/Bed/Sky"]
	check_equal(PanelScript.short_name(paths[0], paths), "Here", "the first")
	check_equal(PanelScript.short_name(paths[1], paths), "There", "the second")
	check_equal(PanelScript.short_name(paths[2], paths), "Sky", "one that is alone")


func test_a_plots_scale_fits() -> void:
	for pair: Array in [[0.0, 1.0], [0.3, 0.5], [1.0, 1.0], [1.1, 2.0], [30.0, 50.0], [700.0, 1000.0]]:
		check_near(Plot.top_for(pair[0]), pair[1], 1e-9, "top for %s" % pair[0])
	check_near(Plot.top_for(1000.9), 1000.0, 1e-9, "a loop that is a little too fast")


## However it sways, as on a busy machine.
func test_the_scale_of_the_loop_stays() -> void:
	var rate: Control = _overlay().get_node("%Panel").get_node("%Rate")
	rate.size = Vector2(300, 60)
	for value: float in [1000.0, 1000.9, 1083.0, 920.0]:
		rate.add("World", value, value)
		check("0 … 1200 Hz" in rate.words()[0].text, "at %s: %s" % [value, rate.words()[0].text])


func test_figures_have_three_digits() -> void:
	for pair: Array in [
		[1015.01, "1015"], [15.63, "15.6"], [4.04, "4.04"], [0.0, "0"], [-1236.6, "-1237"], [20.0, "20"]
	]:
		check_equal(Plot.in_short(pair[0]), pair[1], "of %s" % pair[0])


func test_names_that_are_too_long_lose_their_beginning() -> void:
	var plot := Plot.new()
	add_child(plot)
	plot.size = Vector2(200, 64)
	plot.add("a pointer with a name that is longer than any plot", 0.0, 1.5)
	await frames(2)
	var legend: String = plot.words()[1].text
	check(legend.begins_with("…") and legend.ends_with("any plot 1.5"), legend)


func test_what_nothing_is_known_of_is_not_plotted() -> void:
	var overlay := _overlay()
	var panel: Control = overlay.get_node("%Panel")
	var nothing := {"time": 1.0, "worlds": {}, "links": {}, "devices": {}, "pointers": {}, "sensors": {}}
	panel.show_figures(nothing)
	panel.show_histograms({"World": PackedInt32Array([0, 0])})
	for plot: String in ["Rate", "Work", "Periods", "Force", "Energy", "Link", "Moved", "Noticed"]:
		check(not panel.get_node("%" + plot).visible, "an empty plot: " + plot)
	panel.show_histograms({"World": PackedInt32Array([0, 3])})
	check(panel.get_node("%Periods").visible, "periods are hidden")


## What it covers is left free by the words beside it; what is too high for the window stands in two columns.
func test_it_tells_what_it_covers_and_stays_in_the_window() -> void:
	var overlay := _overlay()
	var told := []
	overlay.room_taken.connect(func(width: float) -> void: told.append(width))
	overlay.shown = true
	check_equal(told[-1], 372.0, "width")
	var panel: Control = overlay.get_node("%Panel")
	for i in 40:
		for plot: String in ["Rate", "Work", "Force", "Energy", "Link"]:
			panel.get_node("%" + plot).add("a curve that has a long name %d" % i, 0.0, 1.0)
	for _i in 4:
		overlay._keep_within_window()
		await frames(2)
	check(panel.columns > 1 and told[-1] > 372.0, "%d columns, %s" % [panel.columns, told])
	overlay.shown = false
	check_equal(told[-1], 0.0, "width while it is hidden")


func test_one_is_not_several() -> void:
	check_equal(PanelScript.counted(1, "body", "bodies"), "1 body", "one")
	check_equal(PanelScript.counted(0, "body", "bodies"), "0 bodies", "none")


## Curves stay below the words about them, however many lines these take.
func test_a_plots_words_and_curves_do_not_overlap() -> void:
	var plot := Plot.new()
	add_child(plot)
	plot.size = Vector2(300, 64)
	for i in 4:
		plot.add("a pointer with a long name %d" % i, 0.0, 1.0)
		plot.add("a pointer with a long name %d" % i, 1.0, 1.0)
	await frames(3)
	check(plot.size.y >= 5 * Plot.LINE + Plot.LEAST, "four lines of names leave no room: %s" % plot.size)


## Below zero, too: what a hand does at a spring is taken from it.
func test_energy_is_plotted() -> void:
	var scene := _scene_in_real_time()
	var overlay := _overlay()
	overlay.shown = true
	var device: HapticDevice = scene.find_children("*", "HapticDevice", true, false)[0]
	check(await until(func() -> bool: return device.get_energy() < -1e-4, SOON), "the hand has done no work")
	var energy: Control = overlay.get_node("%Panel").get_node("%Energy")
	var plotted := func() -> bool: return energy._values.get("HapticDevice", [0.0])[-1] < 0.0
	check(await until(plotted, SOON), "the energy is not plotted: %s" % [energy._values])


## Before its first frame the overlay has drawn nothing.
func _lines(scene: Node) -> int:
	var pictures := _drawings(scene)
	if pictures.is_empty():
		return 0
	var mesh := (pictures[0] as MeshInstance3D).mesh as ImmediateMesh
	return 0 if mesh.get_surface_count() == 0 else mesh.surface_get_arrays(0)[Mesh.ARRAY_VERTEX].size()


func test_boxes_of_trees_are_drawn_by_a_key() -> void:
	var scene: Node = (load("res://gallery/mesh_library/mesh_library.tscn") as PackedScene).instantiate()
	add_child(scene)
	var overlay := _overlay()
	overlay.shown = true
	var world: HapticWorld = scene.get_node("HapticWorld")
	var pointer: ProxyPointer = world.find_children("*", "ProxyPointer", true, false)[0]
	var drawing: Node = overlay.get_node("%Drawing")
	var is_near := func() -> bool:
		return world.get_tree_boxes(pointer.global_position, drawing.NEAR).size() > 4
	check(await until(is_near, 3.0 * SOON), "the hand does not come near a mesh")
	var before := _lines(scene)
	await press_key(overlay.boxes_key)
	# The hand goes on along its path, so where frames are slow it is to come near once more.
	var are_drawn := func() -> bool: return _lines(scene) >= before + 4 * 24 - 64
	check(await until(are_drawn, 3.0 * SOON), "no boxes: %d, then %d" % [before, _lines(scene)])
	await press_key(overlay.boxes_key)
	await frames(2)
	check(not drawing.draws_boxes, "they do not go again")


## Corrections are counted, so that what lies between two frames is plotted as well.
func test_what_corrections_cost_is_plotted_per_second() -> void:
	var overlay := _overlay()
	var panel: Control = overlay.get_node("%Panel")
	var link := {
		"text": "",
		"round_trip_ms": 1.0,
		"packets_per_s": 100.0,
		"lost_percent": 0.0,
		"corrections": 5,
		"moved_mm": 2.0,
		"jnds": 10.0,
		"tank_mj": 3.0,
		"hidden_mj": -1.0
	}
	var figures := {
		"time": 1.0, "worlds": {}, "links": {"A/Link": link}, "devices": {}, "pointers": {}, "sensors": {}
	}
	panel.show_figures(figures)
	figures.time = 1.5
	link.moved_mm = 5.0
	link.jnds = 60.0
	panel.show_figures(figures)
	check(panel.get_node("%Moved").visible and panel.get_node("%Noticed").visible, "their plots are hidden")
	check_near(panel.get_node("%Moved")._values["Link"][-1], 6.0, 1e-9, "mm/s")
	check_near(panel.get_node("%Noticed")._values["Link"][-1], 100.0, 1e-9, "steps a second")
	check_near(panel.get_node("%Energy")._values["Link hidden"][-1], -1.0, 1e-9, "mJ")


func test_the_probe_leaves_a_program_that_no_editor_watches() -> void:
	var probe: Node = Probe.new()
	add_child(probe)
	await frames(2)
	check(not is_instance_valid(probe), "it is still there")
