@tool
extends Control
## Curves over the last seconds, with a scale that fits them; hidden while there is none.
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
const LEAST := 22.0
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
	show()
	queue_redraw()


func has(curve: String) -> bool:
	return _values.has(curve)


func clear() -> void:
	_times.clear()
	_values.clear()
	hide()


## The top of the scale: 1, 2 or 5 times a power of ten.
static func top_for(largest: float) -> float:
	if largest <= 0.0:
		return 1.0
	var power := pow(10.0, floorf(log(largest) / log(10.0)))
	for factor: float in [1.0, 2.0, 5.0]:
		if largest <= factor * power * TOLERANCE:
			return factor * power
	return 10.0 * power


## A figure with three digits that count, without trailing zeros.
static func in_short(value: float) -> String:
	var digits := 2 - floori(log(maxf(absf(value), 1e-2)) / log(10.0) + 1e-9)
	var text := String.num(value, clampi(digits, 0, 3))
	return text.trim_suffix(".0")


## All that is written, from top to bottom: {text, at (its baseline), color}, its texts within the width.
func words() -> Array[Dictionary]:
	var scale_ends := _scale_ends()
	var written := _head("%s … %s %s" % [in_short(scale_ends.x), in_short(scale_ends.y), unit])
	var heads := written.size()
	var place: Vector2 = written[-1].at
	for curve: String in _values:
		var legend := _shortened(curve, " " + in_short(_values[curve][-1]))
		var wide := _width_of(legend)
		if written.size() == heads or place.x + wide > size.x - MARGIN:
			place = Vector2(MARGIN, place.y + LINE)
		written.append({text = legend, at = place, color = COLORS[(written.size() - heads) % COLORS.size()]})
		place.x += wide + 2 * MARGIN
	return written


## The title and the scale, in two lines where one would be wider than the plot.
func _head(scale_text: String) -> Array[Dictionary]:
	var written: Array[Dictionary] = []
	var whole := "%s   %s" % [title, scale_text]
	var lines := [whole] if _width_of(whole) <= size.x - 2 * MARGIN else [title, scale_text]
	for line: String in lines:
		written.append({text = line, at = Vector2(MARGIN, (written.size() + 1) * LINE - 2), color = WORDS})
	return written


func _width_of(text: String) -> float:
	return get_theme_default_font().get_string_size(text, HORIZONTAL_ALIGNMENT_LEFT, -1, FONT_SIZE).x


## A name and what follows it; where that is wider than the plot, without the beginning of the name.
func _shortened(whole: String, rest: String) -> String:
	var shown := whole
	var text := shown + rest
	while shown.length() > 1 and _width_of(text) > size.x - 2 * MARGIN:
		shown = shown.substr(1)
		text = "…" + shown + rest
	return text


func _scale_ends() -> Vector2:
	var largest := at_least
	var least := 0.0
	for curve: String in _values:
		for value: float in _values[curve]:
			largest = maxf(largest, value)
			least = minf(least, value)
	var top := at_least if largest <= at_least else top_for(largest)
	return Vector2(-top_for(-least) if least < 0.0 else 0.0, top)


func _draw() -> void:
	draw_rect(Rect2(Vector2.ZERO, size), PAPER)
	var scale_ends := _scale_ends()
	var area := _draw_words()
	for i: int in 4:
		var y := area.position.y + area.size.y * i / 4
		draw_line(Vector2(0, y), Vector2(size.x, y), GRID)
	if scale_ends.x < 0.0:
		var zero := area.position.y + area.size.y * scale_ends.y / (scale_ends.y - scale_ends.x)
		draw_line(Vector2(0, zero), Vector2(size.x, zero), WORDS)
	var now := 0.0
	for curve: String in _times:
		now = maxf(now, _times[curve][-1])
	var index := 0
	for curve: String in _values:
		_draw_curve(curve, now, scale_ends, area, COLORS[index % COLORS.size()])
		index += 1


## Returns what is left for the curves.
func _draw_words() -> Rect2:
	var used := 0.0
	for word in words():
		draw_string(
			get_theme_default_font(), word.at, word.text, HORIZONTAL_ALIGNMENT_LEFT, -1, FONT_SIZE, word.color
		)
		used = word.at.y + MARGIN
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
