#!/usr/bin/env python3
"""Opens exported .glb files in Blender and compares every frame with what `wisp run` writes.

    python3 studies/export/blender.py PROGRAM MODELS-FOLDER WORK-FOLDER

Exits with 1 where a number differs by more than single precision and Blender's own arithmetic explain.
"""
import csv
import json
import os
import pathlib
import subprocess
import sys

# What runs inside Blender: all frames of all instances, as numbers.
INSIDE = """
import bpy, json, numpy, sys
numpy.bool = bool  # Debian's importer is older than its numpy
path, rate, frames, out = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = round(float(rate))
bpy.ops.import_scene.gltf(filepath=path)
found = []
things = sorted((o for o in bpy.data.objects if o.type == "MESH"), key=lambda o: o.name)
for frame in range(int(frames)):
    bpy.context.scene.frame_set(frame)
    graph = bpy.context.evaluated_depsgraph_get()
    row = []
    for thing in things:
        thing = thing.evaluated_get(graph)
        points = [list(thing.matrix_world @ v.co) for v in thing.data.vertices]
        row.append({"at": list(thing.matrix_world.translation), "points": points})
    found.append(row)
json.dump(found, open(out, "w"))
"""


def in_blender(glb, rate, frames, work):
    script, out = work / "inside.py", work / "found.json"
    script.write_text(INSIDE)
    # Blender looks for its Python's packages beside the first python3 in PATH, which may be another Python than Debian's.
    debian = {**os.environ, "PATH": "/usr/bin:" + os.environ["PATH"]}
    ran = subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", script,
                          "--", glb, str(rate), str(frames), out], env=debian, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                         text=True)
    if ran.returncode != 0:
        sys.exit(f"blender ended with {ran.returncode}:\n{ran.stdout}")
    return json.loads(out.read_text())


def rows_of(path):
    with open(path) as lines:
        rows = list(csv.reader(line for line in lines if not line.startswith("#")))
    names = [name.split(":")[-1].split("[")[0] for name in rows[0]]
    return [dict(zip(names, map(float, row))) for row in rows[1:]]


def axis_of(q, axis):
    """A column of the rotation that a quaternion stands for, w first."""
    size = sum(c * c for c in q) ** 0.5
    w, x, y, z = (c / size for c in q)
    columns = ((1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
               (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)))
    return columns[axis]


def leaf(program, models, work, frames=180, instances=3):
    glb, numbers = work / "leaf.glb", work / "leaf.csv"
    subprocess.run([program, "export", models / "leaf.wisp", "--seconds", str(frames / 60), "--instances",
                    str(instances), "--seed", "3", "-o", glb, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([program, "run", models / "leaf.wisp", "--frames", str(frames), "--instances", str(instances),
                    "--seed", "3", "-o", numbers, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    info = json.loads(subprocess.run([program, "info", models / "leaf.wisp", "--json"], check=True,
                                     capture_output=True).stdout)
    first, second = (info["view"][side] or 0.03 for side in ("half_width", "half_length"))
    worst_place = worst_turn = 0
    # An instance is an episode: all its frames, then those of the next.
    rows = rows_of(numbers)
    assert len(rows) == frames * instances
    for at, found in enumerate(in_blender(glb, 60, frames, work)):
        for k, thing in enumerate(found):
            row = rows[k * frames + at]
            assert row["episode"] == k
            place = [row[f"pos.{axis}"] for axis in "xyz"]
            turn = [row[f"q.{axis}"] for axis in "wxyz"]
            worst_place = max(worst_place, *(abs(a - b) for a, b in zip(place, thing["at"])))
            # Rows of three points: an edge, the midrib, the other edge. The first and the last midrib are 2 half sizes apart
            # along the first axis of the body, the edges of the middle row 2 / 1.08 half sizes along the second.
            for axis, (low, high), apart in ((0, (1, 37), 2 * first), (1, (20, 18), 2 * second / 1.08)):
                found_axis = [(b - a) / apart for a, b in zip(thing["points"][low], thing["points"][high])]
                worst_turn = max(worst_turn, *(abs(a - b) for a, b in zip(axis_of(turn, axis), found_axis)))
    print(f"leaf: {frames} frames of {instances}: places within {worst_place:.1e} m, axes within {worst_turn:.1e}")
    return worst_place < 1e-4 and worst_turn < 1e-3


def flame(program, models, work, frames=120):
    glb, numbers, settled = work / "flame.glb", work / "flame.csv", 240
    subprocess.run([program, "export", models / "flame-4.wisp", "--seconds", str(frames / 60), "--seed", "3", "-o", glb,
                    "--quiet"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([program, "run", models / "flame-4.wisp", "--frames", str(settled + frames), "--seed", "3", "-o",
                    numbers, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    info = json.loads(subprocess.run([program, "info", models / "flame-4.wisp", "--json"], check=True,
                                     capture_output=True).stdout)
    metres = info["view"]["metres_per_unit"] or 1
    worst = 0
    for row, found in zip(rows_of(numbers)[settled:], in_blender(glb, 60, frames, work), strict=True):
        # A clamped spline begins at its first control point and ends at its last.
        ends = [[row["p0.x"], row["p0.y"]], [row["p7.x"], row["p7.y"]]]
        points = found[0]["points"]
        # The outermost shell comes first: three rows below the base, then rings of twelve, whose seventh vertex and
        # first are the outline's sides.
        sides = [points[row * 12 + column] for row in range(3, 15) for column in (6, 0)]
        for end, point in zip(ends, sides):
            worst = max(worst, abs(end[0] - point[0] / metres), abs(end[1] - point[2] / metres))
        top = max(point[2] for point in sides) / metres
        worst = max(worst, top - max(row[f"p{k}.y"] for k in range(8)))  # inside its control polygon
    print(f"flame: {frames} frames: ends of the outline within {worst:.1e} of its height")
    return worst < 1e-4


def main():
    program, models, work = map(pathlib.Path, sys.argv[1:])
    results = [check(program.resolve(), models.resolve(), work.resolve()) for check in (leaf, flame)]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
