extends HapticTool
## Turns the tool in the hand: W and S about the view's x axis, A and D about its z axis, Q and E about the
## vertical, and the wheel about the vertical while Shift is held.

const SPEED := 1.5  # radians a second
const WHEEL_STEP := 0.1  # radians

var _turn := Basis.IDENTITY


func _process(delta: float) -> void:
	var axis := Vector3(
		_pressed(KEY_S) - _pressed(KEY_W),
		_pressed(KEY_Q) - _pressed(KEY_E),
		_pressed(KEY_A) - _pressed(KEY_D)
	)
	if axis != Vector3.ZERO:
		_turn_by(axis.normalized(), SPEED * delta)


func _input(event: InputEvent) -> void:
	var button := event as InputEventMouseButton
	if button == null or not button.pressed or not button.shift_pressed:
		return
	if button.button_index in [MOUSE_BUTTON_WHEEL_UP, MOUSE_BUTTON_WHEEL_DOWN]:
		_turn_by(Vector3.UP, WHEEL_STEP if button.button_index == MOUSE_BUTTON_WHEEL_UP else -WHEEL_STEP)
		get_viewport().set_input_as_handled()


func _pressed(key: Key) -> float:
	return 1.0 if Input.is_physical_key_pressed(key) else 0.0


func _turn_by(axis: Vector3, angle: float) -> void:
	_turn = (Basis(axis, angle) * _turn).orthonormalized()
	grasp_rotation = _turn.get_euler()
