#!/usr/bin/env python3
"""Free simulation of unseen rows of made structures: many outputs that share a few lightly damped modes.

    studies/focus/structures.py WISP SEED          # the program, and the seed of all systems

Two inputs drive the modes; every output sees all of them in its own mixture and is measured with white noise. Models have
order 4 and delay 1 with every coupling, and are learned from the first two thirds.
"""
import cmath
import math
import os
import pathlib
import random
import sys
import tempfile

from focus import run

KINDS = [  # outputs, modes, noise as a share of the output, rows
    (4, 6, 0.05, 1500),
    (8, 10, 0.05, 1500),
    (12, 4, 0.3, 3000),
    (28, 8, 0.02, 3000),
    (28, 10, 0.1, 3000),
]
INPUTS = 2


def structure(outputs, modes, noise, rows, draw):
    poles, drives, shapes = [], [], []
    for k in range(modes):
        share = k / max(modes - 1, 1)
        turn = 2 * math.pi * min(0.01 * 40**share * math.exp(draw.gauss(0, 0.08)), 0.45)  # 0.01 to 0.4 of the rate
        damping = math.exp(draw.uniform(math.log(0.005), math.log(0.03)))
        poles.append(cmath.exp(complex(-damping, 1) * turn))
        drives.append([draw.gauss(0, 1) * math.sqrt(1 - abs(poles[-1]) ** 2) for _ in range(INPUTS)])
        size = draw.uniform(0.3, 1)
        shapes.append([draw.gauss(0, 1) * size for _ in range(outputs)])
    u, state, us, ys = [0.0] * INPUTS, [0j] * modes, [], []
    for _ in range(rows):
        u = [0.5 * one + draw.gauss(0, 1) for one in u]
        us.append(u)
        ys.append([sum(z.imag * shape[o] for z, shape in zip(state, shapes)) for o in range(outputs)])
        state = [pole * z + sum(b * one for b, one in zip(drive, u)) for pole, z, drive in zip(poles, state, drives)]
    for o in range(outputs):
        sd = noise * math.sqrt(sum(y[o] ** 2 for y in ys) / rows)
        for y in ys:
            y[o] += sd * draw.gauss(0, 1)
    return us, ys


def judged(wisp, folder, table, names, rows, focus):
    cut, model = rows * 2 // 3, folder / "m.wisp"
    begin = os.times()
    told = run(wisp, "learn", "arx", table, "-o", model, "--rate", 1, "--focus", focus, "--inputs", ",".join(names[:INPUTS]),
               "--outputs", ",".join(names[INPUTS:]), "--range", f"1:{cut}", "--json")
    end = os.times()
    seconds = end.children_user + end.children_system - begin.children_user - begin.children_system
    ways = {one["chosen"] for one in told.get("focus", {}).get("outputs", [])}
    cells = []
    for start in ("estimated", "measured"):
        seen = run(wisp, "validate", model, table, "--rate", 1, "--steps", "inf", "--initial", start, "--range",
                   f"{cut + 1}:{rows}", "--json")
        found = [one["fit_percent"]["inf"] for one in seen["channels"]]
        cells.append(f"{sum(found) / len(found):.1f} ({min(found):.1f})")
    verdict = "usable" if told["usable"]["verdict"] else "not usable"
    return [*cells, verdict, f"{seconds:.1f}", ", ".join(sorted(ways)) or "least squares"]


def main():
    wisp, draw = pathlib.Path(sys.argv[1]).resolve(), random.Random(int(sys.argv[2]))
    print("| outputs | modes | noise | focus | fitted start: mean (worst) | measured start | verdict | processor, s | chosen |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as name:
        table = pathlib.Path(name) / "made.csv"
        for outputs, modes, noise, rows in KINDS:
            us, ys = structure(outputs, modes, noise, rows, draw)
            names = [f"u{k + 1}" for k in range(INPUTS)] + [f"y{o + 1}" for o in range(outputs)]
            lines = (",".join(repr(x) for x in u + y) for u, y in zip(us, ys))
            table.write_text(",".join(names) + "\n" + "\n".join(lines) + "\n")
            for focus in ("prediction", "auto"):
                cells = judged(wisp, pathlib.Path(name), table, names, rows, focus)
                print("|", outputs, "|", modes, "|", f"{100 * noise:.0f} %", "|", focus, "|", " | ".join(cells), "|",
                      flush=True)


if __name__ == "__main__":
    main()
