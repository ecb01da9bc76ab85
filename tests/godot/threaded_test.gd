extends "felt_test.gd"
## Godot's physics on a thread of its own (physics/3d/run_on_separate_thread), which carries out later what a
## script tells it. A SoftBody3D is left out: Godot 4.6.3 itself can stand still with one there.


func test_bodies_of_the_server_come_and_go() -> void:
	check(ProjectSettings.get_setting("physics/3d/run_on_separate_thread"), "no thread of its own")
	await test_a_height_map_that_only_the_server_knows()
	await test_triangles_that_only_the_server_knows()
	await test_a_plane_that_only_the_server_knows()
	await test_a_body_that_a_script_moves_by_the_server()


func test_a_body_of_the_server_is_pushed() -> void:
	await test_a_body_that_godot_moves_and_no_node_has_is_pushed()
