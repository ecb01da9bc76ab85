extends "test_case.gd"
## A thousand simulated participants answer each study: what is found of them is what they are.

const OBSERVERS := 1000
const Stiffness := preload("res://studies/stiffness.gd")
const Schemes := preload("res://studies/schemes.gd")

var _dice := RandomNumberGenerator.new()


## Plays all trials of one participant without slabs and without a file, which studies_test.gd judges:
## `answers` is asked with the study and returns 0 (left) or 1.
func _play(order: int, answers: Callable) -> Dictionary:
	var study := Stiffness.new()
	study.seed_of_order = order
	study._draw_anew(-1)
	study.begin()
	while study.has_more():
		study._draw_anew(study.trial)
		study.set_up()
		study.take(answers.call(study))
		study.trial += 1
	var found := study.results()
	study.free()
	return found


## Weibull, 75 % at the threshold; a lapse is a guess.
func _weibull(study: Node, threshold: float, slope: float, lapse: float) -> int:
	if _dice.randf() < lapse:
		return _dice.randi_range(0, 1)
	var right := _dice.randf() < 1.0 - 0.5 * exp(-log(2.0) * pow(study.difference / threshold, slope))
	return study.stiffer if right else 1 - study.stiffer


func _guesses(_study: Node) -> int:
	return _dice.randi_range(0, 1)


func _names_the_left(_study: Node) -> int:
	return 0


func _takes_turns(study: Node) -> int:
	return study.trial % 2


func _feels_the_left_alone(study: Node) -> int:
	var ratio := sqrt(1.0 + study.difference)
	var left: float = study.mean_stiffness * (ratio if study.stiffer == 0 else 1.0 / ratio)
	return 0 if left > study.reference else 1


func test_a_thousand_observers_thresholds_are_found_and_their_intervals_hold() -> void:
	_dice.seed = 1
	var ratios := []
	var covered := 0
	var flagged := 0
	for observer in OBSERVERS:
		var threshold := 0.02 * pow(25.0, _dice.randf())
		var slope := _dice.randf_range(1.5, 4.0)
		var lapse := _dice.randf_range(0.0, 0.05)
		var found := _play(observer + 1, _weibull.bind(threshold, slope, lapse))
		ratios.append(found.threshold_share / threshold)
		covered += int(found.threshold_low_share <= threshold and threshold <= found.threshold_high_share)
		flagged += int(found.verdict != "")
	ratios.sort()
	var median: float = ratios[OBSERVERS / 2]
	print("median %.4f, covered %d, flagged %d of %d" % [median, covered, flagged, OBSERVERS])
	check_near(median, 1.0, 0.03, "median of estimate over truth")
	check_near(covered / float(OBSERVERS), 0.95, 0.02, "share of intervals with the truth within")
	check(flagged <= 0.01 * OBSERVERS, "%d who attend are flagged" % flagged)


func test_who_guesses_or_follows_a_pattern_is_flagged() -> void:
	_dice.seed = 2
	for pattern: Callable in [_guesses, _names_the_left, _takes_turns, _feels_the_left_alone]:
		var flagged := 0
		for observer in OBSERVERS / 4:
			flagged += int(_play(observer + 1, pattern).verdict != "")
		print("%s: %d of %d flagged" % [pattern.get_method(), flagged, OBSERVERS / 4])
		check(flagged >= 0.95 * OBSERVERS / 4, "%s: %d flagged" % [pattern.get_method(), flagged])


func test_who_prefers_one_scheme_is_found_at_the_stated_power() -> void:
	_dice.seed = 3
	const TRIALS := 30
	for preference: float in [0.5, 0.75]:
		var found := 0
		for _observer in OBSERVERS:
			var chosen := 0
			for _trial in TRIALS:
				chosen += int(_dice.randf() < preference)
			found += int(2 * chosen > TRIALS and Schemes.p_value(chosen, TRIALS) < Schemes.SIGNIFICANCE)
		var stated := Schemes.power(TRIALS, preference)
		var noise := 3.0 * sqrt(stated * (1.0 - stated) / OBSERVERS)
		print("preference %.2f: found %.3f, stated %.3f" % [preference, found / float(OBSERVERS), stated])
		check_near(found / float(OBSERVERS), stated, noise, "found of those who prefer %.2f" % preference)
