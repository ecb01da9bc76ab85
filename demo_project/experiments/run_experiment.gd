extends SceneTree
## Runs one experiment and ends; experiment.gd has the options.
##
##     godot --headless --path demo_project --script res://experiments/run_experiment.gd -- --KEY=VALUE …
##
## An exported program takes the same options: tactus.x86_64 --headless -- --KEY=VALUE …


func _initialize() -> void:
	await process_frame  # the root enters the tree after this method
	var experiment: Node = load("res://experiments/experiment.gd").new()
	root.add_child(experiment)
	quit(await experiment.run(OS.get_cmdline_user_args()))
