extends Node3D
## A room with a headset and a desktop device: starts OpenXR where there is one, gives each controller a hand
## while it is tracked, and lets the controllers vibrate as firmly as their hands are pressed.
##
## Lower thumb button: put the head back before the table. Upper one: grow, so that hands reach farther.

## The force of full vibration, in newtons.
const FULL_FORCE := 4.0
const PULSE_SECONDS := 0.05
## Where the eyes are after a reset, in meters above and before the middle of the table.
const EYES := Vector3(0, 0.45, 0.45)
const SCALES := [1.0, 2.0]

## By the names of their trackers: what reads the controller, and what feels for it.
@onready var _hands := {
	&"left_hand": [%Left, $HapticWorld/LeftHand, $HapticWorld/LeftFinger],
	&"right_hand": [%Right, $HapticWorld/RightHand, $HapticWorld/RightTool],
}


func _ready() -> void:
	var xr := XRServer.find_interface("OpenXR")
	if xr != null and xr.is_initialized():
		get_viewport().use_xr = true
		%Head.current = true
		DisplayServer.window_set_vsync_mode(DisplayServer.VSYNC_DISABLED)
		reset.call_deferred()
	XRServer.tracker_added.connect(_give_hand.bind(HapticDevice.DRIVER_NODE))
	XRServer.tracker_removed.connect(_give_hand.bind(HapticDevice.DRIVER_AUTOMATIC))
	for hand: StringName in _hands:
		if XRServer.get_tracker(hand) != null:
			_give_hand(hand, XRServer.TRACKER_CONTROLLER, HapticDevice.DRIVER_NODE)
		(_hands[hand][0] as XRController3D).button_pressed.connect(_button_pressed)


func _give_hand(tracker: StringName, _type: int, driver: HapticDevice.Driver) -> void:
	if _hands.has(tracker):
		(_hands[tracker][1] as HapticDevice).driver = driver


func _process(_delta: float) -> void:
	for hand: Array in _hands.values():
		var strength := clampf((hand[2] as Node).get_force().length() / FULL_FORCE, 0.0, 1.0)
		if strength > 0.01:
			(hand[0] as XRController3D).trigger_haptic_pulse("haptic", 0.0, strength, PULSE_SECONDS, 0.0)


func _button_pressed(button: String) -> void:
	if button == "by_button":
		%Origin.world_scale = SCALES[(SCALES.find(%Origin.world_scale) + 1) % SCALES.size()]
	if button in ["ax_button", "by_button"]:
		reset()


## The headset stands where it stands: it is the room that moves.
func reset() -> void:
	%Origin.global_position += to_global(EYES) - %Head.global_position
