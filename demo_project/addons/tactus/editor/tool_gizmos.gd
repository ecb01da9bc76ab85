@tool
extends "grip_gizmos.gd"
## Of a HapticTool: the box about it, and where the hand holds it.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const CROSS := 0.01  # metres


func _class_name() -> String:
	return "HapticTool"


func lines(node: Node3D) -> PackedVector3Array:
	var tool := node as HapticTool
	var drawn := PackedVector3Array()
	if tool.mesh != null:
		drawn.append_array(box_lines(tool.mesh.get_aabb()))
	for axis: Vector3 in [Vector3.RIGHT, Vector3.UP, Vector3.BACK]:
		drawn.append_array([_held_at(tool) - CROSS * axis, _held_at(tool) + CROSS * axis])
	return drawn


## The hand in the frame of the mesh.
func _held_at(tool: HapticTool) -> Vector3:
	return -(Basis.from_euler(tool.grasp_rotation).inverse() * tool.grasp_position)


func grips(node: Node3D) -> Array:
	var tool := node as HapticTool
	var position := func(at: Vector3) -> Vector3: return -(Basis.from_euler(tool.grasp_rotation) * at)
	return [Grip.along("grasp", _held_at(tool), Vector3.ZERO, tool, &"grasp_position", position)]
