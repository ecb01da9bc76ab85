extends Node3D
## A study of which each trial has two alternatives, in an order that only the seed decides and nobody sees.
## A scene that extends it says what a trial is made of.

signal finished

const Table := preload("res://studies/table.gd")

@export var participant := "0"
## The same order again; 0: another one each time.
@export var seed_of_order := 0
@export var csv_path := "user://studies/study.csv"
@export var world: HapticWorld

var dice := RandomNumberGenerator.new()
var table := Table.new()
var is_over := false

var _began_at := 0.0


func _ready() -> void:
	if seed_of_order != 0:
		dice.seed = seed_of_order
	else:
		dice.randomize()
		seed_of_order = dice.seed
	var problem := table.open(csv_path)
	if not problem.is_empty():
		push_error(problem)
		is_over = true
		return
	begin()
	_next()


## The participant's answer: the first (0) or the second (1) of the two.
func answer(alternative: int) -> void:
	if is_over:
		return
	var row := {"participant": participant, "seed": seed_of_order, "seconds": world.get_time() - _began_at}
	row.merge(take(alternative))
	table.add(row)
	if has_more():
		_next()
	else:
		is_over = true
		%Question.text = ending()
		finished.emit()


func _next() -> void:
	_began_at = world.get_time()
	set_up()
	%Question.text = question()


func _unhandled_key_input(event: InputEvent) -> void:
	var key := event as InputEventKey
	if key != null and key.pressed and not key.echo and pressed(key.keycode):
		get_viewport().set_input_as_handled()


# --- of the study


## Once.
func begin() -> void:
	pass


## The next trial, by `dice`.
func set_up() -> void:
	pass


func question() -> String:
	return ""


func pressed(_key: Key) -> bool:
	return false


## What the answer to the present trial gives as a row.
func take(_alternative: int) -> Dictionary:
	return {}


func has_more() -> bool:
	return false


func ending() -> String:
	return "Thank you: that was all."
