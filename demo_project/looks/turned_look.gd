@tool
extends MeshInstance3D
## A shape as a lathe turns it: its outline goes around the y axis. A HapticMesh that names this node as its
## mesh_instance is touched as the same triangles.

const SIDES := 96
const STEPS := 6

## From the axis to the axis, (distance from the axis, height) in metres: the outside upward, the inside
## downward. A smooth curve goes through the points.
@export var outline := PackedVector2Array():
	set(value):
		outline = value
		_turn()


func _ready() -> void:
	_turn()


func _turn() -> void:
	if outline.size() < 3 or not is_node_ready():
		return
	mesh = turned(_smooth(outline))


static func turned(line: PackedVector2Array) -> ArrayMesh:
	var tool := SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	var length := 0.0
	for ring in line.size():
		if ring > 0:
			length += line[ring].distance_to(line[ring - 1])
		for side in SIDES + 1:
			var angle := TAU * side / SIDES
			tool.set_uv(Vector2(float(side) / SIDES, length))
			tool.add_vertex(Vector3(cos(angle) * line[ring].x, line[ring].y, sin(angle) * line[ring].x))
	for ring in line.size() - 1:
		for side in SIDES:
			var first := ring * (SIDES + 1) + side
			var above := first + SIDES + 1
			for index: int in [first, first + 1, above, above, first + 1, above + 1]:
				tool.add_index(index)
	tool.generate_normals()
	tool.generate_tangents()
	return tool.commit()


## Catmull and Rom's curve, which does not leave the axis.
static func _smooth(points: PackedVector2Array) -> PackedVector2Array:
	var line := PackedVector2Array()
	for i in points.size() - 1:
		for step in STEPS:
			var point := points[i].cubic_interpolate(
				points[i + 1],
				points[maxi(i - 1, 0)],
				points[mini(i + 2, points.size() - 1)],
				float(step) / STEPS
			)
			line.append(Vector2(maxf(point.x, 0.0), point.y))
	line.append(points[points.size() - 1])
	return line


## What is made here is made again when the scene is opened: it is not stored.
func _validate_property(property: Dictionary) -> void:
	if property.name == "mesh":
		property.usage &= ~PROPERTY_USAGE_STORAGE
