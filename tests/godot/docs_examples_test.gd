extends "nodes_case.gd"
## Each GDScript that the pages show compiles, and those that stand alone do what they show.


## By "PAGE:NUMBER", as a script of its own.
func _scripts() -> Dictionary[String, GDScript]:
	var clone: String = (get_script() as Script).resource_path.get_base_dir().path_join("../..")
	var block := RegEx.create_from_string("(?ms)^([ \\t]*)```gdscript\\n(.*?)^[ \\t]*```")
	var found: Dictionary[String, GDScript] = {}
	for page: String in ["README.md", "CONTRIBUTING.md"] + _pages(clone, "docs"):
		var number := 0
		for example in block.search_all(FileAccess.get_file_as_string(clone.path_join(page))):
			number += 1
			var script := GDScript.new()
			# Where the page indents by spaces, as a list does.
			script.source_code = example.get_string(2).dedent().replace("    ", "\t")
			found["%s:%d" % [page, number]] = script
	return found


func _pages(clone: String, folder: String) -> Array:
	var here := clone.path_join(folder)
	var found := Array(DirAccess.get_files_at(here)).filter(
		func(name: String) -> bool: return name.ends_with(".md")
	)
	found = found.map(func(name: String) -> String: return folder.path_join(name))
	for inner in DirAccess.get_directories_at(here):
		found.append_array(_pages(clone, folder.path_join(inner)))
	return found


func test_each_script_compiles() -> void:
	var scripts := _scripts()
	for page in scripts:
		check_equal(scripts[page].reload(), OK, "compiling " + page)
	var pages := Array(scripts.keys()).map(func(name: String) -> String: return name.get_slice(":", 0))
	var expected := [
		"README.md", "docs/studies.md", "docs/vr.md", "docs/vr.md", "docs/tutorials/own_force_effect.md"
	]
	pages.sort()
	expected.sort()
	check_equal(pages, expected, "pages with scripts")


## The river drags a hand at rest along: 4 N·s/m of 0.5 m/s in its middle.
func test_the_force_of_the_tutorial_is_felt() -> void:
	var script: GDScript = _scripts()["docs/tutorials/own_force_effect.md:1"]
	check_equal(script.reload(), OK, "compiling")
	var world := add_world()
	var proxy := add_hand(world, path(Vector3.ZERO, Vector3.ZERO))
	var effect: HapticEffect = script.new()
	proxy.add_child(effect)
	for _i in 30:
		world.advance(1.0 / 60.0)
	check_equal(effect.get_state_text(), "working", "state")
	var force: Vector3 = (world.get_node("Device") as HapticDevice).get_force()
	check_near(force, Vector3(2.0, 0, 0), 0.02, "force of the river")


## Without a headset, it leaves the viewport as it is.
func test_the_script_for_a_headset_runs_without_one() -> void:
	var script: GDScript = _scripts()["docs/vr.md:1"]
	check_equal(script.reload(), OK, "compiling")
	var scene: Node3D = script.new()
	add_child(scene)
	check(not get_viewport().use_xr, "the viewport is the headset's")
	scene.free()
