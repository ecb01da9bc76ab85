extends "link_case.gd"
## The presets of MMTTuning: each has a sentence in the class reference, changes basic properties alone, and
## displays the force of a floor under delay.

const FOLDER := "res://addons/tactus/tuning"
const BASIC := [
	"derivation", "stealth_share", "passivity", "deadband_enabled", "state_interval", "buffer_depth"
]


func _presets() -> Dictionary[String, MMTTuning]:
	var found: Dictionary[String, MMTTuning] = {}
	for file in DirAccess.get_files_at(FOLDER):
		found[file] = load(FOLDER.path_join(file)) as MMTTuning
	return found


func _changed(tuning: MMTTuning) -> PackedStringArray:
	var plain := MMTTuning.new()
	var found := PackedStringArray()
	for property in ClassDB.class_get_property_list("MMTTuning", true):
		if property.usage & PROPERTY_USAGE_STORAGE and tuning.get(property.name) != plain.get(property.name):
			found.append(property.name)
	return found


func test_each_preset_changes_basic_properties_and_has_its_sentence() -> void:
	var here: String = (get_script() as Script).resource_path.get_base_dir()
	var reference := FileAccess.get_file_as_string(
		here.path_join("../../extension/doc_classes/MMTTuning.xml")
	)
	var sentences := RegEx.create_from_string("(?m)^\\t\\t\\[code\\](\\w+\\.tres)\\[/code\\]: [A-Z].+\\.$")
	var described := sentences.search_all(reference).map(
		func(found: RegExMatch) -> String: return found.get_string(1)
	)
	var presets := _presets()
	described.sort()
	check_equal(described, Array(presets.keys()), "presets with a sentence")
	check(presets.size() >= 5, "presets: %s" % [presets.keys()])
	for file in presets:
		check(presets[file] != null, file + " is no MMTTuning")
		var changed := _changed(presets[file])
		check(not changed.is_empty(), file + " changes nothing")
		for name in changed:
			check(name in BASIC, "%s changes %s" % [file, name])


func test_each_preset_displays_the_force_of_a_floor_under_delay() -> void:
	for file: String in _presets():
		var is_direct := file == "passive_direct.tres"
		await _connect(MMTLink.SCENARIO_DIRECT if is_direct else MMTLink.SCENARIO_MMT, 0.04)
		for link: MMTLink in [_here, _there]:
			link.tuning = _presets()[file]
		add_floor(_far, 200.0)
		_add_hands(0.5)
		_advance(1.5)
		# The proxy's radius, and as far below the floor. Waves weaken the force of a hand that does not yield.
		var full := 0.02 * 200.0
		var force := _felt(_operator).y
		check(
			force > (0.5 if is_direct else 0.98) * full and force < 1.02 * full, "%s: %.2f N" % [file, force]
		)
		_operator.free()
		_far.free()
		await frames(1)
