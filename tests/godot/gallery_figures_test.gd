extends "nodes_case.gd"
## Five small things of the gallery: what each makes a hand feel, in figures, tick by tick in stepped time.

const Gallery := preload("res://gallery/gallery.gd")
const SCENES: Array[String] = ["knob", "pen", "needle", "tower", "guided_study"]
const LINES := 40
## Between the knob's detents (unit: degrees).
const PITCH := 30.0
## So long after the hand has left it the knob rests (unit: seconds).
const SETTLES := 0.16


func _world(scene: Node) -> HapticWorld:
	return scene.get_node("HapticWorld")


func _proxy(scene: Node) -> ProxyPointer:
	return scene.get_node("HapticWorld/ProxyPointer")


func _device(scene: Node) -> HapticDevice:
	return scene.get_node("HapticWorld/HapticDevice")


## With as many frames of Godot as the scene's script and its signals need.
func _play(scene: Node, seconds: float) -> void:
	for _i in roundi(seconds / 0.02):
		_world(scene).advance(0.02)
		await frames(1)


func test_none_has_more_than_a_page_of_script() -> void:
	for scene_name in SCENES:
		var folder := Gallery.path_of(scene_name).get_base_dir()
		for file in DirAccess.get_files_at(folder):
			if file.ends_with(".gd"):
				var count := (
					FileAccess.get_file_as_string(folder.path_join(file)).strip_edges().count("\n") + 1
				)
				check(count <= LINES, "%s has %d lines" % [file, count])


func test_the_button_clicks_as_its_curve_says() -> void:
	for speed: float in [0.02, 0.2]:
		var scene := add_scene(Gallery.path_of("knob"))
		var button: StaticBody3D = scene.get_node("HapticWorld/Button")
		var curve: Curve = (button.physics_material_override as HapticMaterial).force_curve
		var above := button.position + Vector3(0, 0.026, 0)
		var below := above - Vector3(0, 0.0045, 0)
		var way := path(above, below, 0.0045 / speed)
		way.points_positions = PackedVector3Array([above, below, above])
		way.points_times = PackedFloat64Array([0.0, 0.0045 / speed, 0.009 / speed])
		_device(scene).path = way
		var worst := 0.0
		var deepest := 0.0
		for _i in roundi(0.009 / speed / TICK):
			_world(scene).advance(TICK)
			var depth := _proxy(scene).get_proxy_position().y - _proxy(scene).get_hand_position().y
			deepest = maxf(deepest, depth)
			worst = maxf(worst, absf(_proxy(scene).get_force().y - curve.sample(1e3 * depth)))
		check(deepest > 3.2e-3, "it was pressed by %s mm" % (1e3 * deepest))
		check(worst <= 0.02 * 3.0, "%s N off the curve at %s m/s" % [worst, speed])
		scene.free()


## The knob is turned there and back by the scene's own hand, in each round.
func test_the_knob_rests_in_its_detents_round_after_round() -> void:
	var scene := add_scene(Gallery.path_of("knob"))
	var knob: RigidBody3D = scene.get_node("HapticWorld/Knob")
	var untouched := 0.0
	var rests: Array[int] = []
	for _i in roundi(2.0 * _device(scene).path.get_duration() / 0.02):
		await _play(scene, 0.02)
		untouched = 0.0 if _proxy(scene).is_touching() else untouched + 0.02
		if untouched < SETTLES:
			continue
		var angle := rad_to_deg(knob.rotation.y)
		var detent := roundi(angle / PITCH)
		check_near(angle, PITCH * detent, 1.0, "angle at rest")
		if rests.is_empty() or rests[-1] != detent:
			rests.append(detent)
	check_equal(rests, [0, -1, -2, -3, -2, -1, 0, -1, -2, -3, -2, -1, 0] as Array[int], "detents")


func test_the_lamp_changes_with_each_click() -> void:
	var scene := add_scene(Gallery.path_of("knob"))
	var lamp: MeshInstance3D = scene.get_node("Lamp")
	var duration := _device(scene).path.get_duration()
	for round in 3:
		var before := lamp.get_surface_override_material(0)
		await _play(scene, duration)
		check(lamp.get_surface_override_material(0) != before, "it is as before round %d" % round)


func test_the_pen_leaves_a_line_that_is_wider_where_it_is_pressed() -> void:
	var scene := add_scene(Gallery.path_of("pen"))
	await _play(scene, _device(scene).path.get_duration())
	var image: Image = scene.get_node("HapticWorld/Board/Sheet").get("_image")
	var widths: Array[int] = []
	# Where the line is level: pressed lightly, firmly, firmly, lightly.
	for x: int in [255, 405, 555, 705]:
		widths.append(range(image.get_height()).filter(_is_ink.bind(image, x)).size())
	check(widths[0] > 2 and widths[3] > 2, "there is no line: %s" % [widths])
	check(widths[1] > 2 * widths[0] and widths[2] > 2 * widths[3], "widths: %s" % [widths])


func _is_ink(y: int, image: Image, x: int) -> bool:
	return image.get_pixel(x, y).r < 0.5


func test_the_needle_breaks_and_leaves_each_layer_once_a_round() -> void:
	var scene := add_scene(Gallery.path_of("needle"))
	var events: Array[String] = []
	_proxy(scene).surface_broken.connect(
		func(body: Node3D, force: float) -> void:
			var bears := (body as StaticBody3D).physics_material_override as HapticMaterial
			check_near(force, bears.pop_through_force, 0.02, "force that broke %s" % body.name)
			events.append("+" + body.name)
	)
	_proxy(scene).surface_left.connect(func(body: Node3D) -> void: events.append("-" + body.name))
	for _round in 3:
		events.clear()
		await _play(scene, _device(scene).path.get_duration())
		check_equal(
			events, ["+Skin", "+Fat", "+Muscle", "-Muscle", "-Fat", "-Skin"] as Array[String], "signals"
		)
		check_equal((scene.get_node("Depth") as Label3D).text, "outside", "words")


## An arm that means to be 2 mm farther out pulls all the time.
func test_a_needle_that_is_held_does_not_creep() -> void:
	var scene := add_scene(Gallery.path_of("needle"))
	var device := _device(scene)
	var way := path(Vector3(0, 0.1, 0.02), Vector3(0, 0.03, 0.02), 3.0)
	way.points_positions = PackedVector3Array(
		[Vector3(0, 0.1, 0.02), Vector3(0, 0.03, 0.02), Vector3(0, 0.04, 0.02)]
	)
	way.points_times = PackedFloat64Array([0.0, 3.0, 4.0])
	device.driver = HapticDevice.DRIVER_SIMULATED_ARM
	device.path = way
	await _play(scene, 6.0)
	var held := _proxy(scene).get_hand_position()
	var pull := _proxy(scene).get_force().length()
	await _play(scene, 10.0)
	var crept := held.distance_to(_proxy(scene).get_hand_position())
	check(pull > 0.5 and held.y < 0.05, "it is not held: %s N at %s" % [pull, held])
	check(crept <= 5e-5, "it crept by %s mm" % (1e3 * crept))


func test_the_tower_stands_until_it_is_touched() -> void:
	var scene := add_scene(Gallery.path_of("tower"))
	_device(scene).path = path(Vector3(-0.18, 0.1, 0), Vector3(-0.18, 0.1, 0))
	var words: Label3D = scene.get_node("Hardest")
	await _play(scene, 10.0)
	check_equal(words.text, "not touched yet\n0 fallen", "words")
	check_near((scene.get_node("HapticWorld/Block17") as Node3D).position, Vector3(0, 0.165, 0), 1e-3, "top")


func test_a_harder_knock_is_told_and_blocks_fall() -> void:
	var scene := add_scene(Gallery.path_of("tower"))
	var impulses: Array[float] = []
	_proxy(scene).impact.connect(
		func(_body: Node3D, _speed: float, impulse: float) -> void: impulses.append(impulse)
	)
	await _play(scene, 5.0)
	check_equal(impulses.size(), 1, "knocks of a slow push")
	var pushed: Node3D = scene.get_node("HapticWorld/Block8")
	check(pushed.position.x > 0.05, "it is at %s" % pushed.position)
	check((scene.get_node("Hardest") as Label3D).text.ends_with("\n0 fallen"), "blocks fell")
	await _play(scene, 5.0)
	check(impulses.size() > 1 and impulses[1] > 5.0 * impulses[0], "knocks: %s" % [impulses])
	var words := (scene.get_node("Hardest") as Label3D).text
	check(words.contains("%.0f mN·s" % (1e3 * impulses.max())), words)
	check(not words.ends_with("\n0 fallen"), words)


func test_the_guide_of_the_study_is_its_curve() -> void:
	var scene := add_scene(Gallery.path_of("guided_study"))
	var guide: HapticGuide = (scene.get_node("HapticWorld/Line/Guide") as HapticEffect).guide
	var curve: Curve3D = guide.curve.duplicate()
	curve.bake_interval = 1e-4
	var worst := 0.0
	for i in 1000:
		var hand := Vector3(0.32 * i / 1000.0 - 0.16, 0.01 * sin(i), 0.01 * cos(i))
		var place := guide.get_place(hand)
		worst = maxf(worst, place.distance_to(curve.get_closest_point(place)))
	check(worst <= 1e-4, "%s mm off the curve" % (1e3 * worst))


func test_the_study_goes_on_and_a_guide_helps() -> void:
	var scene := add_scene(Gallery.path_of("guided_study"))
	var words: Label3D = scene.get_node("Results")
	var duration := _device(scene).path.get_duration()
	await _play(scene, 6.0 * duration + 1.0)
	var lines := words.text.split("\n")
	check_equal(lines.size(), 3, "lines")
	var means := PackedFloat64Array()
	for i in 3:
		check(lines[i].begins_with(["no guide", "attracted", "held"][i] + ": "), words.text)
		means.append(lines[i].get_slice(": ", 1).to_float())
	check(means[1] < 0.5 * means[0] and means[2] < means[1], "distances: %s" % [means])
