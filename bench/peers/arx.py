#!/usr/bin/env python3
"""Identification beside its peers, one thread, in one run: wisp_bench_arx, NumPy and, where it is installed, GNU Octave.

  bench/peers/arx.py [PROGRAM]     PROGRAM: default build/release/bin/wisp_bench_arx

needs python3-numpy, python3-scipy and libopenblas0-serial (Debian's default BLAS is a slow reference one); octave and
octave-control are optional. Figures are processor time, the median of several repeats; peers and Wisp take turns, so that
what else the machine does troubles both.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy
import scipy
import scipy.linalg
import scipy.signal

ROUNDS = 5


def polynomial(poles):
    return numpy.real(numpy.poly(poles))[1:]


def simulate(a, b, delay, u, e):
    """y(t) + a1 y(t-1) + … = b1 u(t-delay) + … + e(t), a: order × ny × ny, b: order × ny × nu."""
    rows, outputs = e.shape
    x = e.copy()
    for lag, matrix in enumerate(b):
        x[delay + lag :] += u[: rows - delay - lag] @ matrix.T
    y = numpy.zeros((rows, outputs))
    for t in range(rows):
        y[t] = x[t] - sum(a[l] @ y[t - 1 - l] for l in range(min(len(a), t)))
    return y


def make_data(folder):
    random = numpy.random.default_rng(20240607)
    rows = 100_000
    a = numpy.zeros((4, 2, 2))
    a[:, 0, 0] = polynomial([0.92 * numpy.exp(0.35j), 0.92 * numpy.exp(-0.35j), 0.55, -0.4])
    a[:, 1, 1] = polynomial([0.88 * numpy.exp(0.9j), 0.88 * numpy.exp(-0.9j), 0.3, 0.7])
    a[:, 0, 1] = [-0.12, 0.05, 0.03, -0.02]
    a[:, 1, 0] = [0.08, -0.06, 0.02, 0.01]
    b = numpy.zeros((4, 2, 1))
    b[:, 0, 0] = [0.5, 0.25, -0.1, 0.05]
    b[:, 1, 0] = [0.2, -0.3, 0.15, 0.08]
    noise = numpy.linalg.cholesky(numpy.array([[0.04, 0.012], [0.012, 0.09]]))
    u = 0.8 * numpy.repeat(random.choice([-1.0, 1.0], rows // 5), 5)[:, None] + 0.3 * random.standard_normal((rows, 1))
    coupled = numpy.hstack([u, simulate(a, b, 1, u, random.standard_normal((rows, 2)) @ noise.T)])
    coupled.tofile(folder / "mimo100k.bin")

    a1 = polynomial([0.9 * numpy.exp(0.5j), 0.9 * numpy.exp(-0.5j), 0.6, -0.5])
    b1 = numpy.array([0.4, 0.3, -0.2, 0.1])
    u = random.standard_normal((rows, 1))
    y = scipy.signal.lfilter(numpy.r_[0, 0, b1], numpy.r_[1, a1], u[:, 0])
    y += scipy.signal.lfilter([1.0], numpy.r_[1, a1], 0.3 * random.standard_normal(rows))
    single = numpy.column_stack([u, y])
    single.tofile(folder / "siso100k.bin")

    bank = numpy.stack([coupled[k * 3000 : (k + 1) * 3000] for k in range(8)])
    bank.tofile(folder / "bank8.bin")
    return coupled, single, bank, a1, b1


def regressor(y, u, na, nb, nk, first=None):
    rows = len(y)
    first = max(na, nb + nk - 1) if first is None else first
    columns = [-y[first - i : rows - i] for i in range(1, na + 1)]
    columns += [u[first - nk - j : rows - nk - j] for j in range(nb)]
    return numpy.hstack(columns), y[first:]


def by_gram(y, u, na, nb, nk):
    x, target = regressor(y, u, na, nb, nk)
    return scipy.linalg.cho_solve(scipy.linalg.cho_factor(x.T @ x), x.T @ target)


def by_lstsq(y, u, na, nb, nk):
    x, target = regressor(y, u, na, nb, nk)
    return numpy.linalg.lstsq(x, target, rcond=None)[0]


STRUCTURES = [(na, nb, nk) for nk in range(4) for na in range(1, 11) for nb in range(1, 11)]


def grid_by_gram(ye, ue, yv, uv):
    """All structures over one window, from one Gram matrix of the longest regressor."""
    parts = [numpy.hstack(regressor(y, u, 10, 14, 0, 13)) for y, u in ((ye, ue), (yv, uv))]
    gram, other = (part.T @ part for part in parts)
    rows, others = (len(part) for part in parts)
    found = []
    for na, nb, nk in STRUCTURES:
        at = numpy.r_[0:na, 10 + nk : 10 + nk + nb]
        theta = scipy.linalg.cho_solve(
            scipy.linalg.cho_factor(gram[numpy.ix_(at, at)], check_finite=False), gram[at, 24], check_finite=False)
        loss = (gram[24, 24] - theta @ gram[at, 24]) / rows
        validation = (other[24, 24] - 2 * theta @ other[at, 24] + theta @ other[numpy.ix_(at, at)] @ theta) / others
        d = na + nb
        found.append((loss, loss * (1 + d / rows) / (1 - d / rows), numpy.log(loss) + 2 * d / rows, validation))
    return found


def grid_one_by_one(ye, ue, yv, uv):
    found = []
    for structure in STRUCTURES:
        theta = by_lstsq(ye, ue, *structure)
        x, target = regressor(yv, uv, *structure)
        found.append(numpy.mean((target - x @ theta) ** 2))
    return found


def prediction_errors(y, u, a, b):
    """Mean squared k-step errors for k = 1 … 20 through the first k terms of 1/A."""
    a = numpy.r_[1, a]
    e = scipy.signal.lfilter(a, 1, y) - scipy.signal.lfilter(numpy.r_[0, 0, b], 1, u)
    out = []
    for k in range(1, 21):
        first_terms = scipy.signal.lfilter([1], a, numpy.r_[1, numpy.zeros(k - 1)])
        out.append(numpy.mean(scipy.signal.lfilter(first_terms, 1, e)[100:] ** 2))
    return out


def seconds(work):
    start = time.process_time()
    work()
    return time.process_time() - start


def ours(program, folder):
    environment = dict(os.environ, WISP_BENCH_DATA=str(folder))
    command = [program, "--benchmark_format=json", "--benchmark_min_time=0.1"]
    output = subprocess.run(command, env=environment, capture_output=True, check=True, text=True).stdout
    return {case["name"]: case["cpu_time"] for case in json.loads(output)["benchmarks"]}


def octave(folder):
    script = pathlib.Path(__file__).with_name("arx.m")
    command = ["octave-cli", "-q", str(script), str(folder)]
    output = subprocess.run(command, capture_output=True, text=True, check=False)
    if output.returncode != 0:
        print("Octave did not run:", output.stderr.strip().splitlines()[-1:])
        return {}
    lines = (line.rsplit(" ", 1) for line in output.stdout.splitlines() if line.startswith("octave "))
    return {name.removeprefix("octave "): float(value) for name, value in lines}


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else "build/release/bin/wisp_bench_arx"
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        coupled, single, bank, a1, b1 = make_data(folder)
        u2, y2 = coupled[:, :1].copy(), coupled[:, 1:].copy()
        u1, y1 = single[:, :1].copy(), single[:, 1:].copy()
        half = (y1[:50000], u1[:50000], y1[50000:], u1[50000:])
        cases = [
            ("fit, 100,000 × 2 outputs, full, order 4", "Gram + Cholesky", "fit_two_outputs/0",
             lambda: by_gram(y2, u2, 4, 4, 1), ROUNDS),
            ("the same", "lstsq", "fit_two_outputs/0", lambda: by_lstsq(y2, u2, 4, 4, 1), ROUNDS),
            ("the same with free simulation judged", "Gram + Cholesky", "fit_two_outputs/1",
             lambda: by_gram(y2, u2, 4, 4, 1), ROUNDS),
            ("fit, 100,000 × 1 output (4,4,2)", "Gram + Cholesky", "fit_one_output",
             lambda: by_gram(y1, u1, 4, 4, 2), ROUNDS),
            ("8 fits of 3,000 × 2 outputs, order 4", "Gram + Cholesky", "fit_bank_of_8",
             lambda: [by_gram(part[:, 1:], part[:, :1], 4, 4, 1) for part in bank], ROUNDS),
            ("400 structures, 50,000 + 50,000", "shared Gram", "search_400_structures/1",
             lambda: grid_by_gram(*half), ROUNDS),
            ("the same, each with its own window", "lstsq each", "search_400_structures/0",
             lambda: grid_one_by_one(*half), 1),
            ("J_k, k = 1 … 20, 100,000", "lfilter", "prediction_errors_of_20_steps",
             lambda: prediction_errors(y1[:, 0], u1[:, 0], a1, b1), ROUNDS),
        ]
        own_times = {}
        peer_times = [[] for _ in cases]
        for round_number in range(ROUNDS):
            for name, milliseconds in ours(program, folder).items():
                own_times.setdefault(name, []).append(milliseconds)
            for case, times in zip(cases, peer_times):
                if round_number < case[4]:
                    if round_number == 0 and case[4] > 1:
                        case[3]()
                    times.append(1e3 * seconds(case[3]))
        print(f"NumPy {numpy.__version__}, SciPy {scipy.__version__}, "
              f"BLAS {os.path.realpath('/usr/lib/x86_64-linux-gnu/libblas.so.3')}; one thread, processor time, medians")
        print(f"{'work':42} {'peer':18} {'peer ms':>9} {'Wisp ms':>9} {'ratio':>7}")
        for case, times in zip(cases, peer_times):
            peer, own = numpy.median(times), numpy.median(own_times[case[2]])
            print(f"{case[0]:42} {case[1]:18} {peer:9.2f} {own:9.3f} {peer / own:7.1f}")
        if shutil.which("octave-cli"):
            for name, milliseconds in octave(folder).items():
                own = numpy.median(own_times[name])
                print(f"{name:42} {'Octave arx':18} {milliseconds:9.2f} {own:9.3f} {milliseconds / own:7.1f}")


if __name__ == "__main__":
    main()
