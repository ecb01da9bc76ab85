extends MeshInstance3D
## What the pen leaves on the board: a line, the wider the firmer it is pressed.

const PIXELS := Vector2i(960, 540)
const INK := Color(0.1, 0.2, 0.6)
## Of the line, for each newton (unit: pixels).
const WIDTH := 3.0

var _image := Image.create_empty(PIXELS.x, PIXELS.y, false, Image.FORMAT_RGB8)
var _texture: ImageTexture
var _last := Vector2.INF


func _ready() -> void:
	_image.fill(Color.WHITE)
	_texture = ImageTexture.create_from_image(_image)
	var look := StandardMaterial3D.new()
	look.albedo_texture = _texture
	material_override = look


func _process(_delta: float) -> void:
	var contacts := (%ProxyPointer as ProxyPointer).get_contacts()
	if contacts.is_empty():
		_last = Vector2.INF
		return
	var force: Vector3 = contacts[0]["force"]
	var at := to_local(contacts[0]["position"] as Vector3)
	var size := (mesh as QuadMesh).size
	var place := (Vector2(at.x, -at.y) / size + Vector2(0.5, 0.5)) * Vector2(PIXELS)
	var from := place if _last == Vector2.INF else _last
	var width := ceili(1.0 + WIDTH * force.length())
	for i in ceili(from.distance_to(place)) + 1:
		var dot := from.move_toward(place, i) - Vector2(width, width) * 0.5
		_image.fill_rect(Rect2i(dot, Vector2i(width, width)), INK)
	_texture.update(_image)
	_last = place
