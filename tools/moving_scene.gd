extends Node
## A scene of the gallery in stepped time, which the editor plays and tools/docs_pictures.py films: the file
## FOLDER/shown has the name of the picture that is on the screen, FOLDER/taken that of the last one that was
## taken. The scene goes on when they are the same, however slow the machine is. It begins when there is
## FOLDER/begin.

const Gallery := preload("res://gallery/gallery.gd")
const Stepping := preload("res://gallery/stage/stepping.gd")
const SCENE := "still_life"
const FRAME := 1.0 / 60.0
## Its scripted hand, once around.
const PICTURES := 93
const STEP := 0.125  # seconds


func _ready() -> void:
	var folder: String = OS.get_cmdline_user_args()[0]
	var scene := (load(Gallery.path_of(SCENE)) as PackedScene).instantiate()
	var worlds := Stepping.hold(scene)
	add_child(scene)
	(scene.get_node("Placard") as CanvasLayer).hide()
	while not FileAccess.file_exists(folder.path_join("begin")):
		await get_tree().process_frame
	for picture in PICTURES:
		RenderingServer.render_loop_enabled = false
		for _i in roundi(STEP / FRAME):
			Stepping.advance(worlds, FRAME)
			await get_tree().process_frame
		RenderingServer.render_loop_enabled = true
		for _i in 3:
			await RenderingServer.frame_post_draw
		var called := "playing-%03d" % picture
		_write(folder.path_join("shown"), called)
		while FileAccess.get_file_as_string(folder.path_join("taken")) != called:
			await get_tree().process_frame
	_write(folder.path_join("shown"), "end")


## Whole or not at all.
func _write(path: String, text: String) -> void:
	var file := FileAccess.open(path + ".partial", FileAccess.WRITE)
	file.store_string(text)
	file.close()
	DirAccess.rename_absolute(path + ".partial", path)
