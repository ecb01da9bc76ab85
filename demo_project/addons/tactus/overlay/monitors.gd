extends RefCounted
## Godot's own performance monitors (Debugger, Monitors) of what is haptic. They are asked for only while
## somebody looks at them.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const PREFIX := "tactus/"

static var _ticks := 0
static var _asked_at := 0


## Once is enough; more do no harm.
static func add(tree: SceneTree) -> void:
	var monitors := {
		"ticks_per_s": _ticks_per_s,
		"work_p99_us": _of_world.bind("tick_compute_p99_us"),
		"period_p99_us": _of_world.bind("tick_period_p99_us"),
		"missed_deadlines": _of_world.bind("missed_deadlines"),
		"awake_bodies": _of_world.bind("awake_bodies"),
		"force_n": _force,
		"round_trip_ms": _round_trip_ms,
	}
	for name: String in monitors:
		if not Performance.has_custom_monitor(PREFIX + name):
			Performance.add_custom_monitor(PREFIX + name, monitors[name], [tree])


static func remove() -> void:
	for name in Performance.get_custom_monitor_names():
		if String(name).begins_with(PREFIX):
			Performance.remove_custom_monitor(name)


static func _first(tree: SceneTree, kind: String) -> Node:
	var found := tree.root.find_children("*", kind, true, false)
	return null if found.is_empty() else found[0]


static func _ticks_per_s(tree: SceneTree) -> float:
	var world := _first(tree, "HapticWorld") as HapticWorld
	var ticks := 0 if world == null else world.get_ticks()
	var now := Time.get_ticks_usec()
	var rate := 1e6 * (ticks - _ticks) / maxf(1.0, now - _asked_at)
	_ticks = ticks
	_asked_at = now
	return maxf(0.0, rate)


static func _of_world(tree: SceneTree, figure: String) -> float:
	var world := _first(tree, "HapticWorld") as HapticWorld
	return 0.0 if world == null else float(world.get_statistics().get(figure, 0.0))


static func _force(tree: SceneTree) -> float:
	var pointer := _first(tree, "ProxyPointer") as ProxyPointer
	return 0.0 if pointer == null else pointer.get_force().length()


static func _round_trip_ms(tree: SceneTree) -> float:
	var link := _first(tree, "MMTLink") as MMTLink
	return 0.0 if link == null else 1e3 * float(link.get_statistics().round_trip_s)
