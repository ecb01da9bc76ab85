@tool
extends EditorPlugin
## What the editor shows of the extension's nodes: gizmos with handles, the Tactus panel, and Project, Tools,
## Tactus.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const GIZMOS := [
	preload("device_gizmos.gd"),
	preload("pointer_gizmos.gd"),
	preload("tool_gizmos.gd"),
	preload("mesh_gizmos.gd"),
	preload("soft_gizmos.gd"),
	preload("sensor_gizmos.gd"),
	preload("world_gizmos.gd"),
]
const Dock := preload("dock.tscn")
const Debugger := preload("debugger.gd")
const Notices := preload("notices.gd")
const Tools := preload("tools.gd")

var _gizmos: Array[EditorNode3DGizmoPlugin] = []
var _dock: Control
var _debugger: EditorDebuggerPlugin
var _notices: EditorExportPlugin
var _was_looked_at := false


func _enter_tree() -> void:
	for script: GDScript in GIZMOS:
		_gizmos.append(script.new(get_undo_redo()))
		add_node_3d_gizmo_plugin(_gizmos.back())
	_dock = Dock.instantiate()
	_debugger = Debugger.new(_dock)
	_dock.watched.connect(_debugger.watch)
	_debugger.begun.connect(_show_again)
	add_control_to_bottom_panel(_dock, "Tactus")
	var tools := Tools.new(get_undo_redo())
	add_tool_submenu_item("Tactus", tools)
	add_debugger_plugin(_debugger)
	_notices = Notices.new()
	add_export_plugin(_notices)
	EditorInterface.get_inspector().property_edited.connect(_redraw)
	if Tools.Welcome.is_due():
		tools.welcome.call_deferred()


func _exit_tree() -> void:
	EditorInterface.get_inspector().property_edited.disconnect(_redraw)
	remove_export_plugin(_notices)
	remove_debugger_plugin(_debugger)
	remove_tool_menu_item("Tactus")
	remove_control_from_bottom_panel(_dock)
	_dock.queue_free()
	for gizmos in _gizmos:
		remove_node_3d_gizmo_plugin(gizmos)
	_gizmos.clear()


## Just before a scene is played.
func _build() -> bool:
	_was_looked_at = _dock.is_looked_at()
	return true


## Where a scene begins, the editor opens its output in front of the dock (run/bottom_panel/action_on_play).
func _show_again() -> void:
	if _was_looked_at:
		make_bottom_panel_item_visible(_dock)
	_was_looked_at = false


func _redraw(_property: String) -> void:
	var node := EditorInterface.get_inspector().get_edited_object() as Node3D
	if node != null:
		node.update_gizmos()
