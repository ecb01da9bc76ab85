extends "nodes_case.gd"
## Touch over a network in real time: UDP on this machine, also from a second process.

const LONG := 10.0

# Another run of the tests on this machine has other ports.
var _port := 20000 + OS.get_process_id() % 600 * 20
var _far_port := _port + 1


## A world in real time with a link, in one call.
func _side(side: MMTLink.Side, key := "") -> MMTLink:
	var world := HapticWorld.new()
	world.gravity = Vector3.ZERO
	var link := MMTLink.new()
	link.scenario = MMTLink.SCENARIO_MMT
	link.side = side
	link.local_port = _port if side == MMTLink.SIDE_OPERATOR else _far_port
	link.remote_port = _far_port if side == MMTLink.SIDE_OPERATOR else _port
	link.key_file = _key_file(key)
	world.add_child(link)
	add_child(world)
	return link


## A file that holds the key and that nobody else may read; none for no key.
func _key_file(key: String) -> String:
	if key == "":
		return ""
	var path := ProjectSettings.globalize_path("user://key_%d_%d" % [OS.get_process_id(), key.hash()])
	var file := FileAccess.open(path, FileAccess.WRITE)
	file.store_string(key)
	file.close()
	FileAccess.set_unix_permissions(path, FileAccess.UNIX_READ_OWNER | FileAccess.UNIX_WRITE_OWNER)
	return path


func _reaches(link: MMTLink, state: MMTLink.State, words := "") -> void:
	var does := await until(
		func() -> bool: return link.get_state() == state and link.get_state_text().match("*%s*" % words), LONG
	)
	check(does, "it is in state %d: %s" % [link.get_state(), link.get_state_text()])


func _counts(link: MMTLink, what: String) -> void:
	var does := await until(func() -> bool: return link.get_statistics()[what] > 0, LONG)
	check(does, what + " stays 0")


func _start_far_process() -> int:
	var options := {
		"scene": "res://experiments/static_mmt.tscn",
		"output": ProjectSettings.globalize_path("user://"),
		"link.scenario": 4,
		"link.side": 1,
		"link.local_port": _far_port,
		"link.remote_port": _port
	}
	var arguments := PackedStringArray(
		["--headless", "--path", ProjectSettings.globalize_path("res://"), "--"]
	)
	for key: String in options:
		arguments.append("--%s=%s" % [key, options[key]])
	return OS.create_process(OS.get_executable_path(), arguments)


func test_two_sides_meet_over_udp_with_and_without_a_key() -> void:
	for key: String in ["", "a key of some length"]:
		var here := _side(MMTLink.SIDE_OPERATOR, key)
		var there := _side(MMTLink.SIDE_TELEOPERATOR, key)
		add_floor(there.get_parent())
		await _reaches(here, MMTLink.STATE_CONNECTED)
		await _reaches(there, MMTLink.STATE_CONNECTED)
		check(
			await until(func() -> bool: return here.get_statistics().objects == 1, LONG),
			"the floor is not found"
		)
		check_equal(here.get_statistics().sealed, key != "", "sealed")
		there.get_parent().free()
		await _reaches(here, MMTLink.STATE_LEFT)
		here.get_parent().free()


func test_another_key_or_none_is_said() -> void:
	var here := _side(MMTLink.SIDE_OPERATOR, "the key of this side")
	var there := _side(MMTLink.SIDE_TELEOPERATOR, "another key entirely")
	await _reaches(here, MMTLink.STATE_REFUSED, "has another key")
	await _counts(here, "refused_key")
	there.key_file = ""
	await _reaches(here, MMTLink.STATE_REFUSED, "has no key")
	await _reaches(there, MMTLink.STATE_REFUSED, "this side has none")
	there.key_file = _key_file("the key of this side")
	await _reaches(here, MMTLink.STATE_CONNECTED)


func test_a_port_in_use_is_said_and_tried_again() -> void:
	var squatter := PacketPeerUDP.new()
	squatter.bind(_port)
	var here := _side(MMTLink.SIDE_OPERATOR)
	await _reaches(here, MMTLink.STATE_FAILED, "port %d is in use" % _port)
	squatter.close()
	await _reaches(here, MMTLink.STATE_WAITING)


func test_an_address_that_nobody_knows_is_said() -> void:
	var here := _side(MMTLink.SIDE_OPERATOR)
	here.remote_address = "no such name"
	await _reaches(here, MMTLink.STATE_FAILED, "is not known")
	here.remote_address = "127.0.0.1"
	await _reaches(here, MMTLink.STATE_WAITING)


func test_nonsense_is_counted_and_moves_nothing() -> void:
	var stranger := PacketPeerUDP.new()
	stranger.bind(_far_port)
	stranger.set_dest_address("127.0.0.1", _port)
	var here := _side(MMTLink.SIDE_OPERATOR)
	check(await until(func() -> bool: return stranger.get_available_packet_count() > 0, LONG), "no hello")
	var hello := stranger.get_packet()
	stranger.put_packet(hello)
	await _counts(here, "refused_epoch")
	stranger.put_packet(hello.slice(0, hello.size() - 3))
	await _counts(here, "refused_truncated")
	stranger.put_packet(hello + PackedByteArray([0, 0, 0]))
	await _counts(here, "refused_oversized")
	stranger.put_packet("not a packet of ours at all, but long enough to be one".to_utf8_buffer())
	await _counts(here, "refused_foreign")
	var other_version := hello.duplicate()
	other_version[2] += 2  # past the newest
	stranger.put_packet(other_version)
	await _reaches(here, MMTLink.STATE_REFUSED, "another version")
	check_equal(here.get_statistics().objects, 0, "objects")


func test_addresses_and_keys_may_change_while_it_runs() -> void:
	var here := _side(MMTLink.SIDE_OPERATOR)
	var there := _side(MMTLink.SIDE_TELEOPERATOR)
	await _reaches(here, MMTLink.STATE_CONNECTED)
	for link: MMTLink in [here, there]:
		link.local_port += 10
		link.remote_port += 10
	await frames(3)
	await _reaches(here, MMTLink.STATE_CONNECTED)
	var ticks: int = (here.get_parent() as HapticWorld).get_ticks()
	for link: MMTLink in [here, there]:
		link.key_file = _key_file("from now on with a key")
	check(await until(func() -> bool: return here.get_statistics().sealed, LONG), "it is not sealed")
	await _reaches(here, MMTLink.STATE_CONNECTED)
	check((here.get_parent() as HapticWorld).get_ticks() > ticks, "the world was started anew")


func test_a_second_process_is_touched_vanishes_and_comes_back() -> void:
	var scene := (load("res://experiments/static_mmt.tscn") as PackedScene).instantiate()
	var link: MMTLink = scene.get_node("HapticWorld/MMTLink")
	link.local_port = _port
	link.remote_port = _far_port
	link.scenario = MMTLink.SCENARIO_MMT
	add_child(scene)
	var process := _start_far_process()
	check(await until(func() -> bool: return link.get_statistics().objects == 2, LONG), "no bodies come")
	await _reaches(link, MMTLink.STATE_CONNECTED)
	var proxy: ProxyPointer = scene.get_node("HapticWorld/ProxyPointer")
	check(await until(proxy.is_touching, LONG), "nothing is touched")
	OS.kill(process)
	await _reaches(link, MMTLink.STATE_LOST)
	check(await until(proxy.is_touching, LONG), "the model is not there any more")
	process = _start_far_process()
	await _reaches(link, MMTLink.STATE_CONNECTED)
	check_equal(link.get_statistics().peer_restarts, 1, "restarts")
	check(
		await until(func() -> bool: return link.get_statistics().objects == 2, LONG), "no bodies come again"
	)
	scene.free()
	check(await until(func() -> bool: return not OS.is_process_running(process), LONG), "the far one stays")
