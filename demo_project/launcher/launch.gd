extends RefCounted
## What can be chosen at a start, and what becomes of it: for each process of this machine the options of
## experiments/experiment.gd. The launcher shows it as a form; without a screen the same is given in words:
##
##     tactus.x86_64 -- --launch=form
##     tactus.x86_64 --headless -- --launch=now --scenario=4 --seconds=5 --output=FOLDER

const OptionWords := preload("res://addons/tactus/studies/option_words.gd")

const BOTH := "both, on this machine"
const OPERATOR := "operator"
const ENVIRONMENT := "environment"
const FIRST_PORT := 47001

## By scenario. Those of a link are one scene for both of its sides; those with a robot have both within.
const SCENES := {
	1: "res://gallery/static_testbed/static_testbed.tscn",
	2: "res://gallery/dynamic_testbed/dynamic_testbed.tscn",
	3: "res://gallery/teleoperated_robot/teleoperated_robot.tscn",
	4: "res://gallery/dynamic_testbed/dynamic_testbed.tscn",
	5: "res://gallery/depth_camera/depth_camera.tscn",
}
## By choice, the scenarios that play it; the others are of every scenario.
const ONLY_IN := {
	"side": [2, 4],
	"remote_address": [2, 4],
	"key_file": [2, 4],
	"delay": [2, 3, 4, 5],
	"jitter": [2, 3, 4, 5],
	"loss": [2, 3, 4, 5],
	"correction": [2, 3, 4, 5],
	"derivation": [2, 3, 4, 5],
	"control": [2, 3, 4, 5],
	"camera": [5],
}
## Names of enumerators of a class, with the property that they are values of.
const DRIVERS := ["HapticDevice", "Driver", "device.driver"]
const CORRECTIONS := ["MMTLink", "CorrectionScheme", "link.correction_scheme"]
const CONTROLS := ["MMTLink", "ControlScheme", "link.control_scheme"]
const DERIVATIONS := ["MMTTuning", "Derivation", "link.tuning.derivation"]
const SOURCES := ["HapticDepthSensor", "Source", "camera.source"]

## Every choice with what it is before anybody has chosen: a text, a number, or the name of an enumerator.
var chosen := {
	"scenario": 1,
	"side": BOTH,
	"seconds": 20.0,
	"output": "user://bundles",
	"driver": "DRIVER_PATH",
	"remote_address": "127.0.0.1",
	"local_port": FIRST_PORT,
	"remote_port": FIRST_PORT + 1,
	"key_file": "",
	"delay": 0.0,
	"jitter": 0.0,
	"loss": 0.0,
	"correction": "CORRECTION_MASKED_DIRECTION",
	"derivation": "DERIVATION_RESIMULATE",
	"control": "CONTROL_SPRING",
	"camera": "SOURCE_SYNTHETIC",
	"watch": 1,
}


## Takes --NAME=VALUE; empty, or what is wrong with it.
func take(arguments: PackedStringArray) -> String:
	var words := OptionWords.new()
	words.declared = _declared()
	var wrong := words.read(arguments)
	if not wrong.is_empty():
		return wrong
	words.values.erase("launch")
	wrong = _not_played(words.values)
	if not wrong.is_empty():
		return wrong
	chosen.merge(words.values, true)
	return problem()


## Which of the given values the scenario has no use for; empty where it plays them all.
func _not_played(given: Dictionary) -> String:
	var scenario: int = given.get("scenario", chosen.scenario)
	for key: String in given:
		if scenario not in ONLY_IN.get(key, [scenario]):
			return (
				"--%s is refused: scenario %d does not play it, only %s"
				% [key, scenario, " and ".join(ONLY_IN[key].map(str))]
			)
	return ""


static func _declared() -> Dictionary:
	return {
		"launch": OptionWords.text(),
		"scenario": OptionWords.whole(1, 5),
		"side": OptionWords.choice([BOTH, OPERATOR, ENVIRONMENT]),
		"seconds": OptionWords.number(0.1, 1e6, "s"),
		"output": OptionWords.text(),
		"driver": OptionWords.choice(names_of(DRIVERS)),
		"remote_address": OptionWords.text(),
		"local_port": OptionWords.whole(1, 65535),
		"remote_port": OptionWords.whole(1, 65535),
		"key_file": OptionWords.text(),
		"delay": OptionWords.renamed("delay_ms", OptionWords.number(0.0, 20000.0, "ms")),
		"jitter": OptionWords.renamed("jitter_ms", OptionWords.number(0.0, 10000.0, "ms")),
		"loss": OptionWords.number(0.0, 1.0, "share"),
		"correction": OptionWords.choice(names_of(CORRECTIONS)),
		"derivation": OptionWords.choice(names_of(DERIVATIONS)),
		"control": OptionWords.choice(names_of(CONTROLS)),
		"camera": OptionWords.choice(names_of(SOURCES)),
		"watch": OptionWords.whole(0, 1),
	}


## What keeps it from being started, and what to do; empty where nothing does.
func problem() -> String:
	if not SCENES.has(chosen.scenario):
		return "there is no scenario %s: choose 1 to 5" % chosen.scenario
	if chosen.side not in [BOTH, OPERATOR, ENVIRONMENT]:
		return "there is no side '%s': choose %s or %s" % [chosen.side, OPERATOR, ENVIRONMENT]
	if chosen.output.is_empty():
		return "the bundle has no place: choose a folder"
	if not chosen.seconds > 0.0:
		return "it would last no time: choose more than 0 seconds"
	for choice: Array in [
		["driver", DRIVERS],
		["correction", CORRECTIONS],
		["control", CONTROLS],
		["derivation", DERIVATIONS],
		["camera", SOURCES]
	]:
		if value_of(choice[1], chosen[choice[0]]) < 0:
			return (
				"there is no %s '%s': it is one of %s"
				% [choice[0], chosen[choice[0]], ", ".join(present_names_of(choice[1]))]
			)
	return ""


func has_network() -> bool:
	return chosen.scenario in [2, 4]


## Of the enumeration that begins with a class and a name; former names of its values come last.
static func names_of(enumeration: Array) -> PackedStringArray:
	return ClassDB.class_get_enum_constants(enumeration[0], enumeration[1])


## One name for each value.
static func present_names_of(enumeration: Array) -> PackedStringArray:
	var names := {}
	for name in names_of(enumeration):
		names.get_or_add(value_of(enumeration, name), name)
	return PackedStringArray(names.values())


static func value_of(enumeration: Array, name: String) -> int:
	return ClassDB.class_get_integer_constant(enumeration[0], name) if name in names_of(enumeration) else -1


## The sides that start here, the one with the hand first: each its name and its options.
func sides() -> Dictionary:
	if not has_network():
		return {"hand": _options("hand", 0)}
	var both := {OPERATOR: 0, ENVIRONMENT: 1}
	var here := {}
	for side: String in both:
		if chosen.side in [BOTH, side]:
			here[side] = _options(side, both[side])
	return here


## Of the sides that start here, which are one bundle together.
func _names() -> PackedStringArray:
	if not has_network():
		return PackedStringArray(["hand"])
	var both := PackedStringArray([OPERATOR, ENVIRONMENT])
	return both if chosen.side == BOTH else PackedStringArray([chosen.side])


func _options(side: String, number: int) -> PackedStringArray:
	var options := {
		"scene": SCENES[chosen.scenario],
		"case": side,
		"output": chosen.output,
		"duration": chosen.seconds,
		"inputs": 1,
		"warmup": 0.2,
		"watch": chosen.watch if number == 0 else 0,
		"sides": ",".join(_names()),
	}
	if number == 0 or chosen.side != BOTH:
		options[DRIVERS[2]] = value_of(DRIVERS, chosen.driver)
	if chosen.scenario != 1:
		_add_link(options)
	if has_network():
		_add_way(options, number)
	if chosen.scenario == 5:
		options[SOURCES[2]] = value_of(SOURCES, chosen.camera)
	var words := PackedStringArray()
	for name: String in options:
		words.append("--%s=%s" % [name, options[name]])
	return words


func _add_link(options: Dictionary) -> void:
	options["link.conditions.delay"] = chosen.delay / 2000.0
	options["link.conditions.jitter"] = chosen.jitter / 1000.0
	options["link.conditions.loss"] = chosen.loss
	options[CORRECTIONS[2]] = value_of(CORRECTIONS, chosen.correction)
	options[CONTROLS[2]] = value_of(CONTROLS, chosen.control)
	options[DERIVATIONS[2]] = value_of(DERIVATIONS, chosen.derivation)


func _add_way(options: Dictionary, number: int) -> void:
	var is_peer: bool = chosen.side == BOTH and number == 1
	options["link.scenario"] = chosen.scenario
	options["link.side"] = number
	options["link.local_port"] = chosen.remote_port if is_peer else chosen.local_port
	options["link.remote_port"] = chosen.local_port if is_peer else chosen.remote_port
	if chosen.side != BOTH:
		options["link.remote_address"] = JSON.stringify(chosen.remote_address)
	if chosen.key_file != "":
		options["link.key_file"] = JSON.stringify(chosen.key_file)
