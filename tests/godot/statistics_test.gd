extends "link_case.gd"
## Statistics in objects by group: typed properties that cannot be set, by the keys of get_statistics().

## Of each class, the methods that return a group; what is in none.
const GROUPS := {
	"HapticWorld": ["get_load_statistics", "get_timing_statistics"],
	"MMTLink":
	["get_model_statistics", "get_network_statistics", "get_passivity_statistics", "get_playout_statistics"],
	"HapticDepthSensor": ["get_sensing_statistics"]
}
const IN_NO_GROUP := ["state", "state_text"]
## Properties with another name than their key.
const RENAMED := {"refused_handshakes": "refused_strangers"}


func _properties_of(kind: String) -> Array:
	return ClassDB.class_get_property_list(kind, true).filter(
		func(property: Dictionary) -> bool: return property.type != TYPE_NIL
	)


## Each figure of the node is in one group, with its value.
func _check_groups(node: Node, when: String) -> void:
	var all: Dictionary = node.get_statistics()
	var seen := PackedStringArray(IN_NO_GROUP)
	for method: String in GROUPS[node.get_class()]:
		var group: HapticStatistics = node.call(method)
		var values := group.to_dictionary()
		for property in _properties_of(group.get_class()):
			var key: String = RENAMED.get(property.name, property.name)
			var value: Variant = group.get(property.name)
			check_equal(typeof(value), property.type, "type of " + key)
			check_equal(values.has(key), all.has(key), "%s: presence of %s" % [when, key])
			if all.has(key):
				check_equal(value, all[key], "%s: %s" % [when, key])
				seen.append(key)
			else:
				check(not value, "%s: %s is %s without a figure" % [when, key, value])
	for key: String in all:
		check_equal(seen.count(key), 1, "%s: groups of %s" % [when, key])


func test_groups_have_what_the_dictionary_has() -> void:
	await _connect(MMTLink.SCENARIO_MMT, 0.02)
	add_floor(_far)
	_add_hands(0.1)
	_advance(0.4)
	for world: HapticWorld in [_operator, _far]:
		_check_groups(world, world.name)
		_check_groups(world.get_node("Link"), world.name)
	check(_operator.get_load_statistics().ticks == 400, "ticks")
	check(
		_here.get_network_statistics().packets_received > 20,
		"packets: %d" % _here.get_network_statistics().packets_received
	)
	check_near(_here.get_network_statistics().one_way_delay_s, 0.01, 0.002, "one-way delay")
	check(_there.get_playout_statistics().samples_exact > 100, "samples")
	check(_here.get_model_statistics().objects == 1, "objects")
	check(_here.get_passivity_statistics().energy_hand_j != 0.0, "energy")


func test_a_world_in_real_time_has_its_timing() -> void:
	var world := HapticWorld.new()
	add_child(world)
	await until(func() -> bool: return world.get_ticks() > 50, 10.0)
	var timing := world.get_timing_statistics()
	check(timing.measured_ticks > 0 and timing.mean_period_us > 100.0, "ticks: %s" % timing.measured_ticks)
	check(not timing.realtime.is_empty(), "nothing is said of what the system granted")
	var before := timing.measured_ticks
	await until(func() -> bool: return world.get_ticks() > 100, 10.0)
	check_equal(timing.measured_ticks, before, "ticks of the object from before")
	world.free()


func test_without_a_run_every_figure_is_zero() -> void:
	var world := HapticWorld.new()
	check_equal(world.get_load_statistics().to_dictionary(), {}, "figures")
	check_equal(world.get_load_statistics().ticks, 0, "ticks")
	check_equal(world.get_timing_statistics().realtime, "", "text")
	world.free()
	var sensor := HapticDepthSensor.new()
	_check_groups(sensor, "a closed sensor")
	sensor.free()


## The editor completes names by these types, and what is of another type does not compile.
func test_a_typed_script_knows_the_properties() -> void:
	for line: String in ["timing.tick_period_p99_us", "timing.realtime"]:
		var script := GDScript.new()
		script.source_code = (
			"""extends RefCounted
func of(world: HapticWorld) -> float:
	var timing := world.get_timing_statistics()
	return %s
"""
			% line
		)
		if line == "timing.realtime":
			expect_error("String")
		check_equal(script.reload() == OK, line.ends_with("_us"), line)


func test_no_property_can_be_set() -> void:
	var load_statistics := HapticLoadStatistics.new()
	load_statistics.set("ticks", 5)
	check_equal(load_statistics.ticks, 0, "ticks")
	load_statistics.to_dictionary()["ticks"] = 5
	check_equal(load_statistics.ticks, 0, "ticks of the copy")
