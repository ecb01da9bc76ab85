extends RefCounted
## The scenes of the gallery in the order of its menu, by the names of their folders: what each is called, and
## what there is to feel.
##
## A new one is a folder with a scene and a picture (tools/make_pictures.py) of its name, and a line here.

const SCENES := {
	"still_life":
	[
		"A still life",
		"Stroke hammered bronze, glazed clay, walnut and linen, and roll the oranges: the arrow is the force."
	],
	"static_testbed":
	[
		"A sphere",
		"Follow the yellow path: the proxy slides over the ground and the sphere, and never penetrates them."
	],
	"textures":
	[
		"Materials",
		"Stroke the slabs: rubber clings, ice glides, sandpaper is rough, steel rings, sponge gives and hardens."
	],
	"magnet":
	["Magnets", "Touch the blocks and lift off: the orange ones attract the finger, the right one harder."],
	"guide":
	["A virtual fixture", "There is no surface, only the yellow line: come near it, and it guides the hand."],
	"force_effect":
	[
		"Your own force",
		"A script makes a current round a post: hold still and be pushed, cross it, or be carried along."
	],
	"effects":
	[
		"Effects",
		"A slider in the air: it clicks from mark to mark, rubs a little, and ends at a wall on either side."
	],
	"knob":
	[
		"A button and a knob",
		"Press the button: it clicks, and the lamp changes. Turn the knob by its tab: it rests every 30 degrees."
	],
	"pen":
	[
		"A whiteboard pen",
		"Write on the board: the firmer you press, the wider the line, and it rubs a little."
	],
	"needle":
	[
		"A needle",
		"Push it through skin, fat and muscle: each resists, breaks, and holds the shaft until you draw it out."
	],
	"guided_study":
	[
		"A guided study",
		"An arm follows the line three times: without help, attracted by the line, and held to it."
	],
	"mesh_library":
	["Meshes", "Run along rims, through holes and over edges: every triangle is felt as it is drawn."],
	"globe":
	[
		"A globe",
		"Run over coasts and caps: land is raised and rough, the sea smooth, and the ice a material of its own."
	],
	"field":
	[
		"Volumes",
		"A maze and a lump made of samples, as a scanner has them: enter and touch the walls from inside."
	],
	"soft":
	[
		"Soft bodies",
		"Press the sponge, the ball and the cloth: each deforms, pushes back and recovers its shape."
	],
	"deforming_mesh":
	["A skin that moves", "Lay a finger on the skin: its wave lifts it and lets it down again."],
	"seaweed":
	[
		"Bones and skin",
		"Bones bend the leaf and it swells: lay a finger on it and be carried along by what is drawn."
	],
	"dynamic_testbed":
	[
		"A box",
		"Push it: it resists by its weight and its friction, and tips over when pushed above its middle."
	],
	"stack":
	["A stack", "Take the upper boxes off the lower ones: the deeper, the more weight there is to feel."],
	"tower":
	["A tower", "Push single blocks out of the tower: how long does it stand, and how hard did you knock?"],
	"hinge_door":
	["A door", "Push it open: lightly far from its hinge, hard close to it, and not beyond a right angle."],
	"gate":
	[
		"A gate",
		"Push the box through. It has three millimetres to spare on each side: feel it catch at a post."
	],
	"table_edge":
	["The edge of a table", "Push the box over the edge: it grows lighter as it tips, and then it is gone."],
	"pinch":
	["Two fingers", "Close them on the box and lift it by nothing but friction: too lightly, and it slips."],
	"vr":
	[
		"A room for a headset",
		"Two controllers and a desktop device at one table: the firmer you press, the more they vibrate."
	],
	"peg_in_hole":
	["A tool", "Lead the peg into its hole and feel it jam when it is tilted; then knock down the stack."],
	"delay_lab":
	[
		"Far away",
		"Left your copy, right the box, a delay away. Key 2: its force comes late. Key 4: the copy's, at once."
	],
	"remote_tool":
	[
		"A tool far away",
		"The peg jams at once in the local model; the teleoperator's peg follows a tenth of a second later."
	],
	"wrong_model":
	[
		"A wrong model",
		"Your copy, left, is too heavy and too smooth. Push it: it follows the true box without a jolt."
	],
	"two_operators":
	["Two operators", "Another operator pushes the same box; the pale sphere is that operator's proxy."],
	"teleoperated_robot":
	["A robot", "A robot's tip goes where the hand goes. The table it runs into is felt, a moment later."],
	"robot_tool":
	[
		"A robot with a tool",
		"A robot far away carries the real bar, and cannot turn it. A post that it alone runs into stops you too."
	],
	"depth_camera":
	[
		"A camera",
		"A depth camera has found the green bodies. Touch them here, and a robot touches the real ones."
	],
	"point_cloud":
	[
		"Points",
		"A depth camera sees what it does not know as points. Touch them: the points are the surface."
	],
	"device_check":
	[
		"Check a device",
		"Choose your device and do what is asked: is it found, where is it, does it push back the right way?"
	],
}


static func path_of(name: String) -> String:
	return "res://gallery/%s/%s.tscn" % [name, name]


static func picture_of(name: String) -> String:
	return "res://gallery/%s/%s.webp" % [name, name]


## The name of a scene of the gallery; empty for any other.
static func name_of(path: String) -> String:
	var name := path.get_file().get_basename()
	return name if SCENES.has(name) and path == path_of(name) else ""
