extends Control
## How large two forces have been in the last seconds: on the hand, and at the far side.

const SECONDS := 6.0
const MOST_NEWTONS := 10.0
const LINES := 5
const PAPER := Color(0.07, 0.08, 0.1, 1.0)
const GRID := Color(1.0, 1.0, 1.0, 0.08)

@export var hand_color := Color(0.35, 0.75, 1.0)
@export var far_color := Color(1.0, 0.6, 0.2)

var _times := PackedFloat64Array()
var _hand := PackedFloat64Array()
var _far := PackedFloat64Array()


func add(time: float, hand: float, far: float) -> void:
	_times.append(time)
	_hand.append(hand)
	_far.append(far)
	while _times[0] < time - SECONDS:
		_times.remove_at(0)
		_hand.remove_at(0)
		_far.remove_at(0)
	queue_redraw()


func _draw() -> void:
	draw_rect(Rect2(Vector2.ZERO, size), PAPER)
	var font := get_theme_default_font()
	for i in range(1, LINES):
		var y := size.y * i / LINES
		draw_line(Vector2(0, y), Vector2(size.x, y), GRID)
		var newtons := "%d N" % roundi(MOST_NEWTONS * (LINES - i) / LINES)
		draw_string(font, Vector2(6, y - 3), newtons, HORIZONTAL_ALIGNMENT_LEFT, -1, 11, Color(1, 1, 1, 0.4))
	_draw_curve(_far, far_color)
	_draw_curve(_hand, hand_color)


func _draw_curve(values: PackedFloat64Array, color: Color) -> void:
	if values.size() < 2:
		return
	var points := PackedVector2Array()
	for i in values.size():
		var x := size.x * (1.0 - (_times[-1] - _times[i]) / SECONDS)
		points.append(Vector2(x, size.y * (1.0 - minf(values[i] / MOST_NEWTONS, 1.0))))
	draw_polyline(points, color, 2.0, true)
