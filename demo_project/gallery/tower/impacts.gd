extends Label3D
## The hardest knock so far, and how many blocks lie on the ground.

## A block whose middle is lower lies on the ground (unit: meters).
const FALLEN := 0.02
## Blocks that lie on the ground from the beginning.
const LOWEST := 3

var _hardest := 0.0
var _knock := "not touched yet"

@onready var _blocks := %ProxyPointer.get_parent().find_children("Block*", "RigidBody3D", false)


func _ready() -> void:
	(%ProxyPointer as ProxyPointer).impact.connect(_on_impact)


func _on_impact(_body: Node3D, speed: float, impulse: float) -> void:
	if impulse > _hardest:
		_hardest = impulse
		_knock = "hardest knock: %.0f mN·s at %.2f m/s" % [1e3 * impulse, speed]


func _process(_delta: float) -> void:
	text = "%s\n%d fallen" % [_knock, _blocks.filter(_lies).size() - LOWEST]


func _lies(block: RigidBody3D) -> bool:
	return block.global_position.y < FALLEN
