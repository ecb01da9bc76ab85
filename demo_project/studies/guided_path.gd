extends "res://addons/tactus/studies/study.gd"
## Does a virtual fixture help to follow a line? The fingertip goes along a drawn line from its left end to
## its right one, as exactly as it can. The guide's stiffness is the condition; its order is counterbalanced
## over participants, whose codes end in a number.
##
## An example of a study whose trials are measured: any number of conditions and repeats, figures of each
## trial, and a file with every tick of it.

const Order := preload("res://addons/tactus/studies/order.gd")
## A trial begins and ends so near to an end of the line (unit: meters).
const AT_AN_END := 0.015

## Of the guide.
@export var stiffnesses: PackedFloat64Array = [0.0, 150.0, 500.0]
## How often each condition comes, in blocks that have each of them once.
@export_range(1, 100) var repeats := 4
## 1: every tick of each trial is left as a file of its own.
@export var keeps_ticks := true

var order: PackedInt32Array
## Distances of the fingertip from the line in this trial (unit: meters).
var distances := PackedFloat64Array()
## The trial has begun: the fingertip has left the left end.
var is_under_way := false

var _line: PackedVector3Array
var _figures := {}
var _started_at := 0.0
var _asked := 0

@onready var _pointer: ProxyPointer = %Pointer
@onready var _recorder: HapticRecorder = %Recorder


func begin() -> void:
	_line = _pointer.guide.points
	_pointer.guide = _pointer.guide.duplicate()
	var digits := RegEx.create_from_string("[0-9]+$").search(participant)
	var row := int(digits.get_string()) if digits != null else 0
	for _block in repeats:
		order.append_array(Order.counterbalanced(row, stiffnesses.size()))


func set_up() -> void:
	_pointer.guide.stiffness = stiffnesses[order[trial]]
	is_under_way = false
	distances = PackedFloat64Array()


func question() -> String:
	return (
		"%d of %d.  Begin at the left end and follow the line to the right one." % [trial + 1, order.size()]
	)


func _process(seconds: float) -> void:
	super(seconds)
	look()


## Once a frame: begins, measures and ends the trial by where the fingertip is.
func look() -> void:
	if is_over or is_lifting:
		return
	var at := _pointer.get_proxy_position()
	if not is_under_way:
		if at.distance_to(_line[0]) < AT_AN_END:
			_begin_trial()
		return
	distances.append(_distance(at))
	if at.distance_to(_line[-1]) < AT_AN_END:
		_end_trial()


func _begin_trial() -> void:
	is_under_way = true
	_started_at = world.get_time()
	if keeps_ticks:
		_recorder.csv_path = file.folder.path_join("trial_%03d.csv" % (trial + 1))
		_recorder.start()


func _end_trial() -> void:
	_recorder.stop()
	var squares := 0.0
	var largest := 0.0
	for distance in distances:
		squares += distance * distance
		largest = maxf(largest, distance)
	_figures = {
		"deviation_rms_mm": 1e3 * sqrt(squares / distances.size()),
		"deviation_max_mm": 1e3 * largest,
		"took_s": world.get_time() - _started_at,
	}
	answer(order[trial])


func _distance(at: Vector3) -> float:
	var least := INF
	for i in _line.size() - 1:
		var nearest := Geometry3D.get_closest_point_to_segment(at, _line[i], _line[i + 1])
		least = minf(least, at.distance_to(nearest))
	return least


func restore(row: Dictionary) -> void:
	_figures = {}
	for key: String in ["deviation_rms_mm", "deviation_max_mm", "took_s"]:
		_figures[key] = float(row[key])


func take(_given: int) -> Dictionary:
	_asked += 1
	var row := {"answer": order[trial], "guide_stiffness_n_per_m": stiffnesses[order[trial]]}
	row.merge(_figures)
	return row


func columns() -> Dictionary:
	return {
		"answer": "number of the condition, from 0 on",
		"guide_stiffness_n_per_m": "stiffness of the guide, in newtons per meter",
		"deviation_rms_mm": "distance of the proxy from the line, root mean square, in millimeters",
		"deviation_max_mm": "the largest distance, in millimeters",
		"took_s": "from one end of the line to the other, in seconds of the world's time",
	}


func more_settings() -> Dictionary:
	return {"stiffnesses": Array(stiffnesses)}


func has_more() -> bool:
	return _asked < order.size()
