extends RefCounted
## Orders of trials that only a seed decides.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")
@warning_ignore_start("integer_division", "incompatible_ternary", "shadowed_variable_base_class")


## Each condition equally often (as far as `count` allows), shuffled.
static func balanced(count: int, conditions: int, dice: RandomNumberGenerator) -> PackedInt32Array:
	var order := PackedInt32Array()
	for i in count:
		order.append(i % conditions)
	for i in range(count - 1, 0, -1):
		var other := dice.randi_range(0, i)
		var kept := order[i]
		order[i] = order[other]
		order[other] = kept
	return order


## A row of a balanced Latin square: over `conditions` rows (twice as many where their number is odd) each
## condition stands equally often at each place and directly after each other one (Williams, "Experimental
## designs balanced for the estimation of residual effects of treatments", 1949).
static func counterbalanced(row: int, conditions: int) -> PackedInt32Array:
	var order := PackedInt32Array()
	for place in conditions:
		var offset := (place + 1) / 2 if place % 2 == 1 else (conditions - place / 2) % conditions
		order.append((row + offset) % conditions)
	if conditions % 2 == 1 and row / conditions % 2 == 1:
		order.reverse()
	return order
