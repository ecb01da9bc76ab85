extends "nodes_case.gd"
## Studies with people: what is presented, what is kept of the answers, and where it is.

const Staircase := preload("res://addons/tactus/studies/staircase.gd")
const StudyFile := preload("res://addons/tactus/studies/study_file.gd")
const Order := preload("res://addons/tactus/studies/order.gd")
const OptionWords := preload("res://addons/tactus/studies/option_words.gd")
const Schemes := preload("res://studies/schemes.gd")

var _folder := ProjectSettings.globalize_path("user://studies_%d" % OS.get_process_id())


func _exit_tree() -> void:
	if DirAccess.dir_exists_absolute(_folder):
		remove_folder(_folder)


func _open(scene: String, settings := {}) -> Node:
	var study := (load("res://studies/%s.tscn" % scene) as PackedScene).instantiate()
	study.seed_of_order = 7
	study.folder = _folder
	for name: String in settings:
		study.set(name, settings[name])
	_step(study)
	add_child(study)
	# Those of a study that makes its worlds itself.
	_step(study)
	return study


func _step(study: Node) -> void:
	for world: HapticWorld in study.find_children("*", "HapticWorld", true, false):
		if world.clock != HapticWorld.CLOCK_STEPPED:
			world.clock = HapticWorld.CLOCK_STEPPED


func _rows(path: String) -> Array[Dictionary]:
	var rows: Array[Dictionary] = []
	var text := FileAccess.open(path, FileAccess.READ)
	var columns := text.get_csv_line()
	while not text.eof_reached():
		var cells := text.get_csv_line()
		if cells.size() == columns.size():
			var row := {}
			for i in columns.size():
				row[columns[i]] = cells[i]
			rows.append(row)
	return rows


func _about(study: Node) -> Dictionary:
	return JSON.parse_string(FileAccess.get_file_as_string(study.file.csv_path().replace(".csv", ".json")))


func test_a_staircase_follows_the_rule_of_three_right_and_one_wrong() -> void:
	var staircase := Staircase.new()
	for _i in 3:
		staircase.answer(true)
	check_near(staircase.level, 0.5, 1e-12, "after three right ones")
	staircase.answer(false)
	check_near(staircase.level, 1.0, 1e-12, "after a wrong one")
	check_equal(staircase.reversals, PackedFloat64Array([0.5]), "reversals")
	for _i in 100:
		staircase.answer(true)
	check_near(staircase.level, staircase.least, 1e-12, "the least level")


func test_orders_are_balanced() -> void:
	var dice := RandomNumberGenerator.new()
	dice.seed = 3
	var counts := [0, 0, 0]
	for one in Order.balanced(12, 3, dice):
		counts[one] += 1
	check_equal(counts, [4, 4, 4], "how often each comes")
	for conditions: int in [2, 3, 4, 5, 6]:
		var rows := conditions * (1 + conditions % 2)
		var after := {}
		var at := {}
		for row in rows:
			var order := Order.counterbalanced(row, conditions)
			for place in conditions:
				at[[place, order[place]]] = at.get([place, order[place]], 0) + 1
				if place > 0:
					after[order.slice(place - 1, place + 1)] = (
						after.get(order.slice(place - 1, place + 1), 0) + 1
					)
		check_equal(at.size(), conditions * conditions, "places of %d" % conditions)
		check_equal(at.values().min(), at.values().max(), "how often each is at each place")
		check_equal(after.size(), conditions * (conditions - 1), "successions of %d" % conditions)
		check_equal(after.values().min(), after.values().max(), "how often each comes after each")


func test_of_two_slabs_one_is_stiffer_by_what_is_asked_about_a_mean_that_roves() -> void:
	var study := _open("stiffness", {"trials": 40})
	var sides := {}
	var means := []
	var catches := 0
	while not study.is_over:
		sides[study.stiffer] = true
		var left: float = study.get_node("%Left").physics_material_override.stiffness
		var right: float = study.get_node("%Right").physics_material_override.stiffness
		check((left > right) == (study.stiffer == 0), "the wrong slab is stiffer")
		check_near(
			maxf(left, right) / minf(left, right), 1.0 + study.difference, 1e-9, "the one over the other"
		)
		means.append(sqrt(left * right))
		catches += int(study.is_catch)
		study.answer(study.stiffer)
	check_equal(sides.size(), 2, "sides that were stiffer")
	check_equal(catches, 4, "trials that only attention is needed for")
	check(means.min() < 270.0 and means.max() > 600.0, "the reference does not rove: %s" % [means])
	check(means.min() >= 200.0 and means.max() <= 800.0, "the reference roves too far")


func test_the_hand_feels_the_difference_and_does_not_see_how_deep_it_is() -> void:
	var study := _open("stiffness")
	var world: HapticWorld = study.world
	var proxy: ProxyPointer = world.get_node("ProxyPointer")
	world.advance(1.0)
	var left := proxy.get_force().y
	var at := proxy.global_position
	check(proxy.get_hand_position().distance_to(at) > 1e-3, "the hand is not in the slab")
	check(not proxy.show_hand, "the hand's depth is shown")
	world.advance(3.0)
	var right := proxy.get_force().y
	check_near(
		maxf(left, right) / minf(left, right),
		1.0 + study.difference,
		0.05,
		"the stiffer force over the other"
	)
	check((left > right) == (study.stiffer == 0), "the wrong one pushes harder")


func test_nothing_changes_under_a_resting_hand() -> void:
	var study := _open("stiffness")
	var world: HapticWorld = study.world
	var proxy: ProxyPointer = world.get_node("ProxyPointer")
	world.advance(1.0)
	var before := proxy.get_force()
	study.answer(0)
	check(study.is_lifting, "the next trial begins while the hand touches")
	world.advance(0.001)
	check_near(proxy.get_force(), before, 0.05, "force on the resting hand")
	study.answer(0)
	check_equal(study.trial, 1, "answers while the hand is still there")
	world.advance(0.7)
	check(not proxy.is_touching(), "the hand is still there")
	study.lift()
	check(not study.is_lifting, "the next trial does not begin")


func test_each_participant_and_each_run_has_a_file_and_no_answer_is_lost() -> void:
	var paths := []
	for code: String in ["P01", "P02", "P01"]:
		var study := _open("stiffness", {"participant": code, "trials": 20})
		while not study.is_over:
			study.answer(0)
		check_equal(study.problem, "", "problem")
		paths.append(study.file.csv_path())
		study.free()
	check_equal(paths[2].get_file(), "stiffness_P01_2.csv", "the second run's file")
	for path: String in paths:
		check_equal(_rows(path).size(), 22, "rows of " + path.get_file())


func test_a_row_carries_date_version_seed_and_what_was_presented() -> void:
	var study := _open("stiffness", {"participant": "P03"})
	study.answer(1)
	var row := _rows(study.file.csv_path())[0]
	var plugin := ConfigFile.new()
	plugin.load("res://addons/tactus/plugin.cfg")
	check_equal(row.participant + row.trial + row.seed, "P0317", "participant, trial and seed")
	check_equal(row.version, plugin.get_value("plugin", "version"), "version")
	check(row.utc.begins_with("20") and row.utc.length() == 19, "utc is " + row.utc)
	check_near(row.difference_share.to_float(), study.first_difference, 1e-9, "difference")
	check_equal(row.right == "1", row.stiffer == "1", "whether it is right")
	for column: String in row:
		check(_about(study).columns.has(column), "nothing is said of the column " + column)


func test_a_run_that_was_left_goes_on_at_its_next_trial() -> void:
	var whole := _open("stiffness", {"participant": "whole", "trials": 20})
	while not whole.is_over:
		whole.answer(whole.trial % 2)
	var study: Node = null
	for stop: int in [3, 4, 11, 22]:
		study = _open("stiffness", {"participant": "left", "trials": 20})
		while study.trial < stop:
			study.answer(study.trial % 2)
		if stop < 22:
			study.free()
	check_equal(study.file.csv_path().get_file(), "stiffness_left_1.csv", "the file")
	check(study.is_over, "it goes on")
	var kept := _rows(study.file.csv_path())
	check_equal(kept.size(), 22, "rows")
	var expected := _rows(whole.file.csv_path())
	for i in kept.size():
		for column: String in ["stiffer", "difference_share", "mean_stiffness_n_per_m", "right"]:
			check_equal(kept[i][column], expected[i][column], "%s of trial %d" % [column, i + 1])
	check_equal(_about(study).results, _about(whole).results, "results")


func test_a_row_that_was_cut_by_a_crash_is_asked_again() -> void:
	var study := _open("stiffness", {"participant": "cut"})
	for _i in 5:
		study.answer(0)
	var path: String = study.file.csv_path()
	study.free()
	var text := FileAccess.get_file_as_string(path)
	FileAccess.open(path, FileAccess.WRITE).store_string(text.left(-9))
	study = _open("stiffness", {"participant": "cut"})
	check_equal(study.trial, 4, "the trial that is asked")
	study.answer(0)
	check_equal(_rows(path).size(), 5, "rows")


func test_other_settings_and_a_run_in_use_begin_a_run_of_their_own() -> void:
	var first := _open("stiffness", {"participant": "own"})
	first.answer(0)
	var second := _open("stiffness", {"participant": "own"})
	check_equal(second.file.csv_path().get_file(), "stiffness_own_2.csv", "while the first is in use")
	first.free()
	second.free()
	var third := _open("stiffness", {"participant": "own", "reference": 300.0})
	check_equal(third.file.csv_path().get_file(), "stiffness_own_3.csv", "with another reference")


func test_without_a_participant_each_start_is_a_run_of_its_own() -> void:
	for number: int in [1, 2]:
		var study := _open("stiffness")
		check_equal(study.file.csv_path().get_file(), "stiffness_0_%d.csv" % number, "file")
		check_equal(study.trial, 0, "its first trial")
		study.answer(0)
		# As after a crash: nothing has been finished.
		study.free()
	var form := (load("res://studies/stiffness.tscn") as PackedScene).instantiate()
	var said: String = form.take_words(PackedStringArray(["--goes_on=1"]))
	check("--participant=CODE" in said, "going on with a run of nobody: '%s'" % said)
	check_equal(form.take_words(PackedStringArray(["--goes_on=1", "--participant=P07"])), "", "of P07")
	form.free()


func test_what_cannot_be_kept_stops_the_study_and_says_why() -> void:
	expect_error("cannot be made")
	expect_error("Could not create directory")
	var study := _open("stiffness", {"folder": "/proc/nowhere"})
	check(study.is_over and "choose another folder" in study.problem, "it goes on")
	expect_error("is no participant's code")
	study = _open("stiffness", {"participant": "../other"})
	check(study.is_over, "it goes on with a path for a participant")
	expect_error("there is no scheme 'CORRECTION_MASKED'")
	study = _open("schemes", {"schemes": PackedStringArray(["CORRECTION_MASKED", "CORRECTION_POSE"])})
	check(study.is_over, "it goes on with a scheme that there is not")


func test_an_answer_that_the_disk_does_not_take_is_told() -> void:
	expect_error("could not be written")
	var study := _open("stiffness", {"participant": "full"})
	study.answer(0)
	# A disk that is full cuts what is written; so does this.
	study.file._written += "x"
	study.answer(0)
	check(study.is_over and "could not be written" in study.problem, "it goes on")


func test_schemes_are_compared_blind_and_as_often_the_one_first_as_the_other() -> void:
	var study := _open("schemes", {"trials": 10})
	check_equal(study.world.get_node("MMTLink").scenario, MMTLink.SCENARIO_MMT, "scenario")
	var link: MMTLink = study.world.get_node("MMTLink")
	while not study.is_over:
		for which in 2:
			study.pressed(KEY_1 if which == 0 else KEY_2)
			var scheme: String = study.schemes[study.first if which == 0 else 1 - study.first]
			check_equal(
				int(link.correction_scheme), ClassDB.class_get_integer_constant("MMTLink", scheme), "scheme"
			)
			for label: Label in study.find_children("*", "Label", true, false):
				for word: String in ["carried", "stealthy", "correction"]:
					check(not word in label.text.to_lower(), "'%s' gives it away" % label.text)
		study.answer(0 if study.schemes[study.first] == "CORRECTION_MASKED_DIRECTION" else 1)
	var rows := _rows(study.file.csv_path())
	check_equal(rows.size(), 10, "rows")
	var first := rows.filter(func(row: Dictionary) -> bool: return row.first == "CORRECTION_MASKED_TURN")
	check_equal(first.size(), 5, "trials with the one as the first")
	for row in rows:
		check_equal(row.chosen, "CORRECTION_MASKED_DIRECTION", "chosen")
		check_equal(row.changes, "2", "changes")
	var results: Dictionary = _about(study).results
	check_equal(results.prefers, "CORRECTION_MASKED_DIRECTION", "who is preferred")
	check_near(results.p_value, 2.0 / 1024.0, 1e-9, "p")


## Forces on the operator's hand while it pushes the box along its path (unit: newtons).
func _felt(study: Node) -> PackedVector3Array:
	var worlds: Array[HapticWorld] = [study.world, study.get_node("There/HapticWorld")]
	var pointer: ProxyPointer = study.world.get_node("ProxyPointer")
	var forces := PackedVector3Array()
	for _tick in 2600:
		for world in worlds:
			world.advance(TICK)
		forces.append(pointer.get_force())
	return forces


func _largest_difference(one: PackedVector3Array, other: PackedVector3Array) -> float:
	var largest := 0.0
	for i in one.size():
		largest = maxf(largest, one[i].distance_to(other[i]))
	return largest


func test_in_each_trial_the_two_schemes_differ_and_each_is_what_it_was() -> void:
	var study := _open("schemes", {"trials": 3, "participant": "felt"})
	var before := {}
	for _trial in 3:
		var felt := {}
		for which in 2:
			study.feel(which)
			felt[study.schemes[study.first if which == 0 else 1 - study.first]] = _felt(study)
		var both := felt.values()
		check(_largest_difference(both[0], both[1]) > 0.3, "trial %d compares one with itself" % study.trial)
		for scheme: String in before:
			check_equal(
				_largest_difference(felt[scheme], before[scheme]),
				0.0,
				"%s in trial %d" % [scheme, study.trial]
			)
		before = felt
		study.answer(0)
		study.lift()
		study.is_lifting = false
		if not study.is_over and study.trial < 3:
			study._next()


func test_the_power_is_that_of_the_binomial_distribution() -> void:
	check_near(Schemes.p_value(15, 20), 0.04139, 1e-5, "p of 15 in 20")
	check_near(Schemes.p_value(10, 20), 1.0, 1e-12, "p of 10 in 20")
	check_near(Schemes.power(30, 0.75), 0.8034, 1e-4, "power of 30 trials")


func test_words_are_read_by_type_unit_and_range() -> void:
	var study := _open("stiffness", {"participant": "words"})
	var words := OptionWords.new()
	words.declared = OptionWords.of_properties(study)
	check_equal(words.read(["--participant=P07", "--seed_of_order=7", "--reference=300.5"]), "", "what fits")
	check_equal(words.values, {"participant": "P07", "seed_of_order": 7, "reference": 300.5}, "values")
	for nonsense: String in [
		"nan", "inf", "-1", "1e300", "", "abc", "5O", "300N/m", "1_0", "0x10", "99999999999999999999999"
	]:
		for key: String in ["reference", "trials", "seed_of_order"]:
			var said := words.read(["--%s=%s" % [key, nonsense]])
			check("--%s=%s is refused: it must be a" % [key, nonsense] in said, "%s: '%s'" % [nonsense, said])
	check(
		"from 10.0 to 2000.0 (N/m, which is not written)" in words.read(["--reference=5"]), "unit and range"
	)
	for wrong: String in ["--refrence=5", "reference=5", "--reference", "--=5"]:
		check(words.read([wrong]) != "", "%s is taken" % wrong)
	check("given twice" in words.read(["--trials=50", "--trials=60"]), "a repeated one is taken")
	check_equal(OptionWords.value_of(OptionWords.switch(), "true"), null, "a switch of letters")


func test_each_of_two_staircases_hears_the_answers_to_its_own_trials() -> void:
	var study := _open("stiffness", {"participant": "two"})
	while study.trial < 6:
		var of_three: bool = study.trial % 2 == 1
		study.answer(study.stiffer if of_three else 1 - study.stiffer)
	check_near(study.staircases[0].level, study.catch_difference, 1e-9, "after three wrong answers")
	check_near(study.staircases[1].level, study.first_difference / 2.0, 1e-9, "after three right ones")


func test_a_guided_path_is_measured_trial_by_trial_and_goes_on_after_a_crash() -> void:
	var study := _open("guided_path", {"participant": "P5", "repeats": 1})
	var orders := []
	for part in 2:
		while study.trial < (2 if part == 0 else 3) and not study.is_over:
			study.world.advance(0.02)
			study.look()
		orders.append(study.order)
		if part == 0:
			study.free()
			study = _open("guided_path", {"participant": "P5", "repeats": 1})
			check_equal(study.trial, 2, "trials that are kept")
	check(study.is_over, "it goes on")
	check_equal(orders[0], orders[1], "order")
	check_equal(orders[0], Order.counterbalanced(5, 3), "order of participant 5")
	var rows := _rows(study.file.csv_path())
	var off := {}
	for row in rows:
		off[row.guide_stiffness_n_per_m.to_float()] = row.deviation_rms_mm.to_float()
		check(row.took_s.to_float() > 2.0, "a trial takes %s s" % row.took_s)
	check_equal(off.size(), 3, "conditions")
	check(off[0.0] > 1.0, "the hand's own path is off the line by %s mm" % off[0.0])
	for number in [1, 2, 3]:
		var path: String = study.file.folder.path_join("trial_%03d.csv" % number)
		var ticks := FileAccess.get_file_as_string(path).count("\n") - 1
		check(ticks > 2000, "ticks of trial %d: %d" % [number, ticks])


func test_the_launcher_begins_a_study_and_goes_on_with_it() -> void:
	var launcher := (load("res://launcher/launcher.tscn") as PackedScene).instantiate()
	add_child(launcher)
	launcher.choose_what("A study: the just-noticeable difference of stiffness")
	var form := launcher.get_node("%StudyForm")
	var start: Button = launcher.get_node("%Start")
	form.set_line("folder", _folder)
	for refused: Array in [
		["participant", "Jane Doe"],
		["reference", "abc"],
		["trials", "19"],
		["roving", "nan"],
		["goes_on", "2"]
	]:
		var before: String = form._lines[refused[0]].text
		form.set_line(refused[0], refused[1])
		check(start.disabled and refused[1] in launcher.get_node("%Said").text, "%s is taken" % [refused])
		form.set_line(refused[0], before)
	form.set_line("participant", "P07")
	form.set_line("seed_of_order", "7")
	form.set_line("reference", "300")
	check(not start.disabled, launcher.get_node("%Said").text)
	for answers in 2:
		start.pressed.emit()
		var study: Node = launcher._study
		check(study != null and not launcher.get_node("%Panel").visible, "it does not begin")
		check_equal(study.trial, answers, "it goes on at the next trial")
		check_equal([study.reference, study.seed_of_order, study.participant], [300.0, 7, "P07"], "settings")
		study.answer(0)
		launcher.get_node("%Stop").pressed.emit()
		check("run_1" in launcher.get_node("%Said").text, launcher.get_node("%Said").text)
		await frames(2)
	var rows := _rows(_folder.path_join("stiffness/P07/run_1/stiffness_P07_1.csv"))
	check_equal(rows.size(), 2, "answers")
	launcher.free()
