#!/usr/bin/env python3
"""Do played falls gain energy, dive and spread as recorded ones?

usage: falls_tails.py REAL.csv PLAYED.csv...      (poses of a leaf: `wisp simulate leaf`, `wisp run --instances`)

Energy is what a flat ellipse of the default leaf's axes has, over its weight: a height. In still air it only falls; its
gains are over three rows. Percentiles of vertical speed, mean descent, mean squared displacement over ground after 2 s.
"""

import csv
import sys

import numpy as np

LENGTH, WIDTH, GRAVITY = 0.073, 0.049, 9.81
GAIN = 0.003  # metres: no recorded fall gains as much


def read(path):
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


def body_spin(q, rate):
    """Angular velocity in the body's axes: 2 q* dq/dt."""
    w, x, y, z = q.T
    dw, dx, dy, dz = np.gradient(q, 1 / rate, axis=0).T
    return 2 * np.stack([w * dx - x * dw - y * dz + z * dy, w * dy + x * dz - y * dw - z * dx,
                         w * dz - x * dy + y * dx - z * dw], 1)


def energy(fall, rate):
    a, b = WIDTH / 2, LENGTH / 2
    inertia = np.array([b * b, a * a, a * a + b * b]) / 4
    velocity = np.gradient(fall[:, :3], 1 / rate, axis=0)
    kinetic = (velocity**2).sum(1) + (body_spin(fall[:, 3:], rate)**2 * inertia).sum(1)
    return fall[:, 2] + kinetic / (2 * GRAVITY)


def main():
    for path in sys.argv[1:]:
        rate, falls = read(path)
        gains = np.concatenate([(e[3:] - e[:-3])[3:-3] for e in (energy(fall, rate) for fall in falls)])
        speed = np.concatenate([np.gradient(fall[:, 2], 1 / rate) for fall in falls])
        lag = round(2 * rate)
        spread = np.mean([((f[lag:, :2] - f[:-lag, :2])**2).sum(1).mean() for f in falls if len(f) > lag])
        print(f"{path}: energy grows in {100 * np.mean(gains > 0):.3f} % of spans, by more than 3 mm in "
              f"{100 * np.mean(gains > GAIN):.4f} %, at most by {1000 * gains.max():.1f} mm; vertical speed, 0.1 and 1 "
              f"percentile {np.percentile(speed, 0.1):.3f} {np.percentile(speed, 1):.3f}, mean {speed.mean():.4f} m/s; "
              f"spread in 2 s {spread:.4f} m²")


if __name__ == "__main__":
    main()
