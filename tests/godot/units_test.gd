extends "test_case.gd"
## Units beside the properties, as the inspector shows them.

const CLASSES := [
	"HapticDevice", "HapticMaterial", "HapticMesh", "HapticPath", "HapticRecorder", "HapticWorld", "MMTLink"
]


func _hints(type: String) -> Dictionary:
	var found := {}
	for property in ClassDB.class_get_property_list(type, true):
		found[property.name] = property.hint_string
	return found


func test_signs_beyond_ascii_come_out_as_they_were_written() -> void:
	var density: String = _hints("HapticSoftBody").density
	var damping: String = _hints("HapticMaterial").damping
	check(density.ends_with("suffix:kg/m³"), "density: " + density)
	check(damping.ends_with("suffix:N·s/m"), "damping: " + damping)


func test_no_hint_was_read_in_the_wrong_encoding() -> void:
	for type in CLASSES:
		var hints := _hints(type)
		check(not hints.is_empty(), "%s has no properties" % type)
		for property in hints:
			check(not "Â" in hints[property], "%s.%s: %s" % [type, property, hints[property]])
