extends Skeleton3D
## A leaf of bones that sways, with a mesh around them that a blend shape swells: drawn by the engine, and
## touched as it is drawn by a HapticMesh that follows it.

const LENGTH := 0.24  # metres
const HALF := Vector2(0.045, 0.012)  # of its width and its thickness, metres
const BONES := 8
const RINGS := 33
const SIDES := 20
const SWAY := 0.16  # radians, from bone to bone
const SWELL := 0.012  # metres
const PERIOD := 5.0  # seconds

@export var world: HapticWorld
@export var drawn: MeshInstance3D


func _ready() -> void:
	for i in BONES:
		add_bone("bone%d" % i)
		set_bone_parent(i, i - 1)
		set_bone_rest(i, Transform3D(Basis(), Vector3(0, 0.0 if i == 0 else LENGTH / BONES, 0)))
	reset_bone_poses()
	drawn.mesh = _mesh()
	drawn.skeleton = drawn.get_path_to(self)
	_pose(0.0)


func _process(_delta: float) -> void:
	_pose(world.get_time())


func _pose(time: float) -> void:
	for i in range(1, BONES):
		var phase := TAU * (time / PERIOD - 0.1 * i)
		set_bone_pose_rotation(
			i, Quaternion.from_euler(Vector3(0.5 * SWAY * cos(phase), 0, SWAY * sin(phase)))
		)
	drawn.set_blend_shape_value(0, 0.5 - 0.5 * cos(2.0 * TAU * time / PERIOD))


func _mesh() -> ArrayMesh:
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	var swollen := PackedVector3Array()
	var corners := PackedVector3Array()
	var normals := PackedVector3Array()
	var bones := PackedInt32Array()
	var weights := PackedFloat32Array()
	for ring in RINGS:
		var share := ring / (RINGS - 1.0)
		var bone := clampf(share * BONES - 0.5, 0.0, BONES - 1.0)
		var width := (0.25 + 0.75 * sin(PI * (0.2 + 0.8 * share))) * sqrt(1.0 - 0.97 * pow(share, 6.0))
		for side in SIDES:
			var out := Vector3(cos(TAU * side / SIDES), 0, -sin(TAU * side / SIDES))
			corners.append(width * Vector3(HALF.x * out.x, 0, HALF.y * out.z) + Vector3(0, share * LENGTH, 0))
			swollen.append(SWELL * pow(sin(PI * share), 4.0) * out)
			normals.append(Vector3(out.x / HALF.x, 0, out.z / HALF.y).normalized())
			bones.append_array([floori(bone), mini(ceili(bone), BONES - 1), 0, 0])
			weights.append_array([1.0 - fmod(bone, 1.0), fmod(bone, 1.0), 0.0, 0.0])
	corners.append(Vector3(0, LENGTH, 0))
	swollen.append(Vector3.ZERO)
	normals.append(Vector3.UP)
	bones.append_array([BONES - 1, 0, 0, 0])
	weights.append_array([1.0, 0.0, 0.0, 0.0])
	arrays[Mesh.ARRAY_VERTEX] = corners
	arrays[Mesh.ARRAY_NORMAL] = normals
	arrays[Mesh.ARRAY_BONES] = bones
	arrays[Mesh.ARRAY_WEIGHTS] = weights
	arrays[Mesh.ARRAY_INDEX] = _indices()
	var shape := []
	shape.resize(3)
	shape[Mesh.ARRAY_VERTEX] = swollen
	shape[Mesh.ARRAY_NORMAL] = PackedVector3Array()
	shape[Mesh.ARRAY_NORMAL].resize(corners.size())
	var mesh := ArrayMesh.new()
	mesh.blend_shape_mode = Mesh.BLEND_SHAPE_MODE_RELATIVE
	mesh.add_blend_shape("swollen")
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays, [shape])
	return mesh


func _indices() -> PackedInt32Array:
	var indices := PackedInt32Array()
	for ring in RINGS - 1:
		for side in SIDES:
			var corner := ring * SIDES + side
			var next := ring * SIDES + (side + 1) % SIDES
			indices.append_array([corner, corner + SIDES, next, next, corner + SIDES, next + SIDES])
	var last := (RINGS - 1) * SIDES
	for side in SIDES:
		indices.append_array([last + side, last + SIDES, last + (side + 1) % SIDES])
	return indices
