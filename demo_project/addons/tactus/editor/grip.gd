extends RefCounted
## A handle of a gizmo: a point that is dragged to change one property of one object.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

var name := ""
## Where it is, in metres, in the node's frame.
var place := Vector3.ZERO
## Along which it is dragged, in the node's frame; zero: over the plane that faces the eye.
var axis := Vector3.ZERO
## The node, or a resource of it.
var object: Object
var property: StringName
## What the property becomes when the handle is dragged to a place: value_at.call(place) → Variant.
var value_at: Callable


static func along(
	called: String, at: Vector3, direction: Vector3, owner: Object, of: StringName, becomes: Callable
) -> RefCounted:
	var grip := new()
	grip.name = called
	grip.place = at
	grip.axis = direction
	grip.object = owner
	grip.property = of
	grip.value_at = becomes
	return grip


## One point of a PackedVector3Array. `frame`: of the points, in that of the node.
static func of_point(
	called: String, index: int, owner: Object, of: StringName, frame := Transform3D.IDENTITY
) -> RefCounted:
	var becomes := func(at: Vector3) -> PackedVector3Array:
		var moved: PackedVector3Array = owner.get(of)
		moved[index] = frame.affine_inverse() * at
		return moved
	var points: PackedVector3Array = owner.get(of)
	return along("%s %d" % [called, index], frame * points[index], Vector3.ZERO, owner, of, becomes)


## The points of a curve, and where it leaves and reaches them. `frame`: of the curve, in that of the node.
static func of_curve(curve: Curve3D, frame := Transform3D.IDENTITY) -> Array:
	var found := []
	var into := frame.affine_inverse()
	for i in curve.point_count:
		var point := curve.get_point_position(i)
		var at := func(to: Vector3) -> Vector3: return into * to
		found.append(
			along("point_%d/position" % i, frame * point, Vector3.ZERO, curve, "point_%d/position" % i, at)
		)
		for side: String in ["in", "out"]:
			var bent := "point_%d/%s" % [i, side]
			var bend: Vector3 = curve.get(bent)
			if bend != Vector3.ZERO:
				var from_point := func(to: Vector3) -> Vector3: return into * to - point
				found.append(along(bent, frame * (point + bend), Vector3.ZERO, curve, bent, from_point))
	return found


## Where a ray of the eye drags it to, its direction of unit length as `facing`, which points at the eye. All
## in the node's frame.
func dragged(from: Vector3, direction: Vector3, facing: Vector3) -> Vector3:
	if axis == Vector3.ZERO:
		var at: Variant = Plane(facing, place).intersects_ray(from, direction)
		return place if at == null else at
	# The point of the axis that is nearest to the ray's line.
	var across := axis.cross(direction)
	if across.length_squared() < 1e-6 * axis.length_squared():
		return place
	return place + axis * (from - place).cross(direction).dot(across) / across.length_squared()
