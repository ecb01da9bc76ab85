extends HBoxContainer
## The five scenarios, each as a card with its picture; one of them is chosen.

signal chosen(scenario: int)

const Card := preload("res://gallery/card.tscn")
const Gallery := preload("res://gallery/gallery.gd")
const PICTURE_HEIGHT := 118.0
const HEIGHT := 232.0

## In their order: title, what is played, and the scene of the gallery whose picture shows it.
const CARDS := [
	["1  Local", "A virtual world is touched. There is no network.", "static_testbed"],
	[
		"2  Direct",
		"A virtual world is touched over a network. Its force comes back one delay late.",
		"delay_lab"
	],
	["3  Direct, robot", "A robot touches. What it runs into is felt one delay late.", "teleoperated_robot"],
	["4  Model-mediated", "A local model is touched. States from afar correct it unnoticed.", "wrong_model"],
	["5  Model and robot", "A camera and a robot find what is there. Its model is touched.", "depth_camera"],
]


func _ready() -> void:
	var group := ButtonGroup.new()
	for i in CARDS.size():
		var card := _card(CARDS[i][0], CARDS[i][1], CARDS[i][2])
		card.button_group = group
		card.button_pressed = i == 0
		card.pressed.connect(func() -> void: chosen.emit(i + 1))
		add_child(card)


func _card(title: String, sentence: String, picture: String) -> Button:
	var card: Button = Card.instantiate()
	(card.get_node("%Title") as Label).text = title
	(card.get_node("%Sentence") as Label).text = sentence
	var shown := card.get_node("%Picture") as TextureRect
	shown.texture = load(Gallery.picture_of(picture))
	shown.custom_minimum_size = Vector2(0.0, PICTURE_HEIGHT)
	card.custom_minimum_size = Vector2(0.0, HEIGHT)
	card.size_flags_horizontal = SIZE_EXPAND_FILL
	card.toggle_mode = true
	return card
