extends RefCounted
## An adaptive rule: the difference gets smaller after some right answers in a row and larger after each wrong
## one (Levitt, "Transformed up-down methods in psychoacoustics", 1971). Three right answers converge where
## 0.5^(1/3) = 79.4 % are right, two where 70.7 % are. Steps are factors, so that no difference becomes zero.
##
## It only places the trials; psychometric_fit.gd estimates the threshold from all of them.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")
@warning_ignore_start("integer_division", "incompatible_ternary", "shadowed_variable_base_class")

## The present difference, and the ends beyond which no step leads.
var level := 1.0
var least := 1e-3
var most := 1.0

## Right answers in a row before the difference gets smaller.
var hits := 3
## A step before the second reversal, and from then on.
var first_factor := 2.0
var factor := 1.25

## Levels at which the direction has changed.
var reversals := PackedFloat64Array()
var trials := 0

var _in_a_row := 0
var _last_step := 0


func answer(is_right: bool) -> void:
	trials += 1
	_in_a_row = _in_a_row + 1 if is_right else 0
	if not is_right:
		_step(1)
	elif _in_a_row == hits:
		_in_a_row = 0
		_step(-1)


func _step(direction: int) -> void:
	if _last_step == -direction:
		reversals.append(level)
	_last_step = direction
	var by := first_factor if reversals.size() < 2 else factor
	level = clampf(level * by if direction > 0 else level / by, least, most)
