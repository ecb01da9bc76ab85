## Seven small games of the kinds that exist without Tactus. Each builds itself below a node, plays by its own
## scripts and writes down every signal and event with its frame.

const Parts := preload("nodes_case.gd")


class Game:
	extends Node3D
	## One line for each signal and event.
	var events := PackedStringArray()
	var frame := 0

	func _physics_process(_delta: float) -> void:
		frame += 1
		play()

	func note(what: String) -> void:
		events.append("%d %s" % [frame, what])

	func note_body(body: Node, what: String) -> void:
		note("%s %s" % [what, body.name])

	## Once a physics frame.
	func play() -> void:
		pass

	## Where a hand can be for the whole game without a contact, close to something.
	func hand() -> Vector3:
		return Vector3(0, 2, 0)

	func put(body: Node3D, label: String) -> Node3D:
		body.name = label
		add_child(body)
		return body

	func box(body: CollisionObject3D, size: Vector3, at: Vector3, label: String) -> Node3D:
		return put(Parts.with_shape(body, Parts.box(size), at), label)

	func ground(half := 50.0) -> void:
		box(StaticBody3D.new(), Vector3(2 * half, 1, 2 * half), Vector3(0, -0.5, 0), "Ground")

	## The transforms of all that moves, by name.
	func places() -> Dictionary:
		var found := {}
		for node in find_children("*", "CollisionObject3D", true, false):
			found[String(get_path_to(node))] = (node as Node3D).global_transform
		return found


class Walker:
	extends CharacterBody3D
	var way := Vector3(0.8, 0, 0)
	var jumps_every := 0
	var frames := 0

	func _physics_process(delta: float) -> void:
		frames += 1
		velocity = Vector3(way.x, velocity.y - 9.8 * delta, way.z)
		if jumps_every > 0 and frames % jumps_every == 0 and is_on_floor():
			velocity.y = 4.0
		move_and_slide()
		if is_on_wall() and get_wall_normal().is_normalized():
			way = way.bounce(get_wall_normal()) * Vector3(1, 0, 1)


class VehicleGame:
	extends Game
	var car := VehicleBody3D.new()

	func _init() -> void:
		ground(100.0)
		box(StaticBody3D.new(), Vector3(3, 0.1, 3), Vector3(0, 0.1, 12), "Ramp").rotation.x = -0.15
		for i in 6:
			box(
				RigidBody3D.new(),
				Vector3.ONE * 0.5,
				Vector3(0.1 * i - 0.2, 0.26 + 0.51 * i, 25),
				"Crate%d" % i
			)
		car.mass = 40
		for at: Vector2 in [Vector2(-0.4, 0.6), Vector2(0.4, 0.6), Vector2(-0.4, -0.6), Vector2(0.4, -0.6)]:
			var wheel := VehicleWheel3D.new()
			wheel.position = Vector3(at.x, -0.2, at.y)
			wheel.wheel_radius = 0.2
			wheel.use_as_traction = true
			wheel.use_as_steering = at.y > 0
			wheel.suspension_stiffness = 60.0
			wheel.damping_compression = 4.0
			wheel.damping_relaxation = 6.0
			car.add_child(wheel)
		box(car, Vector3(0.8, 0.3, 1.6), Vector3(0, 0.6, 0), "Car")

	func play() -> void:
		car.engine_force = 30.0 if frame < 400 else 0.0
		car.brake = 0.0 if frame < 450 else 2.0
		car.steering = 0.1 * sin(frame * 0.02)
		if frame % 60 == 0:
			note("%d wheels on the ground" % car.get_children().filter(_is_down).size())

	func _is_down(part: Node) -> bool:
		return part is VehicleWheel3D and part.is_in_contact()

	func hand() -> Vector3:
		return Vector3(1.0, 0.3, 0)


class GridGame:
	extends Game

	func _init() -> void:
		var grid := Parts.tiles(6)
		for x in range(-6, 6):
			for z in range(-6, 6):
				if absi(2 * x + 1) == 11 or absi(2 * z + 1) == 11 or (x % 4 == 1 and z % 3 == 1):
					grid.set_cell_item(Vector3i(x, 0, z), 0)
		put(grid, "Level")
		var walker := Walker.new()
		walker.way = Vector3(1.7, 0, 0.9)
		walker.jumps_every = 70
		box(walker, Vector3(0.4, 1, 0.4), Vector3(-3, 0.6, -3), "Walker")
		for i in 8:
			var ball := Parts.with_shape(
				RigidBody3D.new(), Parts.sphere(0.2), Vector3(0.3 * i - 1, 1 + i, 0.2)
			)
			(ball as RigidBody3D).linear_velocity = Vector3(0.4 * i, 0, 2 - i)
			put(ball, "Ball%d" % i)

	func play() -> void:
		var walker := get_node("Walker") as Walker
		if walker.is_on_wall():
			note("wall")
		if frame % 60 == 0:
			note("on the floor: %s" % walker.is_on_floor())
		if frame % 100 == 50:
			var grid := get_node("Level") as GridMap
			grid.set_cell_item(Vector3i(0, 0, 0), 0 if frame % 200 == 50 else GridMap.INVALID_CELL_ITEM)

	func hand() -> Vector3:
		return Vector3(4.5, 1.3, -5.5)


class RagdollGame:
	extends Game
	var skeleton := Skeleton3D.new()
	var simulator := PhysicalBoneSimulator3D.new()

	func _init() -> void:
		ground()
		box(StaticBody3D.new(), Vector3(0.3, 0.3, 3), Vector3(0.1, 0.15, 0), "Step")
		skeleton.position.y = 1.5
		for i in 5:
			skeleton.add_bone("Bone%d" % i)
			if i > 0:
				skeleton.set_bone_parent(i, i - 1)
			skeleton.set_bone_rest(i, Transform3D(Basis(), Vector3(0.25 if i > 0 else 0.0, 0, 0)))
			skeleton.reset_bone_pose(i)
		simulator.name = "Simulator"
		skeleton.add_child(simulator)
		for i in 5:
			var bone := PhysicalBone3D.new()
			bone.bone_name = "Bone%d" % i
			bone.joint_type = PhysicalBone3D.JOINT_TYPE_PIN if i > 0 else PhysicalBone3D.JOINT_TYPE_NONE
			bone.body_offset = Transform3D(Basis(), Vector3(0.125, 0, 0))
			bone.joint_offset = Transform3D(Basis(), Vector3(-0.125, 0, 0))
			simulator.add_child(Parts.with_shape(bone, Parts.box(Vector3(0.24, 0.1, 0.1))))
			bone.name = "Bone%d" % i
		put(skeleton, "Skeleton")

	func play() -> void:
		if frame == 60:
			simulator.physical_bones_start_simulation()
			note("falls")
		if frame == 90:
			(simulator.get_child(2) as PhysicalBone3D).apply_central_impulse(Vector3(0, 1, 2))
		if frame % 60 == 0:
			note("%s" % simulator.is_simulating_physics())

	func hand() -> Vector3:
		return Vector3(0.5, 1.7, 0.1)


## Areas that see, pull and slow, a belt, and a floor that a character falls past.
class PlatformGame:
	extends Game

	func _init() -> void:
		for i in 5:
			box(StaticBody3D.new(), Vector3(2, 0.2, 2), Vector3(3 * i, -0.3 * i, 0), "Ledge%d" % i)
		(get_node("Ledge3") as StaticBody3D).constant_linear_velocity = Vector3(0.7, 0, 0.2)
		var walker := Walker.new()
		walker.way = Vector3(1.4, 0, 0)
		walker.jumps_every = 75
		box(walker, Vector3(0.4, 1, 0.4), Vector3(0, 0.65, 0), "Walker")
		for i in 6:
			box(RigidBody3D.new(), Vector3.ONE * 0.3, Vector3(3 * i, 1 + 0.4 * i, 0.3), "Box%d" % i)
		for i in 4:
			var area := Area3D.new()
			area.body_entered.connect(note_body.bind("enters %d:" % i))
			area.body_exited.connect(note_body.bind("leaves %d:" % i))
			box(area, Vector3(2, 6, 2), Vector3(3 * i + 1.5, 0, 0), "Area%d" % i)
		var wind := get_node("Area2") as Area3D
		wind.gravity_space_override = Area3D.SPACE_OVERRIDE_COMBINE
		wind.gravity_direction = Vector3(0, 1, 0.3)
		wind.gravity = 4.0
		var water := get_node("Area1") as Area3D
		water.linear_damp_space_override = Area3D.SPACE_OVERRIDE_REPLACE
		water.linear_damp = 3.0
		var below := Area3D.new()
		below.body_entered.connect(_fallen)
		box(below, Vector3(60, 1, 60), Vector3(0, -8, 0), "Below")

	func _fallen(body: Node3D) -> void:
		note_body(body, "fell")
		if body is CharacterBody3D:
			body.position = Vector3(0, 1, 0)
			body.velocity = Vector3.ZERO

	func hand() -> Vector3:
		return Vector3(0, 0.2, 0.9)


class StackGame:
	extends Game

	func _init() -> void:
		ground()
		for x in 3:
			for y in 5:
				var block := RigidBody3D.new()
				block.sleeping_state_changed.connect(note.bind("sleep %d %d" % [x, y]))
				box(block, Vector3(0.5, 0.2, 0.4), Vector3(x, 0.1 + 0.2 * y, 0), "Block%d%d" % [x, y])
		var before := box(StaticBody3D.new(), Vector3.ONE * 0.1, Vector3(-2, 3, 0), "Hook") as PhysicsBody3D
		for i in 5:
			var at := Vector3(-2 + 0.3 * (i + 1), 3, 0)
			var link := box(RigidBody3D.new(), Vector3(0.25, 0.1, 0.1), at, "Link%d" % i) as PhysicsBody3D
			_join(PinJoint3D.new(), before, link, at - Vector3(0.15, 0, 0))
			before = link
		var door := box(RigidBody3D.new(), Vector3(1, 1, 0.1), Vector3(4, 0.8, 0), "Door") as RigidBody3D
		door.angular_velocity.y = 2.0
		var hinge := HingeJoint3D.new()
		hinge.rotation.x = PI / 2
		_join(hinge, get_node("Ground") as PhysicsBody3D, door, Vector3(3.5, 0.8, 0))
		var ball := (
			Parts.with_shape(RigidBody3D.new(), Parts.sphere(0.2), Vector3(-1.5, 0.2, 0)) as RigidBody3D
		)
		ball.mass = 5.0
		ball.linear_velocity.x = 4.0
		put(ball, "Ball")

	func _join(joint: Joint3D, first: PhysicsBody3D, second: PhysicsBody3D, at: Vector3) -> void:
		joint.position = at
		add_child(joint)
		joint.node_a = NodePath("../" + String(first.name))
		joint.node_b = NodePath("../" + String(second.name))

	func hand() -> Vector3:
		return Vector3(2, 1.12, 0)


class LiftGame:
	extends Game

	func _init() -> void:
		ground()
		for i in 4:
			var lift := AnimatableBody3D.new()
			lift.sync_to_physics = i % 2 == 0
			box(lift, Vector3(1.5, 0.2, 1.5), Vector3(2 * i, 0.5, 0), "Lift%d" % i)
			box(RigidBody3D.new(), Vector3.ONE * 0.3, Vector3(2 * i, 0.8, 0.2), "Box%d" % i)
			var rider := Walker.new()
			rider.way = Vector3.ZERO
			box(rider, Vector3(0.3, 0.8, 0.3), Vector3(2 * i - 0.4, 1.05, -0.3), "Rider%d" % i)
		var turning := box(AnimatableBody3D.new(), Vector3(3, 0.2, 0.3), Vector3(3, 0.2, 3), "Sweeper")
		(turning as AnimatableBody3D).sync_to_physics = false
		for i in 5:
			box(RigidBody3D.new(), Vector3.ONE * 0.3, Vector3(1.8 + 0.6 * i, 0.15, 3.8), "Swept%d" % i)

	func play() -> void:
		for i in 4:
			var lift := get_node("Lift%d" % i) as Node3D
			lift.position = Vector3(2 * i, 1 + 0.6 * sin(0.03 * frame + i), 0.4 * cos(0.02 * frame))
			if (get_node("Rider%d" % i) as Walker).is_on_floor() and frame % 50 == 0:
				note("%d rides" % i)
		(get_node("Sweeper") as Node3D).rotation.y = 0.02 * frame

	func hand() -> Vector3:
		return Vector3(0.3, 2.4, 0)


class Enemy:
	extends RigidBody3D
	var game: Game
	var calls := 0

	func _integrate_forces(state: PhysicsDirectBodyState3D) -> void:
		calls += 1
		var player := game.get_node("Player") as Node3D
		state.apply_central_force((player.global_position - global_position).limit_length(3.0))
		if calls % 120 == 0:
			apply_central_impulse(Vector3(0, 2, 0))


class CoinGame:
	extends Game

	func _init() -> void:
		ground()
		var player := Walker.new()
		player.way = Vector3(1.2, 0, 0.1)
		player.jumps_every = 90
		box(player, Vector3(0.4, 1, 0.4), Vector3(-4, 0.6, 0), "Player")
		for i in 7:
			var coin := Area3D.new()
			coin.body_entered.connect(_taken.bind(coin))
			put(Parts.with_shape(coin, Parts.sphere(0.3), Vector3(i - 3, 0.5, 0.1 * i)), "Coin%d" % i)
		for i in 5:
			var enemy := Enemy.new()
			enemy.game = self
			enemy.contact_monitor = true
			enemy.max_contacts_reported = 4
			enemy.body_entered.connect(_hit.bind(enemy))
			put(Parts.with_shape(enemy, Parts.sphere(0.25), Vector3(2 * i - 3, 0.3, 4 - i)), "Enemy%d" % i)

	func _taken(body: Node3D, coin: Area3D) -> void:
		note_body(body, "%s taken by" % coin.name)
		if body.name == "Player":
			coin.queue_free()

	func _hit(body: Node, enemy: Enemy) -> void:
		note("%s hits %s, %d calls" % [enemy.name, body.name, enemy.calls])
		if body.name == "Player":
			enemy.apply_impulse(Vector3(0, 3, -2), Vector3(0.1, 0, 0))

	func play() -> void:
		if frame == 300:
			get_node("Enemy4").queue_free()
		if frame == 350:
			var enemy := get_node("Enemy3") as Enemy
			enemy.global_position += Vector3(0, 2, 0)
			note("%d calls" % enemy.calls)

	func hand() -> Vector3:
		return Vector3(-6, 0.2, 6)


static func all() -> Dictionary:
	return {
		"vehicle": VehicleGame,
		"grid": GridGame,
		"ragdoll": RagdollGame,
		"platforms": PlatformGame,
		"stacks": StackGame,
		"lifts": LiftGame,
		"coins": CoinGame,
	}
