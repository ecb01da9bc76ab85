extends "nodes_case.gd"
## Tools through the nodes, in stepped time.


func bar(size := Vector3(0.2, 0.02, 0.02)) -> BoxMesh:
	var mesh := BoxMesh.new()
	mesh.size = size
	return mesh


func add_tool(world: HapticWorld, way: HapticPath, mesh: Mesh) -> HapticTool:
	add_device(world, way)
	var tool := HapticTool.new()
	tool.name = "Tool"
	tool.mesh = mesh
	world.add_child(tool)
	return tool


func test_a_tool_lies_on_the_floor_and_gives_force_and_torque() -> void:
	var world := add_world()
	var ground := add_floor(world)
	var tool := add_tool(world, path(Vector3(0, 0.05, 0), Vector3(0, 0.006, 0)), bar())
	var heard := []
	tool.contact_started.connect(func(body: Node3D) -> void: heard.append(body))
	world.advance(1.2)
	check(tool.get_sphere_count() > 10, "spheres")
	check(tool.get_sampling_error() < 0.003, "error of the sampling")
	check_equal(tool.get_state_text(), "touching", "state")
	check_near(tool.get_force(), Vector3(0, 3.5, 0), 0.6, "force")
	check_near(tool.global_position, Vector3(0, 0.0095, 0), 6e-4, "the node's place")
	check_equal(heard, [ground], "signals")
	check(tool.get_contacts().size() >= 3, "contacts")
	# Turned in the hand, it stays flat and turns the hand back.
	tool.grasp_rotation = Vector3(0, 0, 0.05)
	world.advance(0.1)
	check_near(tool.get_torque(), Vector3(0, 0, -0.05), 3e-3, "torque")
	check_near(tool.global_basis.get_euler(), Vector3.ZERO, 5e-3, "how it lies")


func test_a_tool_pushes_a_body() -> void:
	var world := add_world()
	var block := with_shape(RigidBody3D.new(), box(Vector3.ONE * 0.1), Vector3(0.3, 0, 0)) as RigidBody3D
	world.add_child(block)
	add_tool(world, path(Vector3.ZERO, Vector3(0.3, 0, 0)), bar())
	for _i in 70:
		world.advance(1.0 / 60.0)
	check(block.global_position.x > 0.44, "it was not pushed: %s" % block.global_position)


## Two hands press two tools onto each other: what the one feels the other feels turned around.
func test_two_tools_press_each_other() -> void:
	var world := add_world()
	var upper := add_tool(world, path(Vector3(0, 0.05, 0), Vector3(0.01, 0.014, 0)), bar())
	var plate := bar(Vector3(0.08, 0.02, 0.08))
	var lower := add_tool(world, path(Vector3.ZERO, Vector3.ZERO), plate)
	for tool: HapticTool in [upper, lower]:
		tool.device = tool.get_path_to(world.get_child(tool.get_index() - 1))
	var heard := []
	upper.contact_started.connect(func(body: Node3D) -> void: heard.append(body))
	world.advance(1.2)
	check(upper.is_touching() and lower.is_touching(), "they pass")
	check(upper.get_force().y > 1.0, "force: %s" % upper.get_force())
	check_near(lower.get_force(), -upper.get_force(), 5e-3, "the other hand's force")
	check(upper.global_position.y - lower.global_position.y > 0.018, "it is inside")
	check_equal(heard, [lower], "signals")
	var contacts := upper.get_contacts()
	check(contacts.size() > 0 and contacts[0].body == lower, "contacts: %s" % [contacts])
	check_equal(upper.get_state_text(), "touching", "state")
	check_equal(world.get_problems().size(), 0, "problems")
	# In no layer of the other's mask they meet no more.
	lower.collision_layer = 2
	upper.collision_mask = 1
	world.advance(0.1)
	check_near(upper.get_force(), Vector3.ZERO, 1e-6, "force without a mask")


func test_what_is_no_tool_is_said() -> void:
	var world := add_world()
	add_floor(world)
	var tool := add_tool(world, path(Vector3(0, 0.05, 0), Vector3(0, 0.05, 0)), null)
	check(tool.get_state_text().contains("no mesh"), tool.get_state_text())
	tool.mesh = QuadMesh.new()
	world.advance(0.01)
	check(tool.get_state_text().contains("close it"), tool.get_state_text())
	check_equal(tool.get_problems().size(), 1, "warnings")
	tool.mesh = bar()
	world.advance(0.01)
	check_equal(tool.get_state_text(), "free", "state")
	check_equal(tool.get_problems().size(), 0, "warnings")


## It pressed the floor, and its force, its contacts and its place stayed.
func test_a_tool_that_loses_its_mesh_is_nowhere() -> void:
	var world := add_world()
	add_floor(world)
	var tool := add_tool(world, path(Vector3(0, 0.05, 0), Vector3(0, 0.005, 0), 0.2), bar())
	world.advance(0.5)
	check(tool.get_force().y > 1.0, "force: %s" % tool.get_force())
	check(tool.get_contacts().size() > 0, "it has no contact")
	tool.mesh = null
	world.advance(0.05)
	check(not tool.is_present(), "it is present")
	check_equal(tool.get_force(), Vector3.ZERO, "force")
	check_equal(tool.get_contacts().size(), 0, "contacts")
	var device: HapticDevice = world.get_node("Device")
	check_equal(device.get_force(), Vector3.ZERO, "force of the device")
	tool.mesh = bar()
	world.advance(0.05)
	check(tool.get_state_text().contains("does not fit"), tool.get_state_text())


## It waits where the hand holds it until that is a place in which it fits.
func test_a_tool_larger_than_its_room_is_absent() -> void:
	var world := add_world()
	add_floor(world)
	var way := path(Vector3(0, 0.005, 0), Vector3(0, 0.1, 0))
	var tool := add_tool(world, way, bar())
	world.advance(0.01)
	check(not tool.is_present(), "it is present inside the floor")
	check(tool.get_state_text().contains("does not fit"), tool.get_state_text())
	world.advance(1.0)
	check(tool.is_present(), "it is absent in the air")


## On its path the peg goes into the hole and topples the stack.
func test_the_scene_with_a_tool_plays() -> void:
	var scene := add_scene("res://gallery/peg_in_hole/peg_in_hole.tscn")
	var world: HapticWorld = scene.get_node("HapticWorld")
	var tool: HapticTool = world.get_node("HapticTool")
	var lowest := 1.0
	for _i in roundi(11.0 * 60.0):
		world.advance(1.0 / 60.0)
		lowest = minf(lowest, tool.global_position.y)
	check(lowest < 0.13, "the peg did not go into its hole: %s" % lowest)
	var top: RigidBody3D = world.get_node("Box10")
	check(top.global_position.y < 0.15, "the stack stands: %s" % top.global_position)
	check_equal(world.get_problems().size(), 0, "problems")
	scene.free()


func test_a_pad_gives_way_with_what_it_touches() -> void:
	var world := add_world()
	add_floor(world, 500.0)
	var finger := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0)))
	finger.pad_stiffness = 500.0
	world.advance(1.5)
	check_near(finger.get_force(), Vector3(0, 5.0, 0), 1e-3, "force")


## A finger of skin holds what a point lets turn.
func test_a_soft_finger_holds_a_body_against_turning() -> void:
	var turned := []
	for modulus: float in [0.0, 100000.0]:
		var world := add_world()
		var lid := with_shape(RigidBody3D.new(), box(Vector3(0.06, 0.06, 0.06))) as RigidBody3D
		lid.mass = 0.2
		lid.physics_material_override = material(1000.0)
		lid.physics_material_override.static_friction = 0.9
		lid.physics_material_override.dynamic_friction = 0.9
		lid.angular_velocity = Vector3(0, 3, 0)
		world.add_child(lid)
		var ground := add_floor(world)
		ground.position.y = -0.13
		ground.physics_material_override.friction = 0.0
		lid.physics_material_override.friction = 0.0
		var finger := add_hand(world, path(Vector3(0, 0.042, 0), Vector3(0, 0.032, 0), 0.01))
		finger.torsion_modulus = modulus
		world.advance(1.0)
		turned.append(absf(lid.angular_velocity.y))
		world.free()
	check(turned[0] > 2.0, "a point stops it: %s" % turned[0])
	check(turned[1] < 0.01, "skin does not: %s" % turned[1])
