extends Label3D
## Three rounds along the line: without a guide, attracted by it, and held to it. The mean distance of each.

const ROUNDS := ["no guide", "attracted", "held"]
const MODES := [HapticGuide.MODE_ATTRACT, HapticGuide.MODE_ATTRACT, HapticGuide.MODE_HOLD]

var _distances := PackedFloat64Array()
var _lines := PackedStringArray()

@onready var _device: HapticDevice = %HapticDevice
@onready var _guide: HapticEffect = %Guide
@onready var _line: Node3D = _guide.get_parent()


func _ready() -> void:
	_device.path_finished.connect(_next_round)
	_prepare()


func _process(_delta: float) -> void:
	var hand := _line.to_local(_device.get_hand_position())
	_distances.append(hand.distance_to(_guide.guide.get_place(hand)))


func _prepare() -> void:
	var i := _lines.size() % ROUNDS.size()
	_guide.enabled = i > 0
	_guide.guide.mode = MODES[i]
	_distances.clear()


func _next_round() -> void:
	var sum := 0.0
	for distance in _distances:
		sum += distance
	var i := _lines.size() % ROUNDS.size()
	_lines.append("%s: %.1f mm" % [ROUNDS[i], 1e3 * sum / maxi(_distances.size(), 1)])
	text = "\n".join(_lines.slice(-ROUNDS.size()))
	_prepare()
	_device.restart_path()
