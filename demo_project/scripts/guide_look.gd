@tool
extends MeshInstance3D
## Shows a HapticGuide as a line, in the editor and while the scene plays.

@export var guide: HapticGuide:
	set(value):
		if guide != null:
			guide.changed.disconnect(_draw_guide)
		guide = value
		if guide != null:
			guide.changed.connect(_draw_guide)
		_draw_guide()


func _draw_guide() -> void:
	mesh = null if guide == null else guide.create_line_mesh(0.004)
