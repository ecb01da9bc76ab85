@tool
extends EditorPlugin
## Runs tests in the editor itself, when it has read the project (tools/testing/godot_suite.py).

const Runner := preload("runner.gd")


func _ready() -> void:
	while EditorInterface.get_resource_filesystem().is_scanning():
		await get_tree().process_frame
	get_tree().root.add_child.call_deferred(Runner.new())
