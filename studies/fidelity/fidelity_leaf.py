#!/usr/bin/env python3
"""Can a classifier tell recorded falls from synthesized ones, and by what?

usage: fidelity_leaf.py WINDOWS.csv [SPLITS]      (wisp_verify_falls windows FILE writes them)

Every line: recorded, synthesized or shuffled, fall, then mean, standard deviation, least and most of six signals over a
window of two and a half mean segments. Gradient-boosted trees, 500 windows a side, five folds over whole falls, repeated
over 20 splits. 0.5 is indistinguishable. Beside it the floor, recorded against recorded (every other fall to a side),
and the ceiling, recorded against the same falls with their rows in random order. Then what gives synthesized falls away:
how sure the trees are with one signal alone, and without it.
"""

import sys

import numpy as np

import two_sample
from two_sample import accuracies, thinned

SPLITS = int(sys.argv[2]) if len(sys.argv) > 2 else 20
MOST = 0.60


def read(path):
    with open(path) as lines:
        names = lines.readline().strip().split(",")[2:]
        cells = [line.strip().split(",") for line in lines]
    sides = np.array([cell[0] for cell in cells])
    falls = np.array([int(cell[1]) for cell in cells])
    return names, sides, falls, np.array([cell[2:] for cell in cells], dtype=float)


def main():
    names, sides, falls, features = read(sys.argv[1])
    print(f"== Classifier two-sample test by {two_sample.TREES}: balanced accuracy, {two_sample.MAX_WINDOWS} windows a side, "
          f"{two_sample.FOLDS} folds over falls, {SPLITS} splits")

    def told(first, second, columns=slice(None), splits=SPLITS):
        rows = np.concatenate([thinned(first), thinned(second)])
        labels = np.repeat([False, True], [len(thinned(first)), len(thinned(second))])
        return accuracies(features[rows][:, columns], labels, falls[rows], splits, max_iter=100)

    def say(what, found):
        print(f"  {what:46s} {found.mean():.3f} ± {found.std(ddof=1):.3f}", flush=True)

    recorded, made, mixed = (sides == side for side in ("recorded", "synthesized", "shuffled"))
    value = told(recorded, made)
    say("recorded against synthesized", value)
    say("floor: recorded against recorded", told(recorded & (falls % 2 == 0), recorded & (falls % 2 == 1)))
    say("ceiling: recorded against shuffled", told(recorded, mixed))
    few = max(2, SPLITS // 5)
    for signal in dict.fromkeys(name.split()[0] for name in names):
        own = [k for k, name in enumerate(names) if name.split()[0] == signal]
        others = [k for k in range(len(names)) if k not in own]
        say(f"  with {signal} alone", told(recorded, made, own, few))
        say(f"  without {signal}", told(recorded, made, others, few))
    print(f"  {'held  ' if value.mean() <= MOST else 'MISSED'} recorded against synthesized at most {MOST:.2f}")
    sys.exit(0 if value.mean() <= MOST else 1)


if __name__ == "__main__":
    main()
