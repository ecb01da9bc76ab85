extends GridContainer
## The settings of a study with people: a line for each exported property of its root node, read as on the
## command line.

signal changed

const OptionWords := preload("res://addons/tactus/studies/option_words.gd")

var _scene: PackedScene
var _lines := {}
## The text of each line before anybody has changed it.
var _defaults := {}


## Shows the settings of that study.
func choose(path: String) -> void:
	for part in get_children():
		part.free()
	_lines.clear()
	_defaults.clear()
	_scene = load(path)
	var study := _scene.instantiate()
	var declared := OptionWords.of_properties(study)
	for key: String in declared:
		_add_line(key, declared[key], OptionWords.text_of(study.get(key)))
	study.free()


func _add_line(key: String, declared: Dictionary, text: String) -> void:
	var unit: String = declared.get("unit", "")
	var label := Label.new()
	label.text = key.capitalize() + ("" if unit.is_empty() else " (%s)" % unit)
	var line := LineEdit.new()
	line.text = text
	line.size_flags_horizontal = SIZE_EXPAND_FILL
	line.text_changed.connect(func(_text: String) -> void: changed.emit())
	add_child(label)
	add_child(line)
	_lines[key] = line
	_defaults[key] = text


func set_line(key: String, text: String) -> void:
	(_lines[key] as LineEdit).text = text
	changed.emit()


## What keeps it from being started, and what to do; empty where nothing does.
func problem() -> String:
	var study := _scene.instantiate()
	var found: String = study.take_words(_words())
	study.free()
	return found


## The study with these settings, not yet in the tree.
func make() -> Node:
	var study := _scene.instantiate()
	study.take_words(_words())
	return study


func _words() -> PackedStringArray:
	var words := PackedStringArray()
	for key: String in _lines:
		if _lines[key].text != _defaults[key]:
			words.append("--%s=%s" % [key, _lines[key].text])
	return words
