extends Control
## Picks a scene to touch. In a scene: move the mouse to move the hand, turn its wheel to push it away or
## pull it closer; Tab changes between the mouse and the scripted path, Escape goes back.
##
## Called with options (tactus.x86_64 -- --scene=… --duration=…), it runs that experiment instead; called
## with a scene's path, it opens that scene.

const SCENES := {
	"Static: a sphere on the thesis's path": "res://static_testbed.tscn",
	"Dynamic: a box that can be pushed": "res://dynamic_testbed.tscn",
	"Materials: rubber, ice, sandpaper, steel, sponge": "res://materials.tscn",
	"Meshes: shapes of the library on a table": "res://mesh_table.tscn",
	"Volumes: a maze and a lump out of samples": "res://field.tscn",
	"A guide: a way in the air that the hand is led along": "res://guide.tscn",
	"A tool with six degrees of freedom: a peg, its hole, a stack": "res://tool.tscn",
	"Over a network: the box, far away": "res://networked_testbed.tscn",
	"Over a network: a robot at a table": "res://robot_testbed.tscn",
	"Over a network: what a camera sees, and a robot there": "res://camera_testbed.tscn",
	"Check a device": "res://device_check.tscn",
}

var _scene: Node

@onready var _choices: VBoxContainer = %Choices
@onready var _hint: Label = %Hint


func _ready() -> void:
	for title: String in SCENES:
		var button := Button.new()
		button.text = title
		button.pressed.connect(open.bind(SCENES[title]))
		_choices.add_child(button)
	_show_menu(true)
	(_choices.get_child(0) as Button).grab_focus()
	var asked := OS.get_cmdline_user_args()
	if not asked.is_empty() and asked[0].begins_with("--"):
		_run_experiment.call_deferred()
	elif not asked.is_empty() and asked[0] in SCENES.values():
		open(asked[0])


func _run_experiment() -> void:
	%Menu.visible = false
	var experiment: Node = load("res://experiments/experiment.gd").new()
	add_child(experiment)
	get_tree().quit(await experiment.run(OS.get_cmdline_user_args()))


func open(path: String) -> void:
	close()
	_scene = (load(path) as PackedScene).instantiate()
	_device().driver = HapticDevice.DRIVER_MOUSE
	add_child(_scene)
	_show_menu(false)


func close() -> void:
	if _scene != null:
		_scene.queue_free()
		_scene = null
	_show_menu(true)


func _device() -> HapticDevice:
	return _scene.find_children("*", "HapticDevice", true, false)[0]


func _show_menu(shown: bool) -> void:
	%Menu.visible = shown
	_hint.visible = not shown


func _unhandled_key_input(event: InputEvent) -> void:
	if _scene == null or not event.is_pressed() or event.is_echo():
		return
	if event.is_action("ui_cancel"):
		close()
	elif event is InputEventKey and event.keycode == KEY_TAB:
		var device := _device()
		var by_mouse := device.driver == HapticDevice.DRIVER_MOUSE
		device.driver = HapticDevice.DRIVER_PATH if by_mouse else HapticDevice.DRIVER_MOUSE
