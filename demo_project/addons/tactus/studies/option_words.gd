extends RefCounted
## Reads --key=value by type, unit and range. What does not fit is refused with the key, the value and what is
## allowed, and nothing is taken.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")
@warning_ignore_start("integer_division", "incompatible_ternary", "shadowed_variable_base_class")

## A whole number has at most so many digits; one that an int does not hold is beyond every range.
const MOST_DIGITS := 18
## Beyond these no property of a study goes where its range has no end of its own.
const LOWEST := -1e9
const HIGHEST := 1e9

## By key, see number(), whole(), choice(), switch(), text() and of_properties().
var declared := {}
## What was given; nothing where something is wrong.
var values := {}


static func number(least: float, most: float, unit := "") -> Dictionary:
	return {"type": TYPE_FLOAT, "least": least, "most": most, "unit": unit}


static func whole(least: int, most: int, unit := "") -> Dictionary:
	return {"type": TYPE_INT, "least": least, "most": most, "unit": unit}


## One of these names.
static func choice(among: PackedStringArray) -> Dictionary:
	return {"type": TYPE_STRING, "among": among}


## Several numbers, separated by commas.
static func numbers(least: float, most: float, unit := "") -> Dictionary:
	return {"type": TYPE_PACKED_FLOAT64_ARRAY, "least": least, "most": most, "unit": unit}


## One that had another name, which still works, with a warning.
static func renamed(was: String, one: Dictionary) -> Dictionary:
	return one.merged({"was": was})


## 0 or 1.
static func switch() -> Dictionary:
	return {"type": TYPE_BOOL}


static func text() -> Dictionary:
	return {"type": TYPE_STRING}


## The exported properties of a script: numbers, texts and switches, with the ranges of their hints.
static func of_properties(object: Object) -> Dictionary:
	var found := {}
	for property in object.get_property_list():
		if property.usage & PROPERTY_USAGE_SCRIPT_VARIABLE and property.usage & PROPERTY_USAGE_EDITOR:
			var one := _of_property(property)
			if not one.is_empty():
				found[property.name] = one
	return found


static func _of_property(property: Dictionary) -> Dictionary:
	var hint: PackedStringArray = property.hint_string.split(",")
	var has_range: bool = property.hint == PROPERTY_HINT_RANGE
	var least := float(hint[0]) if has_range else LOWEST
	var most := float(hint[1]) if has_range else HIGHEST
	var unit := ""
	for word in hint:
		if has_range and word.begins_with("suffix:"):
			unit = word.trim_prefix("suffix:")
	match property.type:
		TYPE_FLOAT:
			return number(least, most, unit)
		TYPE_INT:
			return whole(int(least), int(most), unit)
		TYPE_BOOL:
			return switch()
		TYPE_STRING:
			return text()
		TYPE_PACKED_STRING_ARRAY:
			return {"type": TYPE_PACKED_STRING_ARRAY}
	return {}


## Empty, or what is wrong with the words.
func read(words: PackedStringArray) -> String:
	var found := {}
	for word in words:
		var at := word.find("=")
		var key := word.substr(2, at - 2)
		if not word.begins_with("--") or at < 3:
			return "'%s' is not --key=value; the keys are --%s" % [word, ", --".join(declared.keys())]
		key = _present_name(key)
		if not declared.has(key):
			return "there is no --%s; there are --%s" % [key, ", --".join(declared.keys())]
		if found.has(key):
			return "--%s is given twice: say it once" % key
		var value: Variant = value_of(declared[key], word.substr(at + 1))
		if value == null:
			return "--%s=%s is refused: it must be %s" % [key, word.substr(at + 1), allowed(declared[key])]
		found[key] = value
	values = found
	return ""


func _present_name(key: String) -> String:
	for name: String in declared:
		if declared[name].get("was", "") == key:
			push_warning(
				(
					"--%s is --%s now. The old name still works: write the new one before it is dropped."
					% [key, name]
				)
			)
			return name
	return key


## As value_of() reads it.
static func text_of(value: Variant) -> String:
	if value is bool:
		return str(int(value))
	if value is PackedFloat64Array or value is PackedStringArray:
		return ",".join(Array(value).map(str))
	return str(value)


## Null where the text is not allowed.
static func value_of(one: Dictionary, given: String) -> Variant:
	match one.type:
		TYPE_BOOL:
			return given == "1" if given in ["0", "1"] else null
		TYPE_INT:
			var is_whole := given.is_valid_int() and given.length() <= MOST_DIGITS
			return int(given) if is_whole and _is_within(one, given.to_float()) else null
		TYPE_FLOAT:
			return given.to_float() if _is_number(given) and _is_within(one, given.to_float()) else null
		TYPE_PACKED_FLOAT64_ARRAY:
			var found := PackedFloat64Array()
			for part in given.split(","):
				if not _is_number(part) or not _is_within(one, part.to_float()):
					return null
				found.append(part.to_float())
			return found
		TYPE_PACKED_STRING_ARRAY:
			var parts := given.split(",")
			return null if "" in parts else parts
	if one.has("among"):
		return given if given in one.among else null
	return given if not given.is_empty() else null


static func allowed(one: Dictionary) -> String:
	var unit: String = "" if one.get("unit", "") == "" else " (%s, which is not written)" % one.unit
	match one.type:
		TYPE_BOOL:
			return "0 or 1"
		TYPE_INT:
			return "a whole number from %d to %d%s" % [one.least, one.most, unit]
		TYPE_FLOAT:
			return "a number from %s to %s%s" % [one.least, one.most, unit]
		TYPE_PACKED_FLOAT64_ARRAY:
			return "numbers separated by commas, each from %s to %s%s" % [one.least, one.most, unit]
		TYPE_PACKED_STRING_ARRAY:
			return "names separated by commas"
	return "one of " + ", ".join(one.among) if one.has("among") else "a text, and not an empty one"


## Not nan, not inf, no letters, no blanks.
static func _is_number(given: String) -> bool:
	for letter in given:
		if not letter in "0123456789+-.eE":
			return false
	return given.is_valid_float()


static func _is_within(one: Dictionary, value: float) -> bool:
	return value >= one.least and value <= one.most
