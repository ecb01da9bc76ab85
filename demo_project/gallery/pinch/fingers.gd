extends Node3D
## Two fingers of one hand that the mouse moves; they close while its left button or the space bar is held.

## From the hand's middle to each fingertip, in metres.
const OPENED := 0.055
const CLOSED := 0.033
## In metres a second.
const SPEED := 0.06

@export var hand: HapticDevice

var _apart := OPENED


func _process(delta: float) -> void:
	var closes := Input.is_mouse_button_pressed(MOUSE_BUTTON_LEFT) or Input.is_physical_key_pressed(KEY_SPACE)
	_apart = move_toward(_apart, CLOSED if closes else OPENED, SPEED * delta)
	global_position = hand.get_hand_position()
	($Left as Node3D).position.x = -_apart
	($Right as Node3D).position.x = _apart
