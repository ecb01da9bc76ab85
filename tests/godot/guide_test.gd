extends "nodes_case.gd"
## Guides lead the hand where there is no surface, in stepped time.


func _guide(form: HapticGuide.Form, points: Array[Vector3]) -> HapticGuide:
	var guide := HapticGuide.new()
	guide.form = form
	guide.points = PackedVector3Array(points)
	guide.stiffness = 300.0
	guide.range = 0.04
	return guide


## A hand that stands still at that place.
func _hand_at(world: HapticWorld, place: Vector3) -> ProxyPointer:
	return add_hand(world, path(place, place))


func test_a_guide_pulls_the_hand_to_where_it_leads() -> void:
	for case: Array in [
		[_guide(HapticGuide.FORM_POINT, [Vector3(0, 0.1, 0)]), Vector3(0, 1, 0)],
		[_guide(HapticGuide.FORM_LINE, [Vector3(0.3, 0.09, 0), Vector3(0.6, 0.09, 0)]), Vector3.ZERO],
		[
			_guide(HapticGuide.FORM_PLANE, [Vector3(0, 0.1, 0), Vector3(1, 0.1, 0), Vector3(0, 0.1, 1)]),
			Vector3(0, 1, 0)
		],
		[_guide(HapticGuide.FORM_PATH, [Vector3(-0.2, 0.1, 0), Vector3(0.2, 0.1, 0)]), Vector3(0, 1, 0)],
		[_guide(HapticGuide.FORM_POINT, [Vector3(0, 0.2, 0)]), Vector3.ZERO]
	]:
		var guide: HapticGuide = case[0]
		check_equal(Array(guide.get_problems()), [], "problems")
		var world := add_world()
		var proxy := _hand_at(world, Vector3(0, 0.09, 0))
		proxy.guide = guide
		world.advance(0.3)
		# 10 mm away, a quarter of the range.
		check_near(proxy.get_force(), case[1] * 300.0 * 0.01 * 0.75, 1e-4, "force")
		proxy.guide = null
		world.advance(0.3)
		check_near(proxy.get_force(), Vector3.ZERO, 1e-6, "force without it")
		world.free()


func test_a_guide_begins_and_changes_gradually() -> void:
	var world := add_world()
	var proxy := _hand_at(world, Vector3(0, 0.1, 0))
	world.advance(0.1)
	var guide := _guide(HapticGuide.FORM_POINT, [Vector3(0, 0.12, 0)])
	guide.range = 0.1
	proxy.guide = guide
	var before := Vector3.ZERO
	var largest := 0.0
	for i in 200:
		if i == 100:
			guide.points = PackedVector3Array([Vector3(0, 0.07, 0)])
		world.advance(TICK)
		largest = maxf(largest, proxy.get_force().distance_to(before))
		before = proxy.get_force()
	check(largest < 0.3, "the force changes by %s N in a tick" % largest)
	check_near(before, Vector3(0, -300.0 * 0.03 * 0.7, 0), 1e-3, "force")


## What acts on the hand besides surfaces is no part of what the law makes smooth.
func test_a_guide_is_felt_once_under_the_smoothed_law() -> void:
	var world := add_world()
	var proxy := _hand_at(world, Vector3(0, 0.09, 0))
	proxy.force_law = ProxyPointer.FORCE_LAW_SMOOTHED
	proxy.guide = _guide(HapticGuide.FORM_POINT, [Vector3(0, 0.1, 0)])
	world.advance(0.5)
	check_near(proxy.get_force(), Vector3(0, 2.25, 0), 1e-4, "force")


func test_surfaces_are_touched_as_without_a_guide() -> void:
	var world := add_world()
	add_floor(world, 500.0)
	var proxy := _hand_at(world, Vector3(0, 0.05, 0))
	proxy.guide = _guide(HapticGuide.FORM_POINT, [Vector3(0, -0.01, 0)])
	proxy.get_node(proxy.device).path = path(Vector3(0, 0.05, 0), Vector3(0, 0.0, 0))
	world.advance(1.5)
	check_near(proxy.get_force(), Vector3(0, 500.0 * 0.01 - 300.0 * 0.01 * 0.75, 0), 1e-3, "force")
	check_near(proxy.get_proxy_position(), Vector3(0, 0.01, 0), 1e-6, "proxy")


func test_what_leads_nowhere_is_said() -> void:
	var world := add_world()
	var proxy := _hand_at(world, Vector3(0, 0.09, 0))
	for case: Array in [
		[_guide(HapticGuide.FORM_LINE, [Vector3.ZERO]), "too few points"],
		[_guide(HapticGuide.FORM_LINE, [Vector3.ONE, Vector3.ONE]), "one place"],
		[_guide(HapticGuide.FORM_PLANE, [Vector3.ZERO, Vector3.ONE, 2.0 * Vector3.ONE]), "on a line"],
		[_guide(HapticGuide.FORM_PATH, [Vector3.ZERO, Vector3(NAN, 0, 0)]), "point 1"]
	]:
		var guide: HapticGuide = case[0]
		check(
			"\n".join(guide.get_problems()).contains(case[1]),
			"'%s' says '%s'" % [case[1], guide.get_problems()]
		)
		check_equal(guide.create_line_mesh().get_surface_count(), 0, "lines to look at")
		proxy.guide = guide
		check("\n".join(proxy.get_problems()).contains(case[1]), "%s" % [proxy.get_problems()])
		world.advance(0.05)
		check_near(proxy.get_force(), Vector3.ZERO, 1e-9, "force")
	var long := HapticGuide.new()
	var points := PackedVector3Array()
	for i in 4097:
		points.append(Vector3(i, 0, 0))
	long.points = points
	check("\n".join(long.get_problems()).contains("at most 4096"), str(long.get_problems()))


## The hand's own path leaves the guide's; what is felt leads back. Where the nearest place jumps it takes
## some ticks to turn.
func test_the_scene_with_a_guide_plays() -> void:
	var scene := add_scene("res://gallery/guide/guide.tscn")
	var world: HapticWorld = scene.get_node("HapticWorld")
	var proxy: ProxyPointer = world.get_node("ProxyPointer")
	var led := 0
	var astray := 0
	for _i in roundi(8.0 * 60.0):
		world.advance(1.0 / 60.0)
		var way := proxy.guide.get_place(proxy.get_hand_position()) - proxy.get_hand_position()
		if proxy.get_force().length() > 0.2 and not proxy.is_touching():
			if proxy.get_force().angle_to(way) < 0.1:
				led += 1
			else:
				astray += 1
	check(led > 100 and astray * 10 < led, "%d frames led, %d astray" % [led, astray])
	check_equal(world.get_problems().size(), 0, "problems: %s" % world.get_problems())
	scene.free()


func test_a_guide_along_a_curve_leads_along_it() -> void:
	var guide := _guide(HapticGuide.FORM_PATH, [])
	guide.curve = Curve3D.new()
	check("\n".join(guide.get_problems()).contains("too few points"), str(guide.get_problems()))
	guide.curve.add_point(Vector3(-0.1, 0.1, 0), Vector3.ZERO, Vector3(0.05, 0.05, 0))
	guide.curve.add_point(Vector3(0.1, 0.1, 0), Vector3(-0.05, 0.05, 0))
	check_equal(Array(guide.get_problems()), [], "problems")
	var middle := guide.curve.sample(0, 0.5)
	check_near(guide.get_place(middle + Vector3(0, 0.01, 0)), middle, 1e-3, "place in the middle")
	check_near(guide.get_place(Vector3(-1, 0.1, 0)), Vector3(-0.1, 0.1, 0), 1e-6, "its end")
	var seen := [0]
	guide.changed.connect(func() -> void: seen[0] += 1)
	guide.curve.set_point_position(1, Vector3(0.2, 0.1, 0))
	check_equal(seen[0], 1, "changes that were told")
	check_near(guide.get_place(Vector3(1, 0.1, 0)), Vector3(0.2, 0.1, 0), 1e-6, "its end, moved")
