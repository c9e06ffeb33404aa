#!/usr/bin/env python3
"""How often the verdict of `wisp learn arx` is wrong, over made systems of many kinds and public data sets.

    studies/focus/verdicts.py WISP [DATA [SEED]]

Every model is judged on rows that it was not learned from. Wrong and usable: the verdict is usable, and free simulation
fits less than 30 %. Right and refused: not usable, and free simulation fits at least 60 %.
"""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile


def made(kind, rows, draw):
    """Input and output of one system: a kind, its own poles, gain, noise and delay."""
    radius, angle = draw.uniform(0.3, 0.97), draw.uniform(0.1, 2.5)
    a1, a2 = -2 * radius * math.cos(angle), radius * radius
    b = [draw.uniform(-1, 1) for _ in range(3)]
    hold, u, y, ys, us = 0, 0.0, [0.0, 0.0], [], []
    past = [0.0] * 12
    noise = {"clean": 0.02, "noisy": 0.5, "output noise": 0.5, "white": 1, "weak input": 5, "at once": 0.05,
             "delayed": 0.1, "square": 0.1}[kind]
    for _ in range(rows):
        if kind == "delayed" or draw.random() < 0.3:
            u = draw.gauss(0, 1)
        past = [u] + past[:-1]
        drive = b[0] * past[1] + b[1] * past[2] + b[2] * past[3]
        if kind == "at once":
            drive = 2 * past[0] + b[0] * past[1]
        if kind == "delayed":
            drive = b[0] * past[3] + b[1] * past[4] + past[5]
        if kind == "square":
            drive = past[1] ** 2
        e = draw.gauss(0, noise)
        out = -a1 * y[0] - a2 * y[1] + drive + (0 if kind == "output noise" else e)
        y = [out, y[0]]
        seen = out + e if kind == "output noise" else e if kind == "white" else out
        us.append(u)
        ys.append(seen)
    return us, ys


def judge(wisp, folder, path, rows, cut, names, more):
    model = folder / "m.wisp"
    learned = subprocess.run([wisp, "learn", "arx", str(path), "-o", str(model), "--rate", "1", "--inputs",
                              ",".join(n for n in names if n[0] == "u"), "--outputs",
                              ",".join(n for n in names if n[0] == "y"), "--range", f"1:{cut}", "--json", *more],
                             capture_output=True, text=True)
    if learned.returncode != 0:
        return None
    fit = json.loads(learned.stdout)
    told = subprocess.run([wisp, "validate", str(model), str(path), "--rate", "1", "--steps", "inf", "--initial",
                           "estimated", "--range", f"{cut + 1}:{rows}", "--json"], capture_output=True, text=True)
    if told.returncode != 0:
        return None
    worst = min(one["fit_percent"]["inf"] for one in json.loads(told.stdout)["channels"])
    return fit["usable"]["verdict"], worst, fit["usable"]["reason"]


def main():
    wisp = sys.argv[1]
    data = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    totals = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def count(kind, found):
            if found is None:
                return
            usable, fit, reason = found
            row = totals.setdefault(kind, [0, 0, 0, 0])
            row[0] += 1
            row[1] += usable
            row[2] += usable and fit < 30
            row[3] += not usable and fit >= 60
            if (usable and fit < 30) or (not usable and fit >= 60):
                print(f"# {kind}: usable {usable}, simulation {fit:.0f} %: {reason}", file=sys.stderr)

        for kind in ("clean", "noisy", "output noise", "white", "weak input", "at once", "delayed", "square"):
            for k in range(12):
                draw = random.Random(f"{seed} {kind} {k}")
                rows = draw.choice([120, 400, 1000])
                us, ys = made(kind, 2 * rows, draw)
                path = folder / "made.csv"
                path.write_text("u1,y1\n" + "".join(f"{u!r},{y!r}\n" for u, y in zip(us, ys)))
                order = str(draw.choice([2, 4]))
                count(kind, judge(wisp, folder, path, 2 * rows, rows, ["u1", "y1"], ["--na", order, "--nb", order]))
        for one in sorted(data.glob("*.csv")) if data else []:
            with open(one) as table:
                names = table.readline().strip().split(",")
                rows = sum(1 for _ in table)
            for output in [n for n in names if n[0] == "y"]:
                for share in (0.5, 0.7):
                    used = [n for n in names if n[0] == "u"] + [output]
                    count("public data", judge(wisp, folder, one, rows, round(share * rows), used, []))
    print("| systems | models | usable | wrong and usable | right and refused |")
    print("| --- | --- | --- | --- | --- |")
    for kind, row in totals.items():
        print(f"| {kind} | " + " | ".join(str(value) for value in row) + " |")
    sums = [sum(row[k] for row in totals.values()) for k in range(4)]
    print("| all | " + " | ".join(str(value) for value in sums) + " |")


if __name__ == "__main__":
    main()
