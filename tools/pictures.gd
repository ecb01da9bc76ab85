extends SceneTree
## godot --path demo_project --script tools/pictures.gd -- [--frames=FOLDER] [NAME…]
##
## Plays scenes of the gallery, all or those named, in stepped time, and saves a picture of each as its menu
## shows it; or the frames of a moving picture of them, one scene after the other, into a folder.

const Gallery := preload("res://gallery/gallery.gd")
const Stepping := preload("res://gallery/stage/stepping.gd")

const SIZE := Vector2i(480, 270)
const FRAME := 1.0 / 60.0
## Of a moving picture: of each scene, one frame of it a few of the scene's, from this time on.
const MOVING_SECONDS := 2.4
const FRAMES_SKIPPED := 5
## When the scripted hand touches what there is to touch: of most scenes, and of the others.
const USUAL_SECONDS := 2.5
const SECONDS := {
	"still_life": 7.0,
	"magnet": 5.0,
	"gate": 1.5,
	"table_edge": 1.3,
	"pinch": 4.5,
	"hinge_door": 3.0,
	"knob": 8.0,
	"pen": 8.8,
	"needle": 4.0,
	"tower": 4.3,
	"guided_study": 27.0,
	"deforming_mesh": 4.0,
	"soft": 1.6,
	"peg_in_hole": 2.6,
	"two_operators": 2.5,
	"delay_lab": 4.0,
	"remote_tool": 2.6,
	"wrong_model": 4.0,
	"teleoperated_robot": 3.0,
	"robot_tool": 8.5,
	"depth_camera": 5.5,
	"point_cloud": 7.0,
}
## What a depth camera needs to find what stands before it, at most.
const FINDS_WITHIN := 120.0

var _has_failed := false


func _initialize() -> void:
	root.size = Vector2i(1280, 720)
	OS.low_processor_usage_mode_sleep_usec = 1
	_run.call_deferred()


func _run() -> void:
	var asked := Array(OS.get_cmdline_user_args())
	var folder := ""
	for word: String in asked.filter(func(word: String) -> bool: return word.begins_with("--frames=")):
		folder = word.trim_prefix("--frames=")
		asked.erase(word)
	for scene_name: String in Gallery.SCENES if asked.is_empty() else asked:
		await _take(scene_name, folder)
	quit(1 if _has_failed else 0)


## What saving a picture has returned.
func _keep(code: Error, path: String) -> void:
	if code != OK:
		_has_failed = true
		printerr("'%s' could not be written (%s)" % [path, error_string(code)])


func _take(scene_name: String, frames_folder: String) -> void:
	var scene := (load(Gallery.path_of(scene_name)) as PackedScene).instantiate()
	var worlds := Stepping.hold(scene)
	root.add_child(scene)
	(scene.get_node("Placard") as CanvasLayer).hide()
	RenderingServer.render_loop_enabled = false
	var deadline := Time.get_ticks_msec() + int(FINDS_WITHIN * 1000.0)
	while not _sees(scene) and Time.get_ticks_msec() < deadline:
		await process_frame
	var seconds: float = SECONDS.get(scene_name, USUAL_SECONDS)
	if frames_folder.is_empty():
		await _play(worlds, seconds)
		var path := Gallery.picture_of(scene_name)
		_keep((await _picture()).save_webp(path, true, 0.9), path)
	else:
		await _play(worlds, maxf(0.0, seconds - 0.5 * MOVING_SECONDS))
		for frame in roundi(MOVING_SECONDS / FRAME / FRAMES_SKIPPED):
			await _play(worlds, FRAME * FRAMES_SKIPPED)
			var path := frames_folder.path_join("%s_%03d.png" % [scene_name, frame])
			_keep((await _picture()).save_png(path), path)
	scene.free()


func _play(worlds: Array[HapticWorld], seconds: float) -> void:
	for _i in roundi(seconds / FRAME):
		Stepping.advance(worlds, FRAME)
		await process_frame


func _picture() -> Image:
	RenderingServer.render_loop_enabled = true
	await process_frame
	await RenderingServer.frame_post_draw
	var picture := root.get_texture().get_image()
	RenderingServer.render_loop_enabled = false
	picture.resize(SIZE.x, SIZE.y, Image.INTERPOLATE_LANCZOS)
	return picture


func _sees(scene: Node) -> bool:
	return scene.find_children("*", "HapticDepthSensor").all(
		func(sensor: HapticDepthSensor) -> bool: return sensor.get_objects().size() > 1
	)
