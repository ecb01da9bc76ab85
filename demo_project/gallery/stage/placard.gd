extends CanvasLayer
## The placard beside a scene: what it is, what there is to feel in it, and what is felt right now. It also
## gives the hand to the person, and makes what is touched heard.
##
## A scene that is shown within another one leaves all this to that one.

const Gallery := preload("res://gallery/gallery.gd")
const MENU := "res://main.tscn"
const KEYS := (
	"Mouse, wheel: hand   Tab: mouse or path   R: again   H: words   F3: plots   F4: trace   F5: boxes   "
	+ "Escape: menu"
)

## The one that the person's hands are in.
@export var world: HapticWorld
## Whose hands they are when a person moves them, in the order of the devices; the mouse where there is none.
@export var hand_drivers: Array[HapticDevice.Driver] = []
## Keys of the scene's own, beside those of all.
@export var more_keys := ""
@export var shows_readings := true
## Whether the person moves the hands from the start on, and not their paths.
@export var by_hand := false


func _ready() -> void:
	if get_viewport() != get_tree().root:
		process_mode = PROCESS_MODE_DISABLED
		hide()
		return
	var words: Array = Gallery.SCENES.get(Gallery.name_of(owner.scene_file_path), ["", ""])
	%Title.text = words[0]
	%Sentence.text = words[1]
	%Keys.text = KEYS if more_keys.is_empty() else more_keys + "   " + KEYS
	%Readings.visible = shows_readings
	if by_hand:
		_give_hands(true)
	# Where there is no loudspeaker nobody hears it.
	if AudioServer.get_driver_name() != "Dummy":
		for proxy in world.find_children("*", "ProxyPointer", true, false):
			proxy.add_child(HapticVibrationSound.new())


func _give_hands(to_person: bool) -> void:
	var devices := world.find_children("*", "HapticDevice", true, false)
	for i in devices.size():
		var device: HapticDevice = devices[i]
		if to_person:
			device.driver = _hand_driver(i)
		elif device.path != null:
			device.driver = HapticDevice.DRIVER_PATH


func _hand_driver(i: int) -> HapticDevice.Driver:
	return hand_drivers[i] if i < hand_drivers.size() else HapticDevice.DRIVER_MOUSE


func _unhandled_key_input(event: InputEvent) -> void:
	var key := event as InputEventKey
	if key == null or not key.pressed or key.echo:
		return
	var is_alone := owner == get_tree().current_scene
	match key.keycode:
		KEY_TAB:
			by_hand = not by_hand
			_give_hands(by_hand)
		KEY_H:
			visible = not visible
		KEY_R when is_alone:
			get_tree().reload_current_scene()
		KEY_ESCAPE when is_alone:
			get_tree().change_scene_to_file(MENU)
		_:
			return
	get_viewport().set_input_as_handled()
