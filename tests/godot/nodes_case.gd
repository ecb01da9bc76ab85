extends "test_case.gd"
## What tests of the haptic nodes share: small worlds in stepped time, built by hand.

const TICK := 0.001


## A world without gravity whose ticks the test makes.
func add_world() -> HapticWorld:
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	world.gravity = Vector3.ZERO
	add_child(world)
	return world


## Whose bodies Godot's own physics moves.
func add_godot_world(surface: HapticMaterial = null) -> HapticWorld:
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	world.authority = HapticWorld.AUTHORITY_GODOT
	world.default_material = surface
	add_child(world)
	return world


## A scene of the demo, in stepped time as well.
func add_scene(scene_path: String) -> Node:
	var scene := (load(scene_path) as PackedScene).instantiate()
	var world: HapticWorld = scene.get_node("HapticWorld")
	world.clock = HapticWorld.CLOCK_STEPPED
	add_child(scene)
	return scene


## Without friction.
func material(stiffness: float) -> HapticMaterial:
	var result := HapticMaterial.new()
	result.stiffness = stiffness
	result.static_friction = 0.0
	result.dynamic_friction = 0.0
	return result


static func with_shape(body: CollisionObject3D, shape: Shape3D, at := Vector3.ZERO) -> CollisionObject3D:
	var child := CollisionShape3D.new()
	child.name = "Shape"
	child.shape = shape
	body.add_child(child)
	body.position = at
	return body


static func box(size: Vector3) -> BoxShape3D:
	var shape := BoxShape3D.new()
	shape.size = size
	return shape


static func sphere(radius: float) -> SphereShape3D:
	var shape := SphereShape3D.new()
	shape.radius = radius
	return shape


## Tiles of one meter, whose upper surface is at y = 0: so many to each side of the middle.
static func tiles(to_each_side: int) -> GridMap:
	var library := MeshLibrary.new()
	library.create_item(0)
	library.set_item_shapes(0, [box(Vector3.ONE), Transform3D()])
	var grid := GridMap.new()
	grid.mesh_library = library
	grid.cell_size = Vector3.ONE
	for x in range(-to_each_side, to_each_side):
		for z in range(-to_each_side, to_each_side):
			grid.set_cell_item(Vector3i(x, -1, z), 0)
	return grid


## A floor whose surface is at y = 0.
func add_floor(world: HapticWorld, stiffness := 500.0) -> StaticBody3D:
	var body := with_shape(StaticBody3D.new(), box(Vector3(2, 0.2, 2)), Vector3(0, -0.1, 0)) as StaticBody3D
	body.name = "Floor"
	body.physics_material_override = material(stiffness)
	world.add_child(body)
	return body


## A hand that goes from one place to another in a second and stays there.
func path(from: Vector3, to: Vector3, seconds := 1.0) -> HapticPath:
	var result := HapticPath.new()
	result.form = HapticPath.FORM_POINTS
	result.points_positions = PackedVector3Array([from, to])
	result.points_times = PackedFloat64Array([0.0, seconds])
	result.points_interpolation = HapticPath.INTERPOLATION_LINEAR
	return result


func add_device(world: HapticWorld, way: HapticPath) -> HapticDevice:
	var device := HapticDevice.new()
	device.name = "Device"
	device.path = way
	world.add_child(device)
	return device


func add_hand(world: HapticWorld, way: HapticPath, radius := 0.01) -> ProxyPointer:
	add_device(world, way)
	var proxy := ProxyPointer.new()
	proxy.name = "Proxy"
	proxy.radius = radius
	proxy.device = NodePath("../Device")
	world.add_child(proxy)
	return proxy


## Grey by `at` of each pixel, 0 to 1.
func image_of(width: int, height: int, at: Callable) -> ImageTexture:
	var image := Image.create_empty(width, height, false, Image.FORMAT_L8)
	for y in height:
		for x in width:
			var value: float = at.call(x, y)
			image.set_pixel(x, y, Color(value, value, value))
	return ImageTexture.create_from_image(image)
