#!/usr/bin/env python3
"""How often the verdict of `wisp learn arx` is wrong, over made systems of many kinds and public data sets.

    studies/focus/verdicts.py WISP [FOLDER… [SEED]]

FOLDERs hold tables of inputs u… and outputs y…, as the public data or what package_sets.py makes. Every model is judged on rows that it was not learned from. Wrong and usable: the verdict is usable, and free simulation
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


# Ways of spoiling a recording, and words of the sentence that names each.
SPOILED = {
    "sentinel": "stands for a missing sample", "outliers": "outlier", "redundant input": "tells nothing new",
    "feedback": "closes the loop", "long delay": "acts on", "drift": "drifts", "input that hardly moves": "moves only",
    "few rows": "too few", "acts at once": "in the same sample",
}


def spoiled(way, draw):
    """Columns of a system of one to three poles that a model of order 2 to 4 describes, but for what spoils it."""
    rows = 60 if way == "few rows" else draw.choice([400, 1000, 2000])
    poles = [draw.uniform(0.3, 0.93) for _ in range(draw.choice([1, 2]))]
    gain, noise, level = draw.uniform(0.5, 20), draw.uniform(0.01, 0.15), draw.uniform(-50, 50)
    delay = draw.randint(8, 80) if way == "long delay" else 0 if way == "acts at once" else 1
    hold, u, us, ys, states = draw.choice([1, 5, 20]), 0.0, [], [], [0.0] * len(poles)
    jumps = sorted(draw.sample(range(rows // 4, rows), draw.choice([1, 2, 3])))
    walk = 0.0
    for t in range(rows):
        if way == "input that hardly moves":
            u = draw.uniform(-1, 1) if t in jumps else u
        elif way == "feedback":
            u = -draw.uniform(0.4, 0.6) * (ys[-1] / gain if ys else 0) + 0.1 * draw.gauss(0, 1)
        elif t % hold == 0:
            u = draw.gauss(0, 1)
        us.append(u)
        drive = us[t - delay] if t >= delay else 0.0
        if way == "acts at once":
            drive = 0.2 * drive
        for k, pole in enumerate(poles):
            states[k] = pole * states[k] + (1 - pole) * (drive if k == 0 else states[k - 1])
        walk += draw.gauss(0, 0.02)
        size = 0.5 if way == "feedback" else noise
        ys.append(gain * (states[-1] + (2 * u if way == "acts at once" else 0) + size * draw.gauss(0, 0.5)))
    columns = {"u1": us, "y1": ys}
    spread = math.sqrt(sum(y * y for y in ys) / rows)
    if way == "drift":
        slope = draw.choice([-1, 1]) * draw.uniform(5, 15) * spread / rows
        columns["y1"] = [y + slope * t + spread * 0.1 * walk * t / rows for t, y in enumerate(ys)]
    if way == "sentinel":
        value, share = draw.choice([-999.0, -9999.0, 9999.0]), draw.uniform(0.003, 0.03)
        columns["y1"] = [value if draw.random() < share else y for y in ys]
        columns["y1"][rows // 3] = value
    if way == "outliers":
        count = draw.randint(6, 15)
        for t in draw.sample(range(rows), count):
            columns["y1"][t] += draw.choice([-1, 1]) * spread * draw.uniform(15, 60)
    if way == "redundant input":
        scale, offset = draw.uniform(0.5, 3), draw.uniform(-40, 40)
        columns["u2"] = [round(scale * u + offset, 6) for u in us]
    columns["y1"] = [y if way == "sentinel" and abs(y) > 990 else y + level for y in columns["y1"]]
    return columns


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


def name_causes(wisp, folder, seed):
    print("| spoiled by | models | refused | the sentence names it |")
    print("| --- | --- | --- | --- |")
    sums = [0, 0, 0]
    for way, words in SPOILED.items():
        row = [0, 0, 0]
        for k in range(12):
            columns = spoiled(way, random.Random(f"{seed} {way} {k}"))
            names, rows = sorted(columns), len(columns["y1"])
            path = folder / "spoiled.csv"
            path.write_text(",".join(names) + "\n" +
                            "".join(",".join(repr(x) for x in row) + "\n" for row in zip(*(columns[n] for n in names))))
            order = "6" if way == "few rows" else random.Random(f"{seed} order {k}").choice(["2", "4"])
            found = judge(wisp, folder, path, rows, round(0.7 * rows), names, ["--na", order, "--nb", order])
            if found is None:
                continue
            usable, fit, reason = found
            row = [row[0] + 1, row[1] + (not usable), row[2] + (not usable and words in reason)]
            if not usable and words not in reason:
                print(f"# {way}, simulation {fit:.0f} %: {reason}", file=sys.stderr)
        sums = [a + b for a, b in zip(sums, row)]
        print(f"| {way} | " + " | ".join(str(value) for value in row) + " |", flush=True)
    print("| all | " + " | ".join(str(value) for value in sums) + " |\n")


def main():
    wisp = sys.argv[1]
    seed = int(sys.argv[-1]) if sys.argv[-1].isdigit() else 1
    data = [pathlib.Path(one) for one in sys.argv[2:] if not one.isdigit()]
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
        for one in [path for where in data for path in sorted(where.glob("*.csv"))]:
            with open(one) as table:
                names = table.readline().strip().split(",")
                rows = sum(1 for _ in table)
            for output in [n for n in names if n[0] == "y"]:
                for share in (0.5, 0.7):
                    used = [n for n in names if n[0] == "u"] + [output]
                    count(one.parent.name, judge(wisp, folder, one, rows, round(share * rows), used, []))
        name_causes(wisp, folder, seed)
    print("| systems | models | usable | wrong and usable | right and refused |")
    print("| --- | --- | --- | --- | --- |")
    for kind, row in totals.items():
        print(f"| {kind} | " + " | ".join(str(value) for value in row) + " |")
    sums = [sum(row[k] for row in totals.values()) for k in range(4)]
    print("| all | " + " | ".join(str(value) for value in sums) + " |")


if __name__ == "__main__":
    main()
