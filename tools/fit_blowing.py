#!/usr/bin/env python3
"""Fits the likeness of blowing (src/sound/wind_likeness_weights.hpp) and prints its errors, cross-validated over recordings.

    build/release/bin/wisp_verify_wind --features > features.csv
    tools/fit_blowing.py features.csv > src/sound/wind_likeness_weights.hpp

A small network: the features of FEATURES, a layer of rectified sums, a logistic output. A recording's weight is the root of
its number of hops; both classes have the same total weight. Steady sounds (STEADY) are left out: the background level rejects
them, not these features. Needs numpy and scikit-learn.
"""
import csv
import sys
import warnings

import numpy as np
from sklearn.metrics import roc_auc_score
from sklearn.neural_network import MLPClassifier

FEATURES = ["low", "high", "voicing", "tone", "peaked", "voice", "newest", "flutter", "clipped"]
STEADY = ["seawaves", "helicopter", "traffic", "fan"]
HIDDEN = 8
FOLDS = 5


def read(path):
    with open(path) as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] not in STEADY and float(row["loudness"]) > -60]
    features = np.array([[float(row[name]) for name in FEATURES] for row in rows])
    blowing = np.array([int(row["blowing"]) for row in rows])
    kind = np.array([row["kind"] for row in rows])
    made = ["made" in row["from"] for row in rows]
    source = np.array([row["kind"] + row["from"] if m else row["from"] for row, m in zip(rows, made)])
    return features, blowing, kind, source


def weights(blowing, source):
    weight = np.zeros(len(blowing))
    for name in set(source):
        here = source == name
        weight[here] = 1 / np.sqrt(here.sum())
    for label in (0, 1):
        weight[blowing == label] /= weight[blowing == label].sum()
    return weight / weight.sum()


def fit(features, blowing, weight, random):
    """Returns a network for unscaled features: their means and scales are folded into its first layer."""
    chosen = random.choice(len(blowing), 60000, p=weight)
    middle, scale = features[chosen].mean(0), features[chosen].std(0)
    network = MLPClassifier((HIDDEN,), alpha=1e-2, max_iter=80, random_state=0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        network.fit((features[chosen] - middle) / scale, blowing[chosen])
    first = network.coefs_[0] / scale[:, None]
    return first, network.intercepts_[0] - middle @ first, network.coefs_[1][:, 0], network.intercepts_[1][0]


def likeness(net, features):
    first, bias, second, offset = net
    return 1 / (1 + np.exp(-(np.maximum(features @ first + bias, 0) @ second + offset)))


def judge(features, blowing, kind, source, weight):
    random = np.random.RandomState(1)
    names = random.permutation(sorted(set(source)))
    fold = {name: k % FOLDS for k, name in enumerate(names)}
    folds = np.array([fold[name] for name in source])
    unseen = np.zeros(len(blowing))
    for k in range(FOLDS):
        learned = folds != k
        share = weight[learned] / weight[learned].sum()
        net = fit(features[learned], blowing[learned], share, random)
        unseen[folds == k] = likeness(net, features[folds == k])
    print(f"held out by recording: AUC {roc_auc_score(blowing, unseen, sample_weight=weight):.4f}", file=sys.stderr)
    for name in sorted(set(kind)):
        here = kind == name
        label = blowing[here][0]
        wrong = (unseen[here] > 0.5) != label
        print(f"  {name:10} {'blowing' if label else 'not':8} {here.sum():7} hops, taken for the other: {100 * wrong.mean():5.1f} %",
              file=sys.stderr)


def row(values):
    return "{" + ", ".join(f"{value:.6f}F" for value in values) + "}"


def main():
    features, blowing, kind, source = read(sys.argv[1])
    weight = weights(blowing, source)
    judge(features, blowing, kind, source, weight)
    first, bias, second, offset = fit(features, blowing, weight, np.random.RandomState(1))
    alive = np.abs(first).max(0) > 1e-6  # a unit may die in training
    first, bias, second = first[:, alive], bias[alive], second[alive]
    print(f"""#pragma once
// Made by tools/fit_blowing.py from what `wisp_verify_wind --features` prints. Do not edit.

namespace wisp::wind {{

constexpr int kLikenessUnits = {len(bias)}, kLikenessFeatures = {len(FEATURES)};
/// Of {", ".join(FEATURES)}; a row for each unit.
constexpr float kLikenessFirst[kLikenessUnits][kLikenessFeatures] = {{""")
    for unit in first.T:
        print(f"    {row(unit)},")
    print(f"""}};
constexpr float kLikenessBias[kLikenessUnits] = {row(bias)};
constexpr float kLikenessSecond[kLikenessUnits] = {row(second)};
constexpr float kLikenessOffset = {offset:.6f}F;

}}  // namespace wisp::wind""")


main()
