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
const LINE := FONT_SIZE + 4
const MARGIN := 6.0
## Height of the curves where there is little room, in pixels.
const LEAST := 26.0
## What a larger value may exceed the top of the scale by: a loop of 1000.9 Hz is one of 1000.
const TOLERANCE := 1.05

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
		if largest <= factor * power * TOLERANCE:
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
	var area := _draw_words("%s   %s … %s %s" % [title, String.num(bottom, 3), String.num(top, 3), unit])
	for i: int in 4:
		var y := area.position.y + area.size.y * i / 4
		draw_line(Vector2(0, y), Vector2(size.x, y), GRID)
	if bottom < 0.0:
		var zero := area.position.y + area.size.y * top / (top - bottom)
		draw_line(Vector2(0, zero), Vector2(size.x, zero), WORDS)
	var index := 0
	for curve: String in _values:
		_draw_curve(curve, now, Vector2(bottom, top), area, COLORS[index % COLORS.size()])
		index += 1


## The title and, in as many lines as they need, the names of the curves with their last values. Returns what
## is left for the curves.
func _draw_words(head: String) -> Rect2:
	var font := get_theme_default_font()
	var width := size.x - 2 * MARGIN
	draw_string(font, Vector2(MARGIN, LINE - 2), head, HORIZONTAL_ALIGNMENT_LEFT, width, FONT_SIZE, WORDS)
	var place := Vector2(MARGIN, LINE - 2)
	var index := 0
	for curve: String in _values:
		var legend := "%s %s" % [curve, String.num(_values[curve][-1], 2)]
		var wide := font.get_string_size(legend, HORIZONTAL_ALIGNMENT_LEFT, -1, FONT_SIZE).x
		if index == 0 or place.x + wide > width:
			place = Vector2(MARGIN, place.y + LINE)
		draw_string(
			font, place, legend, HORIZONTAL_ALIGNMENT_LEFT, width, FONT_SIZE, COLORS[index % COLORS.size()]
		)
		place.x += wide + 2 * MARGIN
		index += 1
	var used := place.y + MARGIN
	var needed := used + LEAST
	if not is_equal_approx(custom_minimum_size.y, needed):
		set_deferred("custom_minimum_size", Vector2(custom_minimum_size.x, needed))
	return Rect2(0, used, size.x, maxf(0.0, size.y - used))


func _draw_curve(curve: String, now: float, scale_ends: Vector2, area: Rect2, color: Color) -> void:
	var points := PackedVector2Array()
	for i: int in _values[curve].size():
		var x: float = size.x * (1.0 - (now - _times[curve][i]) / seconds)
		var up := inverse_lerp(scale_ends.x, scale_ends.y, _values[curve][i])
		points.append(Vector2(x, area.position.y + area.size.y * (1.0 - clampf(up, 0.0, 1.0))))
	if points.size() > 1:
		draw_polyline(points, color, 1.5, true)
