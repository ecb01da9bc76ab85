@tool
extends Control
## Curves over the last seconds, with a scale that fits them.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const PAPER := Color(0.07, 0.08, 0.1, 0.85)
const GRID := Color(1.0, 1.0, 1.0, 0.1)
const WORDS := Color(1.0, 1.0, 1.0, 0.75)
const COLORS: Array[Color] = [
	Color(0.35, 0.75, 1.0), Color(1.0, 0.6, 0.2), Color(0.5, 0.85, 0.4), Color(0.95, 0.45, 0.65)
]
const FONT_SIZE := 12

@export var title := ""
@export var unit := ""
## The scale never shows less than this.
@export var at_least := 1.0
@export var seconds := 30.0

var _times := {}  # by curve: PackedFloat64Array
var _values := {}


func add(curve: String, time: float, value: float) -> void:
	if not _times.has(curve):
		_times[curve] = PackedFloat64Array()
		_values[curve] = PackedFloat64Array()
	_times[curve].append(time)
	_values[curve].append(value)
	var gone: int = _times[curve].bsearch(time - seconds)
	if gone > 0:
		_times[curve] = _times[curve].slice(gone)
		_values[curve] = _values[curve].slice(gone)
	queue_redraw()


func clear() -> void:
	_times.clear()
	_values.clear()
	queue_redraw()


## The top of the scale: 1, 2 or 5 times a power of ten.
static func top_for(largest: float) -> float:
	if largest <= 0.0:
		return 1.0
	var power := pow(10.0, floorf(log(largest) / log(10.0)))
	for factor: float in [1.0, 2.0, 5.0]:
		if largest <= factor * power * 1.0001:
			return factor * power
	return 10.0 * power


func _draw() -> void:
	draw_rect(Rect2(Vector2.ZERO, size), PAPER)
	var largest := at_least
	var least := 0.0
	var now := 0.0
	for curve: String in _values:
		for value: float in _values[curve]:
			largest = maxf(largest, value)
			least = minf(least, value)
		now = maxf(now, _times[curve][-1])
	var top := top_for(largest)
	var bottom := -top_for(-least) if least < 0.0 else 0.0
	var font := get_theme_default_font()
	for i: int in [1, 2, 3]:
		draw_line(Vector2(0, size.y * i / 4), Vector2(size.x, size.y * i / 4), GRID)
	if bottom < 0.0:
		var zero := size.y * top / (top - bottom)
		draw_line(Vector2(0, zero), Vector2(size.x, zero), WORDS)
	var head := "%s   %s … %s %s" % [title, String.num(bottom, 3), String.num(top, 3), unit]
	draw_string(font, Vector2(6, FONT_SIZE + 2), head, HORIZONTAL_ALIGNMENT_LEFT, -1, FONT_SIZE, WORDS)
	var place := Vector2(6, 2 * FONT_SIZE + 5)
	var index := 0
	for curve: String in _values:
		var color := COLORS[index % COLORS.size()]
		_draw_curve(curve, now, Vector2(bottom, top), color)
		var legend := "%s %s" % [curve, String.num(_values[curve][-1], 2)]
		draw_string(font, place, legend, HORIZONTAL_ALIGNMENT_LEFT, -1, FONT_SIZE, color)
		place.x += font.get_string_size(legend, HORIZONTAL_ALIGNMENT_LEFT, -1, FONT_SIZE).x + 14
		index += 1


func _draw_curve(curve: String, now: float, scale_ends: Vector2, color: Color) -> void:
	var points := PackedVector2Array()
	for i: int in _values[curve].size():
		var x: float = size.x * (1.0 - (now - _times[curve][i]) / seconds)
		var up := inverse_lerp(scale_ends.x, scale_ends.y, _values[curve][i])
		points.append(Vector2(x, size.y * (1.0 - clampf(up, 0.0, 1.0))))
	if points.size() > 1:
		draw_polyline(points, color, 1.5, true)
