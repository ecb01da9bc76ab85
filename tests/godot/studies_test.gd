extends "nodes_case.gd"
## Studies with people: who answers here is a participant out of chance, of whom it is known what is noticed.

const Staircase := preload("res://studies/staircase.gd")

var _folder := ProjectSettings.globalize_path("user://studies_%d" % OS.get_process_id())


func _exit_tree() -> void:
	for file in DirAccess.get_files_at(_folder):
		DirAccess.remove_absolute(_folder.path_join(file))
	DirAccess.remove_absolute(_folder)


func _init() -> void:
	DirAccess.make_dir_recursive_absolute(_folder)


## The share of right answers at a difference: half by guessing, and a Weibull function with 79.4 % at `jnd`.
func _share_right(difference: float, jnd: float) -> float:
	const STEEPNESS := 2.5
	var at_jnd := -log(1.0 - (pow(0.5, 1.0 / 3.0) - 0.5) / 0.5)
	return 1.0 - 0.5 * exp(-at_jnd * pow(difference / jnd, STEEPNESS))


func _open(scene: String, order: int, file := "study.csv") -> Node:
	var study := (load("res://studies/%s.tscn" % scene) as PackedScene).instantiate()
	study.seed_of_order = order
	study.csv_path = _folder.path_join(file)
	for world: HapticWorld in study.find_children("*", "HapticWorld", true, false):
		world.clock = HapticWorld.CLOCK_STEPPED
	add_child(study)
	return study


func _rows(file := "study.csv") -> Array[Dictionary]:
	var rows: Array[Dictionary] = []
	var text := FileAccess.open(_folder.path_join(file), FileAccess.READ)
	var columns := text.get_csv_line()
	while not text.eof_reached():
		var cells := text.get_csv_line()
		if cells.size() == columns.size():
			var row := {}
			for i in columns.size():
				row[columns[i]] = cells[i]
			rows.append(row)
	return rows


func test_a_staircase_finds_what_is_just_noticed() -> void:
	var dice := RandomNumberGenerator.new()
	for jnd: float in [0.02, 0.1, 0.3]:
		var sum := 0.0
		for run in 200:
			dice.seed = run + 1
			var staircase := Staircase.new()
			while not staircase.is_over():
				staircase.answer(dice.randf() < _share_right(staircase.level, jnd))
			sum += log(staircase.threshold() / jnd)
		check_near(exp(sum / 200.0), 1.0, 0.1, "threshold over what is noticed, at %s" % jnd)


func test_a_staircase_without_a_mistake_ends_at_its_least_level_and_has_no_threshold() -> void:
	var staircase := Staircase.new()
	for _i in 100:
		staircase.answer(true)
	check_near(staircase.level, staircase.least, 1e-12, "level")
	check(not staircase.is_over() and is_nan(staircase.threshold()), "it has a threshold")


func test_of_two_slabs_the_stiffer_one_pushes_harder_and_the_staircase_follows_the_answers() -> void:
	var study := _open("stiffness", 7)
	var dice := RandomNumberGenerator.new()
	dice.seed = 3
	var sides := {}
	while not study.is_over:
		sides[study.stiffer] = true
		var left: HapticMaterial = study.get_node("%Left").physics_material_override
		var right: HapticMaterial = study.get_node("%Right").physics_material_override
		check((left.stiffness > right.stiffness) == (study.stiffer == 0), "the wrong slab is stiffer")
		study.world.advance(0.02)
		var is_found: bool = dice.randf() < _share_right(study.staircase.level, 0.15)
		study.answer(study.stiffer if is_found else 1 - study.stiffer)
	check_equal(sides.size(), 2, "sides that were stiffer")
	var rows := _rows()
	check_equal(rows.size(), study.staircase.trials, "rows")
	check_equal(rows[0].run + rows[0].participant + rows[0].seed, "107", "the first row")
	check_near(rows[-1].threshold_share.to_float(), 0.15, 0.1, "threshold")
	for row in rows:
		check((row.right == "1") == (row.stiffer == row.answer), "an answer is told wrong")


func test_the_hand_feels_the_difference() -> void:
	var study := _open("stiffness", 7)
	var world: HapticWorld = study.world
	var proxy: ProxyPointer = world.get_node("ProxyPointer")
	world.advance(1.0)
	var left := proxy.get_force().y
	world.advance(3.0)
	var right := proxy.get_force().y
	var expected: float = 1.0 + study.first_difference
	check_near(maxf(left, right) / minf(left, right), expected, 0.05, "the stiffer force over the other")
	check((left > right) == (study.stiffer == 0), "the wrong one pushes harder")


func test_the_same_seed_gives_the_same_order() -> void:
	var orders := []
	for file: String in ["a.csv", "b.csv"]:
		var study := _open("stiffness", 11, file)
		for _i in 12:
			study.answer(0)
		orders.append(_rows(file).map(func(row: Dictionary) -> String: return row.stiffer))
		study.free()
	check_equal(orders[0], orders[1], "order")


func test_schemes_are_compared_blind_and_as_often_the_one_first_as_the_other() -> void:
	var study := _open("schemes", 5)
	study.trials = 20
	check_equal(study.world.get_node("MMTLink").scenario, MMTLink.SCENARIO_MMT, "scenario")
	var link: MMTLink = study.world.get_node("MMTLink")
	for _i in study.trials:
		for which in 2:
			study.pressed(KEY_1 if which == 0 else KEY_2)
			var scheme: String = study.schemes[study.first if which == 0 else 1 - study.first]
			check_equal(
				int(link.correction_scheme), ClassDB.class_get_integer_constant("MMTLink", scheme), "scheme"
			)
			for label: Label in study.find_children("*", "Label", true, false):
				for word: String in ["pose", "stealthy", "correction"]:
					check(not word in label.text.to_lower(), "'%s' gives it away" % label.text)
		# Whoever always takes the stealthy one is found out.
		study.answer(0 if study.schemes[study.first] == "CORRECTION_STEALTHY_DIRECTION" else 1)
	check(study.is_over, "it goes on")
	var rows := _rows()
	check_equal(rows.size(), 20, "rows")
	var first := rows.filter(func(row: Dictionary) -> bool: return row.first == "CORRECTION_POSE")
	check_equal(first.size(), 10, "trials with the one as the first")
	for row in rows:
		check_equal(row.chosen, "CORRECTION_STEALTHY_DIRECTION", "chosen")
		check_equal(row.changes, "2", "changes")


func test_what_cannot_be_written_is_said() -> void:
	expect_error("cannot be written")
	expect_error("Could not create directory")
	var study := (load("res://studies/stiffness.tscn") as PackedScene).instantiate()
	study.csv_path = "/proc/nowhere/study.csv"
	study.get_node("HapticWorld").clock = HapticWorld.CLOCK_STEPPED
	add_child(study)
	check(study.is_over, "it goes on")
