extends Control
## The dynamic testbed twice: left the operator's, right the environment that is touched over an emulated
## network. Keys 1, 2 and 4 choose the scenario.

const SCENARIOS := {
	"1  Direct, no network": MMTLink.SCENARIO_LOCAL,
	"2  Direct": MMTLink.SCENARIO_DIRECT,
	"4  Model-mediated": MMTLink.SCENARIO_MMT,
}
const CORRECTIONS := {
	"Never corrected": MMTLink.CORRECTION_NONE,
	"Pose (thesis)": MMTLink.CORRECTION_POSE,
	"Pose, velocities": MMTLink.CORRECTION_POSE_VELOCITY,
	"Masked: magnitude": MMTLink.CORRECTION_MASKED_MAGNITUDE,
	"Masked: direction": MMTLink.CORRECTION_MASKED_DIRECTION,
	"Carried: translate": MMTLink.CORRECTION_MASKED_TRANSLATE,
	"Carried: turn": MMTLink.CORRECTION_MASKED_TURN,
}
const DERIVATIONS := {
	"What was true": MMTTuning.DERIVATION_NONE,
	"Velocity (eq. 3.1)": MMTTuning.DERIVATION_VELOCITY,
	"Acceleration": MMTTuning.DERIVATION_ACCELERATION,
	"Averaged velocity": MMTTuning.DERIVATION_AVERAGED,
	"Model's history": MMTTuning.DERIVATION_HISTORY,
	"Re-simulation": MMTTuning.DERIVATION_RESIMULATE,
}
const CONTROLS := {
	"Spring": MMTLink.CONTROL_SPRING,
	"1: position": MMTLink.CONTROL_POSITION,
	"2: position and force": MMTLink.CONTROL_POSITION_FORCE,
	"3: relative to the object": MMTLink.CONTROL_POSITION_FORCE_RELATIVE,
}
## What the model believes of the box and the ground, as factors.
const WRONG_MODEL := {"Box": {"mass": 1.2, "friction": 0.7}, "Ground": {"friction": 0.7}}

@onready var _here: MMTLink = %OperatorView.get_node("Testbed/HapticWorld/MMTLink")
@onready var _there: MMTLink = %FarView.get_node("Testbed/HapticWorld/MMTLink")
@onready var _scenario: OptionButton = %Scenario


func _ready() -> void:
	_fill(_scenario, SCENARIOS, _here.scenario, _choose_scenario)
	_fill(
		%Correction,
		CORRECTIONS,
		_here.correction_scheme,
		func(value: int) -> void: _here.correction_scheme = value
	)
	var tuning := _here.tuning
	_fill(%Derivation, DERIVATIONS, tuning.derivation, func(value: int) -> void: tuning.derivation = value)
	_fill(%Control, CONTROLS, _there.control_scheme, func(value: int) -> void: _there.control_scheme = value)
	%WrongModel.toggled.connect(_set_model)
	if %WrongModel.button_pressed:
		_set_model(true)
	for slider: HSlider in [%Delay, %Jitter, %Loss]:
		slider.value_changed.connect(func(_value: float) -> void: _set_network())
	_set_network()
	# The overlay plots the same forces.
	$Placard/%Overlay.room_taken.connect(func(width: float) -> void: %Felt.visible = width == 0.0)


func _fill(button: OptionButton, choices: Dictionary, chosen: int, choose: Callable) -> void:
	for title: String in choices:
		button.add_item(title, choices[title])
	button.select(button.get_item_index(chosen))
	button.item_selected.connect(func(index: int) -> void: choose.call(button.get_item_id(index)))


func _set_model(is_wrong: bool) -> void:
	_here.model_errors = WRONG_MODEL if is_wrong else {}


func _choose_scenario(scenario: int) -> void:
	_here.scenario = scenario
	_there.scenario = scenario


func _set_network() -> void:
	# Both sides share them: each way has half of the delay.
	var conditions := _here.conditions
	conditions.delay = %Delay.value * 0.5e-3
	conditions.jitter = %Jitter.value * 1e-3
	conditions.loss = %Loss.value * 1e-2
	%DelayText.text = "Delay, there and back   %d ms" % %Delay.value
	%JitterText.text = "Jitter   ± %d ms" % %Jitter.value
	%LossText.text = "Loss   %d %%" % %Loss.value


func _unhandled_key_input(event: InputEvent) -> void:
	if not event.is_pressed() or event.is_echo() or not event is InputEventKey:
		return
	var scenario: int = {KEY_1: 1, KEY_2: 2, KEY_4: 4}.get(event.keycode, 0)
	if scenario != 0:
		_scenario.select(_scenario.get_item_index(scenario))
		_choose_scenario(scenario)


func _process(_delta: float) -> void:
	var hand: ProxyPointer = _here.get_node("../ProxyPointer")
	var far: ProxyPointer = _there.get_node("../ProxyPointer")
	%Forces.add(Time.get_ticks_usec() * 1e-6, hand.get_force().length(), far.get_force().length())
	var figures := _here.get_statistics()
	if _here.scenario == MMTLink.SCENARIO_LOCAL:
		%Report.text = _here.get_state_text()
		return
	var lines := PackedStringArray([_here.get_state_text()])
	lines.append("round trip %d ms" % roundi(figures.round_trip_s * 1e3))
	lines.append("%d packets/s, %d back" % [figures.packets_sent_per_s, figures.packets_received_per_s])
	if _here.scenario == MMTLink.SCENARIO_MMT:
		lines.append("%d corrections" % figures.corrections)
		lines.append("largest step %.3f N" % figures.correction_force_step_max_n)
		lines.append("pointers carried %.1f mm" % (figures.offset_m * 1e3))
	%Report.text = "\n".join(lines)
