@tool
extends MeshInstance3D
## Draws a HapticPath or a HapticGuide as a line, in the editor and while the scene plays.

@export_custom(PROPERTY_HINT_RESOURCE_TYPE, "HapticPath,HapticGuide") var line: Resource:
	set(value):
		if line != null:
			line.changed.disconnect(_draw_line)
		line = value
		if line != null:
			line.changed.connect(_draw_line)
		_draw_line()
## In metres.
@export_range(0.0005, 0.02, 0.0005, "suffix:m") var thickness := 0.003:
	set(value):
		thickness = value
		_draw_line()


func _draw_line() -> void:
	mesh = null if line == null else line.create_line_mesh(thickness)


## What is made here is made again when the scene is opened: it is not stored.
func _validate_property(property: Dictionary) -> void:
	if property.name == "mesh":
		property.usage &= ~PROPERTY_USAGE_STORAGE
