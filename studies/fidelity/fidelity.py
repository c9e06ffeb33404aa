"""How like recorded flames are synthesized ones? One table for every wind.

usage: fidelity.py FOLDER [--splits 6] [--few 4] [--surely NAME]… [--above-floor D]

FOLDER/WIND/figures.csv and windows.csv are what wisp_verify_flame or wisp_verify_baselines left there. A line of figures:
name, energy distance, log-spectral distance, speeds, fit of the tip, operations, bytes. A line of windows: side, clip,
block, features of half a second; the sides are `recorded`; `again`, other takes in the same wind, where only chance
differs; and one for everything that plays.

What is added here is whether a classifier can tell a side from the recorded one: gradient-boosted trees, five folds over
whole blocks (windows that overlap are alike for that reason alone), repeated over some splits: FEW, and SPLITS for the
floor and whatever is named with --surely. 0.5 is indistinguishable; recorded against `again` is the floor,
recorded against the same windows with their frames in random order the ceiling. With --above-floor the exit status is 1 where
the accuracy of what is named with --surely is more than D above the floor of its table.
"""

import argparse
import csv
import pathlib
import sys

import numpy as np

import two_sample
from two_sample import accuracies, thinned

CHANNELS = 16
SETTINGS = {"max_iter": 60, "max_bins": 63}


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
        return accuracies(self.features[both], self.sides[both] == "recorded", self.groups[both], splits, **SETTINGS)

    def told_shuffled(self, splits):
        x = self.features[self.real]
        both = np.concatenate([x, shuffled(x, np.random.default_rng(1))])
        labels = np.repeat([True, False], len(x))
        return accuracies(both, labels, np.tile(self.groups[self.real], 2), splits, **SETTINGS)


def print_table(folder, arguments):
    """Prints a wind's table. Returns the floor, and the accuracies of what must be sure."""
    floor, sure_accuracies = np.nan, []
    windows = Windows(folder / "windows.csv")
    print(f"\n{folder.name} ({len(windows.real)} recorded windows)\n\n"
          "| what plays | energy distance | log-spectral, dB | speeds, sd | accuracy | tip's fit, % | operations | bytes |"
          "\n| --- | --- | --- | --- | --- | --- | --- | --- |")
    with open(folder / "figures.csv") as lines:
        for name, *figures in csv.reader(lines):
            sure = name in ("floor", *arguments.surely)
            splits = arguments.splits if sure else arguments.few
            if name == "ceiling":
                found = windows.told_shuffled(arguments.few)
            else:
                found = windows.told("again" if name == "floor" else name, splits)
            if name == "floor":
                floor = found.mean()
            if name in arguments.surely:
                sure_accuracies.append(found.mean())
            figures.insert(3, f"{found.mean():.3f} ± {found.std():.3f}")
            print(f"| {name} | " + " | ".join(figures) + " |", flush=True)
    return floor, sure_accuracies


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--splits", type=int, default=6)
    parser.add_argument("--few", type=int, default=4)
    parser.add_argument("--surely", action="append", default=[])
    parser.add_argument("--above-floor", type=float)
    arguments = parser.parse_args()
    print(f"== Classifier two-sample test by {two_sample.TREES}: balanced accuracy, {two_sample.FOLDS} folds over blocks; "
          f"{arguments.splits} splits for the floor and what must be sure, {arguments.few} for the rest")
    folders = sorted(path.parent for path in arguments.folder.glob("*/figures.csv"))
    if not folders:
        sys.exit(f"{arguments.folder} has no WIND/figures.csv; wisp_verify_flame or wisp_verify_baselines makes them")
    differences = []
    for folder in folders:
        floor, sure_accuracies = print_table(folder, arguments)
        differences += [accuracy - floor for accuracy in sure_accuracies]
    if arguments.surely and not differences:
        sys.exit(f"nothing is called {' or '.join(arguments.surely)}")
    if arguments.above_floor is not None and not all(difference <= arguments.above_floor for difference in differences):
        sys.exit(f"classifier accuracy {max(differences):.3f} above the floor, expected at most {arguments.above_floor}")


if __name__ == "__main__":
    main()
