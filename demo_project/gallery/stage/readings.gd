extends Label
## What the hand feels and how evenly the loop ticks, ten times a second.

const SECONDS := 0.1

var _waited := SECONDS
var _pointers: Array[Node] = []


func _process(delta: float) -> void:
	_waited += delta
	var world: HapticWorld = owner.world
	if _waited < SECONDS or not is_visible_in_tree() or world == null:
		return
	_waited = 0.0
	if _pointers.is_empty():
		for kind: String in ["ProxyPointer", "HapticTool"]:
			_pointers.append_array(world.find_children("*", kind, true, false))
	var lines := PackedStringArray(_pointers.map(_line_of))
	var figures := world.get_statistics()
	if figures.has("mean_period_us"):
		lines.append(
			(
				"tick %.1f µs mean, %.1f µs p99, %.1f µs of work p99, %d missed"
				% [
					figures.mean_period_us,
					figures.tick_period_p99_us,
					figures.tick_compute_p99_us,
					figures.missed_deadlines
				]
			)
		)
	text = "\n".join(lines)


func _line_of(pointer: Node3D) -> String:
	var force: float = pointer.get_force().length()
	var line := "force %4.2f N" % force
	var device := pointer.device_node as HapticDevice
	var shown := device.get_displayed_force().length() if device != null else force
	if shown < device.get_requested_force().length() - 0.01:
		line += " (%4.2f N displayed)" % shown
	if pointer is HapticTool:
		line += "   torque %5.3f Nm" % pointer.get_torque().length()
	return "%s   %s" % [line, pointer.get_state_text()]
