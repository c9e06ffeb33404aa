"""Can gradient-boosted trees tell windows of two sides apart? What fidelity.py and fidelity_leaf.py ask them with."""

import numpy as np
import sklearn
from sklearn.ensemble import HistGradientBoostingClassifier

FOLDS = 5
MAX_WINDOWS = 500
TREES = f"gradient-boosted trees (scikit-learn {sklearn.__version__})"


def thinned(where):
    """At most MAX_WINDOWS of the chosen rows, evenly spread."""
    chosen = np.flatnonzero(where)
    if len(chosen) <= MAX_WINDOWS:
        return chosen
    return chosen[np.linspace(0, len(chosen) - 1, MAX_WINDOWS).astype(int)]


def accuracies(x, y, groups, splits, **settings):
    """Held-out balanced accuracy of every split: no group is on both sides of a fold. Settings are the trees' own."""
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
                max_leaf_nodes=8, min_samples_leaf=10, random_state=split, **settings)
            trees.fit(x[train], y[train])
            right[test] = trees.predict(x[test]) == y[test]
        found.append(np.mean([right[y == label].mean() for label in np.unique(y)]))
    return np.array(found)
