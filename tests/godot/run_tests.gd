extends SceneTree
## godot --headless --path demo_project --script …/run_tests.gd -- FILE [NAME…]


func _initialize() -> void:
	var runner: GDScript = load(get_script().resource_path.get_base_dir().path_join("runner.gd"))
	root.add_child.call_deferred(runner.new())
