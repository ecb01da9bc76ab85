extends MeshInstance3D
## Is where the robot's tip is.

@export var robot: HapticDevice


func _process(_delta: float) -> void:
	global_position = robot.get_hand_position()
