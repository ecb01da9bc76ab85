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
	check_near(_tool(_far).get_force(), _tool(_operator).get_force(), 1e-3, "force at the other side")
	check_near(_tool(_far).get_torque().z, -0.05, 5e-3, "torque at the other side")
	check_near(_tool(_far).global_position, _tool(_operator).global_position, 1e-6, "place of the far tool")


func test_traditional_touch_brings_back_the_force_and_torque_of_a_tool() -> void:
	await _connect(MMTLink.SCENARIO_DIRECT, 0.1)
	add_floor(_far, STIFFNESS)
	_add_tools()
	_tool(_operator).grasp_rotation = Vector3(0, 0, 0.05)
	_advance(0.62)
	check_near(_tool(_operator).get_force(), Vector3.ZERO, 1e-9, "force before the other side has answered")
	_advance(0.2)
	check_near(_tool(_operator).get_force(), _tool(_far).get_force(), 1e-3, "force when it has")
	check_near(_tool(_operator).get_torque().z, -0.05, 5e-3, "torque when it has")
	check(_tool(_operator).is_touching(), "it does not touch when the other side has answered")
	check_near(_tool(_operator).global_position, _tool(_far).global_position, 1e-6, "place")


func _small_tool(world: HapticWorld, device: HapticDevice) -> HapticTool:
	world.add_child(device)
	var tool := HapticTool.new()
	tool.name = "Tool"
	tool.device = NodePath("../" + device.name)
	var mesh := BoxMesh.new()
	mesh.size = Vector3(0.04, 0.006, 0.006)
	tool.mesh = mesh
	tool.tolerance = 0.0003
	world.add_child(tool)
	return tool


## The far side's device is an emulated robot, which cannot turn; its tip is a hand of a real place.
func _add_robot(mount: Vector3) -> HapticWorld:
	var robot := HapticDevice.new()
	robot.name = "Robot"
	robot.driver = HapticDevice.DRIVER_EMULATED_ROBOT
	robot.table_height = -0.04
	_small_tool(_far, robot).grasp_rotation = mount
	var place := add_world()
	var tip := HapticDevice.new()
	tip.name = "Tip"
	tip.driver = HapticDevice.DRIVER_ROBOT_TIP
	tip.target = robot.get_path()
	_small_tool(place, tip).grasp_rotation = mount
	return place


func test_a_robot_carries_a_tool_and_both_keep_the_rotation_of_its_mount() -> void:
	await _connect(MMTLink.SCENARIO_MMT_ROBOT, 0.05)
	var mount := Vector3(0, 0.4, 0)
	var place := _add_robot(mount)
	for world: HapticWorld in [_far, place]:
		add_floor(world, STIFFNESS)
	var hand := HapticDevice.new()
	hand.name = "Hand"
	hand.path = path(Vector3(0, 0.02, 0), Vector3(0, -0.001, 0), 2.0)
	_small_tool(_operator, hand).grasp_rotation = Vector3(0.3, 0, 0.2)
	for _tick in 3000:
		for world: HapticWorld in [_operator, _far, place]:
			world.advance(TICK)
	var ours := _tool(_operator)
	check_equal(ours.get_state_text(), "touching; its robot cannot turn it", "state")
	check((ours.get_status() & HapticTool.STATUS_TURN_FIXED) != 0, "its status does not say so")
	check((_tool(_far).get_status() & HapticTool.STATUS_TURN_FIXED) != 0, "nor does the far one's")
	var wanted := Basis.from_euler(mount)
	for tool: HapticTool in [ours, _tool(_far)]:
		check(
			tool.get_tool_transform().basis.is_equal_approx(wanted),
			"it is turned: %s" % tool.get_tool_transform()
		)
	check_near(ours.get_force().y, 4.0, 0.5, "force of the model")
	check_near(ours.get_torque(), Vector3.ZERO, 1e-9, "torque on a hand whose turn means nothing")
	check(
		_tool(place).is_touching(), "the real one touches nothing at %s" % _tool(place).get_tool_transform()
	)
	check(_tool(place).get_force().y > 1.0, "the real one is pressed by %s" % _tool(place).get_force())
	check(_tool(place).global_position.y > 0.002, "it is in the floor: %s" % _tool(place).global_position)


func test_what_a_robots_tool_runs_into_is_felt_without_a_model() -> void:
	await _connect(MMTLink.SCENARIO_DIRECT_ROBOT, 0.05)
	var place := _add_robot(Vector3.ZERO)
	add_floor(place, STIFFNESS)
	var hand := HapticDevice.new()
	hand.name = "Hand"
	hand.path = path(Vector3(0, 0.02, 0), Vector3(0, -0.01, 0), 2.0)
	_small_tool(_operator, hand)
	for _tick in 3000:
		for world: HapticWorld in [_operator, _far, place]:
			world.advance(TICK)
	var felt := _tool(_operator).get_force()
	check(felt.y > 1.0, "felt is %s" % felt)
	check_near(felt, _tool(place).get_force(), 0.4, "beside what the place gives the robot")


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
