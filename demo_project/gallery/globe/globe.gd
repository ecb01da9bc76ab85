extends HapticMesh
## A globe of two surfaces: the caps of ice have a material of their own, and over the rest lie images by
## its texture coordinates: what is land is raised and rough. "Look" beside it shows the same mesh and map.

const RADIUS := 0.11  # metres
const RINGS := 48
const SEGMENTS := 96
const CAP_RINGS := 6  # at each pole
const MAP := Vector2i(256, 128)  # pixels
const SEA_ROUGHNESS := 0.15  # of the land's

@export var land: HapticMaterial
@export var ice: HapticMaterial
@export var land_look: StandardMaterial3D
@export var ice_look: StandardMaterial3D


func _ready() -> void:
	var globe := ArrayMesh.new()
	var caps := _rings(0, CAP_RINGS)
	caps.append_array(_rings(RINGS - CAP_RINGS, RINGS))
	_add_surface(globe, _rings(CAP_RINGS, RINGS - CAP_RINGS))
	_add_surface(globe, caps)
	_draw_map()
	var look := get_node("../Look") as MeshInstance3D
	look.mesh = globe
	look.set_surface_override_material(0, land_look)
	look.set_surface_override_material(1, ice_look)
	surface_materials = [land, ice]
	mesh = globe


func _rings(from: int, to: int) -> PackedInt32Array:
	var indices := PackedInt32Array()
	for ring in range(from, to):
		for segment in SEGMENTS:
			var corner := ring * (SEGMENTS + 1) + segment
			var below := corner + SEGMENTS + 1
			if ring > 0:
				indices.append_array([corner, corner + 1, below])
			if ring < RINGS - 1:
				indices.append_array([below, corner + 1, below + 1])
	return indices


func _add_surface(globe: ArrayMesh, indices: PackedInt32Array) -> void:
	var corners := PackedVector3Array()
	var normals := PackedVector3Array()
	var places := PackedVector2Array()
	for ring in RINGS + 1:
		for segment in SEGMENTS + 1:
			var place := Vector2(float(segment) / SEGMENTS, float(ring) / RINGS)
			places.append(place)
			normals.append(_direction(place))
			corners.append(RADIUS * _direction(place))
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = corners
	arrays[Mesh.ARRAY_NORMAL] = normals
	arrays[Mesh.ARRAY_TEX_UV] = places
	arrays[Mesh.ARRAY_INDEX] = indices
	globe.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)


## Of a place on the map, from 0 to 1 to the east and to the south.
func _direction(place: Vector2) -> Vector3:
	var polar := PI * place.y
	var azimuth := TAU * (1.0 if is_equal_approx(place.x, 1.0) else place.x)
	return Vector3(sin(polar) * cos(azimuth), cos(polar), -sin(polar) * sin(azimuth))


func _draw_map() -> void:
	var noise := FastNoiseLite.new()
	noise.seed = 5
	noise.frequency = 1.1
	var colours := Image.create_empty(MAP.x, MAP.y, false, Image.FORMAT_RGB8)
	var heights := Image.create_empty(MAP.x, MAP.y, false, Image.FORMAT_L8)
	var roughness := Image.create_empty(MAP.x, MAP.y, false, Image.FORMAT_L8)
	for y in MAP.y:
		for x in MAP.x:
			var above_sea := noise.get_noise_3dv(
				_direction((Vector2(x, y) + 0.5 * Vector2.ONE) / Vector2(MAP))
			)
			var coast := smoothstep(-0.01, 0.04, above_sea)
			var height := coast * (0.5 + clampf(above_sea, 0.0, 0.5))
			heights.set_pixel(x, y, Color(height, height, height))
			var rough := lerpf(SEA_ROUGHNESS, 1.0, coast)
			roughness.set_pixel(x, y, Color(rough, rough, rough))
			colours.set_pixel(
				x, y, Color(0.1, 0.24, 0.42).lerp(Color(0.36, 0.42, 0.2).lightened(0.6 * height - 0.3), coast)
			)
	land.texture_image = ImageTexture.create_from_image(heights)
	land.friction_image = ImageTexture.create_from_image(roughness)
	land_look.albedo_texture = ImageTexture.create_from_image(colours)
