extends "nodes_case.gd"
## Games that exist without Tactus go on as they are below a HapticWorld: the same bits, the same signals.
## Runs with each of Godot's physics engines.

const Games := preload("games.gd")
const FRAME := 1.0 / 60.0
const SECONDS := 10.0
const SPEEDUP := 16


func _hurry(times: int) -> void:
	Engine.physics_ticks_per_second = 60 * times
	Engine.time_scale = times
	Engine.max_physics_steps_per_frame = 8 * times


## In a space of its own, so that bodies get the same numbers in every run. Null: without a world. `is_late`:
## the game comes into a world that runs already.
func _play(kind: GDScript, authority: Variant, is_late := false) -> Dictionary:
	await get_tree().physics_frame
	var space := SubViewport.new()
	space.own_world_3d = true
	space.render_target_update_mode = SubViewport.UPDATE_DISABLED
	var game: Games.Game = kind.new()
	var world: HapticWorld = null
	if is_late:
		add_child(space)
	if authority != null:
		world = HapticWorld.new()
		world.clock = HapticWorld.CLOCK_STEPPED
		world.authority = authority
		space.add_child(world)
		world.add_child(game)
		add_hand(world, path(game.hand(), game.hand() + Vector3(0.01, 0, 0)))
	else:
		space.add_child(game)
	if not is_late:
		add_child(space)
	var touched := false
	for _i in int(SECONDS / FRAME):
		await get_tree().physics_frame
		if world != null:
			world.advance(FRAME)
			touched = touched or (world.get_node("Proxy") as ProxyPointer).is_touching()
	# Which of two areas Godot tells first in one frame depends on its threads. Each line has its frame.
	var events := game.events.duplicate()
	events.sort()
	var result := {"places": game.places(), "events": events, "touched": touched}
	result.authority = world.get_authority_in_use() if world != null else -1
	result.problems = world.get_problems() if world != null else PackedStringArray()
	space.free()
	return result


func _check_game(label: String, authority := HapticWorld.AUTHORITY_AUTOMATIC, is_late := false) -> void:
	_hurry(SPEEDUP)
	var kind: GDScript = Games.all()[label]
	var alone := await _play(kind, null, is_late)
	var with_us := await _play(kind, authority, is_late)
	_hurry(1)
	check(alone.events.size() > 3, "only %s" % [alone.events])
	check_equal(with_us.authority, HapticWorld.AUTHORITY_GODOT, "authority")
	check_equal(with_us.touched, false, "touched")
	check_equal(with_us.events, alone.events, "events")
	check_equal(with_us.places.keys(), alone.places.keys(), "bodies")
	for body: String in alone.places:
		var here: Transform3D = with_us.places[body]
		var there: Transform3D = alone.places[body]
		var off := here.origin.distance_to(there.origin)
		check(here == there, "%s is off by %s m: %s, not %s" % [body, off, here, there])
	check_equal(with_us.problems, PackedStringArray(), "problems")


func test_a_vehicle() -> void:
	await _check_game("vehicle")


func test_a_level_of_tiles() -> void:
	await _check_game("grid")


func test_a_ragdoll() -> void:
	await _check_game("ragdoll")


func test_a_platformer() -> void:
	await _check_game("platforms")


func test_stacks_and_joints() -> void:
	await _check_game("stacks")


func test_moving_platforms() -> void:
	await _check_game("lifts", HapticWorld.AUTHORITY_GODOT)  # a haptic world could move all of it


func test_coins_and_enemies() -> void:
	await _check_game("coins")


## The world is to leave its bodies as they are until it knows whether Godot moves them.
func test_games_that_come_into_a_world_that_runs() -> void:
	for label: String in ["stacks", "platforms"]:
		await _check_game(label, HapticWorld.AUTHORITY_AUTOMATIC, true)
