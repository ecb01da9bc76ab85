extends Control
## Picks what is played, starts it, shows it and saves it as a bundle that can be played again; or begins a
## study with a participant.

## The person wants back to where this was opened from; never while something is played.
signal left

const Launch := preload("res://launcher/launch.gd")
const Run := preload("res://launcher/run.gd")
const Replay := preload("res://experiments/replay.gd")

## Each row of the form: its words, the choice, and what can be chosen: texts to values, an enumeration, or a
## range of numbers with its step; nothing: any text.
const ROWS := [
	[
		"Side",
		"side",
		{"both, on this machine": Launch.BOTH, "operator": Launch.OPERATOR, "environment": Launch.ENVIRONMENT}
	],
	["Device", "driver", Launch.DRIVERS],
	["Camera", "camera", Launch.SOURCES],
	["Address of the other side", "remote_address", null],
	["Port of this side", "local_port", [1, 65535, 1]],
	["Port of the other side", "remote_port", [1, 65535, 1]],
	["File with the key", "key_file", null],
	["Delay, there and back (ms)", "delay", [0, 2000, 1]],
	["Jitter (ms)", "jitter", [0, 500, 1]],
	["Loss (0 to 1)", "loss", [0, 1, 0.01]],
	["Correction", "correction", Launch.CORRECTIONS],
	["Derivation", "derivation", Launch.DERIVATIONS],
	["Control scheme", "control", Launch.CONTROLS],
	["Length (s)", "seconds", [1, 3600, 1]],
	["Folder of the bundle", "output", null],
]
const SCENARIO := "A scenario"
## By what they are called, the studies with people that can be begun here.
const STUDIES := {
	"A study: the just-noticeable difference of stiffness": "res://studies/stiffness.tscn",
	"A study: two corrections, compared blind": "res://studies/schemes.tscn",
	"A study: a path with a guide": "res://studies/guided_path.tscn",
}
const OF_A_NETWORK := ["side", "remote_address", "local_port", "remote_port", "key_file"]
const OF_TWO_MACHINES := ["remote_address", "key_file"]

## Whether there is anything to go back to.
var has_way_back := false
var _launch := Launch.new()
var _run: Run
var _study: Node
var _rows := {}

@onready var _form: GridContainer = %Form
@onready var _said: Label = %Said


func _ready() -> void:
	_launch.chosen.output = "user://bundles/" + Time.get_datetime_string_from_system(true).replace(":", "")
	for row: Array in ROWS:
		_add_row(row[0], row[1], row[2])
	for words: String in [SCENARIO] + STUDIES.keys():
		%What.add_item(words)
	%What.item_selected.connect(func(index: int) -> void: choose_what(%What.get_item_text(index)))
	%Scenarios.chosen.connect(func(scenario: int) -> void: _choose("scenario", scenario))
	%StudyForm.changed.connect(_chosen)
	%Start.pressed.connect(_start)
	%Stop.pressed.connect(_stop)
	%Again.pressed.connect(_play_again)
	%Back.pressed.connect(left.emit)
	%Back.visible = has_way_back
	_show_state(false)
	_chosen()
	%Start.grab_focus()


func _add_row(words: String, choice: String, values: Variant) -> void:
	var label := Label.new()
	label.text = words
	var control: Control
	if values is Dictionary:
		control = _choice_among(values.keys(), values.values(), choice)
	elif values is Array and values[0] is String:
		var names := Launch.present_names_of(values)
		control = _choice_among(Array(names).map(_readable.bind(names[0])), Array(names), choice)
	elif values is Array:
		control = _number(values, choice)
	else:
		control = _text(choice)
	control.size_flags_horizontal = SIZE_EXPAND_FILL
	_form.add_child(label)
	_form.add_child(control)
	_rows[choice] = [label, control]


## Of DRIVER_FORCE_DIMENSION: Force dimension.
func _readable(name: String, first: String) -> String:
	return name.trim_prefix(first.get_slice("_", 0) + "_").replace("_", " ").to_lower().capitalize()


func _choice_among(words: Array, values: Array, choice: String) -> OptionButton:
	var button := OptionButton.new()
	for word: String in words:
		button.add_item(word)
	button.select(values.find(_launch.chosen[choice]))
	button.item_selected.connect(func(index: int) -> void: _choose(choice, values[index]))
	return button


func _number(limits: Array, choice: String) -> SpinBox:
	var box := SpinBox.new()
	box.min_value = limits[0]
	box.max_value = limits[1]
	box.step = limits[2]
	box.value = _launch.chosen[choice]
	box.value_changed.connect(
		func(value: float) -> void: _choose(choice, type_convert(value, typeof(_launch.chosen[choice])))
	)
	return box


func _text(choice: String) -> LineEdit:
	var line := LineEdit.new()
	line.text = _launch.chosen[choice]
	line.text_changed.connect(func(text: String) -> void: _choose(choice, text))
	return line


func _choose(choice: String, value: Variant) -> void:
	_launch.chosen[choice] = value
	_chosen()


## The scenario, or one of STUDIES.
func choose_what(words: String) -> void:
	var is_study := STUDIES.has(words)
	%StudyForm.visible = is_study
	%Form.visible = not is_study
	%Scenarios.visible = not is_study
	if is_study:
		%StudyForm.choose(STUDIES[words])
	_chosen()


## What has no part in the scenario is not asked for.
func _chosen() -> void:
	if %StudyForm.visible:
		_show_problem(%StudyForm.problem())
		return
	var shown := {
		"camera": _launch.chosen.scenario == 5,
		"control": _launch.chosen.scenario != 1,
		"correction": _launch.chosen.scenario in [4, 5],
		"derivation": _launch.chosen.scenario in [4, 5],
	}
	for choice: String in ["delay", "jitter", "loss"]:
		shown[choice] = _launch.chosen.scenario != 1
	for choice: String in OF_A_NETWORK:
		shown[choice] = _launch.has_network()
	for choice: String in OF_TWO_MACHINES:
		shown[choice] = _launch.has_network() and _launch.chosen.side != Launch.BOTH
	for choice: String in shown:
		for part: Control in _rows[choice]:
			part.visible = shown[choice]
	_show_problem(_launch.problem())


func _show_problem(problem: String) -> void:
	_said.text = problem
	%Start.disabled = not problem.is_empty()


func _unhandled_key_input(event: InputEvent) -> void:
	if has_way_back and _run == null and _study == null and event.is_action_pressed(&"ui_cancel"):
		get_viewport().set_input_as_handled()
		left.emit()


func _show_state(plays: bool) -> void:
	%Panel.visible = not plays
	%Stop.visible = plays


func _stop() -> void:
	if _study != null:
		_end_study()
	else:
		_run.stop()


## What has been answered is in its file; a run that is not over goes on when it is begun again.
func _end_study() -> void:
	var kept := "The answers are in %s" % ProjectSettings.globalize_path(_study.file.folder)
	_said.text = kept if _study.problem.is_empty() else _study.problem
	_study.queue_free()
	_study = null
	_show_state(false)


func _start() -> void:
	_show_state(true)
	if %StudyForm.visible:
		_study = %StudyForm.make()
		add_child(_study)
		move_child(_study, 0)
		if not _study.problem.is_empty():
			_end_study()
		return
	_run = Run.new()
	_run.finished.connect(func(message: String) -> void: _said.text = message)
	add_child(_run)
	move_child(_run, 0)
	var code := await _run.start(_launch)
	%Again.set_meta("bundle", _run.folder)
	%Again.visible = code == 0
	_run.queue_free()
	_run = null
	_show_state(false)


func _play_again() -> void:
	var bundle: String = %Again.get_meta("bundle")
	_said.text = "Playing it again …"
	await get_tree().process_frame
	await get_tree().process_frame
	var same := Replay.run(["--replay=" + bundle]) == Replay.SAME
	_said.text = "The results are bit-exact" if same else "It was not the same: the output says where"
