extends Label
## What the hand feels and how evenly the loop ticks.

@export var world: HapticWorld
## A ProxyPointer or a HapticTool.
@export var proxy: Node3D


func _process(_delta: float) -> void:
	var force: Vector3 = proxy.get_force()
	var lines := PackedStringArray()
	lines.append("%s   force %5.2f N" % [proxy.get_state_text(), force.length()])
	if proxy is HapticTool:
		lines[0] += "   torque %5.3f Nm" % proxy.get_torque().length()
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
