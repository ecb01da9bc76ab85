extends MultiMeshInstance3D
## Leaves that drift on the water: they show how it flows.

const Current := preload("res://gallery/force_effect/current.gd")
const LENGTH := 0.5  # of the river, metres
const WIDTH := 0.26  # metres

@export var leaves := 150

var _places := PackedVector3Array()


func _ready() -> void:
	var dice := RandomNumberGenerator.new()
	dice.seed = 1
	for _i in leaves:
		var place := Vector3(dice.randf() - 0.5, 0.0, dice.randf() - 0.5) * Vector3(LENGTH, 0, WIDTH)
		_places.append(place)
	multimesh.instance_count = leaves
	_drift(0.0)


func _process(delta: float) -> void:
	_drift(minf(delta, 0.1))


func _drift(seconds: float) -> void:
	for i in leaves:
		var place := _places[i]
		# By the speed half way: the leaves do not drift out of their lines.
		var half_way := place + 0.5 * seconds * Current.flow(place)
		var flow := Current.flow(half_way)
		place += seconds * flow
		if place.x > 0.5 * LENGTH:
			place.x -= LENGTH
		_places[i] = place
		var along := flow.normalized() if flow.length() > 1e-4 else Vector3.RIGHT
		var turned := Basis(along, Vector3.UP, along.cross(Vector3.UP))
		multimesh.set_instance_transform(i, Transform3D(turned, place + Vector3.UP * Current.SURFACE))
