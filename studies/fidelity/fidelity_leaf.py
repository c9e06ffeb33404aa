#!/usr/bin/env python3
"""Can a classifier tell falls that a model plays from recorded ones, over a third of a second and over two?

usage: fidelity_leaf.py [--above-floor D] REAL.csv PLAYED.csv [OTHER.csv]

Poses of a leaf (wisp simulate leaf, wisp run --instances), a fall an episode. OTHER: other recorded falls, for the floor.
Gradient-boosted trees, at most 3,000 windows a side, five folds over whole falls. Windows of 0.35 and 2 s: mean,
deviation, least and most of descent, speed over ground, tilt, spin, change of heading, spin about the normal and velocity in
the leaf's axes. Of 2 s also log powers to 12 Hz of descent, speed over ground, height of the normal, velocity and spin in the
leaf's axes, with noise of 0.3 mm and 0.2° at every frequency on both sides, which hides what no eye sees. 0.5 is
indistinguishable; intervals are of 95 %, by a bootstrap over falls. With --above-floor the exit status is 1 unless both
differences of statistics are below D.

Then what follows from physics: how often energy grows (that of a flat ellipse of the default leaf's axes, over its
weight: in still air it only falls; gains are over three rows), percentiles of vertical speed, spread over ground in 2 s.
"""

import argparse
import csv
import sys

import numpy as np
from sklearn.ensemble import HistGradientBoostingClassifier
from sklearn.model_selection import GroupKFold

LENGTH, WIDTH, GRAVITY = 0.073, 0.049, 9.81
GAIN = 0.003  # metres: no recorded fall gains as much
MAX_WINDOWS, FOLDS, RESAMPLES = 3000, 5, 1000
SHORT, LONG = 0.35, 2.0  # seconds
HIGHEST = 12  # Hz
MASK_METRES, MASK_ANGLE = 0.3e-3, np.radians(0.2)


def read(path):
    """Rows a second, and each fall's positions and attitudes."""
    with open(path) as lines:
        rate = 60.0
        for line in lines:
            if not line.startswith("#"):
                break
            if line.startswith("# rate_hz"):
                rate = float(line.split()[2])
        names = [name.split(":")[-1].split("[")[0] for name in next(csv.reader([line]))]
        cells = np.loadtxt(lines, delimiter=",")
    columns = [names.index(name) for name in ("pos.x", "pos.y", "pos.z", "q.w", "q.x", "q.y", "q.z")]
    episode = cells[:, names.index("episode")]
    return rate, [cells[episode == one][:, columns] for one in np.unique(episode)]


class Fall:
    """Velocities in the room and in the leaf's axes, spin in the leaf's axes, and the height of its normal."""

    def __init__(self, poses, rate):
        self.position, q = poses[:, :3], poses[:, 3:] / np.linalg.norm(poses[:, 3:], axis=1, keepdims=True)
        w, x, y, z = q.T
        dw, dx, dy, dz = np.gradient(q, 1 / rate, axis=0).T
        self.spin = 2 * np.stack([w * dx - x * dw - y * dz + z * dy, w * dy + x * dz - y * dw - z * dx,
                                  w * dz - x * dy + y * dx - z * dw], 1)
        self.velocity = np.gradient(self.position, 1 / rate, axis=0)
        axes = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
                         2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], 1).reshape(-1, 3, 3)
        self.along = np.einsum("tij,ti->tj", axes, self.velocity)
        self.up = axes[:, 2, 2]
        heading = np.unwrap(np.arctan2(self.velocity[:, 1], self.velocity[:, 0]))
        self.ground = np.hypot(self.velocity[:, 0], self.velocity[:, 1])
        self.seen = np.column_stack([-self.velocity[:, 2], self.ground, np.arccos(np.clip(np.abs(self.up), 0, 1)),
                                     np.linalg.norm(self.spin, axis=1), np.gradient(heading) * rate, self.spin[:, 2], self.along])

    def energy(self):
        a, b = WIDTH / 2, LENGTH / 2
        inertia = np.array([b * b, a * a, a * a + b * b]) / 4
        return self.position[:, 2] + ((self.velocity**2).sum(1) + (self.spin**2 * inertia).sum(1)) / (2 * GRAVITY)


def windows(falls, seconds, rate, features):
    """Features of every window, a second or a window from one to the next, and each one's fall; its ends are left out."""
    rows, values, owners = round(seconds * rate), [], []
    for k, fall in enumerate(falls):
        for first in range(3, len(fall.ground) - rows - 3, min(rows, round(rate))):
            values.append(features(fall, slice(first, first + rows), rate))
            owners.append(k)
    return np.array(values), np.array(owners)


def statistics(fall, rows, _):
    values = fall.seen[rows]
    return np.r_[values.mean(0), values.std(0), values.min(0), values.max(0)]


def spectra(random):
    def of(fall, rows, rate):
        values = np.column_stack([fall.velocity[:, 2], fall.ground, fall.along, fall.spin, np.abs(fall.up)])[rows]
        count = len(values)
        bins = np.fft.rfft((values - values.mean(0)) * np.hanning(count)[:, None], axis=0)[1:]
        turn = 2 * np.pi * np.fft.rfftfreq(count, 1 / rate)[1:, None]
        noise = np.hstack([turn * MASK_METRES] * 5 + [turn * MASK_ANGLE] * 3 + [0 * turn + MASK_ANGLE])
        noise = noise * count / 4 / np.sqrt(2)  # of a sine of that amplitude under the window
        bins = bins + noise * (random.normal(size=bins.shape) + 1j * random.normal(size=bins.shape))
        return np.log(np.abs(bins[turn[:, 0] <= 2 * np.pi * HIGHEST])**2 + 1e-12).ravel()
    return of


def held_out_accuracy(first, second):
    """Held-out accuracy of every fall of both sides: no fall is on both sides of a fold."""
    random = np.random.default_rng(0)
    sides = [(values[at], owners[at]) for values, owners in (first, second)
             for at in [random.permutation(len(owners))[:MAX_WINDOWS]]]
    x = np.vstack([values for values, _ in sides])
    y = np.repeat([0, 1], [len(owners) for _, owners in sides])
    owners = np.r_[sides[0][1], sides[1][1] + 1 + first[1].max()]
    groups = random.permutation(owners.max() + 1)[owners]
    right = np.zeros(len(y), bool)
    for train, test in GroupKFold(FOLDS).split(x, y, groups):
        trees = HistGradientBoostingClassifier(max_iter=120, random_state=0)
        right[test] = trees.fit(x[train], y[train]).predict(x[test]) == y[test]
    return [np.array([right[(y == side) & (owners == one)].mean() for one in np.unique(owners[y == side])]) for side in (0, 1)]


def interval(sides):
    random = np.random.default_rng(0)
    means = [np.mean([random.choice(side, len(side)).mean() for side in sides]) for _ in range(RESAMPLES)]
    return np.quantile(means, (0.025, 0.975))


def physics(path, falls, rate):
    gains = np.concatenate([(e[3:] - e[:-3])[3:-3] for e in (fall.energy() for fall in falls)])
    speed = np.concatenate([fall.velocity[:, 2] for fall in falls])
    lag = round(2 * rate)
    places = [fall.position for fall in falls if len(fall.position) > lag]
    spread = np.mean([((p[lag:, :2] - p[:-lag, :2])**2).sum(1).mean() for p in places])
    print(f"{path}: energy grows in {100 * np.mean(gains > 0):.3f} % of spans, by more than 3 mm in "
          f"{100 * np.mean(gains > GAIN):.4f} %, at most by {1000 * gains.max():.1f} mm; vertical speed, 0.1 and 1 "
          f"percentile {np.percentile(speed, 0.1):.3f} {np.percentile(speed, 1):.3f}, mean {speed.mean():.4f} m/s; "
          f"spread in 2 s {spread:.4f} m²")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.replace("%", "%%").replace("usage: ", "", 1))
    parser.add_argument("--above-floor", type=float, default=np.inf)
    parser.add_argument("recordings", nargs="+")
    options = parser.parse_args()
    if not 2 <= len(options.recordings) <= 3:
        sys.exit("two or three recordings of falls; see --help")
    read_in = [read(path) for path in options.recordings]
    rate = read_in[0][0]
    falls = [[Fall(poses, rate) for poses in all_poses if len(poses) > LONG * rate] for _, all_poses in read_in]
    held = True
    for name, seconds, features in (("0.35 s, statistics", SHORT, statistics), ("2 s, statistics", LONG, statistics),
                                    ("2 s, masked spectra to 12 Hz", LONG, spectra(np.random.default_rng(1)))):
        sides = [windows(side, seconds, rate, features) for side in falls]
        found = held_out_accuracy(sides[0], sides[1])
        accuracy, (low, high) = np.mean([side.mean() for side in found]), interval(found)
        line = f"{name:32} {accuracy:.3f} [{low:.3f}, {high:.3f}]"
        if len(sides) == 3:
            floor = np.mean([side.mean() for side in held_out_accuracy(sides[0], sides[2])])
            line += f"   floor {floor:.3f}, above it {accuracy - floor:+.3f}"
            held &= features is not statistics or accuracy - floor < options.above_floor
        print(line, flush=True)
    for path, side in zip(options.recordings, falls):
        physics(path, side, rate)
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
