extends Node
## The operator's model stands where the real things are shown: what is drawn of it goes where no
## stage looks (its layer 2), as the real things do that the camera alone is to see.

const LAYER := 2

@export var link: MMTLink


func _ready() -> void:
	link.object_discovered.connect(_hide)


func _hide(_name: String, node: Node3D) -> void:
	for picture: MeshInstance3D in node.find_children("*", "MeshInstance3D", true, false):
		picture.layers = 1 << (LAYER - 1)
