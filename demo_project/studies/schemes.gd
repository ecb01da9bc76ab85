extends "res://addons/tactus/studies/study.gd"
## Which of two ways to correct the model feels more like a box that is here? Both touch the same box, far
## away, behind the same delay and with the same wrong model; which of them is the first is drawn anew in
## each trial, and nothing on the screen tells.
##
## Each interval begins from the same state: the box stands where it stood, and the model is as wrong as it
## was, whatever touch has taught it before.

const TESTBED := preload("res://gallery/dynamic_testbed/dynamic_testbed.tscn")
const Order := preload("res://addons/tactus/studies/order.gd")
## Of what this side makes of the scene: the far side needs no eye, and the words are the study's.
const NOT_NEEDED := ["Placard"]
## A preference counts that chance gives less often.
const SIGNIFICANCE := 0.05
## Of the participant, at which the power is stated: how often the preferred way is chosen.
const STATED_PREFERENCE := 0.75

## The two ways, as names of MMTLink.CorrectionScheme.
@export var schemes := PackedStringArray(["CORRECTION_MASKED_TURN", "CORRECTION_MASKED_DIRECTION"])
@export_range(2, 200) var trials := 30
## There and back.
@export_range(0.0, 1.0, 0.001, "suffix:s") var delay := 0.1
## What the model believes, as factors of what is true.
@export var wrong_model := {"Box": {"mass": 1.2, "friction": 0.7}}

## The scheme that is the first one of this trial, by its place in `schemes`.
var first := 0
## Which of the two is felt now.
var felt := 0

var _links: Array[MMTLink] = []
var _boxes: Array[RigidBody3D] = []
var _stand := Transform3D.IDENTITY
var _order: PackedInt32Array
var _changes := 0
var _asked := 0
var _chosen := [0, 0]
## The interval that is wanted while the hand still touches; none: -1.
var _wanted := -1


## As often the one as the other is the first.
func begin() -> void:
	_join(_testbed("Here"), _testbed("There"))
	_order = Order.balanced(trials, schemes.size(), dice)


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
	_boxes.append(testbed.get_node("HapticWorld/Box"))
	_stand = _boxes[0].transform
	return testbed


func _join(here: Node3D, there: Node3D) -> void:
	var conditions := MMTNetworkConditions.new()
	conditions.delay = delay / 2.0
	for testbed: Node3D in [here, there]:
		var link: MMTLink = testbed.get_node("HapticWorld/MMTLink")
		link.scenario = MMTLink.SCENARIO_MMT
		link.side = MMTLink.SIDE_OPERATOR if _links.is_empty() else MMTLink.SIDE_TELEOPERATOR
		link.conditions = conditions
		_links.append(link)
	_links[0].partner = NodePath("../../../There/HapticWorld/MMTLink")
	_links[1].partner = NodePath("../../../Here/HapticWorld/MMTLink")
	_links[0].model_errors = wrong_model
	add_child(there)
	add_child(here)


func settings_problem() -> String:
	var known := ClassDB.class_get_enum_constants("MMTLink", "CorrectionScheme")
	for scheme in schemes:
		if not scheme in known:
			return "there is no scheme '%s': it is one of %s" % [scheme, ", ".join(known)]
	if schemes.size() != 2 or _value_of(schemes[0]) == _value_of(schemes[1]):
		return "schemes must be two different ones"
	return ""


func _value_of(scheme: String) -> MMTLink.CorrectionScheme:
	return ClassDB.class_get_integer_constant("MMTLink", scheme) as MMTLink.CorrectionScheme


func set_up() -> void:
	first = _order[trial]
	_changes = 0
	_wanted = -1
	feel(0)


## Begins the first (0) or the second (1) interval anew, from the state that every interval begins with.
func feel(which: int) -> void:
	felt = which
	var scheme := schemes[first if which == 0 else 1 - first]
	_links[0].correction_scheme = _value_of(scheme)
	# A world that comes into the tree starts anew: gone is all that touch has taught the model.
	# Both leave before one comes back, so that neither meets what the other was.
	var testbeds := {}
	for box in _boxes:
		var its_world := box.get_parent()
		testbeds[its_world] = its_world.get_parent()
		its_world.get_parent().remove_child(its_world)
		box.transform = _stand
		box.linear_velocity = Vector3.ZERO
		box.angular_velocity = Vector3.ZERO
	for its_world: Node in testbeds:
		(testbeds[its_world] as Node).add_child(its_world)
	%Felt.text = "First" if which == 0 else "Second"


func question() -> String:
	return (
		"%d of %d.  1, 2: feel the one or the other.   Return: this one is more like a box that is here"
		% [trial + 1, trials]
	)


func pressed(key: Key) -> bool:
	match key:
		KEY_1, KEY_2:
			_changes += 1
			_wanted = 0 if key == KEY_1 else 1
			_feel_wanted()
		KEY_ENTER, KEY_KP_ENTER:
			if _wanted < 0:
				answer(felt)
		_:
			return false
	return true


func _process(seconds: float) -> void:
	super(seconds)
	_feel_wanted()


## As soon as nothing is touched: nothing changes under a hand.
func _feel_wanted() -> void:
	if _wanted < 0 or is_over:
		return
	if touches():
		%Question.text = "Lift your hand."
		return
	feel(_wanted)
	_wanted = -1
	%Question.text = question()


func take(given: int) -> Dictionary:
	var chosen := first if given == 0 else 1 - first
	_asked += 1
	_chosen[chosen] += 1
	return {
		"delay_s": delay,
		"wrong_model": JSON.stringify(wrong_model),
		"first": schemes[first],
		"second": schemes[1 - first],
		"answer": given,
		"chosen": schemes[chosen],
		"changes": _changes,
	}


func columns() -> Dictionary:
	return {
		"delay_s": "of the network, there and back, in seconds",
		"wrong_model": "what the model had wrong at the beginning of each interval (MMTLink.model_errors)",
		"first": "correction scheme of the first interval",
		"second": "correction scheme of the second interval",
		"answer": "0: the first interval was chosen, 1: the second one",
		"chosen": "correction scheme of the interval that was chosen",
		"changes": "how often the participant went to an interval",
	}


func more_settings() -> Dictionary:
	return {"wrong_model": wrong_model}


func has_more() -> bool:
	return _asked < trials


## An exact binomial test of no preference, two-sided, and its power.
func results() -> Dictionary:
	var found := {
		"chosen_share": {schemes[0]: float(_chosen[0]) / _asked, schemes[1]: float(_chosen[1]) / _asked},
		"p_value": p_value(_chosen[0], _asked),
		"power_at_preference_of_%s" % STATED_PREFERENCE: power(_asked, STATED_PREFERENCE),
	}
	found["prefers"] = (schemes[0 if _chosen[0] > _chosen[1] else 1] if found.p_value < SIGNIFICANCE else "")
	return found


## How often chance alone (1/2) is at least as far from half of `count`.
static func p_value(chosen: int, count: int) -> float:
	var sum := 0.0
	for k in count + 1:
		if absi(2 * k - count) >= absi(2 * chosen - count):
			sum += _probability(k, count, 0.5)
	return minf(sum, 1.0)


## How often a participant who chooses one way with this probability is found to prefer it.
static func power(count: int, preference: float) -> float:
	var sum := 0.0
	for k in count + 1:
		if 2 * k > count and p_value(k, count) < SIGNIFICANCE:
			sum += _probability(k, count, preference)
	return sum


## Of k of n, each with the probability p.
static func _probability(k: int, n: int, p: float) -> float:
	var logarithm := k * log(p) + (n - k) * log(1.0 - p)
	for i in k:
		logarithm += log(float(n - i)) - log(float(i + 1))
	return exp(logarithm)
