extends Node3D
## A study with people: trials in an order that only the seed decides, and their answers in a file of their
## own for each participant and each run (study_file.gd). A scene whose root node extends it defines what a
## trial is; docs/studies.md has a whole one.
##
##     ./run app res://studies/stiffness.tscn -- --participant=P07 --seed_of_order=7
##
## Every exported property of the root node can be given so. A participant's run that was not finished, with
## the same settings, goes on at its next trial.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")
@warning_ignore_start("integer_division", "incompatible_ternary", "shadowed_variable_base_class")

signal finished

const StudyFile := preload("study_file.gd")
const CallerPath := preload("caller_path.gd")
const OptionWords := preload("option_words.gd")

## Without contact for so long, a hand counts as lifted (unit: seconds).
const LIFTED := 0.2
## The code where none is given.
const NOT_NAMED := "0"
## Between two signs that this run is being answered (unit: seconds).
const TOUCH_EVERY := 2.0

## The participant's code. A list of codes and names stays apart from the data. NOT_NAMED: each start is a run
## of its own, for two people who start it so may be two participants.
@export var participant := NOT_NAMED
## The same seed gives the same order; 0 draws one.
@export_range(0, 1000000000) var seed_of_order := 0
## Where the files of all participants are.
@export_dir var folder := "user://studies"
## The hand's world: its fingertips have to be lifted between trials.
@export var world: HapticWorld
## 0: a run that was not finished stays as it is, and a new one begins, as it does for NOT_NAMED.
@export var goes_on := true

## Chance of the present trial: it depends on the seed and the trial's number alone.
var dice := RandomNumberGenerator.new()
var file := StudyFile.new()
## The number of the present trial, from 0 on.
var trial := 0
var is_over := false
## Why the study has ended before its end; empty otherwise.
var problem := ""
## The answer is there and the hand is still at what was touched; the next trial waits for it to be lifted.
var is_lifting := false

var _began_at := 0.0
var _free_since := -1.0
var _told_at := 0.0


func _ready() -> void:
	if _is_program():
		var wrong := take_words(OS.get_cmdline_user_args())
		if not wrong.is_empty():
			_end_with(wrong)
			get_tree().quit.call_deferred(2)
			return
	start()


## Takes --NAME=VALUE for the exported properties. Empty, or what is wrong: then nothing is taken.
func take_words(arguments: PackedStringArray) -> String:
	var words := OptionWords.new()
	words.declared = OptionWords.of_properties(self)
	var wrong := words.read(arguments)
	if not wrong.is_empty():
		return wrong
	var place := CallerPath.whole(words.values.get("folder", folder))
	wrong = CallerPath.problem(place)
	if not wrong.is_empty():
		return wrong
	if words.values.get("goes_on", false) and words.values.get("participant", participant) == NOT_NAMED:
		return "--goes_on=1 is refused: say whose run goes on, with --participant=CODE"
	for key: String in words.values:
		set(key, words.values[key])
	folder = place
	return StudyFile.code_problem(participant)


## Opens the participant's file and begins with the first trial that has no answer.
func start() -> void:
	var unplayable := settings_problem()
	if not unplayable.is_empty():
		_end_with(unplayable)
		return
	var settings := _settings()
	var drawn := seed_of_order if seed_of_order != 0 else randi_range(1, 1000000000)
	var may_go_on := goes_on and participant != NOT_NAMED
	var wrong := file.begin(folder, study_name(), participant, settings, _more(drawn), may_go_on)
	if not wrong.is_empty():
		_end_with(wrong)
		return
	seed_of_order = int(file.about.seed)
	_draw_anew(-1)
	begin()
	for row in file.rows:
		_draw_anew(trial)
		set_up()
		restore(row)
		var found := take(int(row.answer))
		if str(found.get("answer")) != row.answer:
			_end_with("'%s' is not of this study: begin a new run with --goes_on=0" % file.csv_path())
			return
		trial += 1
	if has_more():
		_next()
	else:
		_finish()


## The participant's answer to the present trial.
func answer(given: int) -> void:
	if is_over or is_lifting:
		return
	var row := {
		"trial": trial + 1,
		"participant": participant,
		"seed": seed_of_order,
		"utc": Time.get_datetime_string_from_system(true),
		"version": version(),
		"answered_after_s": Time.get_ticks_msec() * 1e-3 - _began_at,
	}
	row.merge(take(given))
	var wrong := file.add(row)
	if not wrong.is_empty():
		_end_with(wrong)
		return
	trial += 1
	if not has_more():
		_finish()
		return
	is_lifting = true
	lift()


## Goes on to the next trial as soon as no fingertip touches anything.
func lift() -> void:
	if touches():
		_free_since = -1.0
		%Question.text = "Lift your hand."
		return
	if is_lifting:
		is_lifting = false
		_next()


## Whether a fingertip of the hand's world touches something.
func touches() -> bool:
	for pointer: ProxyPointer in world.find_children("*", "ProxyPointer", true, false):
		if pointer.is_touching():
			return true
	return false


## Of the addon, with which this was answered.
static func version() -> String:
	var plugin := ConfigFile.new()
	plugin.load("res://addons/tactus/plugin.cfg")
	return plugin.get_value("plugin", "version", "")


func _process(_seconds: float) -> void:
	var now := Time.get_ticks_msec() * 1e-3
	if is_over:
		return
	if now - _told_at > TOUCH_EVERY:
		_told_at = now
		file.touch()
	if not is_lifting:
		return
	if touches():
		_free_since = -1.0
	elif _free_since < 0.0:
		_free_since = now
	elif now - _free_since >= LIFTED:
		lift()


func _exit_tree() -> void:
	if not is_over:
		file.leave()


func _next() -> void:
	_draw_anew(trial)
	set_up()
	_began_at = Time.get_ticks_msec() * 1e-3
	%Question.text = question()


func _finish() -> void:
	is_over = true
	var wrong := file.finish(results())
	if not wrong.is_empty():
		_end_with(wrong)
		return
	%Question.text = ending()
	finished.emit()


func _end_with(why: String) -> void:
	is_over = true
	problem = why
	%Question.text = "The study has stopped: %s." % why
	push_error(why)
	if _is_program() and DisplayServer.get_name() == "headless":
		get_tree().quit.call_deferred(1)


## The program that has started it learns from the exit code that not all answers are there.
func _notification(what: int) -> void:
	if what == NOTIFICATION_WM_CLOSE_REQUEST and not problem.is_empty() and _is_program():
		get_tree().quit(1)


func _is_program() -> bool:
	return is_inside_tree() and get_tree().current_scene == self


func _draw_anew(of_trial: int) -> void:
	dice.seed = hash([seed_of_order, of_trial])


## All that decides what is presented: what has to be the same where a run goes on.
func _settings() -> Dictionary:
	var found := {}
	for name: String in OptionWords.of_properties(self):
		if name not in ["participant", "folder", "goes_on"]:
			found[name] = get(name)
	found.merge(more_settings())
	return found


func _more(drawn: int) -> Dictionary:
	return {
		"study": study_name(),
		"participant": participant,
		"seed": drawn,
		"version": version(),
		"godot": Engine.get_version_info().string,
		"machine": "%s, %s" % [OS.get_processor_name(), OS.get_distribution_name()],
		"begun_utc": Time.get_datetime_string_from_system(true),
		"columns": _columns(),
	}


func _columns() -> Dictionary:
	var all := {
		"trial": "number of the trial, from 1 on",
		"participant": "code of the participant",
		"seed": "decides the order of all trials",
		"utc": "when it was answered, Coordinated Universal Time",
		"version": "version of Tactus",
		"answered_after_s": "from the beginning of the trial to the answer, in seconds",
	}
	all.merge(columns())
	return all


func _unhandled_key_input(event: InputEvent) -> void:
	var key := event as InputEventKey
	if (
		key != null
		and key.pressed
		and not key.echo
		and not is_over
		and not is_lifting
		and pressed(key.keycode)
	):
		get_viewport().set_input_as_handled()


# --- of the study


## What its folder is called: letters, digits, - and _.
func study_name() -> String:
	return String(get_script().resource_path.get_file().get_basename())


## Why the study cannot be played with its settings; empty where it can.
func settings_problem() -> String:
	return ""


## Settings that are not exported properties.
func more_settings() -> Dictionary:
	return {}


## Once, before the first trial.
func begin() -> void:
	pass


## The next trial, by `dice` and `trial`.
func set_up() -> void:
	pass


func question() -> String:
	return ""


func pressed(_key: Key) -> bool:
	return false


## Where a run goes on, before take(): a trial that has measured something itself takes it back from its row.
func restore(_row: Dictionary) -> void:
	pass


## What the answer to the present trial gives as a row: "answer", which is the answer itself, and what was
## presented.
func take(given: int) -> Dictionary:
	return {"answer": given}


## What the columns of take() mean, with their units.
func columns() -> Dictionary:
	return {"answer": ""}


func has_more() -> bool:
	return false


## What is found from all answers, for the run's JSON file.
func results() -> Dictionary:
	return {}


func ending() -> String:
	return "Thank you: that was all."
