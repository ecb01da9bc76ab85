extends HapticEffect
## Water that flows along x and round a post: it drags the hand along. Without friction such a flow is known
## by a formula, that of a dipole in an even stream; it is fastest, twice as fast, at the sides of the post.

const SPEED := 0.25  # of the stream, metres per second
const DRAG := 6.0  # newtons per metre per second
const POST := 0.035  # radius, metres
const SURFACE := 0.05  # height of the water, metres
const FINGER := 0.01  # so deep a finger is wet all over, metres


## How the water flows at a place; it is as deep as it is everywhere alike.
static func flow(at: Vector3) -> Vector3:
	var far := maxf(at.x * at.x + at.z * at.z, POST * POST)
	var along := 1.0 - POST * POST * (at.x * at.x - at.z * at.z) / (far * far)
	var across := -2.0 * POST * POST * at.x * at.z / (far * far)
	return SPEED * Vector3(along, 0.0, across)


func _get_force(hand: Vector3, velocity: Vector3, _time: float) -> Vector3:
	var wet := clampf((SURFACE - hand.y) / FINGER + 0.5, 0.0, 1.0)
	return wet * DRAG * (flow(hand) - velocity)
