@tool
extends "grip_gizmos.gd"
## Of a HapticSoftBody: the edges of its mesh at rest, and the box in which it is held.


func _class_name() -> String:
	return "HapticSoftBody"


func lines(node: Node3D) -> PackedVector3Array:
	var soft := node as HapticSoftBody
	var drawn := PackedVector3Array()
	if soft.mesh != null:
		var corners := soft.mesh.get_faces()
		for i in range(0, corners.size(), 3):
			for k in 3:
				drawn.append(corners[i + k])
				drawn.append(corners[i + (k + 1) % 3])
	if soft.held.size != Vector3.ZERO:
		drawn.append_array(box_lines(soft.held))
	return drawn
