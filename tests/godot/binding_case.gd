extends "test_case.gd"
## What the tests of extension/binding share: the classes of binding_extension/, loaded and made.

const EXTENSION := "binding_extension/binding_probe.gdextension"

static var typed_findings := {}


func _init() -> void:
	var path := sibling(EXTENSION)
	if not GDExtensionManager.is_extension_loaded(path):
		GDExtensionManager.load_extension(path)


func sibling(file: String) -> String:
	return get_script().resource_path.get_base_dir().path_join(file)


## What binding_typed.gd found. GDScript knows only the classes that were there when it started,
## so that script runs in a Godot of its own, in a project with the extension in its list.
func typed(part: String) -> PackedStringArray:
	if typed_findings.is_empty():
		typed_findings = run_typed_script()
	check(part in typed_findings, "binding_typed.gd did not report on " + part)
	return typed_findings.get(part, PackedStringArray())


func run_typed_script() -> Dictionary:
	var project := OS.get_user_data_dir().path_join("binding_probe")
	DirAccess.make_dir_recursive_absolute(project.path_join(".godot"))
	write(project.path_join("project.godot"), "config_version=5\n")
	write(project.path_join(".godot/extension_list.cfg"), sibling(EXTENSION) + "\n")
	var output := []
	var arguments := ["--headless", "--path", project, "--script", sibling("binding_typed.gd")]
	OS.execute(OS.get_executable_path(), arguments, output, true)
	for line in output[0].split("\n"):
		check(not line.contains("ERROR") and not line.contains("leaked"), output[0])
	var report: PackedStringArray = output[0].split("FINDINGS ")
	check(report.size() == 2, output[0])
	return str_to_var(report[1].split("\n")[0]) if report.size() == 2 else {"nothing": output[0]}


func write(path: String, text: String) -> void:
	FileAccess.open(path, FileAccess.WRITE).store_string(text)


func instance(name_of_class: String) -> Variant:
	var made: Variant = ClassDB.instantiate(name_of_class)
	check(made != null, name_of_class + " cannot be made")
	return made
