extends RefCounted
## Everything haptic in a scene tree in figures, plain enough to be sent to another process: the same are
## plotted by the overlay beside the scene and by the editor's dock.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const KINDS := ["HapticWorld", "MMTLink", "HapticDevice", "ProxyPointer", "HapticDepthSensor"]
## Nodes are looked for this often, in milliseconds; looking through a large tree takes a while.
const SEARCH_EVERY := 1000
## Bins of the histogram of periods, in shares of the period that is wanted: 0.5 to 1.5.
const BINS := 40

var _nodes := {}
var _searched := -SEARCH_EVERY
var _counted := {}  # by a world's id: how many periods lie below each bin's upper end, as of the last time


## Of now. {"time": s, "worlds" | "links" | "devices" | "pointers" | "sensors": {path: {figure: value}}}.
func of(tree: SceneTree) -> Dictionary:
	_search(tree)
	return {
		"time": Time.get_ticks_usec() * 1e-6,
		"worlds": _each("HapticWorld", _of_world),
		"links": _each("MMTLink", _of_link),
		"devices": _each("HapticDevice", _of_device),
		"pointers": _each("ProxyPointer", _of_pointer),
		"sensors": _each("HapticDepthSensor", _of_sensor),
	}


func _search(tree: SceneTree) -> void:
	var now := Time.get_ticks_msec()
	if now - _searched < SEARCH_EVERY:
		return
	_searched = now
	for kind: String in KINDS:
		_nodes[kind] = tree.root.find_children("*", kind, true, false)


func _each(kind: String, figures: Callable) -> Dictionary:
	var found := {}
	for node: Variant in _nodes[kind]:
		if is_instance_valid(node) and node.is_inside_tree():
			found[String(node.get_path()).trim_prefix("/root/")] = figures.call(node)
	return found


func _of_world(world: HapticWorld) -> Dictionary:
	var statistics := world.get_statistics()
	return {
		"period_us": 1e6 / world.tick_rate,
		"ticks": world.get_ticks(),
		"work_p50_us": statistics.get("tick_compute_p50_us", 0.0),
		"work_p99_us": statistics.get("tick_compute_p99_us", 0.0),
		"period_p99_us": statistics.get("tick_period_p99_us", 0.0),
		"missed": statistics.get("missed_deadlines", 0),
		"bodies": statistics.get("bodies", 0),
		"awake": statistics.get("awake_bodies", 0),
	}


func _of_link(link: MMTLink) -> Dictionary:
	var statistics := link.get_statistics()
	return {
		"text": link.get_state_text(),
		"round_trip_ms": 1e3 * statistics.round_trip_s,
		"jitter_ms": 1e3 * statistics.one_way_jitter_s,
		"lost_percent": 100.0 * statistics.packets_lost_there,
		"packets_per_s": statistics.packets_received_per_s,
		"corrections": statistics.get("corrections", 0),
		"moved_mm": 1e3 * statistics.get("corrections_moved_m", 0.0),
		"jnds": statistics.get("corrections_jnds", 0.0),
		"tank_mj": 1e3 * statistics.get("energy_tank_j", 0.0),
		"hidden_mj": 1e3 * statistics.get("energy_hidden_j", 0.0),
	}


func _of_device(device: HapticDevice) -> Dictionary:
	return {
		"text": device.get_state_text(),
		"force_n": device.get_force().length(),
		"displayed_n": device.get_displayed_force().length(),
		"cuts": _sum(device.get_force_cuts()),
		"energy_mj": 1e3 * device.get_energy(),
	}


func _sum(counts: Dictionary) -> int:
	var sum := 0
	for count: int in counts.values():
		sum += count
	return sum


func _of_pointer(pointer: ProxyPointer) -> Dictionary:
	return {
		"text": pointer.get_state_text(),
		"force_n": pointer.get_force().length(),
		"depth_mm": 1e3 * pointer.get_hand_position().distance_to(pointer.get_proxy_position()),
	}


func _of_sensor(sensor: HapticDepthSensor) -> Dictionary:
	return {
		"text": sensor.get_state_text(),
		"frame_ms": 1e3 * sensor.frame_time,
		"confidence": sensor.lowest_confidence,
	}


## How many of each world's periods since the last call lie in each bin of its histogram; it takes a while.
func histograms() -> Dictionary:
	var found := {}
	for node: Variant in _nodes.get("HapticWorld", []):
		if is_instance_valid(node) and node.is_inside_tree():
			found[String(node.get_path()).trim_prefix("/root/")] = _histogram(node)
	return found


func _histogram(world: HapticWorld) -> PackedInt32Array:
	var distribution := world.get_period_distribution()
	if distribution.is_empty():
		return PackedInt32Array()
	var below := counts_below(
		distribution, 1e6 / world.tick_rate, world.get_statistics().get("measured_ticks", 0)
	)
	var before: PackedInt32Array = _counted.get(world.get_instance_id(), PackedInt32Array())
	_counted[world.get_instance_id()] = below
	var has_begun_anew := before.size() == BINS and before[-1] > below[-1]
	var bins := PackedInt32Array()
	bins.resize(BINS)
	for i in BINS:
		var upper := below[i] - (0 if before.is_empty() or has_begun_anew else before[i])
		var lower := 0
		if i > 0:
			lower = below[i - 1] - (0 if before.is_empty() or has_begun_anew else before[i - 1])
		bins[i] = upper - lower
	return bins


## How many of `count` periods are no longer than the upper end of each bin; the last one has all.
static func counts_below(distribution: Dictionary, period_us: float, count: int) -> PackedInt32Array:
	var ends: PackedFloat64Array = distribution.period_us
	var shares: PackedFloat64Array = distribution.share
	var below := PackedInt32Array()
	for i in BINS:
		var end := period_us * (0.5 + float(i + 1) / BINS)
		var step := ends.bsearch(end, false)
		var share := shares[step - 1] if step > 0 else 0.0
		below.append(count if i == BINS - 1 else roundi(share * count))
	return below
