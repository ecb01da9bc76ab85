extends Control
## Walks somebody through a first look at a device: it is found, it knows where it is, it goes and pushes
## back the right way in all six directions. Writes a report.
##
## The hand is in a room of six walls, 20 mm from its middle; each is to be pressed in turn. What is pressed
## is judged by place and force alone, so that a path or an emulated hand can do it, too.

signal finished(report: Dictionary)

const WholeFile := preload("res://addons/tactus/studies/whole_file.gd")

## From the middle of the room to its walls, in metres.
const ROOM := 0.02
## A wall is pressed by so much, in newtons.
const PRESSED := 0.5
## So far off the wall's own direction a force may be, in degrees.
const STRAIGHT := 10.0

## How its edges are drawn: as thick, in metres.
const EDGE := 0.0005
const EDGES := Color(0.55, 0.68, 0.85)

const WAYS := {
	"to the right": Vector3.RIGHT,
	"to the left": Vector3.LEFT,
	"up": Vector3.UP,
	"down": Vector3.DOWN,
	"towards you": Vector3.BACK,
	"away from you": Vector3.FORWARD,
}
const DRIVERS := {
	"Novint Falcon": HapticDevice.DRIVER_FALCON,
	"Force Dimension": HapticDevice.DRIVER_FORCE_DIMENSION,
	"3D Systems Touch": HapticDevice.DRIVER_OPENHAPTICS,
	"Haply Inverse3": HapticDevice.DRIVER_INVERSE3,
	"Mouse": HapticDevice.DRIVER_MOUSE,
}

@export var report_path := "user://device_check.json"

var _pressed := {}
var _sides := {}  # by way: the wall's inner side, as it is drawn

@onready var _world: HapticWorld = %HapticWorld
@onready var _device: HapticDevice = %HapticDevice


func _ready() -> void:
	for title: String in DRIVERS:
		%Drivers.add_item(title, DRIVERS[title])
	%Drivers.select(%Drivers.get_item_index(_device.driver))
	if %Drivers.selected < 0:
		%Drivers.text = "Choose your device"
	%Firmware.visible = _device.driver == HapticDevice.DRIVER_FALCON
	%Drivers.item_selected.connect(_choose)
	%Firmware.text_submitted.connect(func(file: String) -> void: _device.firmware = file)
	for way: String in WAYS:
		_add_wall(WAYS[way])
		_sides[way] = _drawn_side(WAYS[way])
	_draw_edges()


func _choose(index: int) -> void:
	_device.driver = %Drivers.get_item_id(index) as HapticDevice.Driver
	%Firmware.visible = _device.driver == HapticDevice.DRIVER_FALCON
	_pressed.clear()


## A box whose inner side is at ROOM.
func _add_wall(way: Vector3) -> void:
	var shape := BoxShape3D.new()
	shape.size = Vector3.ONE * 0.2
	var child := CollisionShape3D.new()
	child.shape = shape
	var wall := StaticBody3D.new()
	wall.add_child(child)
	wall.position = way * (ROOM + 0.1)
	wall.physics_material_override = %Wall.physics_material_override
	_world.add_child(wall)


## Of a wall: seen through, since the hand is behind one of them.
func _drawn_side(way: Vector3) -> StandardMaterial3D:
	var material := StandardMaterial3D.new()
	material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	material.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	material.cull_mode = BaseMaterial3D.CULL_DISABLED
	var side := BoxMesh.new()
	side.size = 2.0 * (ROOM - 0.0005) * (Vector3.ONE - way.abs()) + 0.0002 * way.abs()
	side.material = material
	var drawn := MeshInstance3D.new()
	drawn.mesh = side
	drawn.position = way * ROOM
	_world.add_child(drawn)
	return material


func _draw_edges() -> void:
	var edge := StandardMaterial3D.new()
	edge.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	edge.albedo_color = EDGES
	for axis in 3:
		for corner in 4:
			var bar := BoxMesh.new()
			bar.size = Vector3.ONE * EDGE
			bar.size[axis] = 2.0 * ROOM + EDGE
			bar.material = edge
			var drawn := MeshInstance3D.new()
			drawn.mesh = bar
			drawn.position[(axis + 1) % 3] = ROOM if corner & 1 else -ROOM
			drawn.position[(axis + 2) % 3] = ROOM if corner & 2 else -ROOM
			_world.add_child(drawn)


func _process(_delta: float) -> void:
	observe()
	%Said.text = said()
	for way: String in WAYS:
		_sides[way].albedo_color = _colour_of(way)


func _colour_of(way: String) -> Color:
	if _pressed.has(way):
		return Color(0.2, 0.8, 0.4, 0.25)
	return Color(1.0, 0.55, 0.1, 0.75) if way == next_way() else Color(0.6, 0.7, 0.8, 0.14)


## What is to be done next, or what came of it.
func said() -> String:
	if not _device.is_device_connected():
		return "1. " + _device.get_state_text()
	var next := next_way()
	if next.is_empty():
		return "All six directions are right. The report is in %s" % report_path
	return "2. Push the handle %s until it stops (%d of 6)." % [next, _pressed.size() + 1]


## The direction that has not been pressed yet; empty when all have.
func next_way() -> String:
	for way: String in WAYS:
		if not _pressed.has(way):
			return way
	return ""


## Looks at the hand as it is now.
func observe() -> void:
	var next := next_way()
	var force := _device.get_force()
	if next.is_empty() or not _device.is_device_connected() or force.length() < PRESSED:
		return
	var off := rad_to_deg(force.angle_to(-WAYS[next]))
	if off <= STRAIGHT:
		_pressed[next] = {
			"force_n": force.length(),
			"off_deg": off,
			"depth_mm": 1e3 * (_device.get_hand_position().dot(WAYS[next]) - ROOM),
		}
		if next_way().is_empty():
			_write()


func _write() -> void:
	var statistics := _world.get_statistics()
	var report := {
		"device": _device.get_open_device_id(),
		"driver": _device.driver,
		"state": _device.get_state_text(),
		"directions": _pressed,
		"tick_period_p99_us": statistics.get("tick_period_p99_us", 0.0),
	}
	var problem := WholeFile.write(report_path, JSON.stringify(report, "\t"))
	if not problem.is_empty():
		%Said.text = "The report " + problem
		return
	finished.emit(report)
