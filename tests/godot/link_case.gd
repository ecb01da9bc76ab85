extends "nodes_case.gd"
## The operator's world and the far one, in one process and in stepped time.

const STIFFNESS := 500.0

var _operator: HapticWorld
var _far: HapticWorld
var _here: MMTLink
var _there: MMTLink


func _link(world: HapticWorld, side: MMTLink.Side, scenario: MMTLink.Scenario) -> MMTLink:
	var link := MMTLink.new()
	link.name = "Link"
	link.side = side
	link.scenario = scenario
	link.conditions = MMTNetworkConditions.new()
	link.tuning = MMTTuning.new()
	world.add_child(link)
	return link


## Two worlds with the same hand; only the far one has bodies. `delay`: there and back.
func _connect(scenario: MMTLink.Scenario, delay := 0.0) -> void:
	_operator = add_world()
	_operator.name = "Operator"
	_far = add_world()
	_far.name = "Far"
	_here = _link(_operator, MMTLink.SIDE_OPERATOR, scenario)
	_there = _link(_far, MMTLink.SIDE_TELEOPERATOR, scenario)
	_here.partner = NodePath("../../Far/Link")
	_there.partner = NodePath("../../Operator/Link")
	_here.conditions.delay = delay / 2.0
	_there.conditions.delay = delay / 2.0
	await frames(2)


func _advance(seconds: float) -> void:
	for _tick in roundi(seconds / TICK):
		_operator.advance(TICK)
		_far.advance(TICK)


## Rests above the floor, then goes down into it within a tenth of a second.
func _down_after(rests: float) -> HapticPath:
	var way := HapticPath.new()
	way.form = HapticPath.FORM_POINTS
	way.points_positions = PackedVector3Array(
		[Vector3(0, 0.05, 0), Vector3(0, 0.05, 0), Vector3(0, -0.01, 0)]
	)
	way.points_times = PackedFloat64Array([0.0, rests, rests + 0.1])
	way.points_interpolation = HapticPath.INTERPOLATION_LINEAR
	return way


func _add_hands(rests := 0.5) -> void:
	for world: HapticWorld in [_operator, _far]:
		add_hand(world, _down_after(rests))


func _felt(world: HapticWorld) -> Vector3:
	return (world.get_node("Device") as HapticDevice).get_force()
