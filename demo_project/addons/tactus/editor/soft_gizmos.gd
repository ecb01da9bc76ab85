@tool
extends "grip_gizmos.gd"
## Of a HapticSoftBody: the box about it, and the box of what is held, whose faces are dragged.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")


func _class_name() -> String:
	return "HapticSoftBody"


func lines(node: Node3D) -> PackedVector3Array:
	var body := node as HapticSoftBody
	var drawn := PackedVector3Array()
	if body.mesh != null:
		drawn.append_array(box_lines(body.mesh.get_aabb()))
	if body.held.has_volume():
		drawn.append_array(box_lines(body.held))
	return drawn


func grips(node: Node3D) -> Array:
	var body := node as HapticSoftBody
	if not body.held.has_volume():
		return []
	var found := []
	for axis: Vector3 in [Vector3.RIGHT, Vector3.UP, Vector3.BACK]:
		for side: float in [1.0, -1.0]:
			var face := body.held.get_center() + side * 0.5 * body.held.size * axis
			var held := func(at: Vector3) -> AABB: return _with_face(body.held, axis, side, at.dot(axis))
			found.append(Grip.along("what is held", face, axis, body, &"held", held))
	return found


## The box whose face on that side of the axis is there; never turned inside out.
func _with_face(box: AABB, axis: Vector3, side: float, there: float) -> AABB:
	var low := box.position
	var high := box.end
	if side > 0.0:
		high += axis * (maxf(there, low.dot(axis) + 0.001) - high.dot(axis))
	else:
		low += axis * (minf(there, high.dot(axis) - 0.001) - low.dot(axis))
	return AABB(low, high - low)
