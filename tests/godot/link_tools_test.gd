extends "link_case.gd"
## A tool over a link: the operator's touches the model, the far one follows.


func _add_tools() -> void:
	for world: HapticWorld in [_operator, _far]:
		add_device(world, _down_after(0.5))
		var tool := HapticTool.new()
		tool.name = "Tool"
		var mesh := BoxMesh.new()
		mesh.size = Vector3(0.2, 0.02, 0.02)
		tool.mesh = mesh
		world.add_child(tool)


func _tool(world: HapticWorld) -> HapticTool:
	return world.get_node("Tool")


## The grasp is the operator's: the far tool follows where the hand would have it.
func test_a_tool_touches_the_model_at_once_and_the_far_one_follows() -> void:
	await _connect(MMTLink.SCENARIO_MMT, 0.1)
	add_floor(_far, STIFFNESS)
	_add_tools()
	_tool(_operator).grasp_rotation = Vector3(0, 0, 0.05)
	_advance(0.6)
	check_equal(_tool(_operator).get_state_text(), "touching", "state")
	check_near(_tool(_operator).get_force().y, 19.5, 1.0, "force, without any delay")
	check_near(_tool(_operator).get_torque().z, -0.05, 5e-3, "torque")
	check_near(_tool(_operator).global_position.y, 0.0095, 1e-3, "place")
	_advance(0.2)
	check_near(_tool(_far).get_force(), _tool(_operator).get_force(), 1e-3, "force at the far side")
	check_near(_tool(_far).get_torque().z, -0.05, 5e-3, "torque at the far side")
	check_near(_tool(_far).global_position, _tool(_operator).global_position, 1e-6, "place of the far tool")


func test_traditional_touch_brings_back_the_force_and_torque_of_a_tool() -> void:
	await _connect(MMTLink.SCENARIO_TRADITIONAL, 0.1)
	add_floor(_far, STIFFNESS)
	_add_tools()
	_tool(_operator).grasp_rotation = Vector3(0, 0, 0.05)
	_advance(0.62)
	check_near(_tool(_operator).get_force(), Vector3.ZERO, 1e-9, "force before the far side has answered")
	_advance(0.2)
	check_near(_tool(_operator).get_force(), _tool(_far).get_force(), 1e-3, "force when it has")
	check_near(_tool(_operator).get_torque().z, -0.05, 5e-3, "torque when it has")
	check(_tool(_operator).is_touching(), "it does not touch when the far side has answered")
	check_near(_tool(_operator).global_position, _tool(_far).global_position, 1e-6, "place")


func test_robots_follow_no_tool() -> void:
	await _connect(MMTLink.SCENARIO_MMT_ROBOT)
	_add_tools()
	_advance(0.1)
	check(not _tool(_operator).is_present(), "it is there, and no robot is")


## The way of the lone scene, through its stack of ten boxes, in both worlds of the linked one.
func test_among_boxes_that_topple_no_tool_is_lost() -> void:
	var lone := (load("res://gallery/peg_in_hole/peg_in_hole.tscn") as PackedScene).instantiate()
	var scene := (load("res://gallery/remote_tool/remote_tool.tscn") as PackedScene).instantiate()
	var worlds: Array[HapticWorld] = []
	for side: String in ["Operator", "Far"]:
		var world: HapticWorld = scene.get_node("Views/%s/View/PegInHole/HapticWorld" % side)
		world.clock = HapticWorld.CLOCK_STEPPED
		world.get_node("HapticDevice").path = lone.get_node("HapticWorld/HapticDevice").path
		worlds.append(world)
	lone.free()
	add_child(scene)
	var lost := 0
	var touched := 0
	for _frame in 15 * 60:
		for world in worlds:
			world.advance(1.0 / 60.0)
			var state: String = world.get_node("HapticTool").get_state_text()
			lost += int(state.contains("does not fit"))
			touched += int(state == "touching")
	check_equal(lost, 0, "frames without a tool")
	check(touched > 100, "it touched in %d frames" % touched)
