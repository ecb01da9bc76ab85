extends Node3D
## The three arms of a delta robot, from its base to its tip: each a link that turns at the base, and a rod.

const BASE := 0.05  # of the ring that the arms turn at, metres
const LINK := 0.07  # metres
const ROD := 0.1  # metres
const THICKNESS := 0.0025  # metres
const ARMS := 3

@export var tip: Node3D
@export var look: Material

var _links: Array[MeshInstance3D] = []
var _rods: Array[MeshInstance3D] = []


func _ready() -> void:
	var ring := TorusMesh.new()
	ring.inner_radius = BASE - 2.0 * THICKNESS
	ring.outer_radius = BASE + 2.0 * THICKNESS
	ring.material = look
	var base := MeshInstance3D.new()
	base.mesh = ring
	base.rotation.x = 0.5 * PI
	add_child(base)
	for _arm in ARMS:
		_links.append(_bar(2.0 * THICKNESS))
		_rods.append(_bar(THICKNESS))


func _bar(thickness: float) -> MeshInstance3D:
	var mesh := CylinderMesh.new()
	mesh.top_radius = 0.5 * thickness
	mesh.bottom_radius = 0.5 * thickness
	mesh.height = 1.0
	mesh.material = look
	var bar := MeshInstance3D.new()
	bar.mesh = mesh
	add_child(bar)
	return bar


## The base stands upright behind the tip, its ring in the plane of x and y.
func _process(_delta: float) -> void:
	var end := to_local(tip.global_position)
	for arm in ARMS:
		var outward := Vector3.UP.rotated(Vector3.BACK, TAU * arm / ARMS)
		var shoulder := BASE * outward
		var elbow := _elbow(shoulder, outward, end)
		_lay(_links[arm], shoulder, elbow)
		_lay(_rods[arm], elbow, end)


## Where link and rod meet: in the plane of the arm, on the circle about the shoulder, as far from the tip as
## the rod is long; of the two such places the outer one. Out of reach: straight at it.
func _elbow(shoulder: Vector3, outward: Vector3, end: Vector3) -> Vector3:
	var across := outward.cross(Vector3.BACK)
	var aside := (end - shoulder).dot(across)
	var way := end - shoulder - aside * across
	var rod_squared := ROD * ROD - aside * aside
	var length := way.length()
	var along := clampf((LINK * LINK - rod_squared + length * length) / (2.0 * length), -LINK, LINK)
	var direction := way / length
	var off := direction.cross(across)
	off *= signf(off.dot(outward))
	return shoulder + along * direction + sqrt(LINK * LINK - along * along) * off


func _lay(bar: MeshInstance3D, from: Vector3, to: Vector3) -> void:
	var way := to - from
	var turn := Basis(Quaternion(Vector3.UP, way.normalized()))
	bar.transform = Transform3D(turn * Basis.from_scale(Vector3(1, way.length(), 1)), 0.5 * (from + to))
