#!/usr/bin/env python3
"""From a long CSV file to an ARX fit, in one run: Wisp, and NumPy's loadtxt and normal equations.

    bench/peers/long_csv.py WISP [ROWS [PAIRS]]      # two million rows, seven pairs

Medians of processor time, time on the clock and peak memory of each, run in turn; the ratio is that within a pair.
"""
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

MAKE = """
import sys
import numpy as np
rows = int(sys.argv[2])
draw = np.random.default_rng(5)
u, e = np.repeat(draw.normal(size=rows // 5 + 1), 5)[:rows], 0.1 * draw.normal(size=rows)
y = np.zeros(rows)
for t in range(2, rows):
    y[t] = 1.5 * y[t - 1] - 0.7 * y[t - 2] + 0.5 * u[t - 1] + 0.3 * u[t - 2] + e[t]
np.savetxt(sys.argv[1], np.c_[u, y], fmt="%.6f", delimiter=",", header="u,y", comments="")
print(np.__version__)
"""

PEER = """
import json, sys
import numpy as np
u, y = np.loadtxt(sys.argv[1], delimiter=",", skiprows=1, unpack=True)
u, y = u - u.mean(), y - y.mean()
n = len(y)
columns = [-y[4 - k:n - k] for k in range(1, 5)] + [u[4 - k:n - k] for k in range(1, 5)]
gram = np.array([[a @ b for b in columns] for a in columns])
print(json.dumps(np.linalg.solve(gram, [a @ y[4:] for a in columns]).tolist()))
"""


def timed(*words):
    begin = time.monotonic()
    with tempfile.TemporaryFile("w+") as said:
        child = subprocess.Popen([str(word) for word in words], stdout=said, stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(child.pid, 0)
        said.seek(0)
        assert status == 0, words
        return said.read(), used.ru_utime + used.ru_stime, time.monotonic() - begin, used.ru_maxrss / 1024


def learned(wisp, path, memory, folder):
    text, own, clock, peak = timed(wisp, "learn", "arx", path, "--inputs", "u", "--outputs", "y", "--rate", 1,
                                   "--memory", memory, "-o", folder / "m.wisp", "--json")
    fit = json.loads(text)
    return fit["A"][0][0] + fit["B"][0][0], own, clock, peak


def main():
    # This process stays small: a child's peak begins with its parent's size.
    wisp = sys.argv[1]
    rows, pairs = [int(word) for word in sys.argv[2:]] + [2_000_000, 7][len(sys.argv) - 2:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        path = folder / "long.csv"
        version, *_ = timed(sys.executable, "-c", MAKE, path, rows)
        print(f"{rows} rows, {path.stat().st_size / 1e6:.0f} MB, NumPy {version.strip()}, {pairs} pairs")
        ways = {"NumPy: loadtxt, Gram matrix": None, "Wisp, --memory 1024": 1024, "Wisp, --memory 45": 45}
        runs = {way: [] for way in ways}
        for _ in range(pairs):  # one after the other, so that what else the machine does falls on all alike
            for way, memory in ways.items():
                if memory is None:
                    text, *used = timed(sys.executable, "-c", PEER, path)
                    theta = json.loads(text)
                else:
                    found, *used = learned(wisp, path, memory, folder)
                    print(f"# apart by {max(abs(a - b) for a, b in zip(found, theta)):.1e}", file=sys.stderr)
                runs[way].append(used)
        print("| way | processor, s | of NumPy's in the same pair | clock, s | peak, MiB |\n| --- | --- | --- | --- | --- |")
        peer = [own for own, *_ in runs["NumPy: loadtxt, Gram matrix"]]
        for way, used in runs.items():
            ratio = sorted(one[0] / its for one, its in zip(used, peer))
            own, clock, peak = (statistics.median(one[k] for one in used) for k in range(3))
            print(f"| {way} | {own:.2f} | {statistics.median(ratio):.2f} ({ratio[0]:.2f} to {ratio[-1]:.2f}) "
                  f"| {clock:.2f} | {peak:.0f} |")


if __name__ == "__main__":
    main()
