@tool
extends HBoxContainer
## The Tactus panel below the editor's view: which devices are there, and what the scene that the editor has
## started does.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

## Whether somebody looks at it.
signal watched(is_watched: bool)

const Scan := preload("scan.gd")


func _ready() -> void:
	%Scan.pressed.connect(scan)
	visibility_changed.connect(func() -> void: watched.emit(is_looked_at()))
	end()


func is_looked_at() -> bool:
	return is_visible_in_tree()


func begin() -> void:
	%Panel.clear()
	%Hint.hide()
	%Panel.show()


func end() -> void:
	%Hint.show()
	%Panel.hide()


func show_figures(figures: Dictionary) -> void:
	if not %Panel.visible:
		begin()
	%Panel.show_figures(figures)


func show_histograms(histograms: Dictionary) -> void:
	%Panel.show_histograms(histograms)


## Lists what is plugged in. One that is picked becomes the device of the HapticDevice that is edited.
func scan() -> void:
	for child in %Devices.get_children():
		child.queue_free()
	var found := Scan.devices()
	for device: Dictionary in found:
		var button := Button.new()
		button.text = device.name
		button.tooltip_text = "Use it for the HapticDevice that is selected"
		button.alignment = HORIZONTAL_ALIGNMENT_LEFT
		button.pressed.connect(_pick.bind(device))
		%Devices.add_child(button)
	%Found.text = "" if not found.is_empty() else "Nothing but mouse and keyboard."


func _pick(device: Dictionary) -> void:
	var node := EditorInterface.get_inspector().get_edited_object() as HapticDevice
	if node == null:
		%Found.text = "Select a HapticDevice first."
		return
	var undo_redo := EditorInterface.get_editor_undo_redo()
	undo_redo.create_action("Use %s" % device.name)
	for property: String in device.properties:
		undo_redo.add_do_property(node, property, device.properties[property])
		undo_redo.add_undo_property(node, property, node.get(property))
	undo_redo.commit_action()
	%Found.text = "%s uses %s." % [node.name, device.name]
