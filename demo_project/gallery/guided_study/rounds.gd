extends Label3D
## Three rounds along the line: without a guide, attracted by it, and held to it. The mean distance of each.

const ROUNDS := ["no guide", "attracted", "held"]
const MODES := [HapticGuide.MODE_ATTRACT, HapticGuide.MODE_ATTRACT, HapticGuide.MODE_HOLD]

var _sum := 0.0
var _count := 0
var _lines := PackedStringArray()

@onready var _device: HapticDevice = %HapticDevice
@onready var _guide: HapticEffect = %Guide
@onready var _line: Node3D = _guide.get_parent()


func _ready() -> void:
	_device.path_finished.connect(_next_round)
	_prepare()


func _process(_delta: float) -> void:
	var hand := _line.to_local(_device.get_hand_position())
	_sum += hand.distance_to(_guide.guide.get_place(hand))
	_count += 1


func _prepare() -> void:
	var i := _lines.size() % ROUNDS.size()
	_guide.enabled = i > 0
	_guide.guide.mode = MODES[i]
	_sum = 0.0
	_count = 0


func _next_round() -> void:
	var i := _lines.size() % ROUNDS.size()
	_lines.append("%s: %.1f mm" % [ROUNDS[i], 1e3 * _sum / maxi(_count, 1)])
	text = "\n".join(_lines.slice(-ROUNDS.size()))
	_prepare()
	_device.restart_path()
