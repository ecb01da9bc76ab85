extends Node3D
## Shows the force on a hand in the scene itself: an arrow at the proxy, and a bar with its size. Put it below
## a ProxyPointer or a HapticTool. Where that is below its HapticDevice, or names it, the force is the one
## that the device is given, within all of its limits.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

## Forces below this have no arrow, in newtons.
const LEAST := 0.02

## Length of the arrow for each newton.
@export_range(0.001, 1.0, 0.001, "or_greater", "suffix:m/N") var arrow_scale := 0.02
## The force that fills the bar.
@export_range(0.1, 40.0, 0.1, "or_greater", "suffix:N") var full := 8.0
@export var shows_bar := true:
	set(value):
		shows_bar = value
		if is_node_ready():
			_bar.visible = value

@onready var _arrow: Node3D = %Arrow
@onready var _shaft: MeshInstance3D = %Shaft
@onready var _head: MeshInstance3D = %Head
@onready var _bar: CanvasLayer = %Bar
@onready var _level: ProgressBar = %Level
@onready var _words: Label = %Words


func _ready() -> void:
	_bar.visible = shows_bar


func _process(_delta: float) -> void:
	var hand: Node3D = get_parent()
	var force := _force_on(hand)
	_arrow.visible = force.length() > LEAST
	if _arrow.visible:
		_point(hand.global_position, force)
	_level.value = 100.0 * force.length() / full
	_words.text = "%.1f N" % force.length()


func _force_on(hand: Node3D) -> Vector3:
	var named: NodePath = hand.get("device")
	var device := (hand.get_parent() if named.is_empty() else hand.get_node_or_null(named)) as HapticDevice
	if device != null:
		return device.get_force()
	return (hand as ProxyPointer).get_force() if hand is ProxyPointer else (hand as HapticTool).get_force()


func _point(from: Vector3, force: Vector3) -> void:
	var along := force.normalized()
	var side := along.cross(Vector3.RIGHT if absf(along.x) < 0.9 else Vector3.UP).normalized()
	_arrow.global_transform = Transform3D(Basis(side, along, side.cross(along)), from)
	var length := arrow_scale * force.length()
	var head := minf(0.5 * length, 0.016)
	_shaft.position.y = 0.5 * (length - head)
	_shaft.scale.y = length - head
	_head.position.y = length - 0.5 * head
	_head.scale = Vector3.ONE * head / 0.016
