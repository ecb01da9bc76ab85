@tool
extends EditorDebuggerPlugin
## Brings to the dock what a scene that the editor has started says (overlay/probe.gd).
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

signal begun

var _dock: Control


func _init(dock: Control = null) -> void:
	_dock = dock


func _setup_session(session_id: int) -> void:
	var session := get_session(session_id)
	session.started.connect(_dock.begin)
	session.started.connect(begun.emit)
	session.stopped.connect(_dock.end)


## The dock has come into view, or gone out of it.
func watch(is_watched: bool) -> void:
	for session: EditorDebuggerSession in get_sessions():
		if session.is_active():
			session.send_message("tactus:watch", [is_watched])


func _has_capture(prefix: String) -> bool:
	return prefix == "tactus"


## A scene listens only once its probe is in the tree: it says when, and what was sent before is lost.
func _capture(message: String, data: Array, session_id: int) -> bool:
	match message:
		"tactus:ready":
			get_session(session_id).send_message("tactus:watch", [_dock.is_looked_at()])
		"tactus:figures":
			_dock.show_figures(data[0])
		"tactus:histograms":
			_dock.show_histograms(data[0])
		_:
			return false
	return true
