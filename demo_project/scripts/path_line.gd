@tool
extends MeshInstance3D
## Draws a HapticPath as a line, in the editor and while the scene plays.

@export var path: HapticPath:
	set(value):
		if path != null:
			path.changed.disconnect(_draw_path)
		path = value
		if path != null:
			path.changed.connect(_draw_path)
		_draw_path()
## In metres.
@export_range(0.0005, 0.02, 0.0005, "suffix:m") var thickness := 0.003:
	set(value):
		thickness = value
		_draw_path()


func _draw_path() -> void:
	mesh = null if path == null else path.create_line_mesh(thickness)
