extends Label3D
## Which layer the needle is in, and the force that broke it.

var _inside: Array[String] = []


func _ready() -> void:
	var needle: ProxyPointer = %ProxyPointer
	needle.surface_broken.connect(_on_surface_broken)
	needle.surface_left.connect(_on_surface_left)


func _on_surface_broken(body: Node3D, force: float) -> void:
	_inside.append("%s: %.1f N" % [body.name, force])
	_show()


func _on_surface_left(_body: Node3D) -> void:
	_inside.pop_back()
	_show()


func _show() -> void:
	text = "outside" if _inside.is_empty() else "\n".join(_inside)
