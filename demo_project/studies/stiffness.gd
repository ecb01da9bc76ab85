extends "res://studies/study.gd"
## Which of two slabs is stiffer? One of them has the reference's stiffness, the other one is stiffer by a
## share that a staircase makes smaller as long as it is found: what is left is the just-noticeable
## difference.

const Staircase := preload("res://studies/staircase.gd")

## Of the softer slab, in newtons per metre.
@export_range(10.0, 2000.0) var reference := 400.0
## By which the stiffer one is stiffer in the first trial, as a share.
@export_range(0.01, 2.0) var first_difference := 0.8
## See staircase.gd.
@export_range(1, 4) var hits := 3
@export_range(4, 30) var reversals := 10

var staircase := Staircase.new()
## 0: the left one.
var stiffer := 0

@onready var _slabs: Array[StaticBody3D] = [%Left, %Right]


func begin() -> void:
	staircase.level = first_difference
	staircase.most = first_difference
	staircase.hits = hits
	staircase.reversals_wanted = reversals
	for slab in _slabs:
		slab.physics_material_override = slab.physics_material_override.duplicate()


func set_up() -> void:
	stiffer = dice.randi_range(0, 1)
	for i in _slabs.size():
		var stiffness := reference * (1.0 + staircase.level) if i == stiffer else reference
		(_slabs[i].physics_material_override as HapticMaterial).stiffness = stiffness


func question() -> String:
	return "%d.  Which one is stiffer?   ← left     → right" % (staircase.trials + 1)


func pressed(key: Key) -> bool:
	if key not in [KEY_LEFT, KEY_RIGHT]:
		return false
	answer(0 if key == KEY_LEFT else 1)
	return true


func take(alternative: int) -> Dictionary:
	var row := {
		"reference_n_per_m": reference,
		"difference_share": staircase.level,
		"stiffer": stiffer,
		"answer": alternative,
		"right": alternative == stiffer,
	}
	staircase.answer(alternative == stiffer)
	row["threshold_share"] = staircase.threshold() if staircase.is_over() else ""
	return row


func has_more() -> bool:
	return not staircase.is_over()


func ending() -> String:
	return "Thank you. Just noticed: %.0f %% (%d trials)." % [100.0 * staircase.threshold(), staircase.trials]
