@tool
extends Node3D
## What every scene stands on: light, and an eye.

## Where the eye is, in metres.
@export var eye := Vector3(0, 0.5, 0.7):
	set(value):
		eye = value
		_turn_camera()
## The point in the middle of the picture, in metres; not straight above or below the eye.
@export var looks_at := Vector3.ZERO:
	set(value):
		looks_at = value
		_turn_camera()


func _ready() -> void:
	_turn_camera()


func _turn_camera() -> void:
	if is_node_ready():
		($Camera3D as Camera3D).transform = Transform3D(Basis.looking_at(looks_at - eye), eye)
