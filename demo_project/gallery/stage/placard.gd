extends CanvasLayer
## The placard beside a scene: what it is, what there is to feel in it, and what is felt right now. It also
## gives the hand to the person, and makes what is touched heard.
##
## A scene that is shown within another one leaves all this to that one.

## The paths of its hands are over, and none of them leads back to its beginning.
signal ended

const Gallery := preload("res://gallery/gallery.gd")
const MENU := "res://main.tscn"
const KEYS := "Mouse, wheel: hand   Tab: mouse or path   R: again   H: words   F3: plots   Escape: menu"
## How long what a path has come to is shown before it begins again, in seconds.
const REST := 2.0

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
	%Overlay.room_taken.connect(func(width: float) -> void: %Rows.offset_right = -width)
	for part: Control in [%Rows, %Head, %Foot]:
		part.resized.connect(_make_room)
	visibility_changed.connect(_make_room)
	_make_room()
	if by_hand:
		_give_hands(true)
	# Where there is no loudspeaker nobody hears it.
	if AudioServer.get_driver_name() != "Dummy":
		for proxy in world.find_children("*", "ProxyPointer", true, false):
			proxy.add_child(HapticVibrationSound.new())


## What a scene draws in the window itself stands between the placard's words, and beside the overlay.
func _make_room() -> void:
	var scene := owner as Control
	if scene == null:
		return
	scene.offset_top = %Head.size.y if visible else 0.0
	scene.offset_bottom = -%Foot.size.y if visible else 0.0
	scene.offset_right = %Rows.offset_right if visible else 0.0


## A path that leads nowhere begins again with its scene: what it has pushed is where it was.
func _process(_delta: float) -> void:
	if not by_hand and _paths_are_over():
		set_process(false)
		ended.emit()
		if owner == get_tree().current_scene:
			get_tree().reload_current_scene()


## For a while. Never where one leads back to its beginning, or where there is none.
func _paths_are_over() -> bool:
	var are_over := false
	for device: HapticDevice in world.find_children("*", "HapticDevice", true, false):
		var path := device.path
		if path == null:
			continue
		var leads_back := path.points_loop if path.form == HapticPath.FORM_POINTS else path.curve_loop
		if leads_back or path.form == HapticPath.FORM_CIRCLE_WAVE:
			return false
		if device.get_path_time() < path.get_duration() + REST:
			return false
		are_over = true
	return are_over


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
