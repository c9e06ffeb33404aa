"""Can a classifier tell recorded flames from synthesized ones?

usage: likeness.py WINDOWS.csv [SPLITS]      (wisp_verify_flame FOLDER writes the windows)

Every line: side, clip, block, features of a window of half a second. The sides are `recorded`; `again`, other takes in
the same wind, where only chance differs; and one for every kind of noise that a model may have. Gradient-boosted trees,
five folds over whole blocks (windows that overlap are alike for that reason alone), repeated over 20 splits. 0.5 is
indistinguishable; recorded against `again` is the floor, recorded against the same windows with their frames in random
order the ceiling.
"""

import csv
import sys

import numpy as np
import sklearn
from sklearn.ensemble import HistGradientBoostingClassifier

SPLITS = int(sys.argv[2]) if len(sys.argv) > 2 else 20
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
            features.append([float(value) for value in values])
    return np.array(sides), np.array(clips), np.array(blocks), np.array(features, dtype=np.float32)


def thinned(where, most=500):
    """At most so many of the chosen windows, evenly spread."""
    chosen = np.flatnonzero(where)
    if len(chosen) <= most:
        return chosen
    return chosen[np.linspace(0, len(chosen) - 1, most).astype(int)]


def accuracies(x, y, groups):
    """Held-out balanced accuracy of every split: no group is on both sides of a fold."""
    names = np.unique(groups)
    found = []
    for split in range(SPLITS):
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


def report(name, x, y, groups):
    found = accuracies(x, y, groups)
    print(f"  {name:42s} {found.mean():.3f} ± {found.std():.3f}   ({len(y)} windows)", flush=True)


def shuffled(x, random):
    """Windows with their frames in random order, and the differences that those frames then have."""
    frames = x.shape[1] // (2 * CHANNELS)
    out = np.empty_like(x)
    for row, window in enumerate(x):
        values = window.reshape(2, frames, CHANNELS)[0][random.permutation(frames)]
        steps = np.diff(values, axis=0, prepend=values[:1])
        out[row] = np.stack([values, steps]).reshape(-1)
    return out


def main():
    sides, clips, blocks, features = read(sys.argv[1])
    print(f"== Told apart by gradient-boosted trees (scikit-learn {sklearn.__version__}): balanced accuracy, "
          f"{FOLDS} folds over blocks, {SPLITS} splits")
    # A recorded block and that of the same time on another side have the same wind: they stay on one side of a fold.
    group = clips * 100000 + blocks
    real = thinned(sides == "recorded")

    def against(name, side):
        made = thinned(sides == side)
        both = np.concatenate([real, made])
        report(name, features[both], sides[both] == "recorded", group[both])

    against("floor: recorded, another take", "again")
    for side in dict.fromkeys(sides):
        if side not in ("recorded", "again"):
            against(f"recorded against {side}", side)
    mixed = shuffled(features[real], np.random.default_rng(1))
    report("ceiling: recorded against shuffled frames", np.concatenate([features[real], mixed]),
           np.repeat([True, False], len(real)), np.concatenate([group[real], group[real]]))


if __name__ == "__main__":
    main()
