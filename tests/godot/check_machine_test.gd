extends "test_case.gd"
## The check of a machine reports. Not played in a released program: Debian's template 4.6.3 says of any
## Container with a Button in it that a connection does not exist.


func test_the_machine_is_checked() -> void:
	var scene: Control = load("res://addons/tactus/check/check_machine.tscn").instantiate()
	scene.seconds = 0.5
	var reports: Array[String] = []
	scene.finished.connect(func(report: String) -> void: reports.append(report))
	add_child(scene)
	check(await until(func() -> bool: return not reports.is_empty(), 20.0), "there is no report")
	for words: String in ["Godot 4", "ticks a second of 1000 wanted", "Real-time rights", "Novint Falcon: "]:
		check(reports[0].contains(words), "'%s' is not in: %s" % [words, reports[0]])
