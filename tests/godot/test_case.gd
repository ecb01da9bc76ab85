@tool
extends Node
## What a headless test extends. It is a branch of the tree of its own: what it adds below goes with it.

## Why the test has failed, the first reason; empty while it has not.
var failure := ""


func check(condition: bool, why: String) -> void:
	if not condition and failure.is_empty():
		failure = why


func check_equal(found: Variant, expected: Variant, what := "value") -> void:
	check(
		typeof(found) == typeof(expected) and found == expected, "%s is %s, not %s" % [what, found, expected]
	)


func check_near(found: Variant, expected: Variant, tolerance: float, what := "value") -> void:
	var distance: float = (
		abs(found - expected) if found is float or found is int else (found - expected).length()
	)
	check(distance <= tolerance, "%s is %s, not %s within %s" % [what, found, expected, tolerance])


## Announces that a line of Godot's errors or warnings with this text belongs to the test.
func expect_error(text: String) -> void:
	print("EXPECT ", text)


## Waits for frames of the main loop.
func frames(count: int) -> void:
	for _frame in count:
		await get_tree().process_frame


## A key goes down or comes up, wherever it lies on the keyboard.
func send_key(code: Key, pressed: bool) -> void:
	var event := InputEventKey.new()
	event.physical_keycode = code
	event.keycode = code
	event.pressed = pressed
	Input.parse_input_event(event)
	Input.flush_buffered_events()


## A key goes down, and has been seen.
func press_key(code: Key) -> void:
	send_key(code, true)
	await frames(2)


## Waits until the condition holds, at most for so long; says whether it did.
func until(condition: Callable, seconds: float) -> bool:
	var deadline := Time.get_ticks_msec() + int(seconds * 1000.0)
	while not condition.call():
		if Time.get_ticks_msec() > deadline:
			return false
		await get_tree().process_frame
	return true


## With all that is in it, hidden files too.
func remove_folder(folder: String) -> void:
	var here := DirAccess.open(folder)
	if here == null:
		return
	here.include_hidden = true
	for inner in here.get_directories():
		remove_folder(folder.path_join(inner))
	for file in here.get_files():
		DirAccess.remove_absolute(folder.path_join(file))
	DirAccess.remove_absolute(folder)
