extends SceneTree
## What a HapticWorld costs the main thread of Godot, a frame:
##
##     godot --headless --script frames.gd -- OUTPUT.json
##
## Each scene plays at 60 frames a second with a world and without one (the same nodes below a Node3D; bodies
## that the world would move are frozen there, so that Godot's own physics does not move them either). Counted
## is the time that the kernel gave the main thread, from /proc: sleeping and other threads do not count. The
## longest frames are given in wall clock, too, where waiting for a lock would show. With and without take
## turns, and the median of the rounds is reported.

const FRAMES := 100
const ROUNDS := 4
const SECONDS_OF_BUILDING := 12.0

var _result := {}


func _initialize() -> void:
	_run.call_deferred(OS.get_cmdline_user_args()[0])


func _run(output: String) -> void:
	Engine.max_fps = 60
	Engine.physics_ticks_per_second = 60
	for one: Array in [
		["static_1000_ms", 1000, _static_body],
		["static_10000_ms", 10_000, _static_body],
		["sleeping_1000_ms", 1000, _sleeping_body],
		["moving_1000_ms", 1000, _moving_body],
	]:
		await _measure(one[0], one[1], one[2])
		print("%s: %.4f" % [one[0], _result[one[0]]])
	await _measure_mesh()
	# tools/bench.py looks whether all of it is there.
	var file := FileAccess.open(output, FileAccess.WRITE)
	if file != null:
		file.store_string(JSON.stringify(_result, "  ", false) + "\n")
		file.close()
	quit()


## So long the kernel has had the main thread on a processor, in milliseconds.
func _main_thread_ms() -> float:
	var id := OS.get_process_id()
	var file := FileAccess.open("/proc/%d/task/%d/schedstat" % [id, id], FileAccess.READ)
	return float(file.get_line().get_slice(" ", 0)) * 1e-6


func _frames(count: int) -> void:
	for _i in count:
		await process_frame


func _median(values: Array[float]) -> float:
	values.sort()
	return values[values.size() / 2]


func _shape(body: CollisionObject3D, shape: Shape3D) -> CollisionObject3D:
	var child := CollisionShape3D.new()
	child.shape = shape
	body.add_child(child)
	return body


func _static_body(i: int, _with_world: bool) -> CollisionObject3D:
	var body := _shape(StaticBody3D.new(), BoxShape3D.new())
	body.position = Vector3(i % 100, 0, i / 100) * 2.0
	return body


func _rigid_body(i: int, with_world: bool) -> RigidBody3D:
	var sphere := SphereShape3D.new()
	sphere.radius = 0.1
	var body := _shape(RigidBody3D.new(), sphere) as RigidBody3D
	body.position = Vector3(i % 100, 0, i / 100) * 2.0
	body.gravity_scale = 0.0
	body.freeze = not with_world
	return body


func _sleeping_body(i: int, with_world: bool) -> RigidBody3D:
	return _rigid_body(i, with_world)


func _moving_body(i: int, with_world: bool) -> RigidBody3D:
	var body := _rigid_body(i, with_world)
	body.linear_velocity = Vector3(0, 0.1, 0)
	body.angular_velocity = Vector3(0, 1, 0)
	body.can_sleep = false
	body.linear_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	body.angular_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	return body


func _scene(with_world: bool, count: int, make: Callable) -> Node3D:
	var top: Node3D = HapticWorld.new() if with_world else Node3D.new()
	if with_world:
		top.max_bodies = 16384
	for i in count:
		top.add_child(make.call(i, with_world))
	return top


func _measure(key: String, count: int, make: Callable) -> void:
	var costs := {true: [] as Array[float], false: [] as Array[float]}
	for _round in ROUNDS:
		for with_world: bool in [true, false]:
			var scene := _scene(with_world, count, make)
			root.add_child(scene)
			# Everything has come to rest that is going to, and all changes have been carried out.
			await _frames(120)
			var begin := _main_thread_ms()
			await _frames(FRAMES)
			costs[with_world].append((_main_thread_ms() - begin) / FRAMES)
			if with_world:
				_result[key.replace("_ms", "_awake")] = scene.get_statistics().awake_bodies
			scene.free()
			await _frames(10)
	_result[key] = _median(costs[true]) - _median(costs[false])
	_result[key.replace("_ms", "_without_world_ms")] = _median(costs[false])


## A sheet with hills, of 2 n² triangles.
func _sheet(n: int) -> ArrayMesh:
	var corners := PackedVector3Array()
	corners.resize((n + 1) * (n + 1))
	var indices := PackedInt32Array()
	indices.resize(6 * n * n)
	var at := 0
	for z in n + 1:
		for x in n + 1:
			corners[z * (n + 1) + x] = Vector3(x, sin(x * 0.05) * cos(z * 0.03), z) * 0.01
			if x < n and z < n:
				var i := z * (n + 1) + x
				for index: int in [i, i + 1, i + n + 1, i + 1, i + n + 2, i + n + 1]:
					indices[at] = index
					at += 1
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = corners
	arrays[Mesh.ARRAY_INDEX] = indices
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh


func _mesh_body(mesh: ArrayMesh) -> StaticBody3D:
	var body := StaticBody3D.new()
	var touched := HapticMesh.new()
	touched.mesh = mesh
	body.add_child(touched)
	return body


## The longest frame until the condition holds: [wall clock, main thread] in milliseconds.
func _longest_until(done: Callable) -> Array[float]:
	var longest: Array[float] = [0.0, 0.0]
	var wall := Time.get_ticks_usec()
	var busy := _main_thread_ms()
	var deadline := Time.get_ticks_msec() + int(SECONDS_OF_BUILDING * 1000.0) * 10
	while not done.call() and Time.get_ticks_msec() < deadline:
		await process_frame
		var now := Time.get_ticks_usec()
		var busy_now := _main_thread_ms()
		longest[0] = maxf(longest[0], (now - wall) * 1e-3)
		longest[1] = maxf(longest[1], busy_now - busy)
		wall = now
		busy = busy_now
	return longest


func _measure_mesh() -> void:
	var mesh := _sheet(1000)
	var longest: Array[float] = []
	for with_world: bool in [false, true]:
		var scene := _scene(with_world, 0, _static_body)
		root.add_child(scene)
		await _frames(60)
		scene.add_child(_mesh_body(mesh))
		var begin := Time.get_ticks_msec()
		var shows := func() -> bool:
			if not with_world:
				return Time.get_ticks_msec() - begin > 500
			return scene.get_statistics().trees_building == 0 and Time.get_ticks_msec() - begin > 100
		longest.append_array(await _longest_until(shows))
		if with_world:
			_result.mesh_2m_built_s = (Time.get_ticks_msec() - begin) * 1e-3
			var gone := Time.get_ticks_usec()
			scene.free()
			_result.free_built_ms = (Time.get_ticks_usec() - gone) * 1e-3
		else:
			scene.free()
		await _frames(60)
	_result.mesh_2m_longest_frame_ms = maxf(longest[3] - longest[1], 0.0)
	_result.mesh_2m_longest_frame_wall_ms = longest[2]
	_result.mesh_2m_without_world_wall_ms = longest[0]
	var world := _scene(true, 0, _static_body)
	root.add_child(world)
	await _frames(60)
	world.add_child(_mesh_body(mesh))
	await _frames(12)
	_result.free_while_building_had_begun = world.get_statistics().trees_building
	var begin := Time.get_ticks_usec()
	world.free()
	_result.free_while_building_ms = (Time.get_ticks_usec() - begin) * 1e-3
	await _frames(10)
	print(_result)
