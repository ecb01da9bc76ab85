extends SceneTree
## How much a hand feels of it that Godot's own physics moves the bodies (HapticWorld.authority):
##
##     godot --headless --script played.gd -- OUTPUT.json [CASES]
##
## A hand pushes, stops, tips and pinches a box. The same scene with the authority *haptic* is what it is
## compared with, tick by tick: that world moves the box itself. The hand follows its path exactly, or is a
## simulated arm. Each case has another mass and other friction (half to twice as much), told to the physics
## server past the nodes. In every second case another body, which the world does not know, is welded to the
## box and makes it up to three times as heavy; the world that it is compared with has a box of that mass.
## Played at 30, 60 and 120 physics frames a second, in stepped time.
##
## Two engines differ without any hand, too: `engines_differ_m`. Godot's needs a frame to set a thrown box
## into motion, so that it arrives half a frame later: `same_arrival_...` compares with a box that begins as
## far back. A box that the engine lets sink into the floor loses height: `energy_without_fall_J` leaves out
## the work of its weight.
##
## Then in real time: the work of a tick beside that with *haptic*, and the main thread's time beside that
## without a world, for 300 bodies; without a hand, and with one that hovers over the middle of them.

const MOTIONS := ["push", "stop", "tip", "pinch"]
const RATES := [30, 60, 120]
const SECONDS := 4.0
const SPEEDUP := 16
const SIDE := 0.1
const GRAVITY := 9.8
const BODIES := 300
const ROUNDS := 3
const SECONDS_MEASURED := 3.0
const FRAMES_MEASURED := 200
# As core/teleop/stealth.hpp has them.
const WEBER := 0.07
const LEAST_NOTICEABLE_N := 0.02

var _result := {}
var _outside := Node3D.new()  # beside the world


## What one scene is made of. Factors of 1 leave Godot's body as its node says.
class Case:
	var motion := ""
	var is_arm := false
	var mass_factor := 1.0
	var friction_factor := 1.0
	var hidden := 0.0  # mass of what is welded to it, as a share of its own
	var has_hands := true
	var back := 0.0  # the thrown box begins so much farther away, in meters

	func mass() -> float:
		return 0.1 if motion == "pinch" else 0.5

	func friction() -> float:
		return 0.1 if motion == "stop" else 0.4

	## The energy that the box has at the beginning, in joules.
	func stored(speed: float) -> float:
		return 0.5 * whole_mass() * speed * speed

	## With what is welded to it.
	func whole_mass() -> float:
		return mass() * mass_factor * (1.0 + hidden)


## The result of a case: a row of `forces` for each tick, of all hands one after the other.
class Played:
	var forces: Array[PackedVector3Array] = []
	var energy_created := 0.0
	var energy_without_fall := 0.0
	var contacts := 0
	var place := Vector3.ZERO


func _initialize() -> void:
	_run.call_deferred(OS.get_cmdline_user_args())


func _run(arguments: PackedStringArray) -> void:
	var cases := int(arguments[1]) if arguments.size() > 1 else 20
	Engine.max_fps = 0
	_result["cases"] = cases
	await _compare(_cases(cases))
	await _compare_without_hands(_cases(cases))
	await _measure_ticks()
	await _measure_main_thread()
	# tools/bench.py looks whether all of it is there.
	var file := FileAccess.open(arguments[0], FileAccess.WRITE)
	if file != null:
		file.store_string(JSON.stringify(_result, "  ", false) + "\n")
		file.close()
	quit()


func _cases(count: int) -> Array[Case]:
	var chance := RandomNumberGenerator.new()
	chance.seed = 58
	var cases: Array[Case] = []
	for i in count:
		var mass_factor := exp(chance.randf_range(-log(2.0), log(2.0)))
		var friction_factor := exp(chance.randf_range(-log(2.0), log(2.0)))
		var hidden: float = chance.randf_range(0.5, 2.0) if i % 2 == 1 else 0.0
		for motion: String in MOTIONS:
			for is_arm: bool in [false, true]:
				var one := Case.new()
				one.hidden = hidden
				one.motion = motion
				one.is_arm = is_arm
				one.mass_factor = mass_factor
				one.friction_factor = friction_factor
				cases.append(one)
	return cases


func _hurry(frames_a_second: int, speedup: int) -> void:
	Engine.physics_ticks_per_second = frames_a_second * speedup
	Engine.time_scale = speedup
	Engine.max_physics_steps_per_frame = 8 * speedup


func _material(friction: float) -> HapticMaterial:
	var material := HapticMaterial.new()
	material.stiffness = 500.0
	material.damping = 5.0
	material.friction = friction
	material.static_friction = 1.0
	material.dynamic_friction = 0.8
	return material


func _with_box(body: CollisionObject3D, size: Vector3, at: Vector3) -> CollisionObject3D:
	var child := CollisionShape3D.new()
	var shape := BoxShape3D.new()
	shape.size = size
	child.shape = shape
	body.add_child(child)
	body.position = at
	return body


## A hand that is at these places at these times.
func _add_hand(
	world: HapticWorld, is_arm: bool, places: PackedVector3Array, times: PackedFloat64Array
) -> void:
	var device := HapticDevice.new()
	device.driver = HapticDevice.DRIVER_SIMULATED_ARM if is_arm else HapticDevice.DRIVER_PATH
	device.path = HapticPath.new()
	device.path.form = HapticPath.FORM_POINTS
	device.path.points_positions = places
	device.path.points_times = times
	device.path.points_interpolation = HapticPath.INTERPOLATION_LINEAR
	world.add_child(device)
	var proxy := ProxyPointer.new()
	world.add_child(proxy)
	proxy.device = proxy.get_path_to(device)


func _add_hands(world: HapticWorld, one: Case) -> void:
	var middle := SIDE / 2
	match one.motion:
		"push":
			var ways := [Vector3(-0.1, middle, 0), Vector3(0.1, middle, 0)]
			_add_hand(world, one.is_arm, PackedVector3Array(ways), [1.0, 3.0])
		"stop":
			_add_hand(world, one.is_arm, PackedVector3Array([Vector3(0, middle, 0)]), [0.0])
		"tip":  # the end of a plank that stands out, up and down again
			var below := Vector3(0.13, 0.06, 0)
			var above := below + Vector3(0, 0.055, 0)
			_add_hand(
				world, one.is_arm, PackedVector3Array([below, above, above, below]), [0.5, 1.5, 2.0, 3.0]
			)
		"pinch":  # from both sides, up, and down again
			for side: float in [-1.0, 1.0]:
				var away := Vector3(side * (middle + 0.03), middle, 0)
				var pressed := Vector3(side * (middle + 0.004), middle, 0)
				var up := pressed + Vector3(0, 0.05, 0)
				var ways := PackedVector3Array([away, pressed, up, up, pressed, away])
				_add_hand(world, one.is_arm, ways, [0.3, 0.8, 1.6, 2.2, 3.0, 3.5])


func _speed(one: Case) -> float:
	return 0.8 if one.motion == "stop" else 0.0


## Godot's own physics knows that it hangs on the box, the world does not.
func _weld(block: RigidBody3D, mass: float) -> void:
	var hidden := RigidBody3D.new()
	for child in block.get_children():
		hidden.add_child(child.duplicate())
	hidden.mass = mass
	hidden.can_sleep = false
	hidden.collision_layer = 0
	hidden.collision_mask = 0
	hidden.position = block.position
	var joint := Generic6DOFJoint3D.new()
	joint.position = block.position
	_outside.add_child(hidden)
	_outside.add_child(joint)
	joint.node_a = joint.get_path_to(block)
	joint.node_b = joint.get_path_to(hidden)


## The world with what the bodies really are. `is_known`: their nodes say so as well.
func _build(world: HapticWorld, one: Case, is_known: bool) -> RigidBody3D:
	var friction := one.friction() * one.friction_factor
	var material := _material(friction if is_known else one.friction())
	var fixed: Array[CollisionObject3D] = [
		_with_box(StaticBody3D.new(), Vector3(4, 0.2, 4), Vector3(0, -0.1, 0))
	]
	var block := RigidBody3D.new()
	if one.motion == "tip":
		fixed.append(_with_box(StaticBody3D.new(), Vector3(0.2, 0.09, 0.2), Vector3(0, 0.045, 0)))
		_with_box(block, Vector3(0.24, 0.02, 0.06), Vector3(0.04, 0.1, 0))
	else:
		var x := -0.2 - one.back if one.motion == "stop" else 0.0
		_with_box(block, Vector3.ONE * SIDE, Vector3(x, SIDE / 2, 0))
	block.mass = one.whole_mass() if is_known else one.mass()
	block.can_sleep = false
	for body: CollisionObject3D in fixed + [block as CollisionObject3D]:
		body.physics_material_override = material
		world.add_child(body)
		if not is_known:
			PhysicsServer3D.body_set_param(body.get_rid(), PhysicsServer3D.BODY_PARAM_FRICTION, friction)
	if not is_known:
		var mass := one.mass() * one.mass_factor
		PhysicsServer3D.body_set_param(block.get_rid(), PhysicsServer3D.BODY_PARAM_MASS, mass)
		if one.hidden > 0.0:
			_weld(block, mass * one.hidden)
	return block


func _play(one: Case, authority: HapticWorld.Authority, rate: int) -> Played:
	_hurry(rate, SPEEDUP)
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	world.gravity = Vector3(0, -GRAVITY, 0)
	world.authority = authority
	await process_frame  # Godot goes on at the rate before until its next frame
	await physics_frame
	root.add_child(_outside)
	root.add_child(world)
	var block := _build(world, one, authority == HapticWorld.AUTHORITY_HAPTIC)
	if one.has_hands:
		_add_hands(world, one)
	var devices := world.find_children("*", "HapticDevice", true, false)
	var played := Played.new()
	var given := 0.0
	var without_fall := 0.0
	var was_touched := false
	var height := block.position.y
	var frames := int(SECONDS * rate)
	for frame in frames:
		await physics_frame
		if frame == 0:  # both begin with the first tick
			_throw(block, _speed(one))
		for _tick in (frame + 1) * 1000 / rate - frame * 1000 / rate:
			world.advance(0.001)
			var forces := PackedVector3Array()
			var energy := 0.0
			var is_touched := false
			for device: HapticDevice in devices:
				forces.append(device.get_displayed_force())
				energy += device.get_energy()
				is_touched = is_touched or not device.get_displayed_force().is_zero_approx()
			played.contacts += int(is_touched and not was_touched)
			was_touched = is_touched
			var more := energy - one.stored(_speed(one))
			var fall := maxf(0.0, height - block.global_position.y)
			given = maxf(given, more)
			without_fall = maxf(without_fall, more - one.whole_mass() * GRAVITY * fall)
			played.forces.append(forces)
	played.energy_created = given
	played.energy_without_fall = without_fall
	played.place = block.global_position
	world.free()
	_outside.free()
	_outside = Node3D.new()
	return played


## With what is welded to it.
func _throw(block: RigidBody3D, speed: float) -> void:
	for body: RigidBody3D in [block] + _outside.find_children("*", "RigidBody3D", false, false):
		body.linear_velocity.x = speed


func _compare(cases: Array[Case]) -> void:
	var references: Array[Played] = []
	for one in cases:
		references.append(await _play(one, HapticWorld.AUTHORITY_HAPTIC, 60))
	var worst := {
		"force_error_mean_N": 0.0,
		"felt_excess_100ms_jnd_p99": 0.0,
		"place_error_max_m": 0.0,
		"energy_created_J": 0.0,
		"energy_without_fall_J": 0.0,
	}
	for rate: int in RATES:
		for motion: String in MOTIONS:
			for is_arm: bool in [false, true]:
				var figures := Figures.new()
				var same_arrival := Figures.new()
				for i in cases.size():
					var one := cases[i]
					if one.motion == motion and one.is_arm == is_arm:
						var played := await _play(one, HapticWorld.AUTHORITY_GODOT, rate)
						figures.add(played, references[i])
						if motion == "stop":
							same_arrival.add(played, await _play_later(one, rate))
				var name := "%s.%s.%dHz" % [motion, "arm" if is_arm else "hand", rate]
				var told := figures.told()
				if motion == "stop":
					var then := same_arrival.told()
					for key: String in ["force_error_mean_N", "place_error_median_m", "place_error_max_m"]:
						told["same_arrival_" + key] = then[key]
				for key: String in told:
					_result[name + "." + key] = told[key]
				for key: String in worst:
					worst[key] = maxf(worst[key], told[key])
				print("%s: %s" % [name, told])
	_result.merge(worst)


## Beside the world that moves the box itself, where it begins half a frame of `rate` farther back.
func _play_later(one: Case, rate: int) -> Played:
	one.back = _speed(one) * 0.5 * (1.0 / rate - 0.001)
	var played := await _play(one, HapticWorld.AUTHORITY_HAPTIC, 60)
	one.back = 0.0
	return played


## How far apart the two physics end without a hand.
func _compare_without_hands(cases: Array[Case]) -> void:
	for motion: String in MOTIONS:
		var alike := cases.filter(func(one: Case) -> bool: return one.motion == motion and not one.is_arm)
		var farthest := {}
		for one: Case in alike:
			one.has_hands = false
			var there := await _play(one, HapticWorld.AUTHORITY_HAPTIC, 60)
			for rate: int in RATES:
				var here := await _play(one, HapticWorld.AUTHORITY_GODOT, rate)
				farthest[rate] = maxf(farthest.get(rate, 0.0), here.place.distance_to(there.place))
		for rate: int in RATES:
			_result["%s.%dHz.engines_differ_m" % [motion, rate]] = farthest[rate]


## What a hand feels beside what it would feel in the other world, over several runs.
class Figures:
	var errors := PackedFloat64Array()
	var excesses := PackedFloat64Array()
	var places := PackedFloat64Array()
	var energies := PackedFloat64Array()
	var energies_there := PackedFloat64Array()
	var energies_without_fall := PackedFloat64Array()
	var ticks := 0

	func add(here: Played, there: Played) -> void:
		for tick in here.forces.size():
			for hand in here.forces[tick].size():
				ticks += 1
				var felt := here.forces[tick][hand]
				var direct := there.forces[tick][hand]
				if not (felt.is_zero_approx() and direct.is_zero_approx()):
					errors.append(felt.distance_to(direct))
				if tick >= 100:
					var expected := here.forces[tick - 100][hand] + direct - there.forces[tick - 100][hand]
					var excess := felt.distance_to(expected)
					excesses.append(excess / maxf(WEBER * expected.length(), LEAST_NOTICEABLE_N))
		places.append(here.place.distance_to(there.place))
		energies.append(here.energy_created / maxi(here.contacts, 1))
		energies_without_fall.append(here.energy_without_fall / maxi(here.contacts, 1))
		energies_there.append(there.energy_created / maxi(there.contacts, 1))

	func told() -> Dictionary:
		for list: PackedFloat64Array in [
			errors, excesses, places, energies, energies_there, energies_without_fall
		]:
			list.sort()
		return {
			"contact_share": float(errors.size()) / maxi(ticks, 1),
			"force_error_mean_N": mean(errors),
			"force_error_p95_N": share(errors, 0.95),
			"force_error_p99_N": share(errors, 0.99),
			"force_error_max_N": share(errors, 1.0),
			"felt_excess_100ms_jnd_p99": share(excesses, 0.99),
			"felt_excess_100ms_jnd_max": share(excesses, 1.0),
			"place_error_median_m": share(places, 0.5),
			"place_error_max_m": share(places, 1.0),
			"energy_created_J": share(energies, 1.0),
			"energy_without_fall_J": share(energies_without_fall, 1.0),
			"haptic_energy_created_J": share(energies_there, 1.0),
		}

	static func mean(sorted: PackedFloat64Array) -> float:
		var sum := 0.0
		for value in sorted:
			sum += value
		return sum / maxi(sorted.size(), 1)

	static func share(sorted: PackedFloat64Array, at: float) -> float:
		return sorted[int(at * (sorted.size() - 1))] if sorted.size() > 0 else 0.0


## Bodies that all move for as long as they are looked at: each hangs in free air and turns.
func _fill(top: Node3D) -> void:
	for i in BODIES:
		var at := Vector3(i % 20, 1, i / 20) * 0.3
		var body := _with_box(RigidBody3D.new(), Vector3.ONE * SIDE, at) as RigidBody3D
		body.gravity_scale = 0.0
		body.can_sleep = false
		body.angular_velocity = Vector3(0, 1, 0)
		body.angular_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
		top.add_child(body)


## A world in real time in which a hand pushes a box for as long as it is looked at.
func _pushing(authority: HapticWorld.Authority) -> HapticWorld:
	var world := HapticWorld.new()
	world.authority = authority
	root.add_child(world)
	var one := Case.new()
	one.motion = "push"
	_build(world, one, true)
	var places := PackedVector3Array([Vector3(-0.1, SIDE / 2, 0), Vector3(0.3, SIDE / 2, 0)])
	_add_hand(world, false, places, PackedFloat64Array([0.5, SECONDS_MEASURED + 1.5]))
	return world


func _measure_ticks() -> void:
	_hurry(60, 1)
	Engine.max_fps = 60
	var shares := {"p50": [] as Array[float], "p99": [] as Array[float]}
	for _round in ROUNDS:
		var figures: Array[Dictionary] = []
		for authority: HapticWorld.Authority in [HapticWorld.AUTHORITY_HAPTIC, HapticWorld.AUTHORITY_GODOT]:
			var world := _pushing(authority)
			await create_timer(1.0).timeout
			world.reset_statistics()
			await create_timer(SECONDS_MEASURED).timeout
			figures.append(world.get_statistics())
			world.free()
		for part: String in shares:
			var key := "tick_compute_%s_us" % part
			shares[part].append(figures[1][key] / figures[0][key])
	for part: String in shares:
		_result["tick_%s_over_haptic" % part] = _median(shares[part])


## So long the kernel has had the main thread on a processor, in milliseconds.
func _main_thread_ms() -> float:
	var id := OS.get_process_id()
	var file := FileAccess.open("/proc/%d/task/%d/schedstat" % [id, id], FileAccess.READ)
	return float(file.get_line().get_slice(" ", 0)) * 1e-6


func _median(values: Array[float]) -> float:
	values.sort()
	return values[values.size() / 2]


func _measure_main_thread() -> void:
	var costs := {"hand": [] as Array[float], "world": [] as Array[float], "nothing": [] as Array[float]}
	for _round in ROUNDS:
		for what: String in costs:
			var top := HapticWorld.new() if what != "nothing" else Node3D.new()
			if what != "nothing":
				top.authority = HapticWorld.AUTHORITY_GODOT
			root.add_child(top)
			_fill(top)
			if what == "hand":
				_add_hand(top, false, PackedVector3Array([Vector3(2.85, 1.2, 2.25)]), [0.0])
			for _frame in 60:
				await process_frame
			var begin := _main_thread_ms()
			for _frame in FRAMES_MEASURED:
				await process_frame
			costs[what].append((_main_thread_ms() - begin) / FRAMES_MEASURED)
			top.free()
	var without: float = _median(costs.nothing)
	_result["main_thread_ms"] = _median(costs.world)
	_result["main_thread_with_hand_ms"] = _median(costs.hand)
	_result["main_thread_without_world_ms"] = without
	_result["main_thread_over_without_world"] = _result.main_thread_ms / without
	_result["main_thread_with_hand_over_without_world"] = _result.main_thread_with_hand_ms / without
