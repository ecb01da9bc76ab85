extends Node
## Draws in the scene itself what the hands feel: forces, contacts and their planes, trails, on demand the
## boxes that triangles are looked for in; and where a link's far side is in this program, the true places of
## the bodies about those of the model.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const FORCE_SCALE := 0.02  # metres a newton
const PLANE := 0.015  # half a side of what is drawn of a contact's plane, metres
const TRAIL := 240  # places
const FORCE_COLOR := Color(1.0, 0.85, 0.2)
const CONTACT_COLOR := Color(0.4, 1.0, 0.5)
const TRAIL_COLOR := Color(0.4, 0.75, 1.0)
const TRUTH_COLOR := Color(1.0, 0.4, 0.7)
const NEAR := 0.02  # boxes of trees that are no farther from a hand, metres
const BOX_COLOR := Color(0.55, 0.6, 0.7, 0.35)
const LEAF_COLOR := Color(1.0, 0.95, 0.6, 0.8)
const BOX := AABB(Vector3(-0.5, -0.5, -0.5), Vector3.ONE)

## Whether the boxes are drawn.
var draws_boxes := false

var _pictures := {}  # by a world's id
var _trails := {}  # by a pointer's id: PackedVector3Array


func set_enabled(enabled: bool) -> void:
	set_process(enabled)
	if not enabled:
		for picture: Variant in _pictures.values():
			if is_instance_valid(picture):
				picture.queue_free()
		_pictures.clear()
		_trails.clear()


func _process(_delta: float) -> void:
	for world: HapticWorld in get_tree().root.find_children("*", "HapticWorld", true, false):
		_draw_world(world)


func _draw_world(world: HapticWorld) -> void:
	var lines := Lines.new()
	for pointer: Node3D in world.find_children("*", "Node3D", true, false):
		if pointer is ProxyPointer or pointer is HapticTool:
			_draw_pointer(pointer, lines)
			if draws_boxes and pointer.is_present():
				_draw_boxes(world, pointer.global_position, lines)
	for link: MMTLink in world.find_children("*", "MMTLink", true, false):
		_draw_truth(world, link, lines)
	lines.fill(_picture(world).mesh)


func _draw_pointer(pointer: Node3D, lines: Lines) -> void:
	if not pointer.is_present():
		_trails.erase(pointer.get_instance_id())
		return
	var at := pointer.global_position
	var trail: PackedVector3Array = _trails.get(pointer.get_instance_id(), PackedVector3Array())
	trail.append(at)
	_trails[pointer.get_instance_id()] = trail.slice(maxi(0, trail.size() - TRAIL))
	for i in range(1, trail.size()):
		lines.add(trail[i - 1], trail[i], TRAIL_COLOR)
	lines.add_arrow(at, pointer.get_force() * FORCE_SCALE, FORCE_COLOR)
	for contact: Dictionary in pointer.get_contacts():
		lines.add_plane(contact.position, contact.normal, PLANE, CONTACT_COLOR)


## The smallest shine: those hold the triangles.
func _draw_boxes(world: HapticWorld, at: Vector3, lines: Lines) -> void:
	var boxes := world.get_tree_boxes(at, NEAR)
	for i in boxes.size():
		var place: Transform3D = boxes[i]
		lines.add_box(BOX, place, BOX_COLOR.lerp(LEAF_COLOR, float(i) / boxes.size()))


## What is there, about what the model has.
func _draw_truth(world: HapticWorld, link: MMTLink, lines: Lines) -> void:
	var partner := link.get_node_or_null(link.partner) as MMTLink
	if partner == null or link.side != MMTLink.SIDE_OPERATOR:
		return
	var far := partner.get_parent() as HapticWorld
	if far == null:
		return
	var into := world.global_transform * far.global_transform.affine_inverse()
	for body: RigidBody3D in far.find_children("*", "RigidBody3D", true, false):
		for picture: MeshInstance3D in body.find_children("*", "MeshInstance3D", true, false):
			lines.add_box(picture.get_aabb(), into * picture.global_transform, TRUTH_COLOR)


func _picture(world: HapticWorld) -> MeshInstance3D:
	var found: Variant = _pictures.get(world.get_instance_id())
	if is_instance_valid(found):
		return found
	var look := StandardMaterial3D.new()
	look.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	look.vertex_color_use_as_albedo = true
	look.no_depth_test = true
	look.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	var picture := MeshInstance3D.new()
	picture.mesh = ImmediateMesh.new()
	picture.material_override = look
	picture.top_level = true
	picture.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	world.add_child(picture, false, Node.INTERNAL_MODE_BACK)
	_pictures[world.get_instance_id()] = picture
	return picture


## Pairs of places in the scene, each with a colour.
class Lines:
	extends RefCounted
	var _places := PackedVector3Array()
	var _colors := PackedColorArray()

	func add(from: Vector3, to: Vector3, color: Color) -> void:
		_places.append_array([from, to])
		_colors.append_array([color, color])

	func add_arrow(from: Vector3, along: Vector3, color: Color) -> void:
		if along.length() < 1e-4:
			return
		var tip := from + along
		add(from, tip, color)
		for side: Vector3 in _across(along.normalized()):
			for way: float in [-1.0, 1.0]:
				add(tip, tip - 0.2 * along + 0.08 * way * along.length() * side, color)

	func add_plane(at: Vector3, normal: Vector3, half: float, color: Color) -> void:
		var sides := _across(normal)
		var corners := [sides[0] + sides[1], sides[0] - sides[1], -sides[0] - sides[1], sides[1] - sides[0]]
		for i in 4:
			add(at + half * corners[i], at + half * corners[(i + 1) % 4], color)
		add(at, at + half * normal, color)

	func add_box(box: AABB, place: Transform3D, color: Color) -> void:
		for corner in 8:
			for axis in 3:
				if corner & (1 << axis) == 0:
					add(place * _corner(box, corner), place * _corner(box, corner | 1 << axis), color)

	func _corner(box: AABB, corner: int) -> Vector3:
		return box.position + box.size * Vector3(corner & 1, corner >> 1 & 1, corner >> 2 & 1)

	## Two directions across it and each other.
	func _across(normal: Vector3) -> Array[Vector3]:
		var other := Vector3.UP if absf(normal.y) < 0.9 else Vector3.RIGHT
		var first := normal.cross(other).normalized()
		return [first, normal.cross(first)]

	func fill(mesh: ImmediateMesh) -> void:
		mesh.clear_surfaces()
		if _places.is_empty():
			return
		mesh.surface_begin(Mesh.PRIMITIVE_LINES)
		for i in _places.size():
			mesh.surface_set_color(_colors[i])
			mesh.surface_add_vertex(_places[i])
		mesh.surface_end()
