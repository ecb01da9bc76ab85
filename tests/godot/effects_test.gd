extends "nodes_case.gd"
## What a HapticMaterial adds to the contact, felt through a world in stepped time.

const PRESS := 0.01  ## of the hand below where the proxy rests (unit: metres)


## A floor of the material and a hand that is pressed into it at `from`, then goes to `to` within a second.
func _stroke(look: HapticMaterial, from: Vector3, to: Vector3) -> ProxyPointer:
	var world := add_world()
	add_floor(world).physics_material_override = look
	var way := path(from, to)
	way.points_positions = PackedVector3Array([from + Vector3(0, 0.05, 0), from, from, to])
	way.points_times = PackedFloat64Array([0.0, 0.2, 0.4, 1.4])
	var proxy := add_hand(world, way)
	world.advance(0.4)
	return proxy


func _world_of(proxy: ProxyPointer) -> HapticWorld:
	return proxy.get_parent()


func _at_rest(look: HapticMaterial, at := Vector3.ZERO) -> Vector3:
	return _stroke(look, at, at).get_force()


func test_viscosity_drags_a_moving_hand() -> void:
	var look := material(500.0)
	look.viscosity = 5.0
	var proxy := _stroke(look, Vector3.ZERO, Vector3(0.1, 0, 0))
	_world_of(proxy).advance(0.5)
	check_near(proxy.get_force(), Vector3(-5.0 * 0.1, 5.0, 0), 1e-3, "force")


func test_a_surface_that_stiffens_pushes_harder_the_deeper_it_is_pressed() -> void:
	var look := material(500.0)
	look.stiffening = 3.0
	look.stiffening_depth = PRESS
	check_near(_at_rest(look), Vector3(0, 10.0, 0), 1e-3, "force where it is three times as stiff")
	check_near(_at_rest(look, Vector3(0, -0.01, 0)), Vector3(0, 25.0, 0), 1e-3, "beyond")


func test_friction_falls_with_the_speed() -> void:
	var look := material(500.0)
	look.static_friction = 0.5
	look.dynamic_friction = 0.1
	look.stribeck_speed = 0.1
	var proxy := _stroke(look, Vector3.ZERO, Vector3(0.1, 0, 0))
	_world_of(proxy).advance(0.9)
	check_near(proxy.get_force().x, -5.0 * (0.1 + 0.4 * exp(-1.0)), 0.02, "friction at that speed")


func test_vibration_shakes_with_its_force_and_frequency() -> void:
	var look := material(500.0)
	look.vibration_force = 0.5
	look.vibration_frequency = 50.0
	var proxy := _stroke(look, Vector3.ZERO, Vector3.ZERO)
	var forces := []
	for _i in 40:
		_world_of(proxy).advance(TICK)
		forces.append(proxy.get_force().y)
	check_near(forces.max(), 5.5, 1e-3, "the largest force")
	check_near(forces.min(), 4.5, 1e-3, "the least force")
	check_near(forces[25], forces[5], 1e-3, "force a period later")


func test_a_surface_that_is_met_rings() -> void:
	var look := material(500.0)
	look.impact_strength = 10.0
	look.impact_frequency = 50.0
	look.impact_decay = 0.1
	var world := add_world()
	var ground := add_floor(world)
	ground.physics_material_override = look
	# 0.2 m/s into the floor, and still from 10 mm below its surface on.
	var proxy := add_hand(world, path(Vector3(0, 0.02, 0), Vector3(0, 0.0, 0), 0.1))
	world.advance(0.1)
	var above := 0
	var loudest := 0.0
	for _i in 100:
		world.advance(TICK)
		var ringing := proxy.get_force().y - 5.0
		loudest = maxf(loudest, ringing)
		above += 1 if ringing > 0.01 else 0
	check(loudest > 1.0 and loudest < 2.0, "the loudest is %s" % loudest)
	check(above > 30 and above < 70, "above rest for %d ms" % above)
	world.advance(1.0)
	check_near(proxy.get_force(), Vector3(0, 5.0, 0), 1e-3, "at rest")


func test_stick_slip_holds_and_lets_go_again_and_again() -> void:
	var look := material(500.0)
	look.stick_slip_stiffness = 100.0
	look.stick_slip_force = 0.5
	var proxy := _stroke(look, Vector3.ZERO, Vector3(0.1, 0, 0))
	var slips := 0
	var before := 0.0
	var strongest := 0.0
	for _i in 900:
		_world_of(proxy).advance(TICK)
		var held := -proxy.get_force().x
		slips += 1 if held < before - 0.2 else 0
		before = held
		strongest = maxf(strongest, held)
	check_near(strongest, 0.5, 0.02, "the strongest hold")
	check_equal(slips, 17, "slips in 90 mm, each 5 mm and a tick's way")


func test_a_magnet_pulls_before_it_is_touched() -> void:
	var look := material(500.0)
	look.magnet_force = 2.0
	look.magnet_range = 0.02
	var away := _at_rest(look, Vector3(0, 0.02, 0))
	check_near(away, Vector3(0, -1.0, 0), 1e-3, "force at half the range")
	check_near(_at_rest(look, Vector3(0, 0.035, 0)), Vector3.ZERO, 1e-6, "force beyond the range")


func test_a_surface_pressed_harder_than_it_bears_lets_the_finger_through() -> void:
	var look := material(500.0)
	look.pop_through_force = 4.0
	check_near(_at_rest(look, Vector3(0, 0.003, 0)).y, 3.5, 1e-3, "force before it breaks")
	check_near(_at_rest(look, Vector3(0, -0.05, 0)), Vector3.ZERO, 1e-6, "force after it broke")


func test_a_texture_raises_the_surface_by_its_height() -> void:
	var look := material(500.0)
	look.texture_image = image_of(4, 4, func(_x: int, _y: int) -> float: return 1.0)
	look.texture_depth = 0.002
	check_near(_at_rest(look), Vector3(0, 5.0 + 500.0 * 0.002, 0), 1e-3, "force on the raised surface")
	look.texture_depth = 0.0
	check_near(_at_rest(look), Vector3(0, 5.0, 0), 1e-3, "force without a depth")


func test_a_texture_pushes_downhill() -> void:
	var look := material(500.0)
	look.texture_image = image_of(2, 2, func(x: int, _y: int) -> float: return float(x))
	look.texture_size = 0.2
	look.texture_depth = 0.002
	var along_x := _at_rest(look, Vector3(0.05, 0, 0.05))
	var along_z := _at_rest(look, Vector3(0.05, 0, 0.15))
	# Between two pixels 0.1 m apart: a slope of 0.02 under a hand pressed in by 10 mm and half the depth.
	var push := 500.0 * (PRESS + 0.001) * 0.02
	check_near(Vector2(along_x.x, along_x.z).length(), push, 1e-3, "push along the surface")
	check_near(along_z.y, along_x.y, 1e-3, "the same height")


func test_a_texture_that_changes_while_running_is_felt() -> void:
	var look := material(500.0)
	look.texture_depth = 0.002
	look.texture_image = image_of(4, 4, func(_x: int, _y: int) -> float: return 0.0)
	var proxy := _stroke(look, Vector3.ZERO, Vector3.ZERO)
	check_near(proxy.get_force().y, 5.0, 1e-3, "force before")
	look.texture_image = image_of(4, 4, func(_x: int, _y: int) -> float: return 1.0)
	_world_of(proxy).advance(0.01)
	check_near(proxy.get_force().y, 6.0, 1e-3, "force after")


func test_a_depth_without_an_image_is_grain() -> void:
	var look := material(500.0)
	look.texture_depth = 0.001
	look.texture_size = 0.064
	var proxy := _stroke(look, Vector3.ZERO, Vector3(0.1, 0, 0))
	var forces := []
	for _i in 500:
		_world_of(proxy).advance(TICK)
		forces.append(proxy.get_force().y)
	check(
		forces.max() - forces.min() > 0.3, "the surface is smooth: %s to %s N" % [forces.min(), forces.max()]
	)
	check(forces.min() >= 5.0 - 1e-3 and forces.max() <= 5.5 + 1e-3, "beyond its depth")


func test_an_effect_switched_off_while_running_is_gone() -> void:
	var look := material(500.0)
	look.viscosity = 5.0
	var proxy := _stroke(look, Vector3.ZERO, Vector3(0.1, 0, 0))
	look.viscosity = 0.0
	_world_of(proxy).advance(0.5)
	check_near(proxy.get_force(), Vector3(0, 5.0, 0), 1e-3, "force")


func test_the_default_material_brings_its_effects_and_texture() -> void:
	var world := add_world()
	var look := material(500.0)
	look.texture_image = image_of(4, 4, func(_x: int, _y: int) -> float: return 1.0)
	look.texture_depth = 0.002
	world.default_material = look
	add_floor(world).physics_material_override = null
	var proxy := add_hand(world, path(Vector3(0, 0.05, 0), Vector3.ZERO, 0.1))
	world.advance(0.3)
	check_near(proxy.get_force().y, 6.0, 1e-3, "force")


func test_presets_fill_the_values_and_are_recognised() -> void:
	var look := HapticMaterial.new()
	check_equal(look.preset, HapticMaterial.PRESET_CUSTOM, "preset of a new material")
	for preset: int in range(HapticMaterial.PRESET_RUBBER, HapticMaterial.PRESET_FOAM + 1):
		look.preset = preset
		check_equal(look.preset, preset, "preset")
	look.preset = HapticMaterial.PRESET_STEEL
	check_equal(look.stiffness, 3000.0, "stiffness of steel")
	look.stiffness = 2900.0
	check_equal(look.preset, HapticMaterial.PRESET_STEEL, "preset after a change")
	var stored := HapticMaterial.new()
	stored.stiffness = 2900.0
	check_equal(stored.preset, HapticMaterial.PRESET_CUSTOM, "preset of values that are no preset's")


func test_presets_feel_as_stiff_and_as_slippery_as_they_are_called() -> void:
	var normal := {}
	var along := {}
	for preset: int in range(HapticMaterial.PRESET_RUBBER, HapticMaterial.PRESET_FOAM + 1):
		var look := HapticMaterial.new()
		look.preset = preset
		var proxy := _stroke(look, Vector3(0, 0.008, 0), Vector3(0.05, 0.008, 0))
		var drag := 0.0
		for _i in 500:
			_world_of(proxy).advance(TICK)
			drag -= proxy.get_force().x / 500.0
		normal[preset] = proxy.get_force().y
		along[preset] = drag / normal[preset]
	check(normal[HapticMaterial.PRESET_STEEL] > 10.0 * normal[HapticMaterial.PRESET_SPONGE], str(normal))
	check(normal[HapticMaterial.PRESET_FOAM] < normal[HapticMaterial.PRESET_SKIN], str(normal))
	check(normal[HapticMaterial.PRESET_SKIN] < normal[HapticMaterial.PRESET_WOOD], str(normal))
	check(along[HapticMaterial.PRESET_GLASS] < along[HapticMaterial.PRESET_WOOD], str(along))
	check(along[HapticMaterial.PRESET_ICE] < 0.05, "friction of ice: %s" % along[HapticMaterial.PRESET_ICE])
	check(along[HapticMaterial.PRESET_RUBBER] > 0.5, "rubber: %s" % along[HapticMaterial.PRESET_RUBBER])


func test_the_materials_of_the_demo_are_the_presets() -> void:
	var names := {
		"rubber": HapticMaterial.PRESET_RUBBER,
		"ice": HapticMaterial.PRESET_ICE,
		"sandpaper": HapticMaterial.PRESET_SANDPAPER,
		"steel": HapticMaterial.PRESET_STEEL,
		"sponge": HapticMaterial.PRESET_SPONGE,
	}
	for name: String in names:
		var look: HapticMaterial = load("res://materials/%s.tres" % name)
		check_equal(look.preset, names[name], name)


func test_several_hands_touch_at_once_each_with_its_own_device() -> void:
	var world := add_world()
	add_floor(world, 500.0)
	var proxies: Array[ProxyPointer] = []
	for i in 4:
		var device := HapticDevice.new()
		device.name = "Device%d" % i
		var depth := 0.001 * (i + 1)
		device.path = path(Vector3(0.1 * i, 0.05, 0), Vector3(0.1 * i, 0.01 - depth, 0), 0.1)
		world.add_child(device)
		var proxy := ProxyPointer.new()
		proxy.radius = 0.01
		proxy.device = NodePath("../Device%d" % i)
		world.add_child(proxy)
		proxies.append(proxy)
	world.advance(0.3)
	for i in 4:
		check_near(proxies[i].get_force(), Vector3(0, 0.5 * (i + 1), 0), 1e-3, "force of hand %d" % i)
		check_near(world.get_node("Device%d" % i).get_force().y, 0.5 * (i + 1), 1e-3, "its device")


func test_two_hands_hold_a_box_between_them() -> void:
	var world := add_world()
	world.gravity = Vector3(0, -9.81, 0)
	var cube := with_shape(RigidBody3D.new(), box(Vector3(0.05, 0.05, 0.05))) as RigidBody3D
	cube.mass = 0.05
	var grip := material(500.0)
	grip.static_friction = 1.0
	grip.dynamic_friction = 0.8
	cube.physics_material_override = grip
	world.add_child(cube)
	for side: float in [-1.0, 1.0]:
		var device := HapticDevice.new()
		device.name = "Left" if side < 0.0 else "Right"
		device.path = path(Vector3(0.04 * side, 0, 0), Vector3(0.031 * side, 0, 0), 0.01)
		world.add_child(device)
		var proxy := ProxyPointer.new()
		proxy.device = NodePath("../" + device.name)
		world.add_child(proxy)
	world.advance(1.0)
	check_near(cube.position, Vector3.ZERO, 0.01, "the held box")


func test_a_smoothed_mesh_turns_the_force_smoothly() -> void:
	var around := PackedVector3Array([Vector3(0.06, 0, 0)])
	var times := PackedFloat64Array([0.0])
	for i in 200:
		around.append(Vector3(0.048, 0, 0).rotated(Vector3.UP, PI * i / 200))
		times.append(0.05 + 0.005 * i)
	var turns := []
	for angle: float in [0.0, deg_to_rad(60.0)]:
		var world := add_world()
		var body := StaticBody3D.new()
		body.physics_material_override = material(500.0)
		var mesh := HapticMesh.new()
		mesh.library_mesh = "cylinder"
		mesh.smoothing_angle = angle
		body.add_child(mesh)
		world.add_child(body)
		var way := path(Vector3.ZERO, Vector3.ZERO)
		way.points_positions = around
		way.points_times = times
		var proxy := add_hand(world, way)
		world.advance(0.1)
		var before := proxy.get_force().normalized()
		var largest := 0.0
		for _i in 900:
			world.advance(TICK)
			var now := proxy.get_force().normalized()
			largest = maxf(largest, rad_to_deg(before.angle_to(now)))
			before = now
		turns.append(largest)
	check(turns[1] < 0.5 * turns[0], "largest turns in a tick: %s°" % [turns])
