extends Node
## Tells the editor's Tactus dock what a scene does that the editor has started, while the dock is looked at.
## The first HapticWorld of a running program adds it. Any other program it leaves at once.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const Figures := preload("figures.gd")
const Monitors := preload("monitors.gd")
const EVERY := 0.1  # seconds
const HISTOGRAM_EVERY := 10  # of those

var _figures := Figures.new()
var _waited := 0.0
var _count := 0


func _ready() -> void:
	set_process(false)
	if not EngineDebugger.is_active():
		queue_free()
		return
	Monitors.add(get_tree())
	EngineDebugger.register_message_capture("tactus", _take)
	EngineDebugger.send_message("tactus:ready", [])


func _exit_tree() -> void:
	if EngineDebugger.has_capture("tactus"):
		EngineDebugger.unregister_message_capture("tactus")


func _take(message: String, data: Array) -> bool:
	if message == "watch":
		set_process(data[0])
	return message == "watch"


func _process(delta: float) -> void:
	_waited += delta
	if _waited < EVERY:
		return
	_waited = 0.0
	_count += 1
	EngineDebugger.send_message("tactus:figures", [_figures.of(get_tree())])
	if _count % HISTOGRAM_EVERY == 0:
		EngineDebugger.send_message("tactus:histograms", [_figures.histograms()])
