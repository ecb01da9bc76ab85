extends "nodes_case.gd"
## Nodes that are put where they cannot work, or told what makes no sense: said in words, and nothing breaks.


func test_a_negative_radius_is_refused_and_the_old_one_stays() -> void:
	var proxy := ProxyPointer.new()
	proxy.radius = 0.02
	for radius: float in [-0.01, 0.0, NAN, INF]:
		expect_error("radius = ")
		proxy.radius = radius
		check_equal(proxy.radius, 0.02, "radius")
	proxy.free()


func test_setters_refuse_what_makes_no_sense() -> void:
	var device := HapticDevice.new()
	var world := HapticWorld.new()
	var recorder := HapticRecorder.new()
	var touched := HapticMesh.new()
	var values := {
		"stiffness": [HapticMaterial.new(), -1.0],
		"damping": [HapticMaterial.new(), NAN],
		"static_friction": [HapticMaterial.new(), -0.1],
		"dynamic_friction": [HapticMaterial.new(), INF],
		"texture_depth": [HapticMaterial.new(), -0.001],
		"texture_size": [HapticMaterial.new(), 0.0],
		"magnet_force": [HapticMaterial.new(), NAN],
		"magnet_range": [HapticMaterial.new(), 0.0],
		"stiffening": [HapticMaterial.new(), 0.0],
		"stiffening_depth": [HapticMaterial.new(), 0.0],
		"stribeck_speed": [HapticMaterial.new(), -0.1],
		"viscosity": [HapticMaterial.new(), -1.0],
		"vibration_frequency": [HapticMaterial.new(), -1.0],
		"smoothing_angle": [touched, 4.0],
		"force_limit": [device, -1.0],
		"wheel_step": [device, 0.0],
		"tick_rate": [world, 0],
		"gravity": [world, Vector3(0, NAN, 0)],
		"max_bodies": [world, 0],
		"realtime_priority": [world, 100],
		"processor": [world, -3],
		"trace_seconds": [recorder, 0.0],
		"circle_radius": [HapticPath.new(), -1.0],
		"circle_turn_time": [HapticPath.new(), 0.0],
	}
	for property: String in values:
		var object: Object = values[property][0]
		var before: Variant = object.get(property)
		expect_error("%s = %s was refused, the old value stays" % [property, values[property][1]])
		object.set(property, values[property][1])
		check_equal(object.get(property), before, property)
	device.free()
	world.free()
	recorder.free()
	touched.free()


## As Godot's own properties do.
func test_an_array_will_do_for_a_packed_one() -> void:
	var way := HapticPath.new()
	way.points_positions = [Vector3.ZERO, Vector3.ONE]
	way.points_times = [0, 1.5]
	check_equal(way.points_positions, PackedVector3Array([Vector3.ZERO, Vector3.ONE]), "positions")
	check_equal(way.points_times, PackedFloat64Array([0.0, 1.5]), "times")
	var soft := HapticSoftBody.new()
	soft.held_vertices = [1, 2]
	check_equal(soft.held_vertices, PackedInt32Array([1, 2]), "vertices")
	soft.free()
	var wrong := {
		"points_positions": [[Vector3.ZERO, 1.0], "a PackedVector3Array, or an Array of Vector3"],
		"points_times": [[0.0, "1"], "a PackedFloat64Array, or an Array of float"],
	}
	for property: String in wrong:
		var before: Variant = way.get(property)
		expect_error("it must be " + wrong[property][1])
		way.set(property, wrong[property][0])
		check_equal(way.get(property), before, property)


func test_a_proxy_whose_device_is_nowhere() -> void:
	var world := add_world()
	add_floor(world)
	var proxy := ProxyPointer.new()
	proxy.device = NodePath("../Nothing")
	world.add_child(proxy)
	expect_error("its device '../Nothing' is not a HapticDevice")
	world.advance(0.1)
	check(not proxy.is_touching(), "it touches")
	check(proxy.get_problems()[0].contains("set 'device' anew"), "no warning")
	var device := HapticDevice.new()
	device.name = "Nothing"
	device.path = path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1)
	world.add_child(device)
	world.advance(0.3)
	check(proxy.is_touching(), "it does not touch once the device is there")


func test_a_device_without_a_path() -> void:
	var world := add_world()
	add_floor(world)
	add_hand(world, null)
	var device: HapticDevice = world.get_node("Device")
	device.driver = HapticDevice.DRIVER_PATH
	expect_error("set 'path' to a HapticPath")
	world.advance(0.1)
	check(device.get_problems()[0].contains("set 'path'"), "no warning")
	check(not device.is_device_connected(), "it says that it is connected")


func test_a_device_whose_path_cannot_be_followed() -> void:
	var world := add_world()
	var way := path(Vector3.ZERO, Vector3.ONE)
	way.points_times = PackedFloat64Array([1.0, 0.5])
	add_hand(world, way)
	expect_error("its path cannot be followed: point 1 is not later")
	world.advance(0.1)


func test_a_world_in_a_world_stays_inactive_and_its_bodies_belong_to_the_outer_one() -> void:
	var outer := add_world()
	var inner := HapticWorld.new()
	inner.name = "Inner"
	expect_error("it stands inside another HapticWorld")
	outer.add_child(inner)
	check(not inner.is_running() and outer.is_running(), "the wrong one runs")
	check(inner.get_problems()[0].contains("inside another one"), "no warning")
	add_floor(inner, 500.0)
	var proxy := add_hand(inner, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1))
	outer.advance(0.3)
	check_near(proxy.get_force().y, 10.0, 1e-3, "force")


func test_two_worlds_side_by_side_both_run() -> void:
	var first := add_world()
	var second := add_world()
	add_floor(first, 500.0)
	add_floor(second, 250.0)
	var one := add_hand(first, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1))
	var other := add_hand(second, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1))
	first.advance(0.3)
	second.advance(0.3)
	check_near(one.get_force().y, 10.0, 1e-3, "force in the first")
	check_near(other.get_force().y, 5.0, 1e-3, "force in the second")


func test_a_world_freed_while_it_runs_in_real_time() -> void:
	for _i in 5:
		var world := HapticWorld.new()
		add_child(world)
		add_floor(world)
		add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.05))
		await get_tree().create_timer(0.03).timeout
		world.free()
	await frames(3)


func test_a_world_freed_by_a_signal_of_its_own_proxy() -> void:
	var world := HapticWorld.new()
	add_child(world)
	add_floor(world)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.05))
	var id := world.get_instance_id()
	proxy.contact_started.connect(func(_body: Node3D) -> void: instance_from_id(id).queue_free())
	check(await until(func() -> bool: return not is_instance_id_valid(id), 5.0), "it was not freed")


func test_devices_proxies_and_recorders_may_go_before_their_world() -> void:
	var world := add_world()
	add_floor(world)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1))
	world.advance(0.2)
	world.get_node("Device").free()
	expect_error("its device '../Device' is not a HapticDevice")
	world.advance(0.1)
	check_near(proxy.get_force(), Vector3.ZERO, 1e-6, "force without a device")
	proxy.free()
	world.advance(0.1)


func test_a_world_leaves_the_tree_and_comes_back() -> void:
	var world := add_world()
	add_floor(world)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), 0.1))
	world.advance(0.3)
	remove_child(world)
	check(not world.is_running(), "it runs outside the tree")
	add_child(world)
	world.advance(0.3)
	check_near(proxy.get_force().y, 10.0, 1e-3, "force")


func test_advancing_where_it_cannot_is_an_error_and_nothing_else() -> void:
	var world := HapticWorld.new()
	expect_error("This HapticWorld does not run")
	check_equal(world.advance(1.0), 0, "ticks")
	add_child(world)
	expect_error("set its clock to CLOCK_STEPPED")
	check_equal(world.advance(1.0), 0, "ticks")
	world.clock = HapticWorld.CLOCK_STEPPED
	world.advance(0.0)
	expect_error("between 0 and 3,600 s")
	check_equal(world.advance(-1.0), 0, "ticks")


func test_more_bodies_than_the_world_takes() -> void:
	var world := add_world()
	world.max_bodies = 2
	for i in 3:
		world.add_child(with_shape(StaticBody3D.new(), sphere(0.1), Vector3(i, 0, 0)))
	expect_error("more bodies than it takes")
	world.advance(0.01)
	world.advance(0.01)
	check_equal(int(world.get_statistics().bodies), 2, "bodies that can be touched")
	check_equal(world.get_problems().size(), 1, "problems")


## Whether a script knows the type of its variable or not decides how Godot hands the body over.
func test_a_freed_body_is_refused_by_every_method() -> void:
	var world := add_world()
	add_floor(world)
	world.advance(TICK)
	for method: String in [
		"apply_central_impulse", "apply_torque_impulse", "apply_central_force", "apply_torque"
	]:
		expect_error(method + "() did nothing: the body that it was given has been freed")
		world.call(method, _freed(), Vector3.UP)
	for method: String in ["apply_impulse", "apply_force"]:
		expect_error(method + "() did nothing: the body that it was given has been freed")
		world.call(method, _freed(), Vector3.UP, Vector3.ZERO)
	for method: String in ["get_linear_velocity", "get_angular_velocity"]:
		expect_error(method + "() did nothing: the body that it was given has been freed")
		check_equal(world.call(method, _freed()), Vector3.ZERO, method + " of a freed body")
	world.call("_node_added", _freed())
	world.call("_node_removed", _freed())


func test_a_freed_body_of_a_known_type_is_refused() -> void:
	var world := add_world()
	var body := add_floor(world)
	var rigid := RigidBody3D.new()
	world.advance(TICK)
	body.free()
	rigid.free()
	expect_error("get_linear_velocity() did nothing: the body that it was given has been freed")
	check_equal(world.get_linear_velocity(body), Vector3.ZERO, "velocity of a freed body")
	expect_error("apply_central_impulse() did nothing: the body that it was given has been freed")
	world.apply_central_impulse(rigid, Vector3.UP)
	expect_error("apply_force() did nothing: the body that it was given is null")
	world.apply_force(null, Vector3.UP)


func test_a_property_set_to_a_freed_object_keeps_its_value() -> void:
	var world := add_world()
	var material := HapticMaterial.new()
	world.default_material = material
	expect_error("default_material = <Freed Object> was refused, the old value stays")
	world.set("default_material", _freed())
	check_equal(world.default_material, material, "default_material")


## A method whose argument is declared as an object gets the bare pointer from a typed script, also where the
## object has been freed: it takes a Variant instead.
func test_no_method_takes_the_bare_pointer_of_an_object() -> void:
	var seen := 0
	for name in ClassDB.get_class_list():
		if ClassDB.class_get_api_type(name) != ClassDB.API_EXTENSION:
			continue
		for method in ClassDB.class_get_method_list(name, true):
			for argument in method["args"]:
				seen += 1
				check(argument["type"] != TYPE_OBJECT, "%s.%s takes an object" % [name, method["name"]])
	check(seen > 100, "only %d arguments were looked at" % seen)


func _freed() -> Variant:
	var body := RigidBody3D.new()
	body.free()
	return body
