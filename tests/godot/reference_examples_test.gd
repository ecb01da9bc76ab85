extends "nodes_case.gd"
## Code examples of the class reference: each compiles, and those that stand alone do what they show.

## What an example needs that a machine may not have: it is compiled alone.
const COMPILED_ONLY := [&"HapticDepthSensor"]
const INPUTS := "user://run/inputs.tactus"


func _examples() -> Dictionary[StringName, String]:
	var folder: String = (get_script() as Script).resource_path.get_base_dir().path_join(
		"../../extension/doc_classes"
	)
	var block := RegEx.create_from_string("(?s)\\[codeblock\\]\\n(.*?)\\[/codeblock\\]")
	var found: Dictionary[StringName, String] = {}
	for file in DirAccess.get_files_at(folder):
		for example in block.search_all(FileAccess.get_file_as_string(folder.path_join(file))):
			found[StringName(file.get_basename())] = example.get_string(1).dedent().xml_unescape()
	return found


func _compiled(of_class: StringName, source: String) -> GDScript:
	var script := GDScript.new()
	script.source_code = source
	check_equal(script.reload(), OK, "compiling the example of %s" % of_class)
	return script


## A script with the statements as a function, indented by spaces as the example is.
func _wrapped(example: String, members := "") -> String:
	if example.begins_with("extends "):
		return example
	return "extends Node3D\n\n%s\n\nfunc run() -> void:\n%s" % [members, example.indent("    ")]


## What the example declares can be looked at afterward.
func _with_members(example: String) -> String:
	var declared := RegEx.create_from_string("(?m)^var (\\w+) := ")
	var members := PackedStringArray()
	for one in declared.search_all(example):
		members.append("var " + one.get_string(1))
	return _wrapped(declared.sub(example, "$1 = ", true), "\n".join(members))


## World: Floor, Ball, Device that presses 5 mm into the floor, Pointer, Link.
func _add_scene(example: StringName) -> Node3D:
	var scene := Node3D.new()
	var world := HapticWorld.new()
	world.name = "World"
	world.clock = HapticWorld.CLOCK_STEPPED
	scene.add_child(world)
	add_floor(world)
	var ball := with_shape(StaticBody3D.new(), sphere(0.05), Vector3(0.5, 0.05, 0))
	ball.name = "Ball"
	world.add_child(ball)
	add_device(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.005, 0), 0.2))
	var pointer := ProxyPointer.new()
	pointer.name = "Pointer"
	if example != &"HapticTool":
		world.add_child(pointer)
	else:
		pointer.free()
	var link := MMTLink.new()
	link.name = "Link"
	world.add_child(link)
	return scene


func _run_statements(of_class: StringName, example: String) -> Node3D:
	var scene := _add_scene(of_class)
	scene.set_script(_compiled(of_class, _with_members(example)))
	add_child(scene)
	scene.get_node("World").advance(0.3)
	scene.run()
	return scene


func _run_script(of_class: StringName, example: String) -> Node:
	var script := _compiled(of_class, example)
	check_equal(script.get_instance_base_type(), of_class, "what the example extends")
	var scene := _add_scene(of_class)
	var world: HapticWorld = scene.get_node("World")
	var node: Node
	if of_class == &"HapticDevice" or of_class == &"ProxyPointer":
		node = world.get_node("Device" if of_class == &"HapticDevice" else "Pointer")
		node.set_script(script)
	else:
		node = script.new()
		world.add_child(node)
	add_child(scene)
	for _i in 36:
		world.advance(1.0 / 60.0)
		await frames(1)
	return node


func test_at_least_twelve_classes_have_an_example_that_compiles() -> void:
	var examples := _examples()
	check(examples.size() >= 12, "examples of %s alone" % [examples.keys()])
	for of_class in examples:
		_compiled(of_class, _wrapped(examples[of_class]))


func test_examples_of_scripts_run() -> void:
	var examples := _examples()
	var nodes: Dictionary[StringName, Node] = {}
	for of_class in examples:
		if examples[of_class].begins_with("extends ") and of_class not in COMPILED_ONLY:
			nodes[of_class] = await _run_script(of_class, examples[of_class])
	check(nodes.size() >= 4, "scripts of %s alone" % [nodes.keys()])
	check_equal(nodes[&"HapticDevice"].force_limit, 2.0, "force limit of the device")
	check(nodes[&"HapticDevice"].get_displayed_force().length() > 1.5, "nothing is displayed")
	check(nodes[&"ProxyPointer"].is_touching(), "the pointer touches nothing")
	check(nodes[&"ProxyPointer"].contact_started.get_connections().size() == 1, "nothing hears of contacts")
	check_equal(nodes[&"HapticEffect"].get_state_text(), "working", "state of the effect")
	check(nodes[&"HapticTool"].get_sphere_count() > 10, "the tool has no spheres")


func test_examples_of_statements_run() -> void:
	await _record_inputs()
	var examples := _examples()
	for of_class in examples:
		if examples[of_class].begins_with("extends "):
			continue
		var scene := _run_statements(of_class, examples[of_class])
		var methods := PackedStringArray(get_method_list().map(func(m: Dictionary) -> String: return m.name))
		var judge := "_shows_" + of_class.to_snake_case()
		check(judge in methods, "nothing is expected of the example of %s" % of_class)
		check(call(judge, scene), "the example of %s does not do what it shows" % of_class)
		scene.free()


func _record_inputs() -> void:
	var scene := _add_scene(&"HapticReplay")
	scene.get_node("World").inputs_path = INPUTS
	add_child(scene)
	scene.get_node("World").advance(0.2)
	scene.free()
	await frames(2)


## The node of this class that an example has added.
func _added(scene: Node, parent: String, type: String) -> Node:
	return scene.get_node(parent).find_children("*", type, false, false).back()


func _shows_haptic_vibration_sound(scene: Node) -> bool:
	return _added(scene, "World/Pointer", "HapticVibrationSound").full_force == 1.5


func _shows_haptic_volume(scene: Node) -> bool:
	return scene.triangles > 1000


func _shows_haptic_force(scene: Node) -> bool:
	return _added(scene, "World/Pointer", "HapticEffect").formula.form == HapticForce.FORM_DETENT


func _shows_haptic_joint_drive(scene: Node3D) -> bool:
	return scene.detents.get_problems().is_empty() and scene.hinge.get_child(0) == scene.detents


func _shows_haptic_guide(scene: Node) -> bool:
	return scene.get_node("World/Pointer").guide.get_problems().is_empty()


func _shows_haptic_material(scene: Node) -> bool:
	return scene.get_node("World/Floor").physics_material_override.stiffness == 1200.0


func _shows_haptic_mesh(scene: Node) -> bool:
	return _added(scene, "World/Ball", "HapticMesh").mesh is TorusMesh


## The clock of a path begins with it, not with the world's.
func _shows_haptic_path(scene: Node) -> bool:
	scene.get_node("World").advance(1.001)
	return absf(scene.get_node("World/Device").get_hand_position().y - 0.045) < 0.002


func _shows_haptic_recorder(scene: Node) -> bool:
	return _added(scene, ".", "HapticRecorder").is_recording()


func _shows_haptic_replay(scene: Node) -> bool:
	return scene.replay.get_report()["same"] and scene.replay.get_report()["ticks"] == 200


func _shows_haptic_soft_body(scene: Node) -> bool:
	return _added(scene, "World/Ball", "HapticSoftBody").get_element_count() > 100


func _shows_haptic_statistics(scene: Node) -> bool:
	return scene.row.ticks == 300 and scene.load_statistics is HapticStatistics


func _shows_haptic_load_statistics(scene: Node) -> bool:
	return scene.load_statistics.bodies == 2 and scene.load_statistics.awake_bodies == 0


func _shows_haptic_timing_statistics(scene: Node) -> bool:
	return scene.timing is HapticTimingStatistics and scene.timing.measured_ticks == 0


func _shows_haptic_sensing_statistics(scene: Node) -> bool:
	return scene.sensing is HapticSensingStatistics and scene.sensing.frames == 0


func _shows_mmt_network_statistics(scene: Node) -> bool:
	return scene.network is MMTNetworkStatistics and scene.network.packets_sent == 0


func _shows_mmt_model_statistics(scene: Node) -> bool:
	return scene.model is MMTModelStatistics and scene.model.corrections == 0


func _shows_mmt_passivity_statistics(scene: Node) -> bool:
	return scene.passivity is MMTPassivityStatistics and scene.passivity.energy_hand_j == 0.0


func _shows_mmt_playout_statistics(scene: Node) -> bool:
	return scene.playout is MMTPlayoutStatistics and scene.playout.samples_exact == 0


func _shows_haptic_world(scene: Node) -> bool:
	return _added(scene, ".", "HapticWorld").get_ticks() == 500


func _shows_mmt_link(scene: Node) -> bool:
	return _added(scene, "World", "MMTLink").scenario == MMTLink.SCENARIO_MMT


func _shows_mmt_network_conditions(scene: Node) -> bool:
	return scene.get_node("World/Link").conditions.delay == 0.05


func _shows_mmt_tuning(scene: Node) -> bool:
	return scene.get_node("World/Link").tuning.deadband_enabled
