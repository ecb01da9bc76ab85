extends "nodes_case.gd"
## Scenario 5: a far side with an emulated robot in a place of its own, and a synthetic camera that looks at
## it. What it finds makes the operator's model.

var _scene: Node


func _start() -> void:
	_scene = (load("res://gallery/depth_camera/depth_camera.tscn") as PackedScene).instantiate()
	for world: HapticWorld in _worlds():
		world.clock = HapticWorld.CLOCK_STEPPED
	add_child(_scene)


func _worlds() -> Array:
	return ["HapticWorld", "Far", "Reality"].map(func(path: String) -> Node: return _scene.get_node(path))


## All three worlds go on together, and the camera looks in between.
func _advance(seconds: float) -> void:
	for _step in int(seconds / 0.01):
		for _tick in 10:
			for world: HapticWorld in _worlds():
				world.advance(0.001)
		await get_tree().process_frame


func _modelled(mesh: String) -> Node3D:
	for child in _scene.get_node("HapticWorld").find_children("*", "", true, false):
		if child is Node3D and String(child.name).begins_with(mesh):
			return child
	return null


func _knows_all() -> bool:
	for _try in 60:
		if _modelled("cube") != null and _modelled("bracket") != null and _modelled("support") != null:
			return true
		await _advance(0.1)
	return false


func test_what_the_camera_finds_is_what_the_operator_touches() -> void:
	_start()
	var sensor: HapticDepthSensor = _scene.get_node("Far/DepthSensor")
	check(
		await until(func() -> bool: return sensor.get_objects().size() >= 2, 150.0),
		"it says: %s, and has %s" % [sensor.get_state_text(), sensor.get_objects()]
	)
	check(await _knows_all(), "the operator has %s" % [_scene.get_node("HapticWorld").get_children()])
	if not failure.is_empty():
		return
	for mesh: String in ["Cube", "Bracket"]:
		var real: Node3D = _scene.get_node("Reality/" + mesh)
		var modelled := _modelled(mesh.to_lower())
		check_near(modelled.global_position, real.global_position, 0.004, "place of the " + mesh)
	# The hand goes onto the cube: it is felt here at once, and the robot presses the real one.
	var device: HapticDevice = _scene.get_node("HapticWorld/HapticDevice")
	var top: Vector3 = _scene.get_node("Reality/Cube").global_position + Vector3(0, 0.05, 0)
	device.path = path(top + Vector3(0, 0.05, 0), top + Vector3(0, 0.004, 0))
	var hand: ProxyPointer = _scene.get_node("HapticWorld/ProxyPointer")
	var there: ProxyPointer = _scene.get_node("Reality/ProxyPointer")
	await _advance(1.5)
	check(hand.is_touching(), "nothing is felt: %s" % hand.get_state_text())
	check(hand.get_force().y > 0.5, "force on the hand: %s" % hand.get_force())
	check(there.is_touching(), "the robot touches nothing at %s" % there.global_position)
