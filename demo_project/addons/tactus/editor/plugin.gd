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
## What a scene that the editor starts tells the dock by.
const PROBE := "TactusProbe"

var _gizmos: Array[EditorNode3DGizmoPlugin] = []
var _dock: Control
var _debugger: EditorDebuggerPlugin
var _notices: EditorExportPlugin


func _enable_plugin() -> void:
	var folder: String = (get_script() as Script).resource_path.get_base_dir()
	add_autoload_singleton(PROBE, folder.path_join("../overlay/probe.gd").simplify_path())


func _disable_plugin() -> void:
	remove_autoload_singleton(PROBE)


func _enter_tree() -> void:
	for script: GDScript in GIZMOS:
		_gizmos.append(script.new(get_undo_redo()))
		add_node_3d_gizmo_plugin(_gizmos.back())
	_dock = Dock.instantiate()
	_debugger = Debugger.new(_dock)
	_dock.watched.connect(_debugger.watch)
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


func _redraw(_property: String) -> void:
	var node := EditorInterface.get_inspector().get_edited_object() as Node3D
	if node != null:
		node.update_gizmos()
