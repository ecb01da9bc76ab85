extends Control
## Measures this machine for some seconds and reports: the loop, real-time rights, devices, their libraries,
## and what is missing with how to get it. No force is given to any device.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

signal finished(report: String)

const DRIVERS := {
	"Novint Falcon": HapticDevice.DRIVER_FALCON,
	"Force Dimension": HapticDevice.DRIVER_FORCE_DIMENSION,
	"3D Systems Touch": HapticDevice.DRIVER_OPENHAPTICS,
	"Haply Inverse3": HapticDevice.DRIVER_INVERSE3,
}

@export_range(0.5, 60.0, 0.5, "suffix:s") var seconds := 5.0

var _devices := {}  # by name: HapticDevice

@onready var _world: HapticWorld = %HapticWorld


func _ready() -> void:
	%Copy.pressed.connect(func() -> void: DisplayServer.clipboard_set(%Report.text))
	for title: String in DRIVERS:
		var device := HapticDevice.new()
		device.force_limit = 0.0
		device.driver = DRIVERS[title]
		_world.add_child(device)
		_devices[title] = device
	%Report.text = "Measuring for %.0f s …" % seconds
	await get_tree().create_timer(1.0).timeout
	_world.reset_statistics()
	await get_tree().create_timer(seconds).timeout
	%Report.text = report()
	print(%Report.text)
	finished.emit(%Report.text)


func report() -> String:
	var lines := PackedStringArray()
	lines.append("Tactus %s" % version())
	var engine := Engine.get_version_info()
	lines.append("Godot %s" % engine.string)
	lines.append("System: %s %s, %s" % [OS.get_name(), OS.get_version(), OS.get_processor_name()])
	lines.append("Processors: %d" % OS.get_processor_count())
	lines.append("")
	lines.append_array(_of_the_loop())
	lines.append("")
	lines.append_array(_of_devices())
	return "\n".join(lines)


## The newest one in the addon's list of changes; where that is not there, as in a clone, none.
func version() -> String:
	var folder: String = (get_script() as Script).resource_path.get_base_dir()
	for line in FileAccess.get_file_as_string(folder.path_join("../CHANGELOG.md").simplify_path()).split(
		"\n"
	):
		if line.begins_with("## "):
			return line.trim_prefix("## ")
	return "from source"


func _of_the_loop() -> PackedStringArray:
	var figures := _world.get_timing_statistics()
	if figures.measured_ticks == 0:
		return ["Loop: no tick was made. %s" % "; ".join(_world.get_problems())]
	var rate: float = 1e6 / figures.mean_period_us
	var lines := PackedStringArray()
	lines.append("Loop: %.1f ticks a second of %d wanted" % [rate, _world.tick_rate])
	lines.append(
		(
			"Start of a tick: half at most %.0f µs late, 99 %% at most %.0f µs, the latest %.0f µs"
			% [figures.tick_lateness_p50_us, figures.tick_lateness_p99_us, figures.tick_lateness_max_us]
		)
	)
	lines.append("Deadlines missed: %d of %d" % [figures.missed_deadlines, figures.measured_ticks])
	lines.append("Real-time rights: %s" % ("granted" if figures.fifo else "not granted"))
	lines.append(figures.realtime)
	return lines


func _of_devices() -> PackedStringArray:
	var lines := PackedStringArray()
	var found := HapticDevice.find_devices()
	lines.append("Plugged in by USB: %d" % found.size())
	for device: Dictionary in found:
		lines.append("    %s %s" % [device.name, device.id])
	for title: String in _devices:
		lines.append("%s: %s" % [title, _devices[title].get_state_text()])
	for pad in Input.get_connected_joypads():
		lines.append("Gamepad %d: %s" % [pad, Input.get_joy_name(pad)])
	lines.append("Depth cameras: %s" % _cameras())
	return lines


func _cameras() -> String:
	var found := HapticDepthSensor.find_cameras()
	return "none found" if found.is_empty() else ", ".join(found.keys())
