@tool
extends MeshInstance3D
## Shows a mesh of the library, as it is touched.

@export var library_mesh := "":
	set(value):
		library_mesh = value
		mesh = null if library_mesh.is_empty() else HapticMesh.create_library_mesh(library_mesh)


## What is made here is made again when the scene is opened: it is not stored.
func _validate_property(property: Dictionary) -> void:
	if property.name == "mesh":
		property.usage &= ~PROPERTY_USAGE_STORAGE
