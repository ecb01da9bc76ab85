@tool
extends Control
## The histogram of a loop's periods, from half of what is wanted to one and a half, logarithmic: single late
## ticks are seen beside a thousand punctual ones. Hidden while nothing has been counted.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const Plot := preload("plot.gd")

var _counts := PackedInt32Array()
var _period_us := 1000.0


func show_counts(counts: PackedInt32Array, period_us: float) -> void:
	_counts = counts
	_period_us = period_us
	visible = Array(counts).any(func(count: int) -> bool: return count > 0)
	queue_redraw()


func _draw() -> void:
	draw_rect(Rect2(Vector2.ZERO, size), Plot.PAPER)
	var most := 1
	for count in _counts:
		most = maxi(most, count)
	for i in _counts.size():
		if _counts[i] > 0:
			var height := size.y * 0.75 * log(1.0 + _counts[i]) / log(1.0 + most)
			var bar := Rect2(
				size.x * i / _counts.size(), size.y - height, size.x / _counts.size() - 1.0, height
			)
			draw_rect(bar, Plot.COLORS[0])
	draw_line(Vector2(0.5 * size.x, 0.25 * size.y), Vector2(0.5 * size.x, size.y), Plot.WORDS)
	var head: Dictionary = words()[0]
	draw_string(
		get_theme_default_font(),
		head.at,
		head.text,
		HORIZONTAL_ALIGNMENT_LEFT,
		-1,
		Plot.FONT_SIZE,
		head.color
	)


## All that is written, as a plot's.
func words() -> Array[Dictionary]:
	var head := "periods   %d … %d µs, of the last second" % [0.5 * _period_us, 1.5 * _period_us]
	return [{text = head, at = Vector2(Plot.MARGIN, Plot.LINE - 2), color = Plot.WORDS}]
