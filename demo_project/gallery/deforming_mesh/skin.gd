extends HapticMesh
## A skin with a wave that runs through it. What is touched, and shown as "Look" beside it, is one mesh.

const SIZE := Vector2(0.4, 0.3)  # metres
const CELLS := Vector2i(32, 24)
const AMPLITUDE := 0.018  # metres
const WAVELENGTH := 0.22  # metres
const PERIOD := 4.0  # seconds

@export var world: HapticWorld

var _arrays := []


func _ready() -> void:
	var indices := PackedInt32Array()
	for z in CELLS.y:
		for x in CELLS.x:
			var corner := _corner(x, z)
			var below := _corner(x, z + 1)
			indices.append_array([corner, corner + 1, below, below, corner + 1, below + 1])
	_arrays.resize(Mesh.ARRAY_MAX)
	_arrays[Mesh.ARRAY_INDEX] = indices
	mesh = ArrayMesh.new()
	_shape(0.0)
	(get_node("../Look") as MeshInstance3D).mesh = mesh


func _process(_delta: float) -> void:
	_shape(world.get_time())


func _shape(time: float) -> void:
	var heights := PackedFloat32Array()
	for z in CELLS.y + 1:
		for x in CELLS.x + 1:
			heights.append(_height(_place(x, z), time))
	var corners := PackedVector3Array()
	var normals := PackedVector3Array()
	var cell := SIZE / Vector2(CELLS)
	for z in CELLS.y + 1:
		for x in CELLS.x + 1:
			var place := _place(x, z)
			corners.append(Vector3(place.x, heights[_corner(x, z)], place.y))
			var slope_x := heights[_corner(mini(x + 1, CELLS.x), z)] - heights[_corner(maxi(x - 1, 0), z)]
			var slope_z := heights[_corner(x, mini(z + 1, CELLS.y))] - heights[_corner(x, maxi(z - 1, 0))]
			normals.append(Vector3(-0.5 * slope_x / cell.x, 1.0, -0.5 * slope_z / cell.y).normalized())
	_arrays[Mesh.ARRAY_VERTEX] = corners
	_arrays[Mesh.ARRAY_NORMAL] = normals
	var shown := mesh as ArrayMesh
	shown.clear_surfaces()
	shown.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, _arrays)
	shown.emit_changed()


func _corner(x: int, z: int) -> int:
	return z * (CELLS.x + 1) + x


func _place(x: int, z: int) -> Vector2:
	return (Vector2(x, z) / Vector2(CELLS) - Vector2(0.5, 0.5)) * SIZE


## Held still at its rim.
func _height(place: Vector2, time: float) -> float:
	var from_rim := Vector2.ONE - (2.0 * place / SIZE) * (2.0 * place / SIZE)
	return AMPLITUDE * from_rim.x * from_rim.y * sin(TAU * (place.length() / WAVELENGTH - time / PERIOD))
