@tool
extends Node
## Runs the test_* methods of the file that the first user argument names, or of those the methods that
## follow.
##
## Each method runs on a fresh instance with a fresh branch of the tree; it may await. Prints RUN, TOOK, PASS,
## FAIL and, when everything has run, END: only then does tools/testing/godot_suite.py believe the rest.


func _ready() -> void:
	_run_all.call_deferred(OS.get_cmdline_user_args())


func _run_all(arguments: PackedStringArray) -> void:
	var script: GDScript = load(arguments[0])
	if script == null or not script.can_instantiate():
		print("FAIL load: the script has errors")
		get_tree().quit(1)
		return
	for method in script.get_script_method_list():
		var test: String = method["name"]
		if test.begins_with("test_") and (arguments.size() == 1 or test in arguments):
			await _run(script, test)
	print("END")
	get_tree().quit()


func _run(script: GDScript, test: String) -> void:
	print("RUN ", test)
	var began := Time.get_ticks_msec()
	var case: Node = script.new()
	get_tree().root.add_child(case)
	await get_tree().process_frame
	await case.call(test)
	var why: String = case.failure
	case.queue_free()
	await get_tree().process_frame
	await get_tree().process_frame
	print("TOOK %d ms" % (Time.get_ticks_msec() - began))
	if why.is_empty():
		print("PASS ", test)
	else:
		print("FAIL ", test, ": ", why)
