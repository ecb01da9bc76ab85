@tool
extends GridContainer
## Plots of the figures that Figures gives, and what devices, links and cameras say. Whoever has the figures
## shows them: the overlay of a running scene, or the editor's dock.
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")

var _counted := {}  # by what is counted: [time, count] as of the last figures
var _period_us := {}


func show_figures(figures: Dictionary) -> void:
	var time: float = figures.time
	for world: String in figures.worlds:
		_show_world(short_name(world, figures.worlds.keys()), time, figures.worlds[world])
		_period_us[world] = figures.worlds[world].period_us
	for pointer: String in figures.pointers:
		%Force.add(short_name(pointer, figures.pointers.keys()), time, figures.pointers[pointer].force_n)
	for device: String in figures.devices:
		var curve := short_name(device, figures.devices.keys())
		if %Energy.has(curve) or figures.devices[device].energy_mj != 0.0:
			%Energy.add(curve, time, figures.devices[device].energy_mj)
	for link: String in figures.links:
		_show_link(short_name(link, figures.links.keys()), time, figures.links[link])
	%Said.text = _said(figures)


func _hears(link: Dictionary) -> bool:
	return link.packets_per_s > 0.0


func _corrects(link: Dictionary) -> bool:
	return link.corrections > 0


func _show_world(world: String, time: float, figures: Dictionary) -> void:
	_add_rate(%Rate, world, time, figures.ticks)
	%Work.add(world + " p50", time, figures.work_p50_us)
	%Work.add(world + " p99", time, figures.work_p99_us)


## Over a link: what is corrected, what of that could be noticed, and what hiding it lives on.
func _show_link(link: String, time: float, figures: Dictionary) -> void:
	if %Link.has(link) or figures.round_trip_ms > 0.0:  # the operator's side measures it
		%Link.add(link, time, figures.round_trip_ms)
	if _corrects(figures):
		_add_rate(%Moved, link, time, figures.moved_mm)
		_add_rate(%Noticed, link, time, figures.jnds)
		%Energy.add(link + " tank", time, figures.tank_mj)
		%Energy.add(link + " hidden", time, figures.hidden_mj)


## How much more there is in a second of what only grows; a count that has begun anew starts again.
func _add_rate(plot: Control, curve: String, time: float, count: float) -> void:
	var key := [plot, curve]
	if _counted.has(key) and time > _counted[key][0]:
		plot.add(curve, time, maxf(0.0, (count - _counted[key][1]) / (time - _counted[key][0])))
	_counted[key] = [time, count]


## The first world's.
func show_histograms(histograms: Dictionary) -> void:
	for world: String in histograms:
		%Periods.show_counts(histograms[world], _period_us.get(world, 1000.0))
		return


func clear() -> void:
	_counted.clear()
	for plot: Control in [%Rate, %Work, %Periods, %Force, %Energy, %Link, %Moved, %Noticed]:
		plot.clear()
	%Said.text = ""


## The name of a node; where others are called so too, the nearest one above it that tells it from them.
static func short_name(path: String, among: Array) -> String:
	var own := path.split("/")
	for above in range(1, own.size() + 1):
		var tells := func(other: String) -> bool:
			var words := other.split("/")
			return (
				other == path or words[-1] != own[-1] or words.size() < above or words[-above] != own[-above]
			)
		if among.all(tells):
			return own[-above]
	return path


static func counted(count: int, one: String, several: String) -> String:
	return "%d %s" % [count, one if count == 1 else several]


func _said(figures: Dictionary) -> String:
	var lines := PackedStringArray()
	for kind: String in ["worlds", "devices", "links", "sensors"]:
		for path: String in figures[kind]:
			var said := _said_of(kind, figures[kind][path])
			# What is as it should be is seen.
			if kind != "devices" or said != "connected":
				lines.append("%s: %s" % [short_name(path, figures[kind].keys()), said])
	return "\n".join(lines)


func _said_of(kind: String, figures: Dictionary) -> String:
	if kind == "worlds":
		return (
			"%s, %d awake, %s missed"
			% [
				counted(figures.bodies, "body", "bodies"),
				figures.awake,
				counted(figures.missed, "deadline", "deadlines")
			]
		)
	if kind == "links" and _hears(figures):
		return "%s, %.1f %% lost, %d corrections" % [figures.text, figures.lost_percent, figures.corrections]
	return figures.text
