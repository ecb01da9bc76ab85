@tool
extends "grip_gizmos.gd"
## Of a HapticWorld: the ghosts of its model. Where a link of it errs about a body on purpose
## (MMTLink.model_errors), the body is drawn where the operator's model has it.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")


func _class_name() -> String:
	return "HapticWorld"


func lines(node: Node3D) -> PackedVector3Array:
	var drawn := PackedVector3Array()
	for link: MMTLink in node.find_children("*", "MMTLink", true, false):
		for path: String in link.model_errors:
			var body := node.get_node_or_null(path) as Node3D
			if body != null:
				drawn.append_array(_ghost(node, body, link.model_errors[path]))
	return drawn


func _ghost(world: Node3D, body: Node3D, error: Dictionary) -> PackedVector3Array:
	var place := world.global_transform.affine_inverse() * body.global_transform
	var move: Array = error.get("move", [0, 0, 0])
	var turn: Array = error.get("turn", [0, 1, 0, 0])
	place.origin += Vector3(move[0], move[1], move[2])
	place.basis = Basis(Vector3(turn[0], turn[1], turn[2]).normalized(), deg_to_rad(turn[3])) * place.basis
	var drawn := PackedVector3Array()
	for child: Node in body.find_children("*", "MeshInstance3D", true, false):
		var picture := child as MeshInstance3D
		var within := body.global_transform.affine_inverse() * picture.global_transform
		drawn.append_array(box_lines(picture.get_aabb(), place * within))
	return drawn
