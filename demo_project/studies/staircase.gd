extends RefCounted
## Looks for the difference that is just noticed: harder after some right answers in a row, easier after each
## wrong one (Levitt, "Transformed up-down methods in psychoacoustics", 1971). With three right answers it
## settles where 0.5^(1/3) = 79.4 % are right, with two where 70.7 % are. Steps are factors, so that no
## difference becomes none.

## Of the difference, as the study means it: now, and the ends beyond which no step leads.
var level := 1.0
var least := 1e-3
var most := 1.0

## Right answers in a row before it gets harder.
var hits := 3
## A step before the second reversal, and from then on.
var first_factor := 2.0
var factor := 1.25
## It is over after so many reversals; the first ones do not count.
var reversals_wanted := 10
var reversals_left_out := 4

## Levels at which it has turned.
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


func is_over() -> bool:
	return reversals.size() >= reversals_wanted


## The geometric mean of the levels at which it has turned; not a number before there are any that count.
func threshold() -> float:
	var counted := reversals.slice(reversals_left_out)
	if counted.is_empty():
		return NAN
	var sum := 0.0
	for reversal in counted:
		sum += log(reversal)
	return exp(sum / counted.size())


func _step(direction: int) -> void:
	if _last_step == -direction:
		reversals.append(level)
	_last_step = direction
	var by := first_factor if reversals.size() < 2 else factor
	level = clampf(level * by if direction > 0 else level / by, least, most)
