extends SceneTree
## godot --headless --script tools/icon.gd -- FROM.svg TO.png: the icon at twice its size (asset_library.py).


func _initialize() -> void:
	var files := OS.get_cmdline_user_args()
	var image := Image.new()
	var problem := image.load_svg_from_string(FileAccess.get_file_as_string(files[0]), 2.0)
	if problem == OK:
		problem = image.save_png(files[1])
	quit(0 if problem == OK else 1)
