extends Node3D
## The cap goes down as deep as it is pressed, and the lamp changes where it clicks.

const ON := preload("res://looks/orange.tres")
const OFF := preload("res://looks/white.tres")
## The button clicks between these depths (unit: meters).
const CLICKS := 0.002
const IS_BACK := 0.001

var _is_down := false


func _process(_delta: float) -> void:
	var depth := _depth()
	(%Cap as MeshInstance3D).position.y = -depth
	if not _is_down and depth > CLICKS:
		var lamp: MeshInstance3D = %Lamp
		var is_on := lamp.get_surface_override_material(0) == ON
		lamp.set_surface_override_material(0, OFF if is_on else ON)
	_is_down = depth > (IS_BACK if _is_down else CLICKS)


## How far the hand is below the proxy, while that rests on the button.
func _depth() -> float:
	var pointer: ProxyPointer = %ProxyPointer
	for contact in pointer.get_contacts():
		if contact["collider"] == %Button:
			return maxf(0.0, pointer.get_proxy_position().y - pointer.get_hand_position().y)
	return 0.0
