@tool
extends AcceptDialog
## The first page: what to do with the addon, a button each. It shows once for a project and its user; later
## Project, Tools, Tactus, Welcome shows it.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const SECTION := "tactus"
const SHOWN := "has_shown_welcome"
const GALLERY := "res://gallery/gallery.gd"
const WIDTH := 600.0
const BUTTON_WIDTH := 170.0
const GAP := 12.0

var _tools: Node
var _rows := VBoxContainer.new()


func _init(tools: Node = null) -> void:
	_tools = tools
	title = "Welcome to Tactus"
	ok_button_text = "Close"
	_rows.add_theme_constant_override("separation", 10)
	_rows.custom_minimum_size.x = WIDTH
	add_child(_rows)


func _ready() -> void:
	_add_text("Scenes can be touched now. The mouse leads the hand until there is a haptic device.")
	_add_button("Touch something", "Plays a table: move the mouse, turn its wheel to press.", "play_rig")
	_add_button(
		"Add a rig", "Puts the same table, hand and camera into the scene that is edited.", "ask_for_rig"
	)
	_add_button("Check my machine", "Measures the loop, and looks for devices and their libraries.", "check")
	if has_gallery():
		_add_button(
			"Open the gallery", "Plays the menu of all example scenes of this project.", "play_gallery"
		)
	_add_button(
		"Read the reference", "Opens HapticWorld in the editor's help; F1 finds the others.", "read_reference"
	)
	if FileAccess.file_exists(_tools.path_of("README.md")):
		_add_button(
			"First steps", "Opens the addon's README, with the first scene in five steps.", "read_first_steps"
		)
	_add_text("This page is also in Project, Tools, Tactus, Welcome.")


## A Godot without a window shows no page.
static func is_due() -> bool:
	return DisplayServer.get_name() != "headless" and is_new()


## Whether this user has not seen it in this project.
static func is_new() -> bool:
	return not EditorInterface.get_editor_settings().get_project_metadata(SECTION, SHOWN, false)


static func has_gallery() -> bool:
	return FileAccess.file_exists(GALLERY)


func show_page() -> void:
	EditorInterface.get_editor_settings().set_project_metadata(SECTION, SHOWN, true)
	EditorInterface.popup_dialog_centered(self)


func _add_text(text: String) -> void:
	var label := Label.new()
	label.text = text
	_rows.add_child(_wrapped(label, WIDTH))


## `method` of the menu Project, Tools, Tactus; the page closes first, so that what it starts is seen.
func _add_button(text: String, what_it_does: String, method: StringName) -> void:
	var row := HBoxContainer.new()
	row.add_theme_constant_override("separation", int(GAP))
	var button := Button.new()
	button.text = text
	button.custom_minimum_size.x = BUTTON_WIDTH
	button.pressed.connect(
		func() -> void:
			hide()
			_tools.call(method)
	)
	var label := Label.new()
	label.text = what_it_does
	row.add_child(button)
	row.add_child(_wrapped(label, WIDTH - BUTTON_WIDTH - GAP))
	_rows.add_child(row)


## Without a width of its own it would be as high as it has letters before the page is laid out.
func _wrapped(label: Label, width: float) -> Label:
	label.autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	label.custom_minimum_size.x = width
	return label
