#!/usr/bin/env python3
"""Can a classifier tell flames that a model plays from recorded ones, over half a second and over two?

usage: fidelity_flame.py [--mask PX] [--above-floor D] [--floor A.csv,B.csv…] [--learned A.csv,B.csv…]
                          RECORDED.csv… -- PLAYED.csv… [-- PLAYED.csv…]…

The k-th file after each -- is what a model plays along the wind of the k-th recording (wisp run --input); each -- begins
another play. Whole pairs are left out in turn; give six or more, since with three the names of the sides alone give any
figure, and compare figures of equally many pairs only. --floor has as many recordings in other winds of the same kind,
each judged beside its own wind: recorded against recorded. Another take in the same wind differs by the camera's noise
alone and is no floor. Both sides are on the scale of the recording (median area).

Windows: half a second of eight points at equal steps along the outline, and their differences; two seconds of log spectra
of tip, square root of the area, and a point of each flank, in 13 geometric bands; two seconds of statistics of the same
signals (correlation with the wind by lag, deviation of differences, kurtosis, peaks, deviation by wind, correlations).
Spectra and statistics are of both sides with noise of PX pixels (0.25; the area's root half of it), which hides what no eye
sees. 0.5 is indistinguishable. Intervals are of 95 %, by a bootstrap over pairs. With --above-floor the exit status is 1
unless all differences from the floor are surely below D (the upper end of the interval).

Then the burst: the tip's peak acceleration upwards over its deviation; the correlation of the square root of the area with
the wind 100 ms before, over two seconds; the power of each signal by band; and with --learned, the recordings that the model
was learned from, the longest stretch in wind along which eight points stay on average within 2 % of the flame's height of theirs.
"""

import argparse
import sys
import warnings

import numpy as np
from scipy.interpolate import BSpline
from sklearn.ensemble import HistGradientBoostingClassifier
from sklearn.linear_model import LogisticRegression
from sklearn.model_selection import LeaveOneGroupOut
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

CURVE_POINTS = 400
TIP_POINTS = 8
LAGS = (0, 2, 4, 6, 9, 12, 18, 30)
WINDS = ((-1, 0.05), (0.05, 0.4), (0.4, 0.8), (0.8, 9))
RATE = 60
BANDS = (0.5, 2.5, 5, 8, 12, 16, 20, 25)  # Hz
SIGNALS = ("tip, x", "tip, y", "root of the area", "left flank, x", "left flank, y", "right flank, x", "right flank, y")
MASKED = np.array([1, 1, 0.5, 1, 1, 1, 1])  # of the mask, signal by signal
COPY = 0.02  # of the flame's height
RESAMPLES = 2000


def number(cell):
    return float(cell) if cell else np.nan


def read(path):
    """Header, rows and knots of a recording."""
    knots, lines = None, []
    with open(path) as file:
        for line in map(str.strip, file):
            if line.startswith("# knots"):
                knots = np.array([float(knot) for knot in line.split()[2:]])
            elif line and not line.startswith("#"):
                lines.append(line.split(","))
    return lines[0], lines[1:], knots


class Clip:
    """Eight points of the outline, the tip and the area, a row a frame; the origin is the middle of the base, y is up."""

    def __init__(self, path):
        head, rows, knots = read(path)
        xs = [i for i, name in enumerate(head) if name.startswith("y:p") and ".x" in name]
        ys = [i for i, name in enumerate(head) if name.startswith("y:p") and ".y" in name]
        up = -1 if "[px]" in head[xs[0]] else 1
        points = np.array([[[number(row[i]), up * number(row[j])] for i, j in zip(xs, ys)] for row in rows])
        curve = self.curves(points, knots)
        curve = curve - 0.5 * (curve[:, :1] + curve[:, -1:])
        far = np.argsort(-np.nan_to_num(np.hypot(curve[..., 0], curve[..., 1])), axis=1)[:, :TIP_POINTS]
        self.tip = np.take_along_axis(curve, far[..., None], 1).mean(1)
        x, y = curve[..., 0], curve[..., 1]
        self.area = 0.5 * np.abs(np.sum(x[:, :-1] * y[:, 1:] - x[:, 1:] * y[:, :-1], axis=1))
        self.eight = np.array([self.at_equal_steps(one) for one in curve])
        wind = [i for i, name in enumerate(head) if name.startswith("u:")]
        self.wind = np.array([number(row[wind[0]]) for row in rows])

    @staticmethod
    def curves(points, knots):
        count = points.shape[1]
        if knots is None:
            knots = np.r_[[0] * 3, np.linspace(0, 1, count - 2), [1] * 3]
        elif len(knots) == count - 4:
            knots = np.r_[[0] * 4, knots, [1] * 4]
        at = np.clip(np.linspace(0, 1, CURVE_POINTS), 0, 1 - 1e-12)
        basis = np.array([BSpline(knots, np.eye(count)[k], 3)(at) for k in range(count)]).T
        return np.einsum("sn,fnk->fsk", basis, points)

    @staticmethod
    def at_equal_steps(curve):
        if not np.isfinite(curve).all():
            return np.full((8, 2), np.nan)
        length = np.r_[0, np.cumsum(np.hypot(*np.diff(curve, axis=0).T))]
        at = np.linspace(0, length[-1], 10)[1:-1]
        return np.c_[np.interp(at, length, curve[:, 0]), np.interp(at, length, curve[:, 1])]

    def on_scale_of(self, recorded, own_wind=False):
        scale = np.sqrt(np.nanmedian(recorded.area) / np.nanmedian(self.area))
        self.tip, self.eight, self.area = self.tip * scale, self.eight * scale, self.area * scale**2
        self.wind = self.wind if own_wind else recorded.wind
        return self

    def masked(self, mask, random):
        self.signals = np.column_stack([self.tip, np.sqrt(self.area), self.eight[:, 2], self.eight[:, 5]])
        self.heard = self.signals + mask * MASKED * random.normal(size=self.signals.shape)
        return self

    def burst(self):
        rise = np.diff(self.tip[:, 1], 2)
        return np.nanmax(np.abs(rise)) / np.nanstd(rise)

    def answer(self):
        """Mean correlation of the square root of the area with the wind 100 ms before, over windows of two seconds."""
        lag, rows, found = RATE // 10, 2 * RATE, []
        for first in range(0, len(self.area) - rows, rows // 8):
            y, u = np.sqrt(self.area[first:first + rows]), self.wind[first:first + rows]
            if np.isfinite(y).all() and u.std() > 0:
                found.append(np.mean((y[lag:] - y.mean()) * (u[:-lag] - u.mean())) / (u.std() * y.std()))
        return np.mean(found)

    def powers(self):
        """Power of every signal in bands, over windows of two seconds."""
        rows, powers = 2 * RATE, []
        for first in range(0, len(self.signals) - rows, rows // 2):
            values = self.signals[first:first + rows]
            if np.isfinite(values).all():
                powers.append(np.abs(np.fft.rfft((values - values.mean(0)) * np.hanning(rows)[:, None], axis=0)) ** 2)
        power, at = np.mean(powers, 0), np.fft.rfftfreq(rows, 1 / RATE)
        return np.array([power[(at >= low) & (at < high)].sum(0) for low, high in zip(BANDS, BANDS[1:])]).T

    def copied(self, source):
        """Seconds of the longest stretch in wind that stays near a stretch of the source: at rest all flames are alike."""
        height = np.nanmedian(self.tip[:, 1])
        run, longest = np.zeros(len(source.eight) + 1, int), 0
        for points, wind in zip(self.eight, self.wind):
            near = np.hypot(*np.moveaxis(source.eight - points, 2, 0)).mean(1) <= COPY * height
            near &= abs(wind) > WINDS[0][1]
            run[1:] = np.where(near, run[:-1] + 1, 0)
            longest = max(longest, run.max())
        return longest / RATE


def motion(clip, first, rows):
    points = clip.eight[first:first + rows:3]
    return np.r_[points.ravel(), np.diff(points, axis=0).ravel()]


def spectra(clip, first, rows):
    values = clip.heard[first:first + rows]
    power = np.abs(np.fft.rfft((values - values.mean(0)) * np.hanning(rows)[:, None], axis=0)) ** 2
    edges = np.unique(np.round(np.geomspace(1, rows // 2, 14)).astype(int))
    return np.log(np.array([power[a:b].mean(0) for a, b in zip(edges[:-1], edges[1:])]) + 1e-9).ravel()


def statistics(clip, first, rows):
    values, wind = clip.heard[first:first + rows], clip.wind[first:first + rows]
    speed, acceleration = np.diff(values, axis=0), np.diff(values, 2, axis=0)
    out = []
    for j in range(values.shape[1]):
        y = np.abs(values[:, j]) if j % 2 == 0 else values[:, j]
        for lag in LAGS:
            together = np.mean((y[lag:] - y.mean()) * (wind[:rows - lag] - wind.mean()))
            out.append(together / (wind.std() * y.std() + 1e-9))
        v, a = speed[:, j], acceleration[:, j]
        out += [np.log(v.std() + 1e-9), np.log(a.std() + 1e-9), np.mean(v**4) / (np.mean(v**2) ** 2 + 1e-18),
                np.max(np.abs(a)) / (a.std() + 1e-9), np.mean(v[1:] * v[:-1]) / (np.var(v) + 1e-12)]
    for low, high in WINDS:
        blown = (wind[1:] > low) & (wind[1:] <= high)
        enough = blown.sum() > 5
        out += [np.log(speed[blown].std(0).mean() + 1e-6), values[1:][blown].std(0).mean()] if enough else [0.0, 0.0]
    return np.nan_to_num(np.r_[out, np.corrcoef(values.T)[np.triu_indices(values.shape[1], 1)]])


def trees():
    return HistGradientBoostingClassifier(
        max_iter=60, learning_rate=0.15, random_state=0, max_leaf_nodes=12, l2_regularization=1, max_bins=64)


def lines():
    return make_pipeline(StandardScaler(), LogisticRegression(C=0.1, max_iter=500))


# Name, rows of a window and from one to the next at 60 rows a second, features, classifier.
JUDGES = (
    ("half a second, trees", 30, 6, motion, trees),
    ("half a second, logistic", 30, 6, motion, lines),
    ("two seconds, spectra, logistic", 120, 15, spectra, lines),
    ("two seconds, statistics, logistic", 120, 15, statistics, lines),
    ("two seconds, statistics, trees", 120, 15, statistics, trees),
)


def held_out_accuracy(recorded, played, judge):
    """Held-out accuracy of every pair, each left out once, and windows a side."""
    _, rows, hop, features, make = judge
    x, y, pairs = [], [], []
    for k, (a, b) in enumerate(zip(recorded, played)):
        for first in range(0, min(len(a.tip), len(b.tip)) - rows, hop):
            pair = features(a, first, rows), features(b, first, rows)
            if all(np.isfinite(one).all() for one in pair):
                x += pair
                y += [0, 1]
                pairs += [k, k]
    x, y, pairs = np.array(x), np.array(y), np.array(pairs)
    right = np.zeros(len(y), bool)
    for train, test in LeaveOneGroupOut().split(x, y, pairs):
        right[test] = make().fit(x[train], y[train]).predict(x[test]) == y[test]
    return np.array([right[pairs == k].mean() for k in np.unique(pairs)]), len(y) // 2


def interval(of_pairs):
    """Of the mean over pairs, 95 %."""
    again = np.random.default_rng(0).choice(of_pairs, (RESAMPLES, len(of_pairs))).mean(1)
    return np.quantile(again, (0.025, 0.975))


def compare(recorded, plays, floor, most):
    """Prints every judge's accuracy, the floor and the difference; whether all differences are surely below `most`."""
    held = True
    print(f"{'classifier':34} {'accuracy, 95 %':22} {'plays':16} {'floor':8} difference, 95 %")
    for judge in JUDGES:
        found = [held_out_accuracy(recorded, play, judge) for play in plays]
        of_pairs = np.mean([one[0] for one in found], 0)
        means = [one[0].mean() for one in found]
        low, high = interval(of_pairs)
        line = f"{judge[0]:34} {of_pairs.mean():.3f} [{low:.3f}, {high:.3f}]   {min(means):.3f} to {max(means):.3f}"
        if floor:
            least = held_out_accuracy(recorded, floor, judge)[0]
            low, high = interval(of_pairs - least)
            held &= high < most
            line += f"   {least.mean():.3f}    {(of_pairs - least).mean():+.3f} [{low:+.3f}, {high:+.3f}]"
        print(f"{line}   {found[0][1]} windows a side", flush=True)
    return held


def describe(recorded, plays, learned):
    """Prints where played flames differ: in bursts, in their answer to the wind, by band and signal, and what they copy."""
    for title, figure in (("peak acceleration over deviation", Clip.burst), ("area with the wind 100 ms before", Clip.answer)):
        found = [np.mean([figure(clip) for clip in play]) for play in [recorded, *plays]]
        print(f"{title:36} {np.mean(found[1:]):.2f}   recorded {found[0]:.2f}")
    power = [np.mean([clip.powers() for clip in play], 0) for play in [recorded, *plays]]
    decibels = 10 * np.log10(np.mean(power[1:], 0) / power[0])
    print("power, dB over recorded, by band in Hz  " + " ".join(f"{f'{low:g}–{high:g}':>7}" for low, high in zip(BANDS, BANDS[1:])))
    for signal, row in zip(SIGNALS, decibels):
        print(f"  {signal:37} " + " ".join(f"{of:+7.1f}" for of in row))
    if learned:
        longest = [max(clip.copied(source) for clip in play for source in learned) for play in [recorded, *plays]]
        print(f"{'longest copy of what was learned, s':36} {max(longest[1:]):.2f}   recorded {longest[0]:.2f}")


def main():
    groups = [[]]
    for argument in sys.argv[1:]:
        groups.append([]) if argument == "--" else groups[-1].append(argument)
    parser = argparse.ArgumentParser(usage=__doc__.replace("%", "%%").replace("usage: ", "", 1))
    parser.add_argument("--mask", type=float, default=0.25)
    parser.add_argument("--above-floor", type=float, default=np.inf)
    for name in ("--floor", "--learned"):
        parser.add_argument(name, type=lambda names: names.split(","), default=[])
    parser.add_argument("recorded", nargs="+")
    options = parser.parse_args(groups[0])
    count = len(options.recorded)
    if count < 2 or len(groups) < 2 or any(len(group) != count for group in groups[1:] + [options.floor or options.recorded]):
        sys.exit("at least two recordings, and as many files in every play and in --floor as there are; see --help")
    random = np.random.default_rng(1)
    recorded = [Clip(path).masked(options.mask, random) for path in options.recorded]

    def beside(paths, own_wind=False):
        return [Clip(path).on_scale_of(real, own_wind).masked(options.mask, random) for path, real in zip(paths, recorded)]

    plays = [beside(group) for group in groups[1:]]
    held = compare(recorded, plays, beside(options.floor, own_wind=True), options.above_floor)
    describe(recorded, plays, [Clip(path).on_scale_of(recorded[0]) for path in options.learned])
    return 0 if held else 1


if __name__ == "__main__":
    warnings.filterwarnings("ignore")
    sys.exit(main())
