#!/usr/bin/env python3
"""The peers of bench/run_bench.cpp: an order-4 filter for 10^6 steps, bare and with Gaussian noise.

  OMP_NUM_THREADS=1 python3 bench/peers/run.py        needs python3-numpy and python3-scipy
"""

import time

import numpy
import scipy
import scipy.signal

STEPS = 1_000_000
A = [1.0, -1.7, 0.85, 0.085, -0.105]
B = [0.02, 0.015, -0.004, 0.002]


def median_ms(work, repeats=11):
    work()
    times = []
    for _ in range(repeats):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return 1e3 * float(numpy.median(times))


def main():
    random = numpy.random.default_rng(1)
    wind = random.random(STEPS)

    def bare():
        return scipy.signal.lfilter(B, A, wind)

    def noisy():
        return bare() + scipy.signal.lfilter([1.0], A, 0.006 * random.standard_normal(STEPS))

    print(f"SciPy {scipy.__version__}, NumPy {numpy.__version__}")
    print(f"lfilter, order 4, 10^6 steps                     {median_ms(bare):8.2f} ms")
    print(f"lfilter, order 4, 10^6 steps, with Gaussian noise {median_ms(noisy):7.2f} ms")


if __name__ == "__main__":
    main()
