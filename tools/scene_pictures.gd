extends SceneTree
## godot --path demo_project --script tools/scene_pictures.gd -- OUTPUT [NAME…]: pictures of running scenes as
## a person sees them, with their words (tools/docs_pictures.py).

const Gallery := preload("res://gallery/gallery.gd")
const Stepping := preload("res://gallery/stage/stepping.gd")
const RIG := "res://addons/tactus/HapticRig.tscn"
const SIZE := Vector2i(1280, 720)
const FRAME := 1.0 / 60.0
const FINDS_WITHIN := 120.0

## Of the gallery: when the scripted hand touches what there is to touch, in seconds.
const GALLERY := {
	"still_life": 7.0,
	"static_testbed": 2.5,
	"textures": 2.5,
	"magnet": 5.0,
	"guide": 2.5,
	"force_effect": 2.5,
	"effects": 3.0,
	"knob": 8.0,
	"pen": 8.8,
	"needle": 4.0,
	"guided_study": 27.0,
	"mesh_library": 2.5,
	"globe": 2.5,
	"field": 2.5,
	"soft": 1.6,
	"dynamic_testbed": 2.5,
	"stack": 2.5,
	"tower": 4.3,
	"hinge_door": 3.0,
	"pinch": 4.5,
	"peg_in_hole": 9.4,
	"delay_lab": 4.0,
	"two_operators": 2.5,
	"wrong_model": 4.0,
	"teleoperated_robot": 3.0,
	"depth_camera": 5.5,
	"point_cloud": 7.0,
}
## With the mouse at a place of the rig's table.
const RIG_TOUCHES := {"rig_ball": Vector3(-0.14, 0.06, -0.02), "rig_cushion": Vector3(0.16, 0.02, -0.03)}
## Pages, and how long they need in real time.
const PAGES := {
	"menu": ["res://main.tscn", 1.0],
	"launcher": ["res://launcher/launcher.tscn", 1.0],
	"check_machine": ["res://addons/tactus/check/check_machine.tscn", 8.0],
	"device_check": ["res://gallery/device_check/device_check.tscn", 2.0],
	"study": ["res://studies/stiffness.tscn", 2.0],
}
## With the overlay, in real time; and whether it draws the boxes of the trees.
const OVERLAID := {
	"overlay": ["res://gallery/static_testbed/static_testbed.tscn", 10.0, false],
	"overlay_boxes": ["res://gallery/mesh_library/mesh_library.tscn", 6.0, true],
	"overlay_link": ["res://gallery/delay_lab/delay_lab.tscn", 10.0, false],
}

var _folder := ""
var _has_failed := false


func _initialize() -> void:
	root.size = SIZE
	_run.call_deferred()


func _run() -> void:
	var asked := Array(OS.get_cmdline_user_args())
	_folder = asked.pop_front()
	for called: String in RIG_TOUCHES:
		if asked.is_empty() or called in asked:
			await _rig(called, RIG_TOUCHES[called])
	for called: String in PAGES:
		if asked.is_empty() or called in asked:
			await _page(called, PAGES[called][0], PAGES[called][1])
	for called: String in OVERLAID:
		if asked.is_empty() or called in asked:
			await _overlaid(called, OVERLAID[called])
	for called: String in GALLERY:
		if asked.is_empty() or called in asked:
			await _scene(called, GALLERY[called])
	quit(1 if _has_failed else 0)


func _rig(called: String, at: Vector3) -> void:
	var scene := _added(RIG)
	var worlds := Stepping.hold(scene)
	await _play(worlds, 0.2)
	var device: HapticDevice = scene.get_node("HapticWorld/HapticDevice")
	var camera: Camera3D = scene.get_node("Camera3D")
	var depth := (
		camera.global_position.distance_to(at) - camera.global_position.distance_to(device.global_position)
	)
	device.aim_mouse(camera.unproject_position(at), depth)
	await _play(worlds, 1.5)
	await _save(called)
	scene.free()


func _page(called: String, file: String, seconds: float) -> void:
	var scene := _added(file)
	await create_timer(seconds).timeout
	await _save(called)
	scene.free()


func _overlaid(called: String, shot: Array) -> void:
	var scene := _added(shot[0])
	var overlay: CanvasLayer = scene.get_node("Placard/%Overlay")
	overlay.set("shown", true)
	overlay.get_node("%Drawing").set("draws_boxes", shot[2])
	await create_timer(shot[1]).timeout
	await _save(called)
	scene.free()


func _scene(called: String, seconds: float) -> void:
	var scene := _added(Gallery.path_of(called))
	var worlds := Stepping.hold(scene)
	var deadline := Time.get_ticks_msec() + int(FINDS_WITHIN * 1000.0)
	while not (_sees(scene) and _holds(scene)) and Time.get_ticks_msec() < deadline:
		if not _holds(scene):
			Stepping.advance(worlds, Stepping.TICK)
		await process_frame
	RenderingServer.render_loop_enabled = false
	await _play(worlds, seconds)
	RenderingServer.render_loop_enabled = true
	await _save("scene_" + called)
	scene.free()


func _added(file: String) -> Node:
	var scene := (load(file) as PackedScene).instantiate()
	root.add_child(scene)
	return scene


func _play(worlds: Array[HapticWorld], seconds: float) -> void:
	for _i in roundi(seconds / FRAME):
		Stepping.advance(worlds, FRAME)
		await process_frame


func _save(called: String) -> void:
	for _i in 3:
		await process_frame
	await RenderingServer.frame_post_draw
	_keep(called)
	print("PICTURE ", called)


func _keep(called: String) -> void:
	var path := _folder.path_join(called + ".png")
	var code := root.get_texture().get_image().save_png(path)
	if code != OK:
		_has_failed = true
		printerr("'%s' could not be written (%s)" % [path, error_string(code)])


## A tool is built beside the loop.
func _holds(scene: Node) -> bool:
	return scene.find_children("*", "HapticTool").all(
		func(tool: HapticTool) -> bool: return tool.get_state() == HapticTool.STATE_WORKING
	)


func _sees(scene: Node) -> bool:
	return scene.find_children("*", "HapticDepthSensor").all(
		func(sensor: HapticDepthSensor) -> bool: return sensor.get_objects().size() > 1
	)
