#!/usr/bin/env python3
"""The peer of bench/kmeans_bench.cpp: scikit-learn's k-means of the same 100 000 rows of 12 numbers, 6 clusters, the
best of 10 starts, by both of its algorithms.

  python3 bench/peers/kmeans.py        needs python3-sklearn
"""

import time

import numpy
import sklearn
import sklearn.cluster

ROWS, COLUMNS, CLOUDS = 100_000, 12, 9


def words(count):
    """The upper halves of a linear congruential generator of 64 bits, over 2^32."""
    out = numpy.empty(count)
    state, mask = 1, (1 << 64) - 1
    for k in range(count):
        state = (state * 6364136223846793005 + 1442695040888963407) & mask
        out[k] = (state >> 32) / 4294967296.0
    return out


def clouds():
    drawn = words(CLOUDS * COLUMNS + 3 * ROWS * COLUMNS)
    middles = 3 * drawn[: CLOUDS * COLUMNS].reshape(CLOUDS, COLUMNS)
    noise = drawn[CLOUDS * COLUMNS :].reshape(ROWS, COLUMNS, 3).sum(axis=2) - 1.5
    return middles[numpy.arange(ROWS) % CLOUDS] + 1.5 * noise


def main():
    rows = clouds()
    print(f"scikit-learn {sklearn.__version__}")
    for algorithm in ("lloyd", "elkan"):
        times = []
        for seed in range(3):
            start = time.perf_counter()
            found = sklearn.cluster.KMeans(6, n_init=10, algorithm=algorithm, random_state=seed).fit(rows)
            times.append(time.perf_counter() - start)
        print(f"{algorithm}: {1e3 * sorted(times)[1]:.0f} ms, inertia {found.inertia_:.6g}")


if __name__ == "__main__":
    main()
