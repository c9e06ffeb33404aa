#!/usr/bin/env python3
"""How well falls are found in films whose truth is known: how many, where, how tilted, and what the verdict says.

Two kinds of film: drawn ones, of a strip of paper that flutters or tumbles before a wall, with a camera's noise, blur and
compression, the hand that drops it, shadows, and framings that are too narrow; and those of `wisp simulate leaf --video`, whose
camera and falls are computed again here from the recording that it writes.

  studies/falls/film_falls.py WISP [--seeds S,…] [--only "NAME;…"] [--keep FOLDER]

A fall is missed if nothing was recorded for half of its time in view; it is wrong if it is no fall, or off by more than 5 % of the
picture's height. Exit status 1 where more than a tenth of a film's falls is missed or wrong and the film is called usable.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

METRES = 1.6  # of wall that a drawn film shows from top to bottom

DRAWN = {
    "plain": {},
    "light on dark": dict(wall=40, thing=190),
    "noisy": dict(noise=10, crf=32),
    "faint": dict(wall=205, thing=170, noise=4, crf=28),
    "60 frames/s at 720p": dict(rate=60, falls=5, width=1280, height=720),
    "120 frames/s": dict(rate=120, falls=5),
    "shadow": dict(shadow=True),
    "two at once": dict(two=True),
    "brightness drifts": dict(drift=0.1),
    "leaves the picture below": dict(pile=False),
    "round": dict(length=0.06, across=0.05),
    "too narrow: 270 x 480": dict(rate=25, width=270, height=480, length=0.16),
    "narrow: 360 x 480": dict(width=360, height=480),
    "camera shakes": dict(shake=4, falls=4),
}


def flutter(random, rate):
    """A fall of a strip: x, z in metres, angle, by row."""
    t = np.arange(int(4 * rate)) / rate
    turns, swing, phase = random.uniform(1, 1.8), random.uniform(0.08, 0.2) * METRES, random.uniform(0, 6.28)
    speed = random.uniform(0.5, 0.8)
    x = swing * (np.sin(2 * np.pi * turns * t + phase) - np.sin(phase)) + random.uniform(-0.06, 0.06) * METRES * t
    z = 0.85 * METRES - speed * (t - 0.25 * (1 - np.exp(-t / 0.25)))
    z = z + 0.03 * METRES * (np.cos(4 * np.pi * turns * t + 2 * phase) - np.cos(2 * phase))
    angle = 0.9 * np.cos(2 * np.pi * turns * t + phase)
    if random.random() < 0.3:
        angle = 2 * np.pi * random.uniform(1, 2) * t
    return x, z, angle


def paint(image, poses, length, width, value, fine=3):
    """A rectangle, antialiased, blurred over its poses (x, y down, angle anticlockwise; whole numbers are pixels' middles)."""
    poses = np.atleast_2d(poses)
    reach = length / 2 + width / 2 + 3
    x0, x1 = int(max(0, poses[:, 0].min() - reach)), int(min(image.shape[1], poses[:, 0].max() + reach + 1))
    y0, y1 = int(max(0, poses[:, 1].min() - reach)), int(min(image.shape[0], poses[:, 1].max() + reach + 1))
    if x0 >= x1 or y0 >= y1:
        return
    at = (np.arange(fine) + 0.5) / fine - 0.5
    cover = np.zeros((y1 - y0, x1 - x0))
    for x, y, angle in poses:
        u = (np.arange(x0, x1)[:, None] + at).ravel()[None, :] - x
        v = (np.arange(y0, y1)[:, None] + at).ravel()[:, None] - y
        along, over = u * np.cos(angle) - v * np.sin(angle), u * np.sin(angle) + v * np.cos(angle)
        inside = (abs(along) < length / 2) & (abs(over) < width / 2)
        cover += inside.reshape(y1 - y0, fine, x1 - x0, fine).mean((1, 3)) / len(poses)
    image[y0:y1, x0:x1] += cover * (value - image[y0:y1, x0:x1])


class Encoder:
    def __init__(self, path, width, height, rate, crf):
        self.process = subprocess.Popen(
            ["ffmpeg", "-y", "-v", "error", "-f", "rawvideo", "-pix_fmt", "gray", "-s", f"{width}x{height}", "-r", str(rate)]
            + ["-i", "-", "-c:v", "libx264", "-crf", str(crf), "-preset", "superfast", "-threads", "1", "-pix_fmt", "yuv420p", path],
            stdin=subprocess.PIPE)
        self.frames = 0

    def write(self, image):
        self.process.stdin.write(np.clip(np.round(image), 0, 255).astype(np.uint8).tobytes())
        self.frames += 1

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def draw(path, seed, falls=10, rate=30, width=480, height=360, wall=200, thing=90, noise=3, crf=23, length=0.12, across=0.02,
         shadow=False, two=False, pile=True, drift=0, shake=0):
    """Writes a film; returns its falls, each rows of frame, x, y, angle in pixels: whether in the picture or not."""
    random = np.random.default_rng(seed)
    scale = height / METRES
    y, x = np.mgrid[:height, :width]
    empty = np.float32(wall) * (1 - 0.25 * ((x / width - 0.4)**2 + (y / height - 0.5)**2))
    empty = empty.astype(np.float32)
    if shake:
        empty = empty + 25 * np.sin(x / 9) * np.sin(y / 13)
    grain = random.normal(0, noise, (8, height, width)).astype(np.float32)
    film = Encoder(path, width, height, rate, crf)
    lying, truth = [], []

    def show(strips, hand=None):
        image = empty.copy()
        for x, angle in lying:
            paint(image, (x, height - 12, angle), length * scale, across * scale, thing)
        for poses in strips:
            if shadow:
                paint(image, np.add(poses, (14, 10, 0)), 1.1 * length * scale, 1.5 * across * scale, 0.85 * empty.mean())
            paint(image, poses, length * scale, across * scale, thing)
        if hand is not None:
            paint(image, (hand[0], hand[1] / 2 - 40, np.pi / 2), max(1, hand[1] + 80), 50, 140)
        image *= 1 + drift * np.sin(film.frames / 70)
        if shake:
            image = np.roll(image, tuple(int(s) for s in random.normal(0, shake, 2)), (0, 1))
        film.write(image + np.roll(grain[film.frames % 8], random.integers(0, height), 0))

    for fall in range(falls):
        together = 2 if two and fall % 3 == 2 else 1
        ways = []
        for k in range(together):
            fx, fz, angle = flutter(random, rate)
            begin = (random.uniform(0.3, 0.7) if together == 1 else (0.25, 0.75)[k]) * width
            ways.append(np.stack([begin + fx * scale, height - fz * scale, angle], 1))
        top = ways[0][0]
        for k in range(int(0.5 * rate)):  # the hand comes with it, and holds it
            up = (1 - min(1, k / (0.3 * rate))) * height * 0.3
            show([top - (0, up, 0)], top - (0, up, 0))
        rows = [[] for _ in ways]
        alive = [True] * together
        for k in range(len(ways[0]) - 1):
            strips = []
            for j, way in enumerate(ways):
                if not alive[j]:
                    continue
                if way[k, 1] > height - 14 if pile else way[k, 1] > height + 40:
                    alive[j] = False
                    if pile:
                        lying[:] = (lying + [(way[k, 0], 0)])[-3:]
                    continue
                rows[j].append((film.frames, *way[k]))
                strips.append([way[k] + s * (way[k + 1] - way[k]) for s in (-0.2, 0, 0.2)])  # the shutter's time
            if not strips:
                break
            show(strips, (top[0], top[1] - k * height * 1.2 / rate) if k < 0.4 * rate else None)
        truth += [np.array(r) for r in rows]
        for k in range(int(0.4 * rate)):
            show([])
    film.close()
    return truth, length * scale / 2, (width, height)


def read(path):
    names, rows = None, []
    for line in open(path):
        if line.startswith("#"):
            continue
        if names is None:
            names = [cell.split(":")[-1].split("[")[0] for cell in line.strip().split(",")]
        else:
            rows.append([float(cell) if cell else np.nan for cell in line.strip().split(",")])
    return names, np.array(rows)


def axes(q):
    """The body's first two axes in the world, from quaternions w, x, y, z, a row each."""
    w, x, y, z = q.T
    return (np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], 1),
            np.stack([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)], 1))


class SideCamera:
    """That of `simulate leaf --video`: 1280 x 720 pixels, the room seen from the side."""
    fall = 1.45  # metres

    def __init__(self):
        height = 1.1 * self.fall
        self.eye = np.array([0, -3.2 * height, 0.86 * height])
        way = np.array([0, 0, 0.4 * height]) - self.eye
        distance = np.linalg.norm(way)
        self.forward = way / distance
        self.up = np.cross([1, 0, 0], self.forward)
        self.focal = 720 / height * distance
        self.metres = height

    def __call__(self, places):
        way = places - self.eye
        scale = self.focal / (way @ self.forward)
        return np.stack([640 + scale * way[:, 0] - 0.5, 360 - scale * (way @ self.up) - 0.5], 1)


def rig(wisp, path, seed, drops):
    """Films simulated leaves; returns the falls as draw() does. The angle is that of the blade's long side in the picture."""
    table = path + ".truth.csv"
    subprocess.run([wisp, "simulate", "leaf", "-o", table, "--drops", str(drops), "--seconds", "20", "--video", path, "--seed",
                    str(seed)], check=True, capture_output=True)
    names, rows = read(table)
    camera, truth = SideCamera(), []
    for drop in range(drops):
        all_rows = rows[rows[:, 0] == drop]
        places = all_rows[:, [names.index(f"pos.{a}") for a in "xyz"]]
        midrib, over = axes(all_rows[:, [names.index(f"q.{a}") for a in "wxyz"]])
        across = 2 * drop / (drops - 1) - 1 if drops > 1 else 0
        reach = max(0, 0.55 * camera.fall * 1280 / 720 - 0.38)
        stand = np.array([reach * across, 0.16 * (drop * 2 % 3 - 1)])
        begins, first = 0.45 * (drop * 3 % drops), 0
        while first + 1 < len(places):
            lower = np.nonzero(places[first + 1:, 2] <= places[first, 2] - camera.fall)[0]
            last = first + 1 + lower[0] if len(lower) else len(places) - 1
            p = places[first:last + 1].copy()
            p[:, :2] += stand - (p[:, :2].min(0) + p[:, :2].max(0)) / 2
            p[:, 2] += camera.fall - places[first, 2]
            frames = np.round(begins * 60) + np.arange(len(p))
            at, small = camera(p), 1e-3
            long = (camera(p + small * midrib[first:last + 1]) - at) / small * 0.073
            short = (camera(p + small * over[first:last + 1]) - at) / small * 0.049
            xx, yy = long[:, 0]**2 + short[:, 0]**2, long[:, 1]**2 + short[:, 1]**2
            xy = long[:, 0] * long[:, 1] + short[:, 0] * short[:, 1]
            angle = -0.5 * np.arctan2(2 * xy, xx - yy)
            round_ = np.hypot(xx - yy, 2 * xy) < 0.5 * (xx + yy)  # less than 1.7 times as long as wide
            angle[round_] = np.nan
            kept = frames < 1200
            if kept.any():
                truth.append(np.column_stack([frames, at, angle])[kept])
            begins += (last - first) / 60 + 0.12
            first = last + 1
    return truth, 0.5 * 1.8 * 0.073 / camera.metres * 720, (1280, 720)


def judged(recording, starts, metres, truth, half, size):
    """Of a capture: falls found, missed, wrong, root-mean-square errors."""
    names, rows = read(recording)
    scale = size[1] / metres
    off, tilts, wrong, pieces = [], [], 0, 0
    covered = [np.zeros(len(t), bool) for t in truth]
    for episode, start in zip(np.unique(rows[:, 0]), starts):
        r = rows[rows[:, 0] == episode]
        x = r[:, names.index("pos.x")] * scale + size[0] / 2 - 0.5
        y = size[1] - r[:, names.index("pos.z")] * scale - 0.5
        frames = np.arange(len(r)) + start - 1
        best = None
        for k, t in enumerate(truth):
            _, i, j = np.intersect1d(frames, t[:, 0], return_indices=True)
            if len(i) < 0.5 * len(r):
                continue
            square = (x[i] - t[j, 1])**2 + (y[i] - t[j, 2])**2
            if best is None or square.mean() < best[0]:
                best = (square.mean(), k, i, j, square)
        if best is None or best[0]**0.5 > 0.05 * size[1]:
            wrong += 1
            continue
        _, k, i, j, square = best
        pieces += covered[k].any()
        covered[k][j] = True
        off += list(square)
        if "q.w" in names:
            _, along = axes(r[:, names.index("q.w"):names.index("q.w") + 4])
            angle = np.arctan2(along[:, 2], along[:, 0])
            tilts += list(((angle[i] - truth[k][j, 3] + np.pi / 2) % np.pi - np.pi / 2)**2)
    seen = [(t[:, 1] > half) & (t[:, 1] < size[0] - half) & (t[:, 2] > half) & (t[:, 2] < size[1] - half) for t in truth]
    share = [c[s].mean() if s.sum() else None for c, s in zip(covered, seen)]
    made = [s for s in share if s is not None]
    # Of the whole fall, in the picture or beyond its sides.
    cut = sum(((t[:, 1] < -half) | (t[:, 1] > size[0] + half)).any() for t in truth)
    return dict(made=len(made), found=sum(s >= 0.5 for s in made), wrong=wrong, pieces=int(pieces), cut=int(cut),
                position=100 * np.sqrt(np.mean(off)) / size[1] if off else np.nan,
                tilt=np.degrees(np.sqrt(np.nanmean(tilts))) if tilts else np.nan)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wisp")
    parser.add_argument("--seeds", default="11,12")
    parser.add_argument("--only")
    parser.add_argument("--keep")
    options = parser.parse_args()
    films = {name: lambda path, seed, how=how: (*draw(path, seed, **how), METRES) for name, how in DRAWN.items()}
    for name, drops in {"simulate leaf: one": 1, "simulate leaf: three": 3, "simulate leaf: seven": 7}.items():
        films[name] = lambda path, seed, drops=drops: (*rig(options.wisp, path, seed, drops), SideCamera().metres)
    folder = options.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    bad = 0
    print("| film | seed | falls in it | beyond its sides | found | further pieces of them | wrong | position, % of the height | tilt, ° | verdict |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for name in options.only.split(";") if options.only else films:
        for seed in options.seeds.split(","):
            path = os.path.join(folder, "".join(c if c.isalnum() else "_" for c in name.replace(":", "")) + "_" + seed + ".mp4")
            cached = path + ".truth.npz"
            if options.keep and os.path.exists(cached):
                kept = np.load(cached, allow_pickle=True)
                truth, half, size, metres = list(kept["truth"]), float(kept["half"]), tuple(kept["size"]), float(kept["metres"])
            else:
                truth, half, size, metres = films[name](path, int(seed))
                boxed = np.empty(len(truth), object)
                boxed[:] = truth
                np.savez(cached, truth=boxed, half=half, size=size, metres=metres)
            run = subprocess.run([options.wisp, "capture", "fall", path, "-o", path + ".csv", "--height", str(metres), "--json"],
                                 capture_output=True, text=True)
            if run.returncode:
                print(f"| {name} | {seed} | {len(truth)} | | | | | | | refused: {run.stderr.strip().split(': ', 2)[-1]} |", flush=True)
                continue
            report = json.loads(run.stdout)
            j = judged(path + ".csv", [f["frame"] for f in report["fall"]], metres, truth, half, size)
            verdict = report["usable"]
            print(f"| {name} | {seed} | {j['made']} | {j['cut']} | {j['found']} | {j['pieces']} | {j['wrong']} | {j['position']:.2f} | {j['tilt']:.1f} | "
                  f"{'usable' if verdict['verdict'] else 'not usable'}: {verdict['reason']} |", flush=True)
            bad += verdict["verdict"] and (j["made"] - j["found"] + j["wrong"]) > 0.1 * j["made"]
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
