extends RefCounted
## What the sides of an experiment that run by themselves share.


## Sets --NAME=VALUE at a node; a text needs no quotes. Empty, or why it was refused: what the node has
## afterwards counts.
static func set_property(node: Object, word: String) -> String:
	var at := word.find("=")
	var name := word.substr(2, at - 2)
	if not word.begins_with("--") or at < 3 or not name in node:
		return "'%s' is refused: it must be --NAME=VALUE, with a property of %s" % [word, node.get_class()]
	var text := word.substr(at + 1)
	var json := JSON.new()
	node.set(name, json.data if json.parse(text) == OK and json.data != null else text)
	var now: Variant = node.get(name)
	if str(now) != text and not (text.is_valid_float() and is_equal_approx(float(str(now)), float(text))):
		return "%s is refused: it stays %s" % [word, now]
	return ""
