@tool
extends "grip_gizmos.gd"
## Of a HapticDevice: the box of its workspace, whose faces set how large it is in the scene, and its path.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const PATH_STEPS := 200


func _class_name() -> String:
	return "HapticDevice"


func lines(node: Node3D) -> PackedVector3Array:
	var device := node as HapticDevice
	var half := device.get_workspace_radius()
	var drawn := PackedVector3Array()
	if half > 0.0:
		drawn.append_array(box_lines(AABB(-half * Vector3.ONE, 2.0 * half * Vector3.ONE)))
	if device.path != null and device.path.get_problems().is_empty():
		drawn.append_array(polyline(_way(device.path)))
	return drawn


func _way(path: HapticPath) -> PackedVector3Array:
	var points := PackedVector3Array()
	var seconds := path.get_duration()
	for i in PATH_STEPS + 1:
		points.append(path.sample(seconds * i / PATH_STEPS))
	return points


func grips(node: Node3D) -> Array:
	var device := node as HapticDevice
	return _box_grips(device) + (_path_grips(device.path) if device.path != null else [])


## Hands that are steered have a reach of their own; the box of a device grows with the node.
func _box_grips(device: HapticDevice) -> Array:
	var half := device.get_workspace_radius()
	if half <= 0.0:
		return []
	var found := []
	var is_steered := (
		device.driver
		in [HapticDevice.DRIVER_KEYBOARD, HapticDevice.DRIVER_GAMEPAD, HapticDevice.DRIVER_SPACE_MOUSE]
	)
	for axis: Vector3 in [Vector3.RIGHT, Vector3.UP, Vector3.BACK]:
		if is_steered:
			var reach := func(at: Vector3) -> float: return maxf(at.dot(axis), 0.001)
			found.append(Grip.along("reach", axis * half, axis, device, &"steering_reach", reach))
		else:
			var scale := func(at: Vector3) -> Vector3:
				return device.scale * maxf(at.dot(axis) / device.get_workspace_radius(), 0.01)
			found.append(Grip.along("size of the workspace", axis * half, axis, device, &"scale", scale))
	return found


func _path_grips(path: HapticPath) -> Array:
	if path.form == HapticPath.FORM_POINTS:
		return range(path.points_positions.size()).map(
			func(i: int) -> Grip: return Grip.of_point("point", i, path, &"points_positions")
		)
	if path.form == HapticPath.FORM_CURVE:
		return [] if path.curve == null else Grip.of_curve(path.curve)
	var center := path.circle_center
	var radius := func(at: Vector3) -> float: return maxf(at.x - center.x, 0.0)
	var amplitude := func(at: Vector3) -> float: return maxf(at.y - center.y, 0.0)
	return [
		Grip.along(
			"centre", center, Vector3.ZERO, path, &"circle_center", func(at: Vector3) -> Vector3: return at
		),
		Grip.along(
			"radius",
			center + Vector3(path.circle_radius, 0, 0),
			Vector3.RIGHT,
			path,
			&"circle_radius",
			radius
		),
		Grip.along(
			"amplitude",
			center + Vector3(0, path.circle_amplitude, 0),
			Vector3.UP,
			path,
			&"circle_amplitude",
			amplitude
		),
	]
