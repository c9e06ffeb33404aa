# Plays a table that `wisp run --loop 4 MODEL -o flame.csv` wrote: an outline as a Polygon2D that repeats without a seam.
# Put it on a Polygon2D and set `table`. For a leaf, export a .glb instead: Godot imports it as a scene with its animation.
# Written for Godot 4; not run by Wisp's tests, which have no Godot.
extends Polygon2D

@export_file("*.csv") var table := "res://flame.csv"
@export var height := 200.0  # height of the calm flame, pixels

var rate_hz := 30.0
var frames: Array[PackedFloat32Array] = []
var columns := PackedInt32Array()  # column indices of the outputs: x and y of each control point, alternating
var knots := PackedFloat32Array()
var seconds := 0.0


func _ready() -> void:
	var file := FileAccess.open(table, FileAccess.READ)
	if file == null:
		push_error("%s: cannot be opened" % table)
		return
	while not file.eof_reached():
		var line := file.get_line()
		if line.begins_with("# rate_hz "):
			rate_hz = float(line.substr(10))
		elif line.begins_with("# knots "):
			for word in line.substr(8).split(" ", false):
				knots.append(float(word))
		elif line.begins_with("#") or line.is_empty():
			continue
		elif columns.is_empty():
			var names := line.split(",")
			for k in names.size():
				if names[k].begins_with("y:"):
					columns.append(k)
		else:
			var cells := line.split(",")
			var row := PackedFloat32Array()
			for k in columns:
				row.append(float(cells[k]))
			frames.append(row)


func _process(delta: float) -> void:
	if frames.is_empty():
		return
	seconds = fmod(seconds + delta, frames.size() / rate_hz)
	var at := seconds * rate_hz
	var before := frames[int(at) % frames.size()]
	var after := frames[(int(at) + 1) % frames.size()]
	var controls := PackedVector2Array()
	for k in range(0, before.size(), 2):
		var x := lerpf(before[k], after[k], at - floorf(at))
		var y := lerpf(before[k + 1], after[k + 1], at - floorf(at))
		controls.append(Vector2(x, -y) * height)
	polygon = outline_of(controls, 48)


# Evaluates the cubic B-spline of the control points by de Boor's algorithm.
func outline_of(controls: PackedVector2Array, points: int) -> PackedVector2Array:
	var out := PackedVector2Array()
	for point in points:
		var s := float(point) / (points - 1)
		var span := 3
		while span < controls.size() - 1 and s >= knots[span + 1]:
			span += 1
		var d := controls.slice(span - 3, span + 1)
		for level in range(1, 4):
			for j in range(3, level - 1, -1):
				var low := knots[span - 3 + j]
				var high := knots[span + 1 + j - level]
				d[j] = d[j - 1].lerp(d[j], (s - low) / (high - low))
		out.append(d[3])
	return out
