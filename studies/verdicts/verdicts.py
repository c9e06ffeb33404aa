#!/usr/bin/env python3
"""How often the verdict of a learned flame is wrong, both ways.

What is right: flames of the candle rig that no limit was fitted to, and films whose outlines are right. What is wrong is
made from them: outlines that are noise or mostly noise, or whose tip is or jumps, frames in random order, somebody else's wind, a
recording that is too short. An outline that jumps is refused by capture, which the scenes try.

  studies/verdicts/verdicts.py WISP [FILMS.json FOLDER] [--seeds A:B | --rig RECORDING…] [--points N] [--half 1|2]
                               [--kinds WORD] [--list]

FILMS.json and FOLDER: as for ../shared/judges/films.py; films that capture refuses are left out, since `learn` refuses them
too, and films whose sound is no wind are learned without it. --points: control points; --half: only the first or the second
half of every recording is learned from, where that has 60 outlines or more; --kinds: only what is wrong in a way whose name
has WORD. Exit status 1 where less than 95 % of what is wrong is called not usable, or more than 5 % of what is right.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy as np


def read(path):
    head, names, rows = [], None, []
    for line in open(path):
        if line.startswith("#"):
            head.append(line)
        elif names is None:
            names = line.rstrip("\n").split(",")
        elif line.strip():
            rows.append([float(cell) if cell else np.nan for cell in line.rstrip("\n").split(",")])
    return head, names, np.array(rows)


def write(path, head, names, rows):
    with open(path, "w") as file:
        file.writelines(head)
        file.write(",".join(names) + "\n")
        for row in rows:
            file.write(",".join("" if np.isnan(value) else "%.6g" % value for value in row) + "\n")


STRANGER = "somebody else's wind"


def outline_columns(names):
    return [k for k, name in enumerate(names) if name.startswith(("y:p", "m:base"))]


def wind_columns(names):
    return [k for k, name in enumerate(names) if name.startswith("u:")]


def corruptions(names, rows, random):
    """Recordings of nothing that can be learned, each with the name of what is wrong with it."""
    outline, wind = outline_columns(names), wind_columns(names)
    y = rows[:, outline]
    deviation = np.nanstd(y, axis=0)

    def with_outline(values):
        out = rows.copy()
        out[:, outline] = values
        return out

    yield "white noise", with_outline(np.nanmean(y, 0) + deviation * random.normal(size=y.shape))
    seen, mixed = np.flatnonzero(~np.isnan(y).any(1)), y.copy()
    mixed[seen] = y[random.permutation(seen)]
    yield "frames in random order", with_outline(mixed)
    yield "mostly noise", with_outline(y + 2 * deviation * random.normal(size=y.shape))
    yield "too short", rows[:40]
    for kind, made in tip_corruptions(names, y[:, [names[k].startswith("y:p") for k in outline]].copy(), random):
        out = rows.copy()
        out[:, [k for k in outline if names[k].startswith("y:p")]] = made
        yield kind, out
    if wind:
        stranger = rows.copy()
        gusts = np.abs(np.convolve(random.normal(size=len(rows) + 30), np.ones(31) / 31, "valid"))
        stranger[:, wind] = (gusts / gusts.max())[:, None]
        yield STRANGER, stranger


def tip_corruptions(names, y, random):
    """The outline's points with a tip that cannot be learned, about the base; the other points stay."""
    points = y.shape[1] // 2
    base = np.tile((y[:, :2] + y[:, -2:]) / 2, points)
    distance = np.nanmean(np.hypot((y - base)[:, ::2], (y - base)[:, 1::2]), axis=0)
    farthest = np.sort(np.argsort(-distance)[:2 * max(1, points // 8)])
    where = np.ravel([2 * farthest, 2 * farthest + 1], "F")
    tip = (y - base)[:, where]
    deviation, noise = np.nanstd(tip, axis=0), random.normal(size=tip.shape)
    seen, other = np.flatnonzero(~np.isnan(tip).any(1)), tip.copy()
    other[seen] = tip[random.permutation(seen)]
    jumps = random.random((len(tip), 1)) < 0.3
    for kind, made in (
        ("the tip is white noise", np.nanmean(tip, 0) + deviation * noise),
        ("the tip in random order", other),
        ("the tip trembles as much as it moves", tip + deviation * noise),
        ("the tip is elsewhere in 30 % of the frames", np.where(jumps, other, tip)),
    ):
        out = y.copy()
        out[:, where] = made + base[:, where]
        yield kind, out


def half_of(path, half):
    """Cuts a recording to its first or second half. Returns whether enough is left."""
    head, names, rows = read(path)
    seen = np.flatnonzero(~np.isnan(rows[:, outline_columns(names)]).any(1))
    middle = seen[len(seen) // 2] if len(seen) else 0
    write(path, head, names, rows[:middle] if half == 1 else rows[middle:])
    return len(seen) // 2 >= 60


class Tally:
    def __init__(self, wisp, listed):
        self.wisp, self.listed, self.counts, self.kinds = wisp, listed, {}, {}

    def learn(self, kind, wrong, recording):
        model = tempfile.mktemp(".wisp")
        done = subprocess.run([self.wisp, "learn", "flame", recording, "-o", model, "--json", "--quiet"], capture_output=True, text=True)
        told = json.loads(done.stdout) if done.stdout.startswith("{") else {}
        usable = bool(told.get("usable", {}).get("verdict")) if done.returncode == 0 else False
        # A wind that moves nothing may be left out, with a warning: what is learned then is flicker, which is right.
        usable = usable and not (kind == STRANGER and not told.get("inputs"))
        reason = told.get("usable", {}).get("reason", done.stderr.strip())
        if os.path.exists(model):
            os.remove(model)
        self.kinds.setdefault((wrong, kind), [0, 0])[0 if usable else 1] += 1
        if self.listed:
            print(f"  {'wrong' if wrong else 'right'}  {kind}: {'usable' if usable else 'not usable'}: {reason}", flush=True)

    def table(self):
        for title, wrong in (("right", False), ("wrong", True)):
            rows = [(kind, *count) for (w, kind), count in self.kinds.items() if w == wrong]
            print(f"\n{title:34s} usable  not usable")
            for kind, usable, refused in rows + [("all", sum(r[1] for r in rows), sum(r[2] for r in rows))]:
                print(f"  {kind:32s} {usable:6d} {refused:11d}")
        share = lambda wrong, at: sum(c[at] for (w, _), c in self.kinds.items() if w == wrong) / max(1, sum(sum(c) for (w, _), c in self.kinds.items() if w == wrong))
        print(f"\nright called not usable: {100 * share(False, 1):.1f} %, at most 5; wrong called not usable: {100 * share(True, 1):.1f} %, at least 95")
        return share(False, 1) <= 0.05 and share(True, 1) >= 0.95


def main():
    asked = argparse.ArgumentParser()
    asked.add_argument("wisp")
    asked.add_argument("films", nargs="*")
    asked.add_argument("--seeds", default="11:16")
    asked.add_argument("--rig", nargs="+", default=[])
    asked.add_argument("--points", default="8")
    asked.add_argument("--half", type=int, choices=(1, 2))
    asked.add_argument("--kinds", default="")
    asked.add_argument("--list", action="store_true")
    asked = asked.parse_args()
    capture = [asked.wisp, "capture", "flame", "--points", asked.points, "--quiet"]
    tally = Tally(asked.wisp, asked.list)
    first, last = map(int, asked.seeds.split(":"))
    with tempfile.TemporaryDirectory() as folder:
        recordings = [("rig", path) for path in asked.rig]
        for _, recording in recordings:
            tally.learn("rig", False, recording)
        for seed in [] if asked.rig else range(first, last + 1):
            clip, recording = os.path.join(folder, f"{seed}.mp4"), os.path.join(folder, f"{seed}.csv")
            subprocess.run([asked.wisp, "simulate", "candle", "-o", clip, "--seconds", "15", "--seed", str(seed), "--quiet"], check=True)
            subprocess.run([*capture, clip, "-o", recording], check=True, capture_output=True)
            if asked.half:
                half_of(recording, asked.half)
            tally.learn("rig", False, recording)
            recordings.append((f"rig {seed}", recording))
        if asked.films:
            for film in json.load(open(asked.films[0])):
                recording = os.path.join(folder, "film.csv" + str(len(recordings)))
                done = subprocess.run([*capture, os.path.join(asked.films[1], film["file"]), "-o", recording + ".csv", "--json"], capture_output=True, text=True)
                usable = done.returncode == 0 and json.loads(done.stdout)["usable"]["verdict"]
                if not usable or (asked.half and not half_of(recording + ".csv", asked.half)):
                    continue  # `learn` refuses what capture refuses
                head, names, rows = read(recording + ".csv")
                kept = [k for k, name in enumerate(names) if not name.startswith("u:")]
                write(recording + ".csv", head, [names[k] for k in kept], rows[:, kept])
                tally.learn("film", False, recording + ".csv")
                recordings.append((film["file"], recording + ".csv"))
        for name, recording in recordings:
            head, names, rows = read(recording)
            random = np.random.default_rng(len(rows))
            for kind, made in corruptions(names, rows, random):
                if asked.kinds not in kind:
                    continue
                path = os.path.join(folder, "wrong.csv")
                write(path, head, names, made)
                tally.learn(kind, True, path)
    return 0 if tally.table() else 1


if __name__ == "__main__":
    sys.exit(main())
