extends "nodes_case.gd"
## What a world keeps when it is set otherwise while it runs.


func _running_world() -> HapticWorld:
	var world := HapticWorld.new()
	world.gravity = Vector3.ZERO
	add_child(world)
	return world


func _mesh_body() -> StaticBody3D:
	var drawn := SphereMesh.new()
	drawn.radial_segments = 128
	drawn.rings = 64
	var touched := HapticMesh.new()
	touched.mesh = drawn
	var body := StaticBody3D.new()
	body.add_child(touched)
	return body


func test_what_concerns_the_thread_restarts_the_loop_alone() -> void:
	var world := _running_world()
	var starts := [0]
	world.started.connect(func() -> void: starts[0] += 1)
	check(await until(func() -> bool: return world.get_ticks() > 20 and starts[0] == 1, 5.0), "no ticks")
	var values := {"processor": -1, "realtime_priority": 0, "lock_memory": false, "measure_baseline": true}
	for property: String in values:
		var before := world.get_ticks()
		world.set(property, values[property])
		await frames(2)
		check(world.get_ticks() >= before, "%s: the clock began anew" % property)
		check(
			await until(func() -> bool: return world.get_ticks() > before + 5, 5.0), property + ": it stands"
		)
	check_equal(starts[0], 1, "starts")
	check(world.get_statistics().has("baseline_mean_period_us"), "no bare loop runs beside it")


func test_another_tick_rate_builds_no_tree_again() -> void:
	var world := _running_world()
	world.add_child(_mesh_body())
	var is_built := func() -> bool:
		return world.get_ticks() > 20 and world.get_statistics().trees_building == 0
	check(await until(is_built, 20.0), "it is not built")
	await frames(2)
	var built: int = world.get_statistics().trees_built
	check(built > 0, "no tree was built")
	for rate: int in [500, 1000]:
		world.tick_rate = rate
		await frames(2)
		check(await until(is_built, 20.0), "it is not built at %d Hz" % rate)
		await frames(2)
		check_equal(int(world.get_statistics().bodies), 1, "bodies at %d Hz" % rate)
	check_equal(int(world.get_statistics().trees_built), built, "trees built")
