extends RefCounted
## Plays a scene in stepped time: as fast as the machine can, and the same in every run.

const TICK := 0.001


## Before the scene enters the tree. Returns its worlds, for advance().
static func hold(scene: Node) -> Array[HapticWorld]:
	var worlds: Array[HapticWorld] = []
	worlds.assign(scene.find_children("*", "HapticWorld", true, false))
	for world in worlds:
		world.clock = HapticWorld.CLOCK_STEPPED
	return worlds


## Worlds that are linked go on together, tick by tick.
static func advance(worlds: Array[HapticWorld], seconds: float) -> void:
	if worlds.size() == 1:
		worlds[0].advance(seconds)
		return
	for _tick in roundi(seconds / TICK):
		for world in worlds:
			world.advance(TICK)
