extends HapticMesh
## A volume of samples that a formula fills. What is touched, and shown as "Look" beside it, is where the
## field is 0.

enum Form { MAZE, LUMP }

const MAZE_PERIOD := 0.075  # metres
const MAZE_WALL := 0.6
const MAZE_RIM := 0.004  # metres
const LUMP_BALLS := [
	Vector4(0.0, 0.0, 0.0, 0.019), Vector4(0.022, 0.012, 0.0, 0.012), Vector4(-0.016, 0.016, 0.014, 0.013)
]  # centre and radius in metres

@export var form := Form.MAZE
@export_range(0.01, 1.0, 0.001, "suffix:m") var side := 0.16
@export_range(8, 256) var samples := 56


func _ready() -> void:
	var step := side / (samples - 1)
	var values := PackedFloat32Array()
	values.resize(samples * samples * samples)
	var i := 0
	for z in samples:
		for y in samples:
			for x in samples:
				var p := Vector3(x, y, z) * step - Vector3.ONE * 0.5 * side
				values[i] = _maze(p) if form == Form.MAZE else _lump(p)
				i += 1
	volume = HapticVolume.new()
	volume.size = Vector3i.ONE * samples
	volume.voxel_size = Vector3.ONE * step
	volume.values = values
	(get_node("../Look") as MeshInstance3D).mesh = volume.create_mesh()


## The walls of a gyroid, within a ball.
func _maze(p: Vector3) -> float:
	var q := p * TAU / MAZE_PERIOD
	var wall := absf(sin(q.x) * cos(q.y) + sin(q.y) * cos(q.z) + sin(q.z) * cos(q.x)) - MAZE_WALL
	wall *= MAZE_PERIOD / TAU
	var ball := p.length() - 0.46 * side
	# The larger of both, with a rounded rim.
	return 0.5 * (wall + ball + sqrt((wall - ball) * (wall - ball) + MAZE_RIM * MAZE_RIM))


## Balls that flow into each other.
func _lump(p: Vector3) -> float:
	var sum := 0.0
	for ball: Vector4 in LUMP_BALLS:
		var away := p - Vector3(ball.x, ball.y, ball.z)
		sum += ball.w * ball.w / maxf(away.length_squared(), 1e-6)
	return 1.0 - sum
