extends "nodes_case.gd"
## Devices with a driver of their own: nothing of it is there until a scene picks one, and a device that
## cannot work is a state with a way out.


## The file has no length: it is read as far as it goes.
func _is_loaded(library: String) -> bool:
	var maps := (
		FileAccess.open("/proc/self/maps", FileAccess.READ).get_buffer(1 << 22).get_string_from_ascii()
	)
	check(maps.contains("libtactus"), "the list of what is loaded lacks this extension")
	return maps.contains(library)


func _device(world: HapticWorld, driver: HapticDevice.Driver) -> HapticDevice:
	var device := HapticDevice.new()
	device.driver = driver
	world.add_child(device)
	return device


func test_a_library_is_loaded_when_a_scene_picks_its_device_and_not_before() -> void:
	var world := add_world()
	var device := _device(world, HapticDevice.DRIVER_MOUSE)
	world.advance(0.05)
	check(not _is_loaded("libusb"), "libusb is there without a device on USB")
	var image := "user://no_firmware.bin"
	FileAccess.open(image, FileAccess.WRITE).store_string("not the maker's")
	device.firmware = image
	device.driver = HapticDevice.DRIVER_FALCON
	world.advance(0.05)
	check(
		await until(
			func() -> bool: return "Falcon" in device.get_state_text() or "libusb" in device.get_state_text(),
			5.0
		),
		"the state says: %s" % device.get_state_text()
	)
	if "Falcon" in device.get_state_text():
		check(_is_loaded("libusb"), "libusb is not there with a device on USB")
	check_equal(device.get_open_device_id(), "", "id")
	device.driver = HapticDevice.DRIVER_MOUSE
	DirAccess.remove_absolute(image)


func test_a_falcon_says_what_it_needs() -> void:
	var world := add_world()
	var device := _device(world, HapticDevice.DRIVER_FALCON)
	world.advance(0.01)
	check("firmware" in device.get_state_text(), "without firmware it says: %s" % device.get_state_text())
	device.firmware = "user://nowhere.bin"
	world.advance(0.01)
	check("nowhere.bin" in device.get_state_text(), "without the file it says: %s" % device.get_state_text())
	check(device.get_problems().size() > 0, "no warning")


## A scripted hand presses the six walls in turn.
func test_the_device_check_sees_all_six_directions() -> void:
	var scene: Control = (load("res://gallery/device_check/device_check.tscn") as PackedScene).instantiate()
	scene.report_path = "user://device_check_test.json"
	var world: HapticWorld = scene.get_node("%HapticWorld")
	world.clock = HapticWorld.CLOCK_STEPPED
	var way := HapticPath.new()
	way.form = HapticPath.FORM_POINTS
	var places := PackedVector3Array()
	var times := PackedFloat64Array()
	for direction: Vector3 in scene.WAYS.values():
		for place: Vector3 in [Vector3.ZERO, direction * 0.022, direction * 0.022]:
			times.append(places.size() * 0.2)
			places.append(place)
	way.points_positions = places
	way.points_times = times
	way.points_interpolation = HapticPath.INTERPOLATION_LINEAR
	(scene.get_node("%HapticDevice") as HapticDevice).path = way
	add_child(scene)
	await frames(2)
	for _step in 400:
		world.advance(0.01)
		scene.observe()
	check_equal(scene.next_way(), "", "direction that was not seen")
	var report: Dictionary = JSON.parse_string(FileAccess.get_file_as_string(scene.report_path))
	check_equal(report.directions.size(), 6, "directions in the report")
	DirAccess.remove_absolute(scene.report_path)
