extends Control
## The gallery: picks a scene to touch. Escape comes back from it.
##
## Called with options (tactus.x86_64 -- --scene=… --duration=…), it runs that experiment instead; called
## with the path of a scene of the gallery, it opens that scene.

const Caller := preload("res://experiments/caller.gd")
const Gallery := preload("res://gallery/gallery.gd")
const Card := preload("res://gallery/card.tscn")
const Quietly := preload("res://experiments/quietly.gd")
const LAUNCHER := "res://launcher/launcher.tscn"

var _scene: Node
var _launcher: Control

@onready var _cards: Container = %Cards


func _ready() -> void:
	var asked := OS.get_cmdline_user_args()
	if Caller.asks_for_help(asked):
		print(Caller.USAGE)
		get_tree().quit()
		return
	if not asked.is_empty() and asked[0].begins_with("--"):
		_run_experiment.call_deferred()
		return
	for scene_name: String in Gallery.SCENES:
		_add_card(scene_name)
	%Launch.pressed.connect(open_launcher)
	_choose(0)
	if not asked.is_empty() and not Gallery.name_of(asked[0]).is_empty():
		open(asked[0])


func _add_card(scene_name: String) -> void:
	var card: Button = Card.instantiate()
	var words: Array = Gallery.SCENES[scene_name]
	(card.get_node("%Title") as Label).text = words[0]
	(card.get_node("%Sentence") as Label).text = words[1]
	(card.get_node("%Picture") as TextureRect).texture = load(Gallery.picture_of(scene_name))
	card.pressed.connect(open.bind(Gallery.path_of(scene_name)))
	_cards.add_child(card)


func _choose(card: int) -> void:
	%Menu.visible = true
	(_cards.get_child(card) as Control).grab_focus()


func _run_experiment() -> void:
	%Menu.visible = false
	var asked := OS.get_cmdline_user_args()
	var problem := Caller.problem(asked)
	if problem != "":
		printerr(problem, ".")
		get_tree().quit(2)
		return
	var experiment: Node = load("res://experiments/experiment.gd").new()
	add_child(experiment)
	var code: int = await experiment.run(Caller.words(asked))
	Quietly.free_containers(get_tree().root)
	get_tree().quit(code)


## The hand is the person's at once, but where its path begins again.
func open(path: String, by_hand := true) -> void:
	close()
	_scene = (load(path) as PackedScene).instantiate()
	var placard := _scene.get_node("Placard")
	placard.by_hand = by_hand
	placard.ended.connect(open.bind(path, false), CONNECT_DEFERRED)
	%Menu.visible = false
	add_child(_scene)


func open_launcher() -> void:
	close()
	_launcher = (load(LAUNCHER) as PackedScene).instantiate()
	_launcher.left.connect(_close_launcher)
	_launcher.has_way_back = true
	%Menu.visible = false
	add_child(_launcher)


func _close_launcher() -> void:
	_launcher.queue_free()
	_launcher = null
	%Menu.visible = true
	%Launch.grab_focus()


func close() -> void:
	if _scene != null:
		_choose(Gallery.SCENES.keys().find(Gallery.name_of(_scene.scene_file_path)))
		_scene.queue_free()
		_scene = null


func _unhandled_key_input(event: InputEvent) -> void:
	var key := event as InputEventKey
	if _scene == null or key == null or not key.pressed or key.echo:
		return
	match key.keycode:
		KEY_ESCAPE:
			close()
		KEY_R:
			open(_scene.scene_file_path)
