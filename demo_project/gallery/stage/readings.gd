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
	var line := "force %4.2f N" % pointer.get_force().length()
	if pointer is HapticTool:
		line += "   torque %5.3f Nm" % pointer.get_torque().length()
	return "%s   %s" % [line, pointer.get_state_text()]
