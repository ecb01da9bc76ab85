extends RefCounted
## Frees what Debian's export template complains of.


## Frees the Containers below a node. With each child of a Container, Debian's export template prints two
## errors ("Attempt to disconnect a nonexistent connection"), in any project: a hundred lines in which what
## matters is not found. Other programs print none, and there this does nothing.
static func free_containers(above: Node) -> void:
	if not OS.has_feature("template"):
		return
	Engine.print_error_messages = false
	for container in above.find_children("*", "Container", true, false):
		# One within another is gone with it.
		if is_instance_valid(container):
			container.free()
	Engine.print_error_messages = true
