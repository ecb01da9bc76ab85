extends SceneTree
## What a world costs the processor while nothing happens in it, and how punctual its loop is by that:
##
##     godot --headless --script idle.gd -- OUTPUT.json [SECONDS]
##
## One rig with one body, at 60 frames a second: with a mouse; with a device that displays forces (its driver
## looks for one); with such a device and the project's `tactus/haptic_thread/real_time` off. Counted is the
## processor time of the whole process, all threads, from /proc; that of the same scene without a world is
## taken off. Shares are of one processor.

const REAL_TIME := "tactus/haptic_thread/real_time"

var _result := {}


func _initialize() -> void:
	_run.call_deferred(OS.get_cmdline_user_args())


func _run(arguments: PackedStringArray) -> void:
	var seconds := float(arguments[1]) if arguments.size() > 1 else 10.0
	Engine.max_fps = 60
	var without := await _share_of("without_world", _scene(Node3D.new(), HapticDevice.DRIVER_MOUSE), seconds)
	_result["seconds"] = seconds
	_result["without_world_share"] = without
	for one: Array in [
		["mouse", HapticDevice.DRIVER_MOUSE, true],
		["force_device", HapticDevice.DRIVER_FALCON, true],
		["force_device_real_time_off", HapticDevice.DRIVER_FALCON, false],
	]:
		ProjectSettings.set_setting(REAL_TIME, one[2])
		var world := HapticWorld.new()
		var share := await _share_of(one[0], _scene(world, one[1]), seconds)
		_result[one[0] + "_share"] = share - without
		print("%s: %.4f of a processor" % [one[0], share - without])
	# tools/bench.py looks whether all of it is there.
	var file := FileAccess.open(arguments[0], FileAccess.WRITE)
	if file != null:
		file.store_string(JSON.stringify(_result, "  ", false) + "\n")
		file.close()
	quit()


func _scene(top: Node3D, driver: HapticDevice.Driver) -> Node3D:
	var body := StaticBody3D.new()
	var child := CollisionShape3D.new()
	child.shape = BoxShape3D.new()
	body.add_child(child)
	top.add_child(body)
	if top is HapticWorld:
		var device := HapticDevice.new()
		device.driver = driver
		top.add_child(device)
		top.add_child(ProxyPointer.new())
	var camera := Camera3D.new()
	camera.position.z = 2.0
	top.add_child(camera)
	return top


## Of one processor, by all threads of the process.
func _share_of(name: String, scene: Node3D, seconds: float) -> float:
	root.add_child(scene)
	await create_timer(1.0).timeout
	if scene is HapticWorld:
		scene.reset_statistics()
	var begin := Time.get_ticks_usec()
	var before := _processor_seconds()
	await create_timer(seconds).timeout
	var share := (_processor_seconds() - before) / ((Time.get_ticks_usec() - begin) * 1e-6)
	if scene is HapticWorld:
		var statistics: Dictionary = scene.get_statistics()
		for key: String in [
			"measured_ticks", "tick_period_p50_us", "tick_period_p99_us", "tick_period_p999_us"
		]:
			_result[name + "_" + key] = statistics[key]
	scene.queue_free()
	await process_frame
	return share


func _processor_seconds() -> float:
	var total := 0.0
	var id := OS.get_process_id()
	for task in DirAccess.get_directories_at("/proc/%d/task" % id):
		var file := FileAccess.open("/proc/%d/task/%s/schedstat" % [id, task], FileAccess.READ)
		if file != null:
			total += float(file.get_line().get_slice(" ", 0)) * 1e-9
	return total
