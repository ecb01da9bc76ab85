@tool
extends VBoxContainer
## Plots of the figures that Figures gives, and what devices, links and cameras say. Whoever has the figures
## shows them: the overlay of a running scene, or the editor's dock.

var _ticks := {}  # by world: [time, ticks] as of the last figures
var _period_us := {}


func show_figures(figures: Dictionary) -> void:
	var time: float = figures.time
	for world: String in figures.worlds:
		_show_world(short_name(world, figures.worlds.keys()), time, figures.worlds[world])
		_period_us[world] = figures.worlds[world].period_us
	for pointer: String in figures.pointers:
		%Force.add(short_name(pointer, figures.pointers.keys()), time, figures.pointers[pointer].force_n)
	var is_linked: bool = figures.links.values().any(_hears)
	%Link.visible = %Link.visible or is_linked
	%Correction.visible = %Link.visible
	for link: String in figures.links:
		var called := short_name(link, figures.links.keys())
		%Link.add(called, time, figures.links[link].round_trip_ms)
		%Correction.add(called, time, figures.links[link].moved_mm)
	%Said.text = _said(figures)


func _hears(link: Dictionary) -> bool:
	return link.packets_per_s > 0.0


func _show_world(world: String, time: float, figures: Dictionary) -> void:
	if _ticks.has(world) and time > _ticks[world][0]:
		%Rate.add(world, time, maxf(0.0, (figures.ticks - _ticks[world][1]) / (time - _ticks[world][0])))
	_ticks[world] = [time, figures.ticks]
	%Work.add(world + " p50", time, figures.work_p50_us)
	%Work.add(world + " p99", time, figures.work_p99_us)


## The first world's.
func show_histograms(histograms: Dictionary) -> void:
	for world: String in histograms:
		%Periods.show_counts(histograms[world], _period_us.get(world, 1000.0))
		return


func clear() -> void:
	_ticks.clear()
	for plot: Control in [%Rate, %Work, %Force, %Link, %Correction]:
		plot.clear()
	%Link.hide()
	%Correction.hide()
	%Said.text = ""


## The name of a node; where others are called so too, after what tells it from them on the way to it.
static func short_name(path: String, among: Array) -> String:
	var own := path.split("/")
	for above in range(1, own.size() + 1):
		var tells := func(other: String) -> bool:
			var words := other.split("/")
			return (
				other == path or words[-1] != own[-1] or words.size() < above or words[-above] != own[-above]
			)
		if among.all(tells):
			return own[-1] if above == 1 else "%s %s" % [own[-above], own[-1]]
	return path


func _said(figures: Dictionary) -> String:
	var lines := PackedStringArray()
	for kind: String in ["worlds", "devices", "links", "sensors"]:
		for path: String in figures[kind]:
			var called := short_name(path, figures[kind].keys())
			lines.append("%s: %s" % [called, _said_of(kind, figures[kind][path])])
	return "\n".join(lines)


func _said_of(kind: String, figures: Dictionary) -> String:
	if kind == "worlds":
		return "%d bodies, %d awake, %d deadlines missed" % [figures.bodies, figures.awake, figures.missed]
	if kind == "links" and _hears(figures):
		return "%s, %.1f %% lost, %d corrections" % [figures.text, figures.lost_percent, figures.corrections]
	return figures.text
