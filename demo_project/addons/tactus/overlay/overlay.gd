extends CanvasLayer
## Shows beside any scene what its haptic loop does: plots over time, and in the scene itself forces, contacts
## and trails. Add this scene to yours. Hidden it costs nothing.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

## How much of the window's right it covers, in pixels; none while it is hidden.
signal room_taken(width: float)

const Figures := preload("figures.gd")
const Monitors := preload("monitors.gd")
const EVERY := 0.1  # seconds
const HISTOGRAM_EVERY := 1.0  # seconds
const COLUMN := 340.0  # pixels
const MARGIN := 16.0  # pixels

## Shows and hides it.
@export var key: Key = KEY_F3
## Records the stages of every tick for a while, for Perfetto or chrome://tracing.
@export var trace_key: Key = KEY_F4
## Draws the boxes of the trees that triangles are looked for in around the hands, and no more.
@export var boxes_key: Key = KEY_F5
@export_range(0.1, 60.0, 0.1, "suffix:s") var trace_seconds := 5.0
## Where traces go.
@export_dir var trace_folder := "user://"
@export var shown := false:
	set(value):
		shown = value
		_show()

var _figures: Figures
var _waited := EVERY
var _histogram_waited := HISTOGRAM_EVERY
var _recorder: HapticRecorder


func _ready() -> void:
	Monitors.add(get_tree())
	var keys := [key, trace_key, boxes_key].map(OS.get_keycode_string)
	%Keys.text = "%s: hide   %s: trace   %s: boxes of trees" % keys
	get_viewport().size_changed.connect(_lay_out.bind(1))
	_show()


func _show() -> void:
	if not is_node_ready():
		return
	visible = shown
	set_process(shown)
	%Drawing.set_enabled(shown)
	_figures = Figures.new() if shown else null
	if not shown:
		%Panel.clear()
	_lay_out(1)


func _lay_out(columns: int) -> void:
	%Panel.columns = columns
	%Panel.offset_left = -MARGIN - COLUMN * columns
	room_taken.emit(MARGIN - %Panel.offset_left if shown else 0.0)


## What does not fit below each other stands beside each other.
func _keep_within_window() -> void:
	var room := get_viewport().get_visible_rect().size - 2.0 * Vector2(MARGIN, MARGIN)
	var is_too_high: bool = %Panel.get_combined_minimum_size().y > room.y
	if is_too_high and COLUMN * (%Panel.columns + 1) <= room.x:
		_lay_out(%Panel.columns + 1)


func _process(delta: float) -> void:
	_waited += delta
	_histogram_waited += delta
	if _waited < EVERY:
		return
	_waited = 0.0
	%Panel.show_figures(_figures.of(get_tree()))
	if _histogram_waited >= HISTOGRAM_EVERY:
		_histogram_waited = 0.0
		%Panel.show_histograms(_figures.histograms())
	_keep_within_window()


func _unhandled_key_input(event: InputEvent) -> void:
	var pressed := event as InputEventKey
	if pressed == null or not pressed.pressed or pressed.echo:
		return
	if pressed.keycode == key:
		shown = not shown
	elif pressed.keycode == trace_key:
		record_trace()
	elif pressed.keycode == boxes_key and shown:
		%Drawing.draws_boxes = not %Drawing.draws_boxes
	else:
		return
	get_viewport().set_input_as_handled()


## Begins a trace of the first pointer's world; one at a time. Returns the file that it will be in; empty
## where there is nothing to trace.
func record_trace() -> String:
	var pointers := get_tree().root.find_children("*", "ProxyPointer", true, false)
	if _recorder != null or pointers.is_empty():
		return ""
	_recorder = HapticRecorder.new()
	_recorder.autostart = false
	_recorder.trace_seconds = trace_seconds
	var file := "trace_%s.json" % Time.get_datetime_string_from_system().replace(":", "-")
	_recorder.trace_path = trace_folder.path_join(file)
	pointers[0].add_sibling(_recorder)
	_recorder.proxy = _recorder.get_path_to(pointers[0])
	if not _recorder.start():
		_end_trace()
		return ""
	%Note.text = "Tracing for %.1f s …" % trace_seconds
	%Note.show()
	get_tree().create_timer(trace_seconds).timeout.connect(_end_trace)
	return _recorder.trace_path


func _end_trace() -> void:
	if not is_instance_valid(_recorder):
		_recorder = null
		return
	_recorder.stop()
	%Note.text = "Trace: %s" % ProjectSettings.globalize_path(_recorder.trace_path)
	_recorder.queue_free()
	_recorder = null
