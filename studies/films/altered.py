#!/usr/bin/env python3
"""What copies of a film do to the outline: cut, scaled, brightened, coded again, with titles and logos.

  studies/films/altered.py WISP FILMS.json FOLDER [KIND…]

FILMS.json and FOLDER: as for ../shared/judges/films.py. Of every film and its altered copies the outlines are laid over each
other; an outline agrees where the two share three quarters of their area. Not to agree is no mistake where another flame or
another channel is followed: look at those. Needs ffmpeg, OpenCV and SciPy.
"""

import json
import os
import subprocess
import sys
import tempfile

import cv2
import numpy as np
from scipy.interpolate import BSpline

AGREES = 0.75


def outlines(path):
    """Row by row 200 points of the outline, or None."""
    knots, names, rows = None, None, []
    for line in open(path):
        line = line.strip()
        if line.startswith("# knots"):
            knots = np.array(line.split()[2:], float)
        elif line and not line.startswith("#"):
            if names is None:
                names = line.split(",")
            else:
                rows.append(line.split(","))
    xs, ys = ([k for k, name in enumerate(names) if name.startswith("y:p") and axis in name] for axis in (".x", ".y"))
    if knots is None:
        knots = np.r_[[0] * 3, np.linspace(0, 1, len(xs) - 2), [1] * 3]
    basis = BSpline(knots, np.eye(len(xs)), 3)(np.linspace(0, 1 - 1e-9, 200))
    at = lambda row: np.array([[float(row[x]), float(row[y])] for x, y in zip(xs, ys)])
    return [None if row[xs[0]] == "" else basis @ at(row) for row in rows]


def shared(a, b):
    """The area that two outlines share over the area of both."""
    low, high = np.minimum(a.min(0), b.min(0)) - 2, np.maximum(a.max(0), b.max(0)) + 2
    masks = np.zeros((2, 210, 210), np.uint8)
    for mask, curve in zip(masks, (a, b)):
        cv2.fillPoly(mask, [np.round((curve - low) * 200 / max(high - low) * 16).astype(np.int32)], 1, shift=4)
    return (masks[0] & masks[1]).sum() / max(1, (masks[0] | masks[1]).sum())


def alterations(width, height, rate):
    """Name: (filter, back from the copy's pixels to the film's, frames put before)."""
    even = lambda value: int(value) // 2 * 2
    same = lambda curve: curve
    bar, side, second = even(0.15 * height), even(0.3 * width), int(rate)

    def scaled(share):
        w, h = even(share * width), even(share * height)
        return f"scale={w}:{h}:flags=area", lambda curve: curve * [width / w, height / h], 0

    box = lambda x, y, w, h: f"drawbox=x={even(x * width)}:y={even(y * height)}:w={even(w * width)}:h={even(h * height)}:color=white:t=fill"
    return {
        "coded again": ("null", same, 0),
        "mirrored": ("hflip", lambda curve: np.c_[width - 1 - curve[:, 0], curve[:, 1]], 0),
        "scaled 0.6": scaled(0.6),
        "scaled 0.35": scaled(0.35),
        "letterbox": (f"pad={width}:{height + 2 * bar}:0:{bar}:black", lambda curve: curve - [0, bar], 0),
        "blurred sides": (f"split[a][b];[a]scale={width + 2 * side}:{height},boxblur=20[c];[c][b]overlay={side}:0", lambda curve: curve - [side, 0], 0),
        "logo": (box(0.85, 0.05, 0.1, 0.06), same, 0),
        "subtitle bar": (box(0.1, 0.88, 0.8, 0.06), same, 0),
        "fade in": (f"fade=in:0:{second}", same, 0),
        "gamma 0.7": ("eq=gamma=0.7", same, 0),
        "gamma 1.4": ("eq=gamma=1.4", same, 0),
        "contrast": ("eq=contrast=1.4:saturation=1.3", same, 0),
        "grey": ("hue=s=0", same, 0),
        "cool": ("colorbalance=rs=-.3:bs=.3", same, 0),
        "noise": ("noise=alls=18:allf=t", same, 0),
        "black title": (f"tpad=start={2 * second}:color=black", same, 2 * second),
        "white title": (f"tpad=start={2 * second}:color=white", same, 2 * second),
    }


def captured(wisp, clip, folder):
    """Outlines and verdict of a clip."""
    recording = os.path.join(folder, "recording.csv")
    if os.path.exists(recording):
        os.remove(recording)
    done = subprocess.run([wisp, "capture", "flame", clip, "-o", recording, "--json", "--quiet"], capture_output=True, text=True)
    if done.returncode != 0:
        return [], (False, done.stderr.strip())
    usable = json.loads(done.stdout)["usable"]
    return outlines(recording), (usable["verdict"], usable["reason"])


def main():
    wisp, table, folder, *kinds = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        for film in json.load(open(table)):
            source = os.path.join(folder, film["file"])
            clip = cv2.VideoCapture(source)
            known, _ = captured(wisp, source, scratch)
            for kind, (how, back, before) in alterations(int(clip.get(3)), int(clip.get(4)), clip.get(5)).items():
                if kinds and kind not in kinds:
                    continue
                copy = os.path.join(scratch, "copy.mp4")
                subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", source, "-filter_complex", how, "-an", "-c:v", "libx264", "-crf",
                                "30" if kind == "coded again" else "20", "-pix_fmt", "yuv420p", copy], check=True)
                found, (usable, reason) = captured(wisp, copy, scratch)
                pairs = [(a, b) for a, b in zip(known, found[before:]) if a is not None]
                tracked = [(a, back(b)) for a, b in pairs if b is not None]
                agree = sum(shared(a, b) >= AGREES for a, b in tracked)
                share = lambda count: 100 * count / max(1, len(pairs))
                print(f"{os.path.basename(film['file']):30s} {kind:13s} tracked {share(len(tracked)):3.0f} % agree {share(agree):3.0f} %  "
                      f"{'usable' if usable else 'not usable'}: {reason}", flush=True)


if __name__ == "__main__":
    main()
