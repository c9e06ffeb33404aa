#!/usr/bin/env python3
"""How often the verdict of a learned flame is wrong, both ways.

What is right: flames of the candle rig that no limit was fitted to, and films whose outlines are right. What is wrong is
made from them: outlines that are noise or mostly noise, frames in random order, somebody else's wind, a recording
that is too short. An outline that jumps is refused by capture, which the scenes try.

  studies/verdicts/verdicts.py WISP [FILMS.json FOLDER] [--seeds A:B | --rig RECORDING…] [--list]

FILMS.json and FOLDER: as for ../shared/judges/films.py; films that capture refuses are left out, since `learn` refuses them
too, and films whose sound is no wind are learned without it. Exit status 1 where less than 95 % of what is wrong is called not
usable, or more than 5 % of what is right.
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
    yield "frames in random order", with_outline(y[random.permutation(len(y))])
    yield "mostly noise", with_outline(y + 2 * deviation * random.normal(size=y.shape))
    yield "too short", rows[:40]
    if wind:
        stranger = rows.copy()
        gusts = np.abs(np.convolve(random.normal(size=len(rows) + 30), np.ones(31) / 31, "valid"))
        stranger[:, wind] = (gusts / gusts.max())[:, None]
        yield STRANGER, stranger


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
    asked.add_argument("--list", action="store_true")
    asked = asked.parse_args()
    tally = Tally(asked.wisp, asked.list)
    first, last = map(int, asked.seeds.split(":"))
    with tempfile.TemporaryDirectory() as folder:
        recordings = [("rig", path) for path in asked.rig]
        for _, recording in recordings:
            tally.learn("rig", False, recording)
        for seed in [] if asked.rig else range(first, last + 1):
            clip, recording = os.path.join(folder, f"{seed}.mp4"), os.path.join(folder, f"{seed}.csv")
            subprocess.run([asked.wisp, "simulate", "candle", "-o", clip, "--seconds", "15", "--seed", str(seed), "--quiet"], check=True)
            subprocess.run([asked.wisp, "capture", "flame", clip, "-o", recording, "--quiet"], check=True, capture_output=True)
            tally.learn("rig", False, recording)
            recordings.append((f"rig {seed}", recording))
        if asked.films:
            for film in json.load(open(asked.films[0])):
                recording = os.path.join(folder, "film.csv" + str(len(recordings)))
                done = subprocess.run([asked.wisp, "capture", "flame", os.path.join(asked.films[1], film["file"]), "-o", recording + ".csv", "--json", "--quiet"], capture_output=True, text=True)
                usable = done.returncode == 0 and json.loads(done.stdout)["usable"]["verdict"]
                if not usable:
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
                path = os.path.join(folder, "wrong.csv")
                write(path, head, names, made)
                tally.learn(kind, True, path)
    return 0 if tally.table() else 1


if __name__ == "__main__":
    sys.exit(main())
