extends "nodes_case.gd"
## docs/godot_physics.md: complete against the ClassDB of this Godot, and what it calls said is said.

const ROOTS := [
	"CollisionObject3D",
	"CollisionShape3D",
	"CollisionPolygon3D",
	"Shape3D",
	"Joint3D",
	"GridMap",
	"SoftBody3D",
	"VehicleWheel3D"
]
const HEADINGS := PROPERTY_USAGE_GROUP | PROPERTY_USAGE_CATEGORY | PROPERTY_USAGE_SUBGROUP


## What the table is about.
func add_world() -> HapticWorld:
	var world := super()
	world.authority = HapticWorld.AUTHORITY_HAPTIC
	return world


func _rows() -> Array[Dictionary]:
	var folder: String = (get_script() as Script).resource_path.get_base_dir()
	var rows: Array[Dictionary] = []
	for line in FileAccess.get_file_as_string(folder.path_join("../../docs/godot_physics.md")).split("\n"):
		if line.begins_with("| `"):
			var cells := line.split("|")
			var members := PackedStringArray()
			for member in cells[2].split(","):
				members.append(member.strip_edges().trim_prefix("`").trim_suffix("`"))
			rows.append(
				{
					"type": cells[1].strip_edges().trim_prefix("`").trim_suffix("`"),
					"members": members,
					"here": cells[3].strip_edges(),
					"what": cells[4].strip_edges()
				}
			)
	return rows


func _classes() -> PackedStringArray:
	var found := PackedStringArray()
	for type in ClassDB.get_class_list():
		var is_physics := func(root: String) -> bool: return ClassDB.is_parent_class(type, root)
		if ROOTS.any(is_physics) and ClassDB.class_get_api_type(type) == ClassDB.API_CORE:
			found.append(type)
	return found


## Its own properties and signals, and those methods that are no property's.
func _members(type: String) -> PackedStringArray:
	var found := PackedStringArray()
	var of_properties := {}
	for property in ClassDB.class_get_property_list(type, true):
		if property.usage & HEADINGS:
			continue
		found.append(property.name)
		of_properties[String(ClassDB.class_get_property_getter(type, property.name))] = true
		of_properties[String(ClassDB.class_get_property_setter(type, property.name))] = true
	for described in ClassDB.class_get_signal_list(type, true):
		found.append(described.name)
	for method in ClassDB.class_get_method_list(type, true):
		if not of_properties.has(String(method.name)):
			found.append(method.name)
	return found


func test_the_table_has_every_member_once_and_no_other() -> void:
	var rows := _rows()
	var classes := _classes()
	check(rows.size() > 40 and classes.size() > 25, "%d rows, %d classes" % [rows.size(), classes.size()])
	var used := {}
	for type in classes:
		for member in _members(type):
			var exact := 0
			var by_star := 0
			for i in rows.size():
				for pattern: String in rows[i].members if rows[i].type == type else PackedStringArray():
					if member.match(pattern):
						exact += 1 if pattern == member else 0
						by_star += 1 if pattern != member else 0
						used["%d %s" % [i, pattern]] = true
			check(
				exact == 1 or (exact == 0 and by_star == 1),
				"%s.%s stands %d times" % [type, member, exact + by_star]
			)
	for i in rows.size():
		check(rows[i].here in ["works", "said", "n/a"], "%s: '%s'" % [rows[i].type, rows[i].here])
		for pattern: String in rows[i].members:
			check(used.has("%d %s" % [i, pattern]), "%s has no %s" % [rows[i].type, pattern])


func _used(node: Node, member: String) -> bool:
	if node.has_signal(member):
		var listener := func(_a = null, _b = null, _c = null, _d = null) -> void: pass
		node.connect(member, listener)
		return true
	for property in node.get_property_list():
		if property.name != member:
			continue
		match property.type:
			TYPE_BOOL:
				node.set(member, true)
			TYPE_VECTOR3:
				node.set(member, Vector3.ONE)
			TYPE_INT, TYPE_FLOAT:
				node.set(member, 2)
			_:
				return false
		return true
	return false


## At least by one of its members.
func _is_said(row: Dictionary) -> bool:
	for member: String in row.members:
		var is_abstract := not ClassDB.can_instantiate(row.type)
		var node: Node = ClassDB.instantiate("StaticBody3D" if is_abstract else row.type)
		var is_whole: bool = row.what.begins_with("for the node") or row.what.begins_with("for the joint")
		if member.contains("*") and not is_whole:
			member = member.replace("*", "x/enabled")
		if not is_whole and not _used(node, member):
			node.free()
			continue
		node.name = "Used"
		if node is CollisionObject3D and not node is Area3D:
			with_shape(node, sphere(0.1))
		var world := add_world()
		add_floor(world)
		world.add_child(node)
		world.advance(TICK)
		var problems := "\n".join(world.get_problems())
		var warnings := "\n".join(world._list_warnings())
		world.free()
		if problems.contains("Used") and warnings.contains("'Used'"):
			return true
	return false


func test_what_the_table_calls_said_is_said() -> void:
	var seen := 0
	for row in _rows():
		var by_test: bool = row.type in ["SeparationRayShape3D"] or row.what.contains("script calls")
		by_test = by_test or row.members.has("get_collision_exceptions") or row.members.has("sleeping")
		if row.here == "said" and not by_test:
			seen += 1
			check(_is_said(row), "%s: %s are not said" % [row.type, row.members])
	check(seen > 12, "only %d rows" % seen)


func _problems_of(body: Node) -> String:
	var world := add_world()
	add_floor(world)
	world.add_child(body)
	world.advance(TICK)
	var problems := "\n".join(world.get_problems())
	world.free()
	return problems


## Godot says of each body that the world holds that it sleeps.
func test_a_body_that_comes_asleep_is_said_as_it_comes() -> void:
	var world := add_world()
	add_floor(world)
	world.advance(TICK)
	var body := with_shape(RigidBody3D.new(), sphere(0.1)) as RigidBody3D
	body.sleeping = true
	expect_error("'sleeping' is not carried out")
	world.add_child(body)
	await get_tree().physics_frame
	world.advance(TICK)
	check_equal(world.get_problems(), PackedStringArray(), "problems")


func test_exceptions_rays_and_pushes_of_scripts_are_said() -> void:
	var other := with_shape(StaticBody3D.new(), sphere(0.1), Vector3(2, 0, 0)) as StaticBody3D
	add_child(other)
	var body := with_shape(RigidBody3D.new(), sphere(0.1)) as RigidBody3D
	body.add_collision_exception_with(other)
	check(_problems_of(body).contains("collision exceptions"), "exceptions are not said")
	var standing := with_shape(StaticBody3D.new(), SeparationRayShape3D.new())
	check(_problems_of(standing).contains("SeparationRayShape3D"), "a ray is not said")
	var calls := {
		"apply_impulse(Vector3.UP)": true,
		"self.apply_central_force(Vector3.UP)": true,
		"set_axis_velocity(Vector3.UP)": true,
		"get_parent().apply_impulse(self, Vector3.UP)": false,
		"my_apply_impulse(1)": false,
	}
	for source: String in calls:
		var script := GDScript.new()
		script.source_code = (
			"extends RigidBody3D\nfunc my_apply_impulse(_x):\n\tpass\nfunc jump():\n\t%s\n" % source
		)
		script.reload()
		var pushed := with_shape(RigidBody3D.new(), sphere(0.1))
		pushed.set_script(script)
		check_equal(_problems_of(pushed).contains("of its own"), calls[source], "said of " + source)


func test_nothing_is_said_of_areas_that_only_mark_a_place() -> void:
	var world := add_world()
	add_floor(world)
	for i in 44:
		var coin := Area3D.new()
		coin.area_entered.connect(func(_area: Area3D) -> void: pass)
		world.add_child(coin)
	world.advance(TICK)
	check_equal(Array(world.get_problems()), [], "problems")
	check_equal(Array(world._list_warnings()), [], "warnings")


func test_what_stands_across_the_border_is_said() -> void:
	var scene := Node3D.new()
	var world := HapticWorld.new()
	world.clock = HapticWorld.CLOCK_STEPPED
	var body := with_shape(RigidBody3D.new(), sphere(0.1)) as RigidBody3D
	body.name = "Body"
	world.add_child(body)
	scene.add_child(world)
	var ground := with_shape(StaticBody3D.new(), box(Vector3.ONE), Vector3(0, -2, 0)) as StaticBody3D
	ground.name = "Ground"
	scene.add_child(ground)
	var joint := PinJoint3D.new()
	joint.name = "Pin"
	joint.exclude_nodes_from_collision = false
	joint.node_a = NodePath("../HapticWorld/Body")
	world.name = "HapticWorld"
	scene.add_child(joint)
	add_child(scene)
	world.advance(TICK)
	var problems := "\n".join(world.get_problems())
	check(problems.contains("'Ground'"), "of the floor it says: " + problems)
	check(problems.contains("'Pin'"), "of the joint it says: " + problems)
	ground.collision_layer = 4
	joint.node_a = NodePath("")
	check_equal("\n".join(world.get_problems()), "", "problems of others")


func test_a_joint_of_what_does_not_move_is_said() -> void:
	var world := add_world()
	var body := add_floor(world)
	var joint := PinJoint3D.new()
	joint.name = "Pin"
	joint.node_a = NodePath("../" + String(body.name))
	world.add_child(joint)
	world.advance(TICK)
	check("\n".join(world.get_problems()).contains("nothing that moves"), "%s" % [world.get_problems()])


func test_a_slow_engine_is_said_in_real_time() -> void:
	var world := HapticWorld.new()
	add_child(world)
	Engine.time_scale = 0.5
	await frames(3)
	var problems := "\n".join(world.get_problems())
	Engine.time_scale = 1.0
	check(problems.contains("time_scale"), "it says: " + problems)
	check_equal("\n".join(world.get_problems()), "", "afterwards")


func _disabled_height(mode: CollisionObject3D.DisableMode, above: bool, seconds: float) -> float:
	var world := add_world()
	world.gravity = Vector3(0, -9.8, 0)
	var holder := Node3D.new()
	world.add_child(holder)
	var body := with_shape(RigidBody3D.new(), sphere(0.1), Vector3(0, 5, 0)) as RigidBody3D
	body.disable_mode = mode
	holder.add_child(body)
	world.advance(0.1)
	var disabled: Node = holder if above else body
	disabled.process_mode = Node.PROCESS_MODE_DISABLED
	var before := body.position.y
	world.advance(seconds)
	var after := body.position.y
	var ray: Dictionary = world.intersect_ray(body.position + Vector3.UP, body.position, -1)
	check_equal(ray.is_empty(), mode == CollisionObject3D.DISABLE_MODE_REMOVE, "out of touch, mode %d" % mode)
	disabled.process_mode = Node.PROCESS_MODE_INHERIT
	world.advance(seconds)
	check(body.position.y < after - 0.05, "it does not go on, mode %d" % mode)
	world.free()
	return before - after


func test_a_disabled_body_is_what_its_mode_says() -> void:
	for above: bool in [false, true]:
		check_near(_disabled_height(CollisionObject3D.DISABLE_MODE_REMOVE, above, 0.2), 0.0, 1e-6, "removed")
		check_near(
			_disabled_height(CollisionObject3D.DISABLE_MODE_MAKE_STATIC, above, 0.2), 0.0, 0.011, "static"
		)
		check(_disabled_height(CollisionObject3D.DISABLE_MODE_KEEP_ACTIVE, above, 0.2) > 0.2, "kept active")


func test_a_body_in_a_paused_tree_waits_and_goes_on() -> void:
	var world := HapticWorld.new()
	world.process_mode = Node.PROCESS_MODE_ALWAYS
	var waits := with_shape(RigidBody3D.new(), sphere(0.1)) as RigidBody3D
	waits.process_mode = Node.PROCESS_MODE_PAUSABLE
	var goes := with_shape(RigidBody3D.new(), sphere(0.1), Vector3(2, 0, 0)) as RigidBody3D
	world.add_child(waits)
	world.add_child(goes)
	process_mode = Node.PROCESS_MODE_ALWAYS
	add_child(world)
	check(await until(func() -> bool: return goes.position.y < -0.1, 5.0), "nothing falls")
	get_tree().paused = true
	await frames(5)
	var before := waits.position.y
	var there := goes.position.y
	check(await until(func() -> bool: return goes.position.y < there - 1.0, 5.0), "the other does not go on")
	check_near(waits.position.y, before, 0.02, "one that waits")
	get_tree().paused = false
	await frames(3)
	check(waits.linear_velocity.y < -0.5, "it begins anew: %s" % waits.linear_velocity)


func _random_value(chance: RandomNumberGenerator, type: int) -> Variant:
	var floats: Array[float] = [0.0, 1.0, -1.0, 0.5, 1e-6, 1e-9, 100.0, 1e6]
	var pick := func() -> float: return floats[chance.randi() % floats.size()]
	match type:
		TYPE_BOOL:
			return chance.randi() % 2 == 0
		TYPE_INT:
			return chance.randi() % 4
		TYPE_FLOAT:
			return pick.call()
		TYPE_VECTOR3:
			return Vector3(pick.call(), pick.call(), pick.call())
	return null


func _random_node(chance: RandomNumberGenerator, types: PackedStringArray) -> Node:
	var node: Node = ClassDB.instantiate(types[chance.randi() % types.size()])
	if node is CollisionObject3D:
		var shapes: Array[Shape3D] = [sphere(0.1), box(Vector3.ONE * 0.2), SeparationRayShape3D.new()]
		shapes.append_array([HeightMapShape3D.new(), ConcavePolygonShape3D.new(), WorldBoundaryShape3D.new()])
		with_shape(node, shapes[chance.randi() % shapes.size()])
	return node


## Ten thousand changes of bodies, areas, joints and shapes as Godot has them: nothing crashes, and every
## place that is shown is a place.
func test_ten_thousand_changes_of_godots_physics() -> void:
	expect_error("")
	PhysicsServer3D.set_active(false)
	var chance := RandomNumberGenerator.new()
	chance.seed = 20261127
	var types := PackedStringArray()
	for type in _classes():
		if ClassDB.can_instantiate(type) and ClassDB.is_parent_class(type, "Node3D"):
			types.append(type)
	check(types.size() > 12, "only %s" % [types])
	var world := add_world()
	world.gravity = Vector3(0, -9.8, 0)
	add_floor(world)
	add_hand(world, path(Vector3(0, 0.3, 0), Vector3(0, 0.05, 0)))
	var nodes: Array[Node] = []
	for i in 10_000:
		nodes = nodes.filter(func(node: Variant) -> bool: return is_instance_valid(node))
		if nodes.size() < 20 or (nodes.size() < 40 and chance.randi() % 20 == 0):
			var above: Node = nodes[chance.randi() % nodes.size()] if nodes.size() > 4 else world
			nodes.append(_random_node(chance, types))
			(above if chance.randi() % 3 == 0 else world).add_child(nodes.back())
		var node := nodes[chance.randi() % nodes.size()]
		match chance.randi() % 8:
			0:
				if chance.randi() % 10 == 0:
					node.free()
			1:
				node.process_mode = (chance.randi() % 5) as Node.ProcessMode
			2:
				if node is Joint3D:
					node.set("node_a", node.get_path_to(nodes[chance.randi() % nodes.size()]))
			3:
				if node is RigidBody3D:
					(node as RigidBody3D).position += Vector3(0.01, 0, 0)
			_:
				var properties := ClassDB.class_get_property_list(node.get_class())
				var property: Dictionary = properties[chance.randi() % properties.size()]
				var is_ours: bool = not property.name in ["process_priority", "process_physics_priority"]
				var value: Variant = _random_value(chance, property.type)
				if value != null and is_ours and not property.name.begins_with("process_"):
					node.set(property.name, value)
		if i % 20 == 19:
			world.advance(0.002)
			for one: Variant in nodes:
				if is_instance_valid(one) and one is RigidBody3D:
					check(
						(one as RigidBody3D).position.is_finite(),
						"it is at %s" % (one as RigidBody3D).position
					)
		if i % 500 == 499:
			await frames(1)
	world.free()
	await frames(2)
	PhysicsServer3D.set_active(true)
