extends "nodes_case.gd"
## The gallery's room for a headset, with trackers that the test moves in the place of a headset's.

const FRAME := 1.0 / 60.0
const STIFFNESS := 500.0


## Keeps what a headset would have been told.
class Headset:
	extends XRInterfaceExtension
	var pulses: Array[Dictionary] = []

	func _get_name() -> StringName:
		return &"Headset of the test"

	func _get_capabilities() -> int:
		return 0

	func _is_initialized() -> bool:
		return true

	func _trigger_haptic_pulse(
		action: String, tracker: StringName, frequency: float, amplitude: float, seconds: float, delay: float
	) -> void:
		pulses.append({"tracker": tracker, "amplitude": amplitude, "seconds": seconds, "action": action})
		assert(frequency == 0.0 and delay == 0.0)


var _headset := Headset.new()
var _trackers := {}


func _ready() -> void:
	XRServer.add_interface(_headset)
	XRServer.primary_interface = _headset


func _exit_tree() -> void:
	for tracker: XRPositionalTracker in _trackers.values():
		XRServer.remove_tracker(tracker)
	XRServer.primary_interface = null
	XRServer.remove_interface(_headset)


func _add_tracker(label: StringName) -> void:
	var tracker := XRControllerTracker.new()
	tracker.name = label
	tracker.type = XRServer.TRACKER_CONTROLLER
	_trackers[label] = tracker
	XRServer.add_tracker(tracker)


## Where the hand is in the room, whatever its scale.
func _lead(room: Node3D, label: StringName, place: Vector3, turn := Basis()) -> void:
	var origin := room.get_node("Origin") as XROrigin3D
	var pose := Transform3D(turn, (place - origin.global_position) / origin.world_scale)
	var tracker := _trackers[label] as XRPositionalTracker
	tracker.set_pose("default", pose, Vector3.ZERO, Vector3.ZERO, XRPose.XR_TRACKING_CONFIDENCE_HIGH)


func _press(label: StringName, button: String) -> void:
	var tracker := _trackers[label] as XRPositionalTracker
	tracker.set_input(button, true)
	await frames(1)
	tracker.set_input(button, false)


func _room() -> Node3D:
	var room := (load("res://gallery/vr/vr.tscn") as PackedScene).instantiate() as Node3D
	(room.get_node("HapticWorld") as HapticWorld).clock = HapticWorld.CLOCK_STEPPED
	add_child(room)
	return room


func _play(room: Node3D, count: int) -> void:
	for _i in count:
		(room.get_node("HapticWorld") as HapticWorld).advance(FRAME)
		await get_tree().process_frame


func test_controllers_lead_hands_and_vibrate_as_firmly_as_they_press() -> void:
	var room := _room()
	_add_tracker(&"left_hand")
	var device := room.get_node("HapticWorld/LeftHand") as HapticDevice
	check_equal(device.driver, HapticDevice.DRIVER_NODE, "driver")
	check_equal(
		(room.get_node("HapticWorld/RightHand") as HapticDevice).driver,
		HapticDevice.DRIVER_AUTOMATIC,
		"the other"
	)
	var finger := room.get_node("HapticWorld/LeftFinger") as ProxyPointer
	var top := Vector3(-0.2, 0.13, 0)
	_lead(room, &"left_hand", top + Vector3(0, 0.1, 0))
	await _play(room, 60)
	check_near(device.get_hand_position(), top + Vector3(0, 0.1, 0), 1e-3, "hand")
	_headset.pulses = _headset.pulses.filter(_is_right)
	check_equal(_headset.pulses.filter(_is_left).size(), 0, "pulses in the air")
	var strengths := {}
	for depth: float in [0.001, 0.002, 0.004]:
		_lead(room, &"left_hand", top - Vector3(0, depth, 0))
		await _play(room, 90)
		_headset.pulses.clear()
		await _play(room, 2)
		var pulses := _headset.pulses.filter(_is_left)
		check(pulses.size() > 0, "%s m: no pulse" % depth)
		if not pulses.is_empty():
			strengths[depth] = pulses[-1].amplitude
			check_near(pulses[-1].amplitude, finger.get_force().length() / 4.0, 1e-3, "amplitude")
			check(pulses[-1].seconds > 0.0 and pulses[-1].action == "haptic", "%s" % [pulses[-1]])
	check_near(strengths.get(0.002, 0.0), 2.0 * strengths.get(0.001, 1.0), 0.02, "twice as deep")
	check_near(strengths.get(0.004, 0.0), 4.0 * strengths.get(0.001, 1.0), 0.04, "four times as deep")
	room.free()


func _is_left(pulse: Dictionary) -> bool:
	return pulse.tracker == &"left_hand"


func _is_right(pulse: Dictionary) -> bool:
	return pulse.tracker == &"right_hand"


func test_a_tool_turns_with_its_controller() -> void:
	var room := _room()
	_add_tracker(&"right_hand")
	var turn := Basis(Vector3.UP, 0.7) * Basis(Vector3.RIGHT, 0.3)
	_lead(room, &"right_hand", Vector3(0.2, 0.3, 0.1), turn)
	await _play(room, 90)
	var tool := room.get_node("HapticWorld/RightTool") as HapticTool
	check_near(tool.global_position, Vector3(0.2, 0.3, 0.1), 2e-3, "place")
	var off := tool.global_basis.get_rotation_quaternion().angle_to(turn.get_rotation_quaternion())
	check(off < 0.01, "its rotation is off by %s rad" % off)
	room.free()


func test_a_controller_that_is_lost_leaves_its_hand_to_the_path() -> void:
	var room := _room()
	_add_tracker(&"left_hand")
	XRServer.remove_tracker(_trackers[&"left_hand"])
	_trackers.erase(&"left_hand")
	var device := room.get_node("HapticWorld/LeftHand") as HapticDevice
	check_equal(device.driver, HapticDevice.DRIVER_AUTOMATIC, "driver")
	room.free()


func test_buttons_put_the_head_back_and_make_the_person_grow() -> void:
	var room := _room()
	_add_tracker(&"left_hand")
	var origin := room.get_node("Origin") as XROrigin3D
	var head := room.get_node("Origin/Head") as Node3D
	head.position = Vector3(0.7, 1.6, 0.4)
	await _press(&"left_hand", "ax_button")
	check_near(head.global_position, Vector3(0, 0.45, 0.45), 1e-5, "eyes")
	var before := origin.global_position
	await _press(&"left_hand", "by_button")
	check_equal(origin.world_scale, 2.0, "scale")
	check_near(head.global_position, Vector3(0, 0.45, 0.45), 1e-5, "eyes")
	# A hand 0.1 m beside the head in the room is twice as far from it in the scene.
	var tracker := _trackers[&"left_hand"] as XRPositionalTracker
	for away: float in [0.0, 0.1]:
		var pose := Transform3D(Basis(), Vector3(away, 0.5, -0.1))
		tracker.set_pose("default", pose, Vector3.ZERO, Vector3.ZERO, XRPose.XR_TRACKING_CONFIDENCE_HIGH)
		await _play(room, 90)
		var hand := (room.get_node("HapticWorld/LeftHand") as HapticDevice).get_hand_position()
		check_near(hand - origin.global_position, 2.0 * pose.origin, 2e-3, "hand at scale 2")
	await _press(&"left_hand", "by_button")
	check_equal(origin.world_scale, 1.0, "scale")
	check_near(origin.global_position, before, 1e-5, "origin")
	room.free()


## The controllers' hands and the desktop device are in one world: each feels what the other pushes.
func test_a_headset_and_a_desktop_device_move_the_same_box() -> void:
	var room := _room()
	var box_body := room.get_node("HapticWorld/Box") as RigidBody3D
	var before := box_body.global_position
	await _play(room, 240)
	check(
		box_body.global_position.x > before.x + 0.005, "by the desktop device: %s" % box_body.global_position
	)
	_add_tracker(&"left_hand")
	var place := box_body.global_position
	_lead(room, &"left_hand", place + Vector3(-0.08, 0, 0))
	await _play(room, 30)
	for i in 60:
		_lead(room, &"left_hand", place + Vector3(-0.08 + 0.001 * i, 0, 0))
		await _play(room, 1)
	await _play(room, 300)
	check(box_body.global_position.distance_to(place) > 0.01, "the box is at %s" % box_body.global_position)
	check(_headset.pulses.any(_is_left), "no pulse")
	room.free()
