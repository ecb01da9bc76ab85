@tool
extends "grip_gizmos.gd"
## Of a HapticMesh: the edges of what is touched; of many triangles the box about them.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const MOST_TRIANGLES := 20000


func _class_name() -> String:
	return "HapticMesh"


func lines(node: Node3D) -> PackedVector3Array:
	var mesh := _touched(node as HapticMesh)
	if mesh == null:
		return PackedVector3Array()
	var corners := mesh.get_faces()
	if corners.size() > 3 * MOST_TRIANGLES:
		return box_lines(mesh.get_aabb())
	var drawn := PackedVector3Array()
	for i in range(0, corners.size(), 3):
		for k in 3:
			drawn.append(corners[i + k])
			drawn.append(corners[i + (k + 1) % 3])
	return drawn


func _touched(node: HapticMesh) -> Mesh:
	if node.volume != null:
		return node.volume.create_mesh()
	if node.mesh != null:
		return node.mesh
	return null if node.library_mesh.is_empty() else HapticMesh.create_library_mesh(node.library_mesh)
