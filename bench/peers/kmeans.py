#!/usr/bin/env python3
"""K-means against scikit-learn's: the same 100 000 rows of 12 numbers, 6 clusters, the best of 10 starts, by both of its
algorithms, on as many threads, one after the other in one run.

  python3 bench/peers/kmeans.py build/release/bin/wisp_bench_kmeans        needs python3-sklearn
"""

import json
import subprocess
import sys
import time

import numpy
import sklearn
import sklearn.cluster
from threadpoolctl import threadpool_limits

ROWS, COLUMNS, CLOUDS = 100_000, 12, 9
REPEATS = 3


def words(count):
    """The upper halves of a linear congruential generator of 64 bits, over 2^32: its k-th state is
    a^k + c (1 + a + … + a^(k−1)), modulo 2^64 as unsigned numbers are."""
    a, c = numpy.uint64(6364136223846793005), numpy.uint64(1442695040888963407)
    powers = numpy.multiply.accumulate(numpy.full(count, a, dtype=numpy.uint64))
    sums = numpy.concatenate([[numpy.uint64(1)], numpy.uint64(1) + numpy.add.accumulate(powers)[:-1]])
    return ((powers + c * sums) >> numpy.uint64(32)) / 4294967296.0


def clouds():
    drawn = words(CLOUDS * COLUMNS + 3 * ROWS * COLUMNS)
    middles = 3 * drawn[: CLOUDS * COLUMNS].reshape(CLOUDS, COLUMNS)
    noise = drawn[CLOUDS * COLUMNS :].reshape(ROWS, COLUMNS, 3).sum(axis=2) - 1.5
    return middles[numpy.arange(ROWS) % CLOUDS] + 1.5 * noise


def ours(program):
    """Milliseconds (by the clock, and of all processors together) and inertia."""
    said = subprocess.run([program, f"--benchmark_repetitions={REPEATS}", "--benchmark_format=json"], check=True,
                          capture_output=True, text=True).stdout
    run = next(run for run in json.loads(said)["benchmarks"] if run.get("aggregate_name") == "median")
    return (run["real_time"], run["cpu_time"]), run["inertia"]


def theirs(rows, algorithm):
    clock, processors, inertias = [], [], []
    with threadpool_limits(limits=1):
        for seed in range(REPEATS):
            start, work = time.perf_counter(), time.process_time()
            found = sklearn.cluster.KMeans(6, n_init=10, algorithm=algorithm, random_state=seed).fit(rows)
            clock.append(1e3 * (time.perf_counter() - start))
            processors.append(1e3 * (time.process_time() - work))
            inertias.append(found.inertia_)
    return (sorted(clock)[REPEATS // 2], sorted(processors)[REPEATS // 2]), min(inertias)


def main():
    rows = clouds()
    print(f"k-means of {ROWS} × {COLUMNS}, 6 clusters, 10 starts; medians of {REPEATS}; scikit-learn {sklearn.__version__}")
    own, inertia = ours(sys.argv[1])
    print(f"  one thread: wisp {own[0]:.0f} ms ({own[1]:.0f} of processors), inertia {inertia:.9g}")
    for algorithm in ("lloyd", "elkan"):
        peer, peer_inertia = theirs(rows, algorithm)
        print(f"    scikit-learn, {algorithm}: {peer[0]:.0f} ms ({peer[1]:.0f}), inertia {peer_inertia:.9g}: wisp is "
              f"{peer[0] / own[0]:.1f} times as fast ({peer[1] / own[1]:.1f} by processors' time), "
              f"its inertia {inertia / peer_inertia:.8f} of theirs")


if __name__ == "__main__":
    main()
