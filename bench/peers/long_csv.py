#!/usr/bin/env python3
"""From a long CSV file to an ARX fit, in one run: Wisp, and NumPy's loadtxt and normal equations.

    bench/peers/long_csv.py WISP [ROWS]      # two million rows

Processor time, time on the clock and peak memory of each, and the largest difference of their coefficients.
"""
import json
import os
import pathlib
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


def main():
    # This process stays small: a child's peak begins with its parent's size.
    wisp, rows = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 2_000_000
    with tempfile.TemporaryDirectory() as name:
        path = pathlib.Path(name) / "long.csv"
        version, *_ = timed(sys.executable, "-c", MAKE, path, rows)
        print(f"{rows} rows, {path.stat().st_size / 1e6:.0f} MB, NumPy {version}")
        print("| way | processor, s | clock, s | peak, MiB |\n| --- | --- | --- | --- |")
        text, own, clock, peak = timed(sys.executable, "-c", PEER, path)
        peer, theta = own, json.loads(text)
        print(f"| NumPy: loadtxt, Gram matrix | {own:.2f} | {clock:.2f} | {peak:.0f} |")
        for memory in (1024, 45):
            text, own, clock, peak = timed(wisp, "learn", "arx", path, "--inputs", "u", "--outputs", "y", "--rate", 1,
                                           "--memory", memory, "-o", pathlib.Path(name) / "m.wisp", "--json")
            fit = json.loads(text)
            found = fit["A"][0][0] + fit["B"][0][0]
            apart = max(abs(a - b) for a, b in zip(found, theta))
            print(f"| Wisp, --memory {memory} | {own:.2f}: {own / peer:.2f} of it | {clock:.2f} | {peak:.0f} |")
            print(f"# coefficients differ by {apart:.1e}", file=sys.stderr)


if __name__ == "__main__":
    main()
