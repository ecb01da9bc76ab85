@tool
extends "grip_gizmos.gd"
## Of a ProxyPointer: its sphere, and the guide that leads it.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")


func _class_name() -> String:
	return "ProxyPointer"


func lines(node: Node3D) -> PackedVector3Array:
	var pointer := node as ProxyPointer
	var drawn := sphere_lines(pointer.radius)
	if pointer.guide != null:
		drawn.append_array(polyline(_way(pointer.guide), _from_world(node)))
	return drawn


func _way(guide: HapticGuide) -> PackedVector3Array:
	return guide.points if guide.curve == null else guide.curve.tessellate()


func grips(node: Node3D) -> Array:
	var pointer := node as ProxyPointer
	var radius := func(at: Vector3) -> float: return maxf(at.x, 0.0005)
	var found := [
		Grip.along("radius", Vector3(pointer.radius, 0, 0), Vector3.RIGHT, pointer, &"radius", radius)
	]
	if pointer.guide != null and pointer.guide.curve != null:
		found.append_array(Grip.of_curve(pointer.guide.curve, _from_world(node)))
	elif pointer.guide != null:
		for i in pointer.guide.points.size():
			found.append(Grip.of_point("guide's point", i, pointer.guide, &"points", _from_world(node)))
	return found


## A guide's points are the world's.
func _from_world(node: Node3D) -> Transform3D:
	return node.global_transform.affine_inverse()
