extends "nodes_case.gd"
## A depth camera in a scene, through the real OpenNI2: the synthetic camera is one of its devices.


## The file has no length: it is read as far as it goes.
func _is_loaded(library: String) -> bool:
	var maps := (
		FileAccess.open("/proc/self/maps", FileAccess.READ).get_buffer(1 << 22).get_string_from_ascii()
	)
	check(maps.contains("libtactus"), "the list of what is loaded lacks this extension")
	return maps.contains(library)


func _drawn(mesh: Mesh, at: Vector3, parent: Node = self) -> MeshInstance3D:
	var drawn := MeshInstance3D.new()
	drawn.mesh = mesh
	drawn.position = at
	parent.add_child(drawn)
	return drawn


func _slab(size: Vector3) -> BoxMesh:
	var mesh := BoxMesh.new()
	mesh.size = size
	return mesh


## A table with the named meshes on it, seen from 0.85 m above and before it. Not yet in the tree.
func _sensor(parent: Node) -> HapticDepthSensor:
	var sensor := HapticDepthSensor.new()
	sensor.name = "DepthSensor"
	sensor.source = HapticDepthSensor.SOURCE_SYNTHETIC
	sensor.synthetic_scene = NodePath("../Table")
	sensor.meshes = PackedStringArray(["cube"])
	sensor.position = Vector3(0, 0.7, 0.48)
	sensor.rotation.x = -0.97
	var table := _drawn(_slab(Vector3(1, 0.02, 0.8)), Vector3(0, -0.01, 0), parent)
	table.name = "Table"
	return sensor


func _sees(sensor: HapticDepthSensor) -> bool:
	return await until(func() -> bool: return sensor.get_state() == HapticDepthSensor.STATE_SEEING, 60.0)


## Until it has seen so many more images: how long that takes is the machine's to decide.
func _images(sensor: HapticDepthSensor, count: int) -> void:
	var last: int = sensor.get_statistics().frames + count
	check(
		await until(func() -> bool: return sensor.get_statistics().frames >= last, 60.0),
		"of %d images the last is not seen; it says: %s" % [count, sensor.get_state_text()]
	)


func test_nothing_of_it_is_loaded_until_a_sensor_looks() -> void:
	for library: String in ["OpenNI2", "pcl_", "libtactus_sensing"]:
		check(not _is_loaded(library), "%s is there without a HapticDepthSensor" % library)
	var sensor := _sensor(self)
	sensor.active = false
	add_child(sensor)
	await frames(2)
	check(not _is_loaded("OpenNI2"), "OpenNI2 is there though the sensor is switched off")
	sensor.active = true
	check(await _sees(sensor), "it says: %s" % sensor.get_state_text())
	check(_is_loaded("OpenNI2"), "nothing of OpenNI2 is there, and yet it sees")


func test_it_sees_points_where_the_table_is() -> void:
	var sensor := _sensor(self)
	sensor.synthetic_depth_error = 0.0
	sensor.show_cloud = true
	add_child(sensor)
	check(await _sees(sensor), "it says: %s" % sensor.get_state_text())
	var statistics := sensor.get_statistics()
	check(statistics.points > 10000, "points: %d" % statistics.points)
	check(statistics.frames > 0, "no frames")
	check(sensor.frame_time > 0.0, "it takes no time")
	var cloud: MeshInstance3D = sensor.get_child(-1, true)
	var points: PackedVector3Array = cloud.mesh.surface_get_arrays(0)[Mesh.ARRAY_VERTEX]
	check_equal(points.size(), statistics.points, "points drawn")
	var middle := 0.0
	for point in points:
		middle += (sensor.global_transform * point).y
	check_near(middle / points.size(), 0.0, 0.002, "height of the table")


## Calibration has left an error: what is seen is where the node's pose has it, not where it is.
func test_a_camera_that_is_not_at_its_node_sees_all_elsewhere() -> void:
	var sensor := _sensor(self)
	sensor.synthetic_depth_error = 0.0
	add_child(sensor)
	check(await _sees(sensor), "it says: %s" % sensor.get_state_text())
	check(await _plane_is(sensor, 0.0, 0.0), "the table is at %s" % sensor.get_plane())
	# Higher by 20 mm than the node, which looks down by 0.97 rad.
	sensor.synthetic_place_error = sensor.basis.inverse() * Vector3(0, 0.02, 0)
	check(await _plane_is(sensor, -0.02, 0.0), "below a camera that is too high: %s" % sensor.get_plane())
	sensor.synthetic_place_error = Vector3.ZERO
	sensor.synthetic_rotation_error = Vector3(0.05, 0, 0)
	check(await _plane_is(sensor, NAN, 0.05), "tilted by 0.05 rad: %s" % sensor.get_plane())


## The table is seen at this height (unless that is NAN), and tilted by so much.
func _plane_is(sensor: HapticDepthSensor, height: float, tilt: float) -> bool:
	return await until(
		func() -> bool:
			var plane := sensor.get_plane()
			if plane.is_empty():
				return false
			var normal: Vector3 = plane.normal
			var is_high: bool = is_nan(height) or absf(plane.offset - height) < 0.002
			return is_high and absf(normal.angle_to(Vector3.UP) - tilt) < 0.005,
		30.0
	)


func test_an_unplugged_camera_is_a_state_and_comes_back() -> void:
	var sensor := _sensor(self)
	sensor.show_cloud = true
	add_child(sensor)
	check(await _sees(sensor), "it says: %s" % sensor.get_state_text())
	var said: Array[String] = []
	sensor.state_changed.connect(func(_state: int, text: String) -> void: said.append(text))
	sensor.set_plugged(false)
	check(
		await until(func() -> bool: return sensor.get_state() == HapticDepthSensor.STATE_OPENING, 60.0),
		"without a plug it says: %s" % sensor.get_state_text()
	)
	check(sensor.get_statistics().points > 0, "the last good image is gone")
	sensor.set_plugged(true)
	check(await _sees(sensor), "plugged in again it says: %s" % sensor.get_state_text())
	check(said.any(func(text: String) -> bool: return "plug it in again" in text), "it said: %s" % [said])


func _named(sensor: HapticDepthSensor, mesh: String) -> Dictionary:
	for object in sensor.get_objects():
		if object.name == mesh and object.state != "lost":
			return object
	return {}


func test_objects_are_found_moved_and_lost() -> void:
	var sensor := _sensor(self)
	sensor.knows_support = true
	sensor.meshes = PackedStringArray(["bracket", "cylinder"])
	var bracket := _drawn(
		HapticMesh.create_library_mesh("bracket"), Vector3(-0.12, 0.04, 0.02), get_node("Table")
	)
	bracket.position.y += 0.01
	var told := {"object_found": 0, "object_updated": 0, "object_lost": 0}
	sensor.object_found.connect(func(_id: int, _mesh: String) -> void: told.object_found += 1)
	sensor.object_updated.connect(func(_id: int, _at: Transform3D) -> void: told.object_updated += 1)
	sensor.object_lost.connect(func(_id: int, _mesh: String) -> void: told.object_lost += 1)
	add_child(sensor)
	check(
		await until(func() -> bool: return _named(sensor, "bracket").size() > 0, 60.0),
		"it says: %s, and has %s" % [sensor.get_state_text(), sensor.get_objects()]
	)
	var near := func(at: Vector3) -> bool:
		var object := _named(sensor, "bracket")
		return object.size() > 0 and object.transform.origin.distance_to(at) < 0.003
	check(
		await until(near.bind(bracket.global_position), 60.0),
		"the bracket is seen as %s" % _named(sensor, "bracket")
	)
	check_equal(told.object_found, 1, "objects found")
	for _step in 30:
		bracket.position.x += 0.002
		await _images(sensor, 1)
	check(
		await until(near.bind(bracket.global_position), 60.0),
		"moved to %s, it is seen as %s" % [bracket.global_position, _named(sensor, "bracket")]
	)
	check(told.object_updated > 0, "no update")
	check_equal(told.object_found, 1, "objects found, moved")
	bracket.visible = false
	check(await until(func() -> bool: return told.object_lost > 0, 60.0), "gone, it is not lost")


## Without the camera and without the scene.
func test_what_was_recorded_is_seen_again() -> void:
	var file := OS.get_temp_dir().path_join("images_%d.oni" % OS.get_process_id())
	var sensor := _sensor(self)
	sensor.meshes = PackedStringArray(["bracket"])
	sensor.images_path = file
	_drawn(HapticMesh.create_library_mesh("bracket"), Vector3(-0.12, 0.05, 0.02), get_node("Table"))
	add_child(sensor)
	var is_found := func(by: HapticDepthSensor) -> bool: return _named(by, "bracket").size() > 0
	check(await until(is_found.bind(sensor), 60.0), "it says: %s" % sensor.get_state_text())
	var place: Transform3D = _named(sensor, "bracket").transform
	await _images(sensor, 5)
	sensor.free()
	get_node("Table").free()
	sensor = _sensor(self)
	sensor.meshes = PackedStringArray(["bracket"])
	sensor.source = HapticDepthSensor.SOURCE_RECORDING
	sensor.recording = file
	add_child(sensor)
	get_node("Table").free()
	check(await until(is_found.bind(sensor), 60.0), "played, it says: %s" % sensor.get_state_text())
	check_near(_named(sensor, "bracket").transform.origin, place.origin, 0.003, "place")
	sensor.free()
	DirAccess.remove_absolute(file)


func test_what_is_found_can_be_touched() -> void:
	var world := add_world()
	var sensor := _sensor(world)
	sensor.knows_support = true
	sensor.bodies = HapticDepthSensor.BODIES_HELD
	_drawn(HapticMesh.create_library_mesh("cube"), Vector3(0, 0.06, 0), world.get_node("Table"))
	world.add_child(sensor)
	check(
		await until(func() -> bool: return _named(sensor, "cube").size() > 0, 60.0),
		"it says: %s, and has %s" % [sensor.get_state_text(), sensor.get_objects()]
	)
	var hand := add_hand(world, path(Vector3(0, 0.2, 0), Vector3(0, 0.095, 0)), 0.005)
	world.advance(2.0)
	var contact := hand.get_contacts()
	check(contact.size() > 0, "nothing is touched: %s" % hand.get_state_text())
	if contact.size() > 0:
		check_equal(contact[0].body, _named(sensor, "cube").node, "body")
		check_near(contact[0].point.y, 0.1, 0.004, "top of the cube")


## A cube that is touched from above with more than a newton; the world is not yet in real time.
func _touched_cube(world: HapticWorld, sensor: HapticDepthSensor) -> MeshInstance3D:
	sensor.knows_support = true
	sensor.bodies = HapticDepthSensor.BODIES_HELD
	var mesh := HapticMesh.create_library_mesh("cube")
	var cube := _drawn(mesh, Vector3(0, 0.06, 0), world.get_node("Table"))
	world.add_child(sensor)
	check(
		await until(func() -> bool: return _named(sensor, "cube").size() > 0, 60.0),
		"it says: %s, and has %s" % [sensor.get_state_text(), sensor.get_objects()]
	)
	add_hand(world, path(Vector3(0, 0.2, 0), Vector3(0, 0.099, 0)), 0.005)
	return cube


## It is seen 4 mm higher, as where the camera was calibrated anew, and back. `tick` is called in each frame.
func _see_elsewhere(sensor: HapticDepthSensor, cube: MeshInstance3D, tick: Callable) -> void:
	var height := func() -> float: return _named(sensor, "cube").transform.origin.y
	var seen: float = height.call()
	for up: float in [0.004, -0.004]:
		cube.position.y += up
		var is_seen_there := func() -> bool:
			tick.call()
			return absf(height.call() - seen - maxf(up, 0.0)) < 0.001
		check(await until(is_seen_there, 60.0), "it is seen at %s" % height.call())
		for _frame in 100:
			tick.call()


func test_what_is_seen_elsewhere_while_it_is_touched_is_no_kick() -> void:
	var world := add_world()
	var sensor := _sensor(world)
	var cube := await _touched_cube(world, sensor)
	var hand: ProxyPointer = world.get_node("Proxy")
	world.advance(2.0)
	check(hand.get_force().length() > 1.0, "nothing is touched: %s" % hand.get_state_text())
	var worst := [0.0, hand.get_force()]
	var tick := func() -> void:
		world.advance(0.001)
		worst[0] = maxf(worst[0], hand.get_force().distance_to(worst[1]))
		worst[1] = hand.get_force()
	await _see_elsewhere(sensor, cube, tick)
	check(worst[0] <= 0.5, "%.2f N in a tick" % worst[0])


func test_nor_is_it_in_real_time() -> void:
	var world := add_world()
	world.clock = HapticWorld.CLOCK_REAL_TIME
	var sensor := _sensor(world)
	var cube := await _touched_cube(world, sensor)
	var hand: ProxyPointer = world.get_node("Proxy")
	var is_touched := func() -> bool: return hand.get_force().length() > 1.0
	check(await until(is_touched, 10.0), "nothing is touched: %s" % hand.get_state_text())
	await frames(30)
	var recorder := HapticRecorder.new()
	recorder.proxy = NodePath("../Proxy")
	recorder.csv_path = "user://seen_elsewhere_%d.csv" % OS.get_process_id()
	world.add_child(recorder)
	check(recorder.start(), "it does not record")
	await _see_elsewhere(sensor, cube, func() -> void: pass)
	await frames(30)
	recorder.stop()
	var rows := FileAccess.get_file_as_string(recorder.csv_path).strip_edges().split("\n")
	DirAccess.remove_absolute(recorder.csv_path)
	var worst := 0.0
	for i in range(2, rows.size()):
		var now := rows[i].split_floats(",")
		var before := rows[i - 1].split_floats(",")
		worst = maxf(worst, Vector3(now[1] - before[1], now[2] - before[2], now[3] - before[3]).length())
	check(rows.size() > 100, "rows: %d" % rows.size())
	check(worst <= 0.5, "%.2f N in a tick" % worst)


func test_every_source_that_is_not_there_says_what_to_do() -> void:
	var sensor := HapticDepthSensor.new()
	add_child(sensor)
	check(
		await until(func() -> bool: return "plug one in" in sensor.get_state_text(), 60.0),
		"without a camera it says: %s" % sensor.get_state_text()
	)
	sensor.camera_id = "1d27/0601@9/9"
	check(
		await until(func() -> bool: return "there is no camera '1d27" in sensor.get_state_text(), 60.0),
		"without that camera it says: %s" % sensor.get_state_text()
	)
	sensor.source = HapticDepthSensor.SOURCE_RECORDING
	check("set 'recording'" in sensor.get_state_text(), "it says: %s" % sensor.get_state_text())
	check(sensor.get_problems().size() > 0, "no warning")
	sensor.recording = "user://nowhere.oni"
	check("nowhere.oni" in sensor.get_state_text(), "it says: %s" % sensor.get_state_text())
	var file := "user://damaged.oni"
	FileAccess.open(file, FileAccess.WRITE).store_string("no recording")
	sensor.recording = file
	check(
		await until(func() -> bool: return "not a recording" in sensor.get_state_text(), 60.0),
		"of a damaged file it says: %s" % sensor.get_state_text()
	)
	DirAccess.remove_absolute(file)


func test_an_empty_scene_is_said_to_be_empty() -> void:
	var sensor := _sensor(self)
	get_node("Table").visible = false
	add_child(sensor)
	check(
		await until(func() -> bool: return "nothing is drawn" in sensor.get_state_text(), 60.0),
		"it says: %s" % sensor.get_state_text()
	)
	get_node("Table").visible = true
	check(await _sees(sensor), "with something drawn it says: %s" % sensor.get_state_text())


func test_cameras_are_found_by_name() -> void:
	check_equal(HapticDepthSensor.find_cameras(), {}, "cameras on a machine without any")


## Once the cloud can be touched: what appears around a hand lets it out.
func _hand_on_cloud(world: HapticWorld, sensor: HapticDepthSensor, top: float) -> ProxyPointer:
	var is_there := func() -> bool:
		if world.clock == HapticWorld.CLOCK_STEPPED:
			world.advance(0.02)
		return world.get_statistics().bodies >= 2 and world.get_statistics().trees_built > 0
	check(await until(is_there, 60.0), "there is no cloud; it says: %s" % sensor.get_state_text())
	var proxy := add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0, top + 0.005, 0), 0.2))
	return proxy


func _height_over(proxy: ProxyPointer, cube: Node3D) -> float:
	return proxy.get_proxy_position().y - cube.global_position.y - 0.05


func _rests_on(proxy: ProxyPointer, cube: Node3D) -> bool:
	return proxy.is_touching() and absf(_height_over(proxy, cube) - 0.01) < 0.004


func _check_touched(touches: Callable, proxy: ProxyPointer, sensor: HapticDepthSensor) -> void:
	check(
		await until(touches, 60.0),
		(
			"it touches nothing at %s; it says: %s, and has %s"
			% [proxy.get_proxy_position(), sensor.get_state_text(), sensor.get_objects()]
		)
	)


## Nobody knows the box: its points are touched, and take the hand along when it is put elsewhere.
func test_a_cloud_is_touched_until_what_it_is_of_is_recognised() -> void:
	var world := add_world()
	var sensor := _sensor(world)
	sensor.knows_support = true
	sensor.bodies = HapticDepthSensor.BODIES_HELD
	sensor.touch_cloud = true
	sensor.meshes = PackedStringArray(["torus"])
	var cube := _drawn(HapticMesh.create_library_mesh("cube"), Vector3(0, 0.06, 0), world.get_node("Table"))
	world.add_child(sensor)
	var top := cube.global_position.y + 0.05
	var proxy := await _hand_on_cloud(world, sensor, top)
	var touches := func() -> bool:
		world.advance(0.02)
		return _rests_on(proxy, cube)
	await _check_touched(touches, proxy, sensor)
	check(proxy.get_force().y > 0.1, "force on the hand: %s" % proxy.get_force())
	cube.position.y += 0.03
	check(await until(touches, 60.0), "lifted by 3 cm, the hand is at %s" % proxy.get_proxy_position())
	sensor.meshes = PackedStringArray(["cube"])
	cube.position.y -= 0.03
	check(
		await until(func() -> bool: return touches.call() and _named(sensor, "cube").size() > 0, 60.0),
		"as a cube it is not touched: the hand is at %s" % proxy.get_proxy_position()
	)
	var statistics := world.get_statistics()
	check(
		statistics.trees_refitted > maxi(2, statistics.trees_built),
		"refitted: %d, built: %d" % [statistics.trees_refitted, statistics.trees_built]
	)
	sensor.touch_cloud = false
	await frames(3)
	world.advance(0.05)
	check(sensor.find_children("cloud", "StaticBody3D", false, false).is_empty(), "the cloud is still there")


## Thirty surfaces a second, each of thousands of triangles: more than some machines can build.
func test_in_real_time_a_cloud_is_touched_too_and_lifts_the_hand() -> void:
	var world := HapticWorld.new()
	world.gravity = Vector3.ZERO
	add_child(world)
	var sensor := _sensor(world)
	sensor.knows_support = true
	sensor.touch_cloud = true
	sensor.meshes = PackedStringArray(["torus"])
	var cube := _drawn(HapticMesh.create_library_mesh("cube"), Vector3(0, 0.06, 0), world.get_node("Table"))
	world.add_child(sensor)
	var top := cube.global_position.y + 0.05
	var proxy := await _hand_on_cloud(world, sensor, top)
	var rests := _rests_on.bind(proxy, cube)
	await _check_touched(rests, proxy, sensor)
	# As it rises under the hand, it takes it along.
	var lowest := 1.0
	for _step in 40:
		cube.position.y += 0.001
		await _images(sensor, 1)
		lowest = minf(lowest, _height_over(proxy, cube))
	check(lowest > -0.02, "the hand was passed through: %.1f mm beneath its top" % [-1e3 * lowest])
	check(await until(rests, 60.0), "lifted by 4 cm, the hand is at %s" % proxy.get_proxy_position())
