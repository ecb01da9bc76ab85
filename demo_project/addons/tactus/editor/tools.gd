@tool
extends PopupMenu
## Project, Tools, Tactus: what makes a first scene quick. All of it can be undone.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

const Welcome := preload("welcome.gd")
## What each item says, what it does, and the method that does it.
const ITEMS := [
	["Add Haptic Rig", "A table, a hand, a camera and light in the scene that is edited", "ask_for_rig"],
	[
		"Make Touchable",
		"Puts the selected bodies and meshes below a HapticWorld, with a material",
		"make_selection_touchable"
	],
	[
		"Check My Machine",
		"Plays a scene that measures the loop and looks for devices and their libraries",
		"check"
	],
	["Welcome", "The first page: what to begin with", "welcome"],
]

var _undo_redo: EditorUndoRedoManager


func _init(undo_redo: EditorUndoRedoManager = null) -> void:
	_undo_redo = undo_redo
	name = "TactusTools"
	for item: Array in ITEMS:
		add_item(item[0])
		set_item_tooltip(item_count - 1, item[1])
	index_pressed.connect(func(index: int) -> void: call(ITEMS[index][2]))


func ask_for_rig() -> void:
	_tell(add_rig(EditorInterface.get_edited_scene_root()))


func make_selection_touchable() -> void:
	var selected := EditorInterface.get_selection().get_selected_nodes()
	_tell(make_touchable(EditorInterface.get_edited_scene_root(), selected))


func check() -> void:
	EditorInterface.play_custom_scene(path_of("check/check_machine.tscn"))


func play_rig() -> void:
	EditorInterface.play_custom_scene(path_of("HapticRig.tscn"))


func play_gallery() -> void:
	EditorInterface.play_main_scene()


func read_reference() -> void:
	EditorInterface.set_main_screen_editor("Script")
	EditorInterface.get_script_editor().goto_help("class_name:HapticWorld")


func read_first_steps() -> void:
	OS.shell_open(ProjectSettings.globalize_path(path_of("README.md")))


func welcome() -> void:
	var page := Welcome.new(self)
	_free_when_closed(page)
	page.show_page()


func _tell(problem: String) -> void:
	if problem.is_empty():
		return
	var dialog := AcceptDialog.new()
	dialog.title = "Tactus"
	dialog.dialog_text = problem
	_free_when_closed(dialog)
	EditorInterface.popup_dialog_centered(dialog)


func _free_when_closed(dialog: AcceptDialog) -> void:
	dialog.visibility_changed.connect(
		func() -> void:
			if not dialog.visible:
				dialog.queue_free()
	)


## Of a file of the addon, wherever that was copied to.
func path_of(file: String) -> String:
	var folder: String = (get_script() as Script).resource_path.get_base_dir()
	return folder.path_join("..").path_join(file).simplify_path()


## Adds the rig to the scene. Returns why not, empty where it did.
func add_rig(root: Node) -> String:
	if root == null:
		return "Open or make a scene first."
	if not root.find_children("*", "HapticWorld", true, false).is_empty() or root is HapticWorld:
		return "This scene has a HapticWorld already: add a HapticDevice and a ProxyPointer below it."
	var rig: Node3D = (load(path_of("HapticRig.tscn")) as PackedScene).instantiate()
	_undo_redo.create_action("Add Haptic Rig", UndoRedo.MERGE_DISABLE, root, true)
	_undo_redo.add_do_method(root, "add_child", rig, true)
	_undo_redo.add_do_property(rig, "owner", root)
	_undo_redo.add_do_reference(rig)
	_undo_redo.add_undo_method(root, "remove_child", rig)
	_undo_redo.commit_action()
	return ""


## Puts bodies below a HapticWorld, and gives meshes a body. Returns why not, empty where it did.
func make_touchable(root: Node, selected: Array[Node]) -> String:
	var chosen := selected.filter(
		func(node: Node) -> bool: return node is PhysicsBody3D or node is MeshInstance3D
	)
	if root == null or chosen.is_empty():
		return "Select bodies (StaticBody3D, RigidBody3D …) or meshes (MeshInstance3D) first."
	if chosen.has(root):
		return "The root of a scene cannot go below a HapticWorld: select what is below it."
	_undo_redo.create_action("Make Touchable", UndoRedo.MERGE_DISABLE, root, true)
	var world := _world_for(root)
	for node: Node3D in chosen:
		if not _has_world_above(node):
			_undo_redo.add_do_method(node, "reparent", world)
			_undo_redo.add_undo_method(node, "reparent", node.get_parent())
		if node is PhysicsBody3D:
			_add_material(node)
		else:
			_add_body(node, root)
	_undo_redo.commit_action()
	return ""


## The scene's own, or a new one.
func _world_for(root: Node) -> Node:
	if root is HapticWorld:
		return root
	var worlds := root.find_children("*", "HapticWorld", true, false)
	if not worlds.is_empty():
		return worlds[0]
	var world := HapticWorld.new()
	world.name = "HapticWorld"
	_undo_redo.add_do_method(root, "add_child", world, true)
	_undo_redo.add_do_property(world, "owner", root)
	_undo_redo.add_do_reference(world)
	_undo_redo.add_undo_method(root, "remove_child", world)
	return world


func _has_world_above(node: Node) -> bool:
	var above := node.get_parent()
	while above != null:
		if above is HapticWorld:
			return true
		above = above.get_parent()
	return false


func _add_material(body: PhysicsBody3D) -> void:
	if not "physics_material_override" in body or body.physics_material_override != null:
		return
	_undo_redo.add_do_property(body, "physics_material_override", new_material())
	_undo_redo.add_undo_property(body, "physics_material_override", null)


## A mesh is touched as it is drawn, and stays where it is.
func _add_body(mesh: MeshInstance3D, root: Node) -> void:
	if mesh.mesh == null or not mesh.find_children("*", "StaticBody3D", false, false).is_empty():
		return
	var body := StaticBody3D.new()
	body.name = "Touched"
	body.physics_material_override = new_material()
	var touched := HapticMesh.new()
	touched.name = "HapticMesh"
	touched.mesh = mesh.mesh
	body.add_child(touched)
	_undo_redo.add_do_method(mesh, "add_child", body, true)
	_undo_redo.add_do_property(body, "owner", root)
	_undo_redo.add_do_property(touched, "owner", root)
	_undo_redo.add_do_reference(body)
	_undo_redo.add_undo_method(mesh, "remove_child", body)


## Wood: hard, with friction, so that a first touch is not on ice.
static func new_material() -> HapticMaterial:
	var material := HapticMaterial.new()
	material.preset = HapticMaterial.PRESET_WOOD
	return material
