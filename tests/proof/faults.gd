extends "../godot/nodes_case.gd"
## What goes wrong inside of a program while a hand touches, in real time: tools/proof/faults.py does it.
##
## A line "SEEN …" says what came of it.

const LONG := 30.0
const EXTENSION := "res://addons/tactus/tactus.gdextension"
## That a hand may feel of a wall of 500 N/m that it is 20 mm deep in, and half as much again.
const MOST_FORCE := 15.0

var _seconds := float(OS.get_environment("TACTUS_PROOF_SECONDS"))
var _cycles := int(OS.get_environment("TACTUS_PROOF_CYCLES"))
var _chance := RandomNumberGenerator.new()


func _seen(words: String) -> void:
	print("SEEN ", words)


## A world in real time whose hand goes to and fro, up to 20 mm into the floor.
func _touched_world() -> ProxyPointer:
	var world := HapticWorld.new()
	world.name = "World"
	world.gravity = Vector3.ZERO
	add_child(world)
	var way := HapticPath.new()
	way.form = HapticPath.FORM_POINTS
	way.points_positions = PackedVector3Array(
		[Vector3(-0.1, 0.03, 0), Vector3(0.1, -0.01, 0.02), Vector3(-0.1, 0.03, 0)]
	)
	way.points_times = PackedFloat64Array([0.0, 0.5, 1.0])
	way.points_interpolation = HapticPath.INTERPOLATION_LINEAR
	way.points_loop = true
	return add_hand(world, way)


## For so long: `act` in every frame; the loop ticks on and the hand feels forces that are some.
func _touch(proxy: ProxyPointer, seconds: float, act: Callable) -> Dictionary:
	var world: HapticWorld = proxy.get_parent()
	check(await until(func() -> bool: return world.get_ticks() > 100, LONG), "it does not tick")
	var figures := {"frames": 0, "touching": 0, "most": 0.0, "ticks": world.get_ticks()}
	var end := Time.get_ticks_msec() + int(seconds * 1000.0)
	while Time.get_ticks_msec() < end:
		act.call(figures.frames)
		await frames(1)
		var force := proxy.get_force()
		check(force.is_finite() and proxy.global_position.is_finite(), "the force is %s" % force)
		figures.frames += 1
		figures.touching += int(proxy.is_touching())
		figures.most = maxf(figures.most, force.length())
	figures.ticks = world.get_ticks() - figures.ticks
	check(figures.ticks > 0, "it has stopped")
	return figures


func _in_words(figures: Dictionary) -> String:
	return (
		"%d frames, touched in %d, %d ticks, force at most %.2f N"
		% [figures.frames, figures.touching, figures.ticks, figures.most]
	)


## A patch of 20 x 20 squares, in waves.
func _waves(phase: float) -> ArrayMesh:
	var tool := SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	for row in 21:
		for column in 21:
			var x := 0.03 * (column - 10)
			var z := 0.03 * (row - 10)
			tool.add_vertex(Vector3(x, 0.004 * sin(20.0 * x + phase) * cos(15.0 * z), z))
	for row in 20:
		for column in 20:
			var first := 21 * row + column
			for corner: int in [0, 1, 21, 1, 22, 21]:
				tool.add_index(first + corner)
	return tool.commit()


func test_mesh_edited_while_touched() -> void:
	var proxy := _touched_world()
	var touched := HapticMesh.new()
	touched.mesh = _waves(0.0)
	var body := StaticBody3D.new()
	body.physics_material_override = material(500.0)
	body.add_child(touched)
	proxy.get_parent().add_child(body)
	var edit := func(frame: int) -> void:
		if frame % 60 == 59:
			touched.mesh = BoxMesh.new() if frame % 120 == 59 else _waves(0.1 * frame)
		else:
			touched.mesh = _waves(0.1 * frame)
	var figures := await _touch(proxy, _seconds, edit)
	check(figures.touching > 0, "it was never touched")
	_seen(_in_words(figures))


func test_bodies_come_go_and_jump_while_touched() -> void:
	var proxy := _touched_world()
	var world: HapticWorld = proxy.get_parent()
	add_floor(world)
	_chance.seed = 8
	var bodies: Array[PhysicsBody3D] = []
	var act := func(_frame: int) -> void:
		var place := Vector3(_chance.randf() - 0.5, _chance.randf() * 0.1, 0.1 * _chance.randf()) * 0.4
		match _chance.randi() % 4:
			0:
				var kind: PhysicsBody3D = (
					[RigidBody3D, StaticBody3D, AnimatableBody3D][_chance.randi() % 3].new()
				)
				bodies.append(with_shape(kind, sphere(0.03), place) as PhysicsBody3D)
				world.add_child(bodies[-1])
			1:
				if bodies.size() > 8:
					(bodies.pop_front() as Node).free()
			2:
				if not bodies.is_empty():
					bodies[_chance.randi() % bodies.size()].position = place
			3:
				if not bodies.is_empty():
					var shape: CollisionShape3D = bodies[_chance.randi() % bodies.size()].get_child(0)
					shape.shape = box(Vector3.ONE * _chance.randf_range(0.01, 0.08))
	var figures := await _touch(proxy, _seconds, act)
	check(figures.touching > 0, "nothing was touched")
	_seen(_in_words(figures))


## The library is another file under the same name, as after a build; Godot is asked to load it anew, which it
## does for extensions that say that they can be.
func test_hot_reload() -> void:
	var proxy := _touched_world()
	add_floor(proxy.get_parent())
	var config := ConfigFile.new()
	config.load(EXTENSION)
	check_equal(config.get_value("configuration", "reloadable"), false, "reloadable")
	var library := ""
	for line in (
		FileAccess
		. open("/proc/self/maps", FileAccess.READ)
		. get_buffer(1 << 22)
		. get_string_from_ascii()
		. split("\n")
	):
		if line.contains("libtactus.") and library.is_empty():
			library = line.substr(line.find("/"))
	check(FileAccess.file_exists(library), "its library is not found: " + library)
	var refused := 0
	for _time in 3:
		# Another file, and the one that is in use stays as it is until it is closed.
		check_equal(OS.execute("cp", ["-p", library, library + ".new"]), 0, "copy")
		check_equal(DirAccess.rename_absolute(library + ".new", library), OK, "rename")
		expect_error("GDExtension reloading is disabled")
		refused += int(GDExtensionManager.reload_extension(EXTENSION) != GDExtensionManager.LOAD_STATUS_OK)
		var figures := await _touch(proxy, _seconds / 3.0, func(_frame: int) -> void: pass)
		check(figures.touching > 0, "it was not touched any more")
		check(figures.most < MOST_FORCE, "it kicked with %.2f N" % figures.most)
	_seen("refused %d times in words, touched before and after" % refused)


func _count(folder: String) -> int:
	return DirAccess.get_files_at(folder).size() + DirAccess.get_directories_at(folder).size()


## Of this process (unit: megabytes).
func _resident() -> float:
	var words := FileAccess.open("/proc/self/statm", FileAccess.READ).get_buffer(256).get_string_from_ascii()
	return 4096e-6 * words.get_slice(" ", 1).to_float()


func _open_and_close(number: int) -> void:
	var proxy := _touched_world()
	var world: HapticWorld = proxy.get_parent()
	world.inputs_path = "user://proof_%d.tactus" % OS.get_process_id()
	add_floor(world)
	var link := MMTLink.new()
	link.scenario = MMTLink.SCENARIO_MMT
	link.side = MMTLink.SIDE_OPERATOR if number % 2 == 0 else MMTLink.SIDE_TELEOPERATOR
	link.local_port = 20000 + OS.get_process_id() % 6000 * 2
	link.remote_port = link.local_port + 1
	world.add_child(link)
	var recorder := HapticRecorder.new()
	recorder.proxy = NodePath("../Proxy")
	recorder.csv_path = "user://proof_%d.csv" % OS.get_process_id()
	world.add_child(recorder)
	check(await until(func() -> bool: return world.get_ticks() > 20, LONG), "it does not tick")
	world.free()
	await frames(1)


func _least(values: PackedFloat64Array) -> float:
	var sorted := values.duplicate()
	sorted.sort()
	return sorted[0]


func test_open_and_close() -> void:
	var warm := maxi(8, _cycles / 4)
	for number in warm:
		await _open_and_close(number)
	var before := [_count("/proc/self/fd"), _count("/proc/self/task")]
	var resident := PackedFloat64Array()
	for number in _cycles:
		await _open_and_close(number)
		resident.append(_resident())
	# What is closed is destroyed by threads of their own, which may lie behind.
	var ended := Time.get_ticks_msec()
	var all_ended := func() -> bool:
		return _count("/proc/self/task") <= before[1] and _count("/proc/self/fd") <= before[0]
	await until(all_ended, LONG)
	ended = Time.get_ticks_msec() - ended
	var after := [_count("/proc/self/fd"), _count("/proc/self/task")]
	check(after[0] <= before[0], "files: %d, then %d" % [before[0], after[0]])
	# By up to three worlds: the least of many times has none of them.
	resident.append(_resident())
	var half := maxi(1, _cycles / 2)
	var growth: float = _least(resident.slice(-half)) - _least(resident.slice(0, half))
	# In fewer, pools and caches are still filling.
	if _cycles >= 100:
		check(after[1] <= before[1], "threads: %d, then %d" % [before[1], after[1]])
		check(growth < 25.0, "memory grew by %.1f MB" % growth)
	_seen(
		(
			"%d times: files %d → %d, threads %d → %d %d ms later, memory %+.1f MB"
			% [_cycles, before[0], after[0], before[1], after[1], ended, growth]
		)
	)


func test_no_files_left() -> void:
	var proxy := _touched_world()
	var world: HapticWorld = proxy.get_parent()
	add_floor(world)
	var held := []
	var limit := 200_000
	while held.size() < limit:
		var file := FileAccess.open("/proc/self/statm", FileAccess.READ)
		if file == null:
			break
		held.append(file)
	check(held.size() < limit, "there is no end to the files that may be opened")
	var recorder := HapticRecorder.new()
	recorder.proxy = NodePath("../Proxy")
	recorder.csv_path = "user://proof_%d.csv" % OS.get_process_id()
	expect_error("cannot be written")
	world.add_child(recorder)
	var link := MMTLink.new()
	link.scenario = MMTLink.SCENARIO_MMT
	link.remote_port = 47_801
	var other := HapticWorld.new()
	other.add_child(link)
	add_child(other)
	var figures := await _touch(proxy, _seconds / 2.0, func(_frame: int) -> void: pass)
	check(figures.touching > 0, "it was not touched any more")
	check(not recorder.is_recording(), "it says that it records")
	check_equal(link.get_state(), MMTLink.STATE_FAILED, "state of the link: " + link.get_state_text())
	var said := link.get_state_text()
	var count := held.size()
	held.clear()
	recorder.start()
	check(recorder.is_recording(), "it does not record once there is room")
	link.remote_port = 47_802
	check(
		await until(func() -> bool: return link.get_state() != MMTLink.STATE_FAILED, LONG),
		"the link stays failed: " + link.get_state_text()
	)
	_seen("%d files held; the link said: %s; %s" % [count, said, _in_words(figures)])


func test_main_thread_stands_still() -> void:
	var proxy := _touched_world()
	var world: HapticWorld = proxy.get_parent()
	add_floor(world)
	await _touch(proxy, 0.5, func(_frame: int) -> void: pass)
	var before := world.get_ticks()
	OS.delay_msec(int(_seconds * 500.0))
	await frames(2)
	var between := world.get_ticks() - before
	check(between > int(_seconds * 500.0) / 2, "there were %d ticks meanwhile" % between)
	var figures := await _touch(proxy, 1.0, func(_frame: int) -> void: pass)
	check(figures.touching > 0, "it was not touched any more")
	_seen("%d ticks meanwhile; %s" % [between, _in_words(figures)])
