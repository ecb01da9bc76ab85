extends "nodes_case.gd"
## What a pointer reports of what it touches, in stepped time.


func test_a_contact_names_body_point_and_normal() -> void:
	var world := add_world()
	var ground := add_floor(world)
	var proxy := add_hand(world, path(Vector3(0.1, 0.05, 0), Vector3(0.1, -0.01, 0)))
	world.advance(1.5)
	var contacts := proxy.get_contacts()
	check_equal(contacts.size(), 1, "contacts")
	check(contacts[0].body == ground, "the body is not the floor")
	check_near(contacts[0].point, Vector3(0.1, 0, 0), 1e-6, "point")
	check_near(contacts[0].normal, Vector3.UP, 1e-6, "normal")


func test_contact_signals_come_once_each() -> void:
	var world := add_world()
	var ground := add_floor(world)
	var way := path(Vector3(0, 0.05, 0), Vector3(0, -0.01, 0))
	way.points_positions = PackedVector3Array(
		[Vector3(0, 0.05, 0), Vector3(0, -0.01, 0), Vector3(0, 0.05, 0)]
	)
	way.points_times = PackedFloat64Array([0.0, 0.5, 1.0])
	var proxy := add_hand(world, way)
	var heard := []
	proxy.contact_started.connect(func(body: Node3D) -> void: heard.append(["started", body]))
	proxy.contact_ended.connect(func(body: Node3D) -> void: heard.append(["ended", body]))
	for _i in 120:
		world.advance(0.01)
	check_equal(heard, [["started", ground], ["ended", ground]], "signals")


func test_a_harder_impact_tells_more_speed_and_impulse() -> void:
	var impacts := []
	for seconds: float in [1.0, 0.25]:
		var world := add_world()
		add_floor(world)
		var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3.ZERO, seconds))
		proxy.impact.connect(
			func(body: Node3D, speed: float, impulse: float) -> void:
				impacts.append([String(body.name), speed, impulse])
		)
		world.advance(seconds + 0.1)
		world.free()
	check_equal(impacts.size(), 2, "impacts")
	check_equal(impacts[0][0], "Floor", "body")
	check_near(impacts[0][1], 0.05, 1e-6, "speed")
	check_near(impacts[1][1], 0.2, 1e-6, "speed of the harder one")
	check_near(impacts[1][2] / impacts[0][2], 4.0, 0.5, "impulse of the harder one")


func test_a_contact_has_its_force() -> void:
	var world := add_world()
	add_floor(world)
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3.ZERO))
	world.advance(1.2)
	check_near(proxy.get_contacts()[0]["force"], Vector3(0, 5.0, 0), 1e-6, "force of the contact")
