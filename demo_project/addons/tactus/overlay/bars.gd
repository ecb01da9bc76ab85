@tool
extends "plot.gd"
## The histogram of a loop's periods, from half of what is wanted to one and a half, logarithmic: single late
## ticks are seen beside a thousand punctual ones. Hidden while nothing has been counted.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

var _counts := PackedInt32Array()
var _period_us := 1000.0


func show_counts(counts: PackedInt32Array, period_us: float) -> void:
	_counts = counts
	_period_us = period_us
	visible = Array(counts).any(func(count: int) -> bool: return count > 0)
	queue_redraw()


func words() -> Array[Dictionary]:
	return _head("%s … %s %s" % [in_short(0.5 * _period_us), in_short(1.5 * _period_us), unit])


func _draw() -> void:
	draw_rect(Rect2(Vector2.ZERO, size), PAPER)
	var area := _draw_words()
	var most := 1
	for count in _counts:
		most = maxi(most, count)
	for i in _counts.size():
		if _counts[i] > 0:
			var height := area.size.y * log(1.0 + _counts[i]) / log(1.0 + most)
			var wide := size.x / _counts.size()
			draw_rect(Rect2(wide * i, area.end.y - height, wide - 1.0, height), COLORS[0])
	draw_line(Vector2(0.5 * size.x, area.position.y), Vector2(0.5 * size.x, area.end.y), WORDS)
