"""How like recorded flames are synthesized ones? One table for every wind.

usage: likeness.py FOLDER [--splits 20] [--few 4] [--surely NAME]…

FOLDER/WIND/figures.csv and windows.csv are what wisp_verify_flame or wisp_verify_baselines left there. A line of figures:
name, energy distance, log-spectral distance, speeds, fit of the tip, operations, bytes. A line of windows: side, clip,
block, features of half a second; the sides are `recorded`; `again`, other takes in the same wind, where only chance
differs; and one for everything that plays.

What is added here is whether a classifier can tell a side from the recorded one: gradient-boosted trees, five folds over
whole blocks (windows that overlap are alike for that reason alone), repeated over some splits: FEW, and SPLITS for the
floor and whatever is named with --surely. 0.5 is indistinguishable; recorded against `again` is the floor,
recorded against the same windows with their frames in random order the ceiling.
"""

import argparse
import csv
import pathlib

import numpy as np
import sklearn
from sklearn.ensemble import HistGradientBoostingClassifier

FOLDS = 5
CHANNELS = 16


def read(path):
    """Side, clip, block and features of every window."""
    sides, clips, blocks, features = [], [], [], []
    with open(path) as lines:
        for side, clip, block, *values in csv.reader(lines):
            sides.append(side)
            clips.append(int(clip))
            blocks.append(int(block))
            features.append(np.array(values, dtype=np.float32))
    return np.array(sides), np.array(clips), np.array(blocks), np.array(features)


def thinned(where, most=500):
    """At most so many of the chosen windows, evenly spread."""
    chosen = np.flatnonzero(where)
    if len(chosen) <= most:
        return chosen
    return chosen[np.linspace(0, len(chosen) - 1, most).astype(int)]


def accuracies(x, y, groups, splits):
    """Held-out balanced accuracy of every split: no group is on both sides of a fold."""
    names = np.unique(groups)
    found = []
    for split in range(splits):
        random = np.random.default_rng(split)
        fold_of = dict(zip(random.permutation(names), np.arange(len(names)) % FOLDS))
        folds = np.array([fold_of[group] for group in groups])
        right = np.zeros(len(y), dtype=bool)
        for fold in range(FOLDS):
            train, test = folds != fold, folds == fold
            if not test.any() or len(np.unique(y[train])) < 2:
                continue
            trees = HistGradientBoostingClassifier(
                max_iter=60, max_leaf_nodes=8, min_samples_leaf=10, max_bins=63, random_state=split)
            trees.fit(x[train], y[train])
            right[test] = trees.predict(x[test]) == y[test]
        found.append(np.mean([right[y == label].mean() for label in np.unique(y)]))
    return np.array(found)


def shuffled(x, random):
    """Windows with their frames in random order, and the differences that those frames then have."""
    frames = x.shape[1] // (2 * CHANNELS)
    out = np.empty_like(x)
    for row, window in enumerate(x):
        values = window.reshape(2, frames, CHANNELS)[0][random.permutation(frames)]
        steps = np.diff(values, axis=0, prepend=values[:1])
        out[row] = np.stack([values, steps]).reshape(-1)
    return out


class Windows:
    """The windows of one wind."""

    def __init__(self, path):
        self.sides, clips, blocks, self.features = read(path)
        # A recorded block and that of the same time on another side have the same wind: they stay on one side of a fold.
        self.groups = clips * 100000 + blocks
        self.real = thinned(self.sides == "recorded")

    def told(self, side, splits):
        made = thinned(self.sides == side)
        both = np.concatenate([self.real, made])
        return accuracies(self.features[both], self.sides[both] == "recorded", self.groups[both], splits)

    def told_shuffled(self, splits):
        x = self.features[self.real]
        both = np.concatenate([x, shuffled(x, np.random.default_rng(1))])
        labels = np.repeat([True, False], len(x))
        return accuracies(both, labels, np.tile(self.groups[self.real], 2), splits)


def print_table(folder, arguments):
    windows = Windows(folder / "windows.csv")
    print(f"\n{folder.name} ({len(windows.real)} recorded windows)\n\n"
          "| what plays | energy distance | log-spectral, dB | speeds, sd | told apart | tip's fit, % | operations | bytes |"
          "\n| --- | --- | --- | --- | --- | --- | --- | --- |")
    with open(folder / "figures.csv") as lines:
        for name, *figures in csv.reader(lines):
            sure = name in ("floor", *arguments.surely)
            splits = arguments.splits if sure else arguments.few
            if name == "ceiling":
                found = windows.told_shuffled(arguments.few)
            else:
                found = windows.told("again" if name == "floor" else name, splits)
            figures.insert(3, f"{found.mean():.3f} ± {found.std():.3f}")
            print(f"| {name} | " + " | ".join(figures) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--splits", type=int, default=20)
    parser.add_argument("--few", type=int, default=4)
    parser.add_argument("--surely", action="append", default=[])
    arguments = parser.parse_args()
    print(f"== Told apart by gradient-boosted trees (scikit-learn {sklearn.__version__}): balanced accuracy, {FOLDS} folds "
          f"over blocks; {arguments.splits} splits for the floor and what must be sure, {arguments.few} for the rest")
    for folder in sorted(path.parent for path in arguments.folder.glob("*/figures.csv")):
        print_table(folder, arguments)


if __name__ == "__main__":
    main()
