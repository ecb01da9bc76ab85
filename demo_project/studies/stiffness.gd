extends "res://addons/tactus/studies/study.gd"
## The just-noticeable difference of stiffness: which of two slabs is stiffer?
##
## Both slabs lie about a stiffness that is drawn anew in each trial, so that who remembers one slab, or feels
## only one, cannot tell. Two interleaved staircases place the differences; about each tenth trial has a large
## difference that is missed only by who does not attend. Neither the hand nor how deep it is, is shown.
## The threshold is fitted to all answers (psychometric_fit.gd), with its interval, and with a verdict where
## the answers follow something else than the difference.

const Staircase := preload("res://addons/tactus/studies/staircase.gd")
const PsychometricFit := preload("res://addons/tactus/studies/psychometric_fit.gd")

## Standard deviations beyond which chance does not explain a pattern: one in a thousand.
const BEYOND_CHANCE := 3.29

## The geometric mean of the two stiffnesses is drawn about this one.
@export_range(10.0, 2000.0, 0.1, "suffix:N/m") var reference := 400.0
## From the reference divided by this factor to the reference times it; 1 keeps it where it is.
@export_range(1.0, 4.0) var roving := 2.0
## By which the stiffer slab is stiffer in the first trial, as a share.
@export_range(0.01, 2.0) var first_difference := 0.8
## The same in trials that only attention is needed for; no other is larger.
@export_range(0.1, 4.0) var catch_difference := 1.5
## Trials of the two staircases together.
@export_range(20, 1000) var trials := 100
## After so many of them comes one with the catch difference.
@export_range(2, 100) var catch_every := 10

var staircases: Array[Staircase] = []
var fit := PsychometricFit.new()
## 0: the left one.
var stiffer := 0
## Of the present trial: the share by which the stiffer one is stiffer, and the geometric mean (N/m).
var difference := 0.0
var mean_stiffness := 0.0
var is_catch := false

var _asked := 0
var _catches := 0
var _caught := 0
var _lefts := 0
## The logarithm of each trial's mean over the reference, and whether the left one was named (±1).
var _means := PackedFloat64Array()
var _names := PackedFloat64Array()

@onready var _slabs: Array[StaticBody3D] = [%Left, %Right]


func begin() -> void:
	for hits: int in [2, 3]:
		var staircase := Staircase.new()
		staircase.level = first_difference
		staircase.least = 0.002
		staircase.most = catch_difference
		staircase.hits = hits
		staircases.append(staircase)
	for slab in _slabs:
		slab.physics_material_override = slab.physics_material_override.duplicate()


func set_up() -> void:
	is_catch = (_asked + 1) % (catch_every + 1) == 0
	difference = catch_difference if is_catch else _staircase().level
	stiffer = dice.randi_range(0, 1)
	mean_stiffness = reference * pow(roving, dice.randf_range(-1.0, 1.0))
	for i in _slabs.size():
		var ratio := sqrt(1.0 + difference) if i == stiffer else 1.0 / sqrt(1.0 + difference)
		(_slabs[i].physics_material_override as HapticMaterial).stiffness = mean_stiffness * ratio


func question() -> String:
	return "%d.  Which one is stiffer?   ← left     → right" % (_asked + 1)


func pressed(key: Key) -> bool:
	if key not in [KEY_LEFT, KEY_RIGHT]:
		return false
	answer(0 if key == KEY_LEFT else 1)
	return true


func take(given: int) -> Dictionary:
	var is_right := given == stiffer
	if not is_catch:
		_staircase().answer(is_right)
	_asked += 1
	_lefts += int(given == 0)
	_means.append(log(mean_stiffness / reference))
	_names.append(1.0 if given == 0 else -1.0)
	var row := {
		"mean_stiffness_n_per_m": mean_stiffness,
		"difference_share": difference,
		"catch": is_catch,
		"stiffer": stiffer,
		"answer": given,
		"right": is_right,
	}
	if is_catch:
		_catches += 1
		_caught += int(is_right)
	fit.add(difference, is_right)
	return row


func columns() -> Dictionary:
	return {
		"mean_stiffness_n_per_m": "geometric mean of the two slabs' stiffness, in newtons per meter",
		"difference_share": "stiffness of the stiffer slab over that of the softer one, minus 1",
		"catch": "1: a trial with a difference that everyone who attends notices",
		"stiffer": "0: the left slab, 1: the right one",
		"answer": "0: the left slab was named, 1: the right one",
		"right": "1: the stiffer one was named",
	}


func has_more() -> bool:
	return _asked < trials + trials / catch_every


func results() -> Dictionary:
	var found := fit.result()
	return {
		"threshold_share": found.threshold,
		"threshold_low_share": found.low,
		"threshold_high_share": found.high,
		"slope": found.slope,
		"lapse_share": found.lapse,
		"evidence_over_guessing": found.evidence,
		"catch_trials": _catches,
		"catch_trials_right": _caught,
		"named_left_share": float(_lefts) / maxi(_asked, 1),
		"verdict": verdict(found.evidence),
	}


## What speaks against the threshold; empty where nothing does.
func verdict(evidence: float) -> String:
	if evidence < PsychometricFit.LEAST_EVIDENCE:
		return "the answers cannot be told from guessing: there is no threshold"
	if absf(2.0 * _lefts - _asked) > BEYOND_CHANCE * sqrt(_asked):
		return "one side was named more often than chance explains"
	if absf(_follows_one_slab()) > BEYOND_CHANCE:
		return "the answers follow the stiffness of one slab alone, not the difference"
	return ""


## How much the answers go with the mean of both slabs, which says nothing of which is stiffer, in standard
## deviations of chance.
func _follows_one_slab() -> float:
	var sum := 0.0
	var squares := 0.0
	for i in _means.size():
		sum += _means[i] * _names[i]
		squares += _means[i] * _means[i]
	return sum / sqrt(squares) if squares > 0.0 else 0.0


func ending() -> String:
	var found := results()
	if found.verdict != "":
		return "Thank you. But %s." % found.verdict
	return (
		"Thank you. Just noticed: %.0f %% (95 %%: %.0f to %.0f %%)."
		% [
			100.0 * found.threshold_share,
			100.0 * found.threshold_low_share,
			100.0 * found.threshold_high_share
		]
	)


## Whose turn it is: the one and the other in turns.
func _staircase() -> Staircase:
	return staircases[(_asked - _catches) % staircases.size()]
