extends "link_case.gd"
## What shows the bodies of the far side: their names, and nodes that go and come.


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
	var others := _operator.find_children("*", "MeshInstance3D", true, false).size()
	_operator.get_node("Floor").free()
	_advance(0.1)
	await frames(1)
	_advance(0.1)
	check_equal(_operator.find_children("*", "MeshInstance3D", true, false).size(), others + 1, "pictures")
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
	check_equal(_operator.find_children("*", "MeshInstance3D", true, false).size(), others, "pictures")


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
	check(problems.contains("Alone") and problems.contains("other side does not have"), problems)
	check(not problems.contains("Floor"), problems)
