extends "link_case.gd"
## What shows the bodies of the far side: their names, nodes that go and come, a far world that is moved.


## Freed here it gets a picture, and a new body of that name shows it again; contacts name what shows it.
func test_a_body_that_is_freed_here_is_shown_by_what_comes_in_its_place() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	for world: HapticWorld in [_operator, _far]:
		add_floor(world, STIFFNESS)
	_add_hands(0.3)
	await frames(1)
	_advance(1.0)
	var proxy: ProxyPointer = _operator.get_node("Proxy")
	check_equal(proxy.get_contacts()[0]["body"], _operator.get_node("Floor"), "what is touched")
	_operator.get_node("Floor").free()
	_advance(0.1)
	await frames(1)
	_advance(0.1)
	check_equal(_operator.find_children("*", "MeshInstance3D", true, false).size(), 1, "pictures")
	check(proxy.get_contacts()[0]["body"] != null, "what is touched has no node")
	check(_felt(_operator).y > 4.0, "it is felt as before: %s" % _felt(_operator))
	var shown := []
	_here.object_discovered.connect(func(_name: String, node: Node3D) -> void: shown.append(node))
	for picture: Node in _operator.find_children("Floor*", "Node3D", true, false):
		picture.name = "Picture"
	var again := add_floor(_operator, STIFFNESS)
	_advance(0.1)
	await frames(1)
	_advance(0.1)
	check_equal(shown, [again], "what shows it")
	check_equal(proxy.get_contacts()[0]["body"], again, "what is touched")
	check_equal(_operator.find_children("*", "MeshInstance3D", true, false).size(), 0, "pictures")


func test_a_far_body_with_another_name_or_parent_is_told() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	var floor_body := add_floor(_far, STIFFNESS)
	_advance(0.5)
	var names := []
	_here.object_discovered.connect(func(name: String, _node: Node3D) -> void: names.append(name))
	floor_body.name = "Ground"
	_advance(0.5)
	var room := Node3D.new()
	room.name = "Room"
	_far.add_child(room)
	floor_body.reparent(room)
	await frames(1)
	_advance(0.5)
	check_equal(names, ["Ground", "Room/Ground"], "names")
	check_equal(_here.get_statistics().objects, 1, "objects")


## The far world is on a carriage: what is in it, and its hand, go along.
func test_a_far_world_may_be_moved_and_turned_while_it_runs() -> void:
	await _connect(MMTLink.SCENARIO_MMT, 0.02)
	add_floor(_far, STIFFNESS)
	_add_hands(0.3)
	await frames(1)
	_advance(1.0)
	var proxy: ProxyPointer = _far.get_node("Proxy")
	var places := [
		Transform3D(Basis.IDENTITY, Vector3(3.7, 0, 0)),
		Transform3D(Basis(Vector3.UP, 1.0), Vector3(0, 2.0, -1.0)),
		Transform3D.IDENTITY,
	]
	for place: Transform3D in places:
		_far.transform = place
		_advance(0.5)
		check_near(_felt(_operator), Vector3(0, 8.0, 0), 0.01, "force at the operator")
		check_near(proxy.get_force().y, 10.0, 0.01, "force at the far side")
		var below: Vector3 = _far.to_local(proxy.get_proxy_position())
		check_near(below, Vector3(0, 0.01, 0), 1e-3, "the far proxy in its world")


func test_a_body_that_only_the_operator_has_is_named() -> void:
	await _connect(MMTLink.SCENARIO_MMT)
	for world: HapticWorld in [_operator, _far]:
		add_floor(world, STIFFNESS)
	var alone := with_shape(StaticBody3D.new(), box(Vector3.ONE * 0.1))
	alone.name = "Alone"
	_operator.add_child(alone)
	await frames(1)
	_advance(0.5)
	var problems := "\n".join(_operator.get_problems())
	check(problems.contains("Alone") and problems.contains("far side does not have"), problems)
	check(not problems.contains("Floor"), problems)
