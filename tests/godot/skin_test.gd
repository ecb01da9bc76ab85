extends "nodes_case.gd"
## Meshes that follow a skeleton and blend shapes are touched as they are drawn.


## A plate of 0.4 by 0.4 m in strips along x. It follows two bones: "still" on the left, "lid" on the right,
## and in between by shares; its blend shape lifts all of it by 0.1 m.
func _plate_mesh(mode := Mesh.BLEND_SHAPE_MODE_NORMALIZED) -> ArrayMesh:
	var corners := PackedVector3Array()
	var bones := PackedInt32Array()
	var weights := PackedFloat32Array()
	var lifted := PackedVector3Array()
	for i in 9:
		var share := i / 8.0
		for z: float in [-0.2, 0.2]:
			corners.append(Vector3(0.4 * share - 0.2, 0, z))
			lifted.append(
				(
					Vector3(0, 0.1, 0)
					if mode == Mesh.BLEND_SHAPE_MODE_RELATIVE
					else corners[-1] + Vector3(0, 0.1, 0)
				)
			)
			bones.append_array([0, 1, 0, 0])
			weights.append_array([1.0 - share, share, 0.0, 0.0])
	var indices := PackedInt32Array()
	for i in 8:
		indices.append_array([2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 1, 2 * i + 2, 2 * i + 3])
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = corners
	arrays[Mesh.ARRAY_INDEX] = indices
	arrays[Mesh.ARRAY_BONES] = bones
	arrays[Mesh.ARRAY_WEIGHTS] = weights
	var shape := []
	shape.resize(3)
	shape[Mesh.ARRAY_VERTEX] = lifted
	var mesh := ArrayMesh.new()
	mesh.blend_shape_mode = mode
	mesh.add_blend_shape("lift")
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays, [shape])
	return mesh


class Plate:
	var body := StaticBody3D.new()
	var skeleton := Skeleton3D.new()
	var instance := MeshInstance3D.new()
	var touched := HapticMesh.new()


func _plate(world: HapticWorld, mesh: ArrayMesh) -> Plate:
	var plate := Plate.new()
	for bone: String in ["still", "lid"]:
		plate.skeleton.add_bone(bone)
	plate.instance.mesh = mesh
	plate.body.physics_material_override = material(500.0)
	plate.skeleton.add_child(plate.instance)
	plate.body.add_child(plate.skeleton)
	plate.body.add_child(plate.touched)
	plate.instance.skeleton = NodePath("..")
	plate.touched.mesh_instance = NodePath("../" + str(plate.body.get_path_to(plate.instance)))
	world.add_child(plate.body)
	return plate


func _hand(world: HapticWorld, x: float) -> ProxyPointer:
	return add_hand(world, path(Vector3(x, 0.3, 0), Vector3(x, -0.005, 0), 0.3))


func test_a_mesh_at_rest_is_touched_where_it_lies() -> void:
	var world := add_world()
	var plate := _plate(world, _plate_mesh())
	var proxy := _hand(world, 0.1)
	world.advance(0.6)
	check_near(proxy.get_proxy_position(), Vector3(0.1, 0.01, 0), 1e-3, "proxy")
	check_equal(plate.touched.get_problems().size(), 0, "warnings")


func test_a_skinned_mesh_is_touched_where_its_bones_have_it() -> void:
	var world := add_world()
	var plate := _plate(world, _plate_mesh())
	var proxy := _hand(world, 0.1)
	world.advance(0.6)
	var force_before := proxy.get_force().y
	for i in 40:
		plate.skeleton.set_bone_pose_position(1, Vector3(0, 0.002 * (i + 1), 0))
		await frames(1)
		world.advance(0.02)
	# At x = 0.1 three quarters of it follow the lid, which was lifted by 80 mm: the plate rises by a fifth, and
	# the proxy lies on it where it is nearest to the hand.
	var up := Vector3(-0.2, 1, 0).normalized()
	var hand := Vector3(0.1, -0.005, 0)
	var below := (Vector3(0.1, 0.06, 0) - hand).dot(up)
	check_near(proxy.get_proxy_position(), hand + (below + 0.01) * up, 1e-3, "proxy")
	check(proxy.get_force().y > force_before + 10.0, "force %s" % proxy.get_force())


func test_blend_shapes_of_both_modes_are_felt() -> void:
	for mode: Mesh.BlendShapeMode in [Mesh.BLEND_SHAPE_MODE_NORMALIZED, Mesh.BLEND_SHAPE_MODE_RELATIVE]:
		var world := add_world()
		var plate := _plate(world, _plate_mesh(mode))
		var proxy := _hand(world, -0.1)
		world.advance(0.6)
		for i in 10:
			plate.instance.set_blend_shape_value(0, 0.05 * (i + 1))
			await frames(1)
			world.advance(0.02)
		check_near(proxy.get_proxy_position().y, 0.01 + 0.05, 2e-3, "proxy, mode %d" % mode)


## What the engine draws: each corner where the bones take it, by their weights.
func test_turned_bones_take_their_corners_along() -> void:
	var world := add_world()
	var plate := _plate(world, _plate_mesh())
	plate.skeleton.set_bone_pose_position(1, Vector3(0.02, 0.05, 0.01))
	plate.skeleton.set_bone_pose_rotation(1, Quaternion(Vector3(0, 0, 1), 0.2))
	await frames(1)
	var arrays := plate.instance.mesh.surface_get_arrays(0)
	var corners: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var lid := plate.skeleton.get_bone_global_pose(1)
	for i in corners.size():
		corners[i] = corners[i].lerp(lid * corners[i], (i / 2) / 8.0)
	var drawn := []
	drawn.resize(Mesh.ARRAY_MAX)
	drawn[Mesh.ARRAY_VERTEX] = corners
	drawn[Mesh.ARRAY_INDEX] = arrays[Mesh.ARRAY_INDEX]
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, drawn)
	var here := _hand(world, 0.1)
	world.advance(0.6)
	var there_world := add_world()
	var touched := HapticMesh.new()
	touched.mesh = mesh
	var body := StaticBody3D.new()
	body.physics_material_override = material(500.0)
	body.add_child(touched)
	there_world.add_child(body)
	var there := _hand(there_world, 0.1)
	there_world.advance(0.6)
	check(there.get_proxy_position().y > 0.04, "it was lifted: %s" % there.get_proxy_position())
	check_near(here.get_proxy_position(), there.get_proxy_position(), 1e-5, "proxies")


func test_a_path_that_leads_nowhere_is_said() -> void:
	var world := add_world()
	var plate := _plate(world, _plate_mesh())
	plate.touched.mesh_instance = NodePath("../Nobody")
	world.advance(0.1)
	var said := str(plate.touched.get_problems())
	check("no mesh to follow" in said, said)
