extends RefCounted
## What could be a hand and is plugged in now.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const SPACE_MOUSE_SOCKET := "/var/run/spnav.sock"


## Each {"name": for the person, "properties": those of a HapticDevice that uses it}.
static func devices() -> Array[Dictionary]:
	var found: Array[Dictionary] = []
	for device: Dictionary in HapticDevice.find_devices():
		found.append({"name": device.name, "properties": {"driver": device.driver, "device_id": device.id}})
	for gamepad in Input.get_connected_joypads():
		var properties := {"driver": HapticDevice.DRIVER_GAMEPAD, "gamepad": gamepad}
		found.append({"name": Input.get_joy_name(gamepad), "properties": properties})
	if FileAccess.file_exists(SPACE_MOUSE_SOCKET):
		found.append({"name": "SpaceMouse", "properties": {"driver": HapticDevice.DRIVER_SPACE_MOUSE}})
	return found
