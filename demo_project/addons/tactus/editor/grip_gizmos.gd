@tool
extends EditorNode3DGizmoPlugin
## Lines and handles of one class of nodes. What inherits says which lines, and which property each handle
## changes; dragging and undoing are the same for all.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const Grip := preload("grip.gd")
const LINES := "lines"
const HANDLES := "handles"

var _undo_redo: EditorUndoRedoManager


func _init(undo_redo: EditorUndoRedoManager = null, color := Color(0.35, 0.7, 1.0)) -> void:
	_undo_redo = undo_redo
	create_material(LINES, color)
	create_handle_material(HANDLES)


## What inherits says these three.
func _class_name() -> String:
	return ""


## Pairs of points, in metres, in the node's frame.
func lines(_node: Node3D) -> PackedVector3Array:
	return PackedVector3Array()


## An array of Grip.
func grips(_node: Node3D) -> Array:
	return []


func _get_gizmo_name() -> String:
	return _class_name()


func _has_gizmo(node: Node3D) -> bool:
	return node.is_class(_class_name())


func _redraw(gizmo: EditorNode3DGizmo) -> void:
	gizmo.clear()
	var node := gizmo.get_node_3d()
	var drawn := lines(node)
	if not drawn.is_empty():
		gizmo.add_lines(drawn, get_material(LINES, gizmo))
		gizmo.add_collision_segments(drawn)
	var places := PackedVector3Array()
	for grip: Grip in grips(node):
		places.append(grip.place)
		_follow(grip.object, node)
	if not places.is_empty():
		gizmo.add_handles(places, get_material(HANDLES, gizmo), PackedInt32Array())


## A resource that changes changes the picture.
func _follow(object: Object, node: Node3D) -> void:
	var resource := object as Resource
	if resource != null and not resource.changed.is_connected(node.update_gizmos):
		resource.changed.connect(node.update_gizmos)


func _get_handle_name(gizmo: EditorNode3DGizmo, id: int, _secondary: bool) -> String:
	return grips(gizmo.get_node_3d())[id].name


func _get_handle_value(gizmo: EditorNode3DGizmo, id: int, _secondary: bool) -> Variant:
	var grip: Grip = grips(gizmo.get_node_3d())[id]
	return grip.object.get(grip.property)


func _set_handle(
	gizmo: EditorNode3DGizmo, id: int, _secondary: bool, camera: Camera3D, point: Vector2
) -> void:
	var into_node := gizmo.get_node_3d().global_transform.affine_inverse()
	var from := into_node * camera.project_ray_origin(point)
	var direction := (into_node.basis * camera.project_ray_normal(point)).normalized()
	var facing := (into_node.basis * camera.global_basis.z).normalized()
	drag(gizmo.get_node_3d(), id, from, direction, facing)


## Drags a handle to where a ray of the eye leads it.
func drag(node: Node3D, id: int, from: Vector3, direction: Vector3, facing: Vector3) -> void:
	var grip: Grip = grips(node)[id]
	grip.object.set(grip.property, grip.value_at.call(grip.dragged(from, direction, facing)))
	node.update_gizmos()


func _commit_handle(
	gizmo: EditorNode3DGizmo, id: int, _secondary: bool, restore: Variant, cancel: bool
) -> void:
	var node := gizmo.get_node_3d()
	var grip: Grip = grips(node)[id]
	if cancel:
		grip.object.set(grip.property, restore)
		return
	_undo_redo.create_action("Set %s" % grip.name)
	_undo_redo.add_do_property(grip.object, grip.property, grip.object.get(grip.property))
	_undo_redo.add_do_method(node, &"update_gizmos")
	_undo_redo.add_undo_property(grip.object, grip.property, restore)
	_undo_redo.add_undo_method(node, &"update_gizmos")
	_undo_redo.commit_action()


## Three circles about the origin.
static func sphere_lines(radius: float, center := Vector3.ZERO) -> PackedVector3Array:
	const STEPS := 48
	var drawn := PackedVector3Array()
	for plane: Array in [
		[Vector3.RIGHT, Vector3.UP], [Vector3.UP, Vector3.BACK], [Vector3.BACK, Vector3.RIGHT]
	]:
		for i in STEPS:
			for k: int in [i, i + 1]:
				var angle := TAU * k / STEPS
				drawn.append(center + radius * (cos(angle) * plane[0] + sin(angle) * plane[1]))
	return drawn


static func box_lines(box: AABB, place := Transform3D.IDENTITY) -> PackedVector3Array:
	var drawn := PackedVector3Array()
	for axis in 3:
		for corner in 8:
			if corner & (1 << axis) == 0:
				drawn.append(place * box.get_endpoint(_endpoint(corner)))
				drawn.append(place * box.get_endpoint(_endpoint(corner | (1 << axis))))
	return drawn


## AABB counts its corners with z as the first bit.
static func _endpoint(corner: int) -> int:
	return (corner & 1) << 2 | (corner & 2) | (corner & 4) >> 2


static func polyline(points: PackedVector3Array, frame := Transform3D.IDENTITY) -> PackedVector3Array:
	var drawn := PackedVector3Array()
	for i in range(1, points.size()):
		drawn.append(frame * points[i - 1])
		drawn.append(frame * points[i])
	return drawn
