extends "res://studies/study.gd"
## Which of two ways to correct the model feels more like a box that is here? Both touch the same box, far
## away, behind the same delay and with the same wrong model; which of them is the first is drawn anew in
## each trial, and nothing on the screen tells.

const TESTBED := preload("res://gallery/dynamic_testbed/dynamic_testbed.tscn")
## Of what this side makes of the scene: the far side needs no eye, and the words are the study's.
const NOT_NEEDED := ["Placard"]

## The two ways, as names of MMTLink.CorrectionScheme.
@export var schemes := PackedStringArray(["CORRECTION_POSE", "CORRECTION_STEALTHY_DIRECTION"])
@export_range(2, 200) var trials := 20
## There and back, in seconds.
@export_range(0.0, 1.0) var delay := 0.1
## What the model believes, as factors of what is true.
@export var wrong_model := {"Box": {"mass": 1.2, "friction": 0.7}}

var done := 0
## The scheme that is the first one of this trial, by its place in `schemes`.
var first := 0
## Which of the two is felt now.
var felt := 0

var _link: MMTLink
var _order: PackedInt32Array
var _changes := 0


## As often the one as the other is the first.
func begin() -> void:
	_link = _joined(_testbed("Here"), _testbed("There"))
	for i in trials:
		_order.append(i % 2)
	for i in range(trials - 1, 0, -1):
		var other := dice.randi_range(0, i)
		var kept := _order[i]
		_order[i] = _order[other]
		_order[other] = kept


func _testbed(called: String) -> Node3D:
	var testbed: Node3D = TESTBED.instantiate()
	testbed.name = called
	for part: String in NOT_NEEDED:
		testbed.get_node(part).free()
	var its_world: HapticWorld = testbed.get_node("HapticWorld")
	if called == "Here":
		world = its_world
	else:
		testbed.get_node("Stage").free()
		testbed.hide()
	return testbed


func _joined(here: Node3D, there: Node3D) -> MMTLink:
	var conditions := NetworkConditions.new()
	conditions.delay = delay / 2.0
	var links: Array[MMTLink] = []
	for testbed: Node3D in [here, there]:
		var link: MMTLink = testbed.get_node("HapticWorld/MMTLink")
		link.scenario = MMTLink.SCENARIO_MMT
		link.side = MMTLink.SIDE_OPERATOR if links.is_empty() else MMTLink.SIDE_TELEOPERATOR
		link.conditions = conditions
		links.append(link)
	links[0].partner = NodePath("../../../There/HapticWorld/MMTLink")
	links[1].partner = NodePath("../../../Here/HapticWorld/MMTLink")
	links[0].model_errors = wrong_model
	add_child(there)
	add_child(here)
	return links[0]


func set_up() -> void:
	first = _order[done]
	_changes = 0
	_feel(0)


func _feel(which: int) -> void:
	felt = which
	var scheme := schemes[first if which == 0 else 1 - first]
	_link.correction_scheme = (
		ClassDB.class_get_integer_constant("MMTLink", scheme) as MMTLink.CorrectionScheme
	)
	%Felt.text = "First" if which == 0 else "Second"


func question() -> String:
	return (
		"%d of %d.  1, 2: feel the one or the other.   Return: this one is more like a box that is here"
		% [done + 1, trials]
	)


func pressed(key: Key) -> bool:
	match key:
		KEY_1, KEY_2:
			_changes += 1
			_feel(0 if key == KEY_1 else 1)
		KEY_ENTER, KEY_KP_ENTER:
			answer(felt)
		_:
			return false
	return true


func take(alternative: int) -> Dictionary:
	done += 1
	return {
		"delay_s": delay,
		"first": schemes[first],
		"second": schemes[1 - first],
		"answer": alternative,
		"chosen": schemes[first if alternative == 0 else 1 - first],
		"changes": _changes,
	}


func has_more() -> bool:
	return done < trials
