extends Node3D
## Turns what stands on it.

## In radians a second.
@export var speed := 0.3


func _process(delta: float) -> void:
	rotate_y(speed * delta)
