extends RefCounted
## What the sides of an experiment that run by themselves share.


## Sets --NAME=VALUE at a node; a text needs no quotes, lists are [a,b]. Empty, or why it was refused:
## what the node has afterwards counts.
static func set_property(node: Object, word: String) -> String:
	var at := word.find("=")
	var name := word.substr(2, at - 2)
	if not word.begins_with("--") or at < 3 or not name in node:
		return "'%s' is refused: it must be --NAME=VALUE, with a property of %s" % [word, node.get_class()]
	var text := word.substr(at + 1)
	var json := JSON.new()
	var given: Variant = json.data if json.parse(text) == OK and json.data != null else text
	if given is Array and node.get(name) is Vector3 and given.size() == 3:
		given = Vector3(given[0], given[1], given[2])
	elif given is Array and node.get(name) is PackedStringArray:
		given = PackedStringArray(given)
	node.set(name, given)
	var now: Variant = node.get(name)
	var is_taken := str(now) == text
	if given is Vector3 or given is PackedStringArray:
		is_taken = now.is_equal_approx(given) if given is Vector3 else now == given
	elif text.is_valid_float():
		is_taken = is_equal_approx(float(str(now)), float(text))
	if not is_taken:
		return "%s is refused: it stays %s" % [word, now]
	return ""
