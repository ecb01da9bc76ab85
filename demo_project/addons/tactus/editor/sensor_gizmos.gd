@tool
extends "grip_gizmos.gd"
## Of a HapticDepthSensor: what it sees, and how high the support is.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

## As a Kinect's, and the synthetic camera's.
const FIELD_OF_VIEW := 1.0  # horizontal, radians
const ASPECT := 0.75  # height over width
const NEAR := 0.4  # metres
const FAR := 1.5  # metres
const SUPPORT := 0.3  # half of what is drawn of the support, metres


func _class_name() -> String:
	return "HapticDepthSensor"


func lines(node: Node3D) -> PackedVector3Array:
	var sensor := node as HapticDepthSensor
	var half := tan(0.5 * FIELD_OF_VIEW) * Vector2(1.0, ASPECT)
	var corners := [
		Vector3(-half.x, -half.y, -1),
		Vector3(half.x, -half.y, -1),
		Vector3(half.x, half.y, -1),
		Vector3(-half.x, half.y, -1)
	]
	var drawn := PackedVector3Array()
	for i in 4:
		var next: Vector3 = corners[(i + 1) % 4]
		drawn.append_array([Vector3.ZERO, corners[i] * FAR])
		for depth: float in [NEAR, FAR]:
			drawn.append_array([corners[i] * depth, next * depth])
	if sensor.knows_support:
		drawn.append_array(_support(sensor))
	return drawn


## Below the middle of what is seen.
func _support(sensor: HapticDepthSensor) -> PackedVector3Array:
	var into_node := sensor.global_transform.affine_inverse()
	var middle := _middle(sensor)
	var square := PackedVector3Array()
	for corner: Vector3 in [
		Vector3(-1, 0, -1), Vector3(1, 0, -1), Vector3(1, 0, 1), Vector3(-1, 0, 1), Vector3(-1, 0, -1)
	]:
		square.append(into_node * (middle + SUPPORT * corner))
	return polyline(square)


func _middle(sensor: HapticDepthSensor) -> Vector3:
	var level := Plane(Vector3.UP, sensor.support_height)
	var at: Variant = level.intersects_ray(sensor.global_position, -sensor.global_basis.z)
	return level.project(sensor.global_position) if at == null else at


func grips(node: Node3D) -> Array:
	var sensor := node as HapticDepthSensor
	if not sensor.knows_support:
		return []
	var into_node := sensor.global_transform.affine_inverse()
	var height := func(at: Vector3) -> float: return (sensor.global_transform * at).y
	var up := (into_node.basis * Vector3.UP).normalized()
	return [
		Grip.along(
			"height of the support", into_node * _middle(sensor), up, sensor, &"support_height", height
		)
	]
