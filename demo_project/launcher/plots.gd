extends RefCounted
## The plots of a bundle as files of their own: curves that a paper can take, of CASE.csv.

const WholeFile := preload("res://addons/tactus/studies/whole_file.gd")

const SIZE := Vector2(900, 320)
const MARGIN := Vector4(70, 40, 20, 50)  ## left, top, right, bottom
const POINTS := 1500  ## of a curve; of more rows some are left out
const STYLE := "font-family='DejaVu Sans, sans-serif' font-size='13' fill='#1f2933'"
const AXES := {"x": "#b2443f", "y": "#3f8148", "z": "#33649c"}


## Empty, or why one could not be written.
static func draw(folder: String, side: String) -> String:
	var columns := _read(folder.path_join(side + ".csv"))
	if columns.is_empty() or (columns.time_us as PackedFloat64Array).size() < 2:
		return ""
	for plot: Array in [
		["force", "Force on the hand", "N", 1.0], ["hand", "Place of the hand", "mm", 1000.0]
	]:
		var path := folder.path_join("%s_%s.svg" % [side, plot[0]])
		var text := _svg(columns, plot[0], "%s: %s" % [side, plot[1]], plot[2], plot[3])
		var problem := WholeFile.write(path, text)
		if not problem.is_empty():
			return problem
	return ""


static func _read(path: String) -> Dictionary:
	var file := FileAccess.open(path, FileAccess.READ)
	if file == null:
		return {}
	var names := file.get_csv_line()
	var columns := {}
	for name in names:
		columns[name] = PackedFloat64Array()
	while not file.eof_reached():
		var row := file.get_csv_line()
		if row.size() == names.size():
			for i in names.size():
				columns[names[i]].append(row[i].to_float())
	return columns


static func _svg(columns: Dictionary, quantity: String, title: String, unit: String, scale: float) -> String:
	var times: PackedFloat64Array = columns.time_us
	var seconds := maxf((times[-1] - times[0]) * 1e-6, 1e-6)
	var low := 0.0
	var high := 1e-9
	for axis: String in AXES:
		for value: float in columns["%s_%s" % [quantity, axis]]:
			low = minf(low, value * scale)
			high = maxf(high, value * scale)
	var frame := Rect2(MARGIN.x, MARGIN.y, SIZE.x - MARGIN.x - MARGIN.z, SIZE.y - MARGIN.y - MARGIN.w)
	var lines := PackedStringArray(
		[
			"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %d %d'>" % [SIZE.x, SIZE.y],
			"<rect width='100%' height='100%' fill='white'/>",
			"<text x='%d' y='24' font-weight='bold' %s>%s</text>" % [frame.position.x, STYLE, title],
		]
	)
	var step := _step((high - low) / 5.0)
	var mark := ceilf(low / step) * step
	while mark <= high:
		var y := frame.end.y - (mark - low) / (high - low) * frame.size.y
		lines.append(
			(
				"<path d='M%.1f %.1fh%.1f' stroke='#e4e7eb'/>" % [frame.position.x, y, frame.size.x]
				+ (
					"<text x='%.1f' y='%.1f' text-anchor='end' %s>%s</text>"
					% [frame.position.x - 8, y + 4, STYLE, String.num(mark, 4)]
				)
			)
		)
		mark += step
	step = _step(seconds / 8.0)
	mark = 0.0
	while mark <= seconds:
		var x := frame.position.x + mark / seconds * frame.size.x
		lines.append(
			(
				"<text x='%.1f' y='%.1f' text-anchor='middle' %s>%s</text>"
				% [x, frame.end.y + 20, STYLE, String.num(mark, 3)]
			)
		)
		mark += step
	lines.append(
		(
			"<text x='%.1f' y='%.1f' text-anchor='middle' %s>time (s)</text>"
			% [frame.get_center().x, frame.end.y + 40, STYLE]
		)
	)
	lines.append("<text x='8' y='%.1f' %s>%s</text>" % [frame.position.y - 8, STYLE, unit])
	var place := frame.end.x - 60.0
	for axis: String in AXES:
		lines.append(
			(
				"<path fill='none' stroke='%s' stroke-width='1.5' d='%s'/>"
				% [
					AXES[axis],
					_curve(times, columns["%s_%s" % [quantity, axis]], scale, Vector2(low, high), frame)
				]
			)
		)
		lines.append(
			(
				"<text x='%.1f' y='24' %s fill='%s' font-weight='bold'>%s</text>"
				% [place, STYLE.replace(" fill='#1f2933'", ""), AXES[axis], axis]
			)
		)
		place += 22.0
	lines.append("</svg>\n")
	return "\n".join(lines)


static func _curve(
	times: PackedFloat64Array, values: PackedFloat64Array, scale: float, limits: Vector2, frame: Rect2
) -> String:
	var every := maxi(1, times.size() / POINTS)
	var points := PackedStringArray()
	for i in range(0, times.size(), every):
		var x := (times[i] - times[0]) / (times[-1] - times[0])
		var y := (values[i] * scale - limits.x) / (limits.y - limits.x)
		points.append("%.1f %.1f" % [frame.position.x + x * frame.size.x, frame.end.y - y * frame.size.y])
	return "M" + "L".join(points)


## 1, 2 or 5 times a power of ten, not below.
static func _step(least: float) -> float:
	var power := pow(10.0, floorf(log(maxf(least, 1e-12)) / log(10.0)))
	for factor: float in [1.0, 2.0, 5.0]:
		if factor * power >= least:
			return factor * power
	return 10.0 * power
