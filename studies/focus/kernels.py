#!/usr/bin/env python3
"""Free simulation of held-out rows with a kernel, beside least squares and --focus auto.

    studies/focus/kernels.py WISP DATA [SHARE…]    # public sets: means over outputs, learned from the first SHARE of rows
    studies/focus/kernels.py WISP --made SEED      # eight made systems of each kind of verdicts.py
"""
import collections
import json
import pathlib
import random
import subprocess
import sys
import tempfile

from focus import SETS, header
from verdicts import made

LAGS = ["--na", 15, "--nb", 15, "--nk", 0, "--kernel", "tc"]
KINDS = ["clean", "noisy", "output noise", "weak input", "at once", "delayed", "square"]


def ways(cut, inputs):
    return {
        "order 4, delay 1": [],
        "the same, --focus auto": ["--focus", "auto"],
        "order 4, delay 0, on their own": ["--nk", 0, "--coupling", "diagonal"],
        "60 lags of the input, kernel": ["--na", 0, "--nb", min(60, cut // (6 * inputs)), "--nk", 0, "--kernel", "tc"],
        "15 lags, kernel, on their own": [*LAGS, "--coupling", "diagonal"],
        "15 lags, kernel": LAGS,
    }


def run(*words):
    said = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    return json.loads(said.stdout) if said.returncode == 0 else None


def fits(wisp, folder, table, names, rows, cut, more):
    """Of every output from a fitted and from a measured start, and whether the model is called usable."""
    model = folder / "m.wisp"
    told = run(wisp, "learn", "arx", table, "-o", model, "--rate", 1, "--inputs", ",".join(n for n in names if n[0] == "u"),
               "--outputs", ",".join(n for n in names if n[0] == "y"), "--range", f"1:{cut}", "--json", *more)
    if told is None:
        return [], False
    found = []
    for start in ("estimated", "measured"):
        judged = run(wisp, "validate", model, table, "--rate", 1, "--steps", "inf", "--initial", start, "--range",
                     f"{cut + 1}:{rows}", "--json")
        found.append([max(one["fit_percent"]["inf"], -100) for one in judged["channels"]])
    return list(zip(*found)), told["usable"]["verdict"]


def public(wisp, data, shares, folder):
    for share in shares:
        for name in SETS:
            names, rows = header(data / f"{name}.csv")
            cut = round(share * rows)
            for way, more in ways(cut, sum(n[0] == "u" for n in names)).items():
                found, usable = fits(wisp, folder, data / f"{name}.csv", names, rows, cut, more)
                for fitted, measured in found:
                    yield way, fitted, measured, usable and fitted < 30


def systems(wisp, seed, folder):
    draw = random.Random(seed)
    for kind in KINDS:
        for _ in range(8):
            us, ys = made(kind, 900, draw)
            table = folder / "made.csv"
            table.write_text("u1,y1\n" + "".join(f"{u!r},{y!r}\n" for u, y in zip(us, ys)))
            for way, more in ways(500, 1).items():
                found, usable = fits(wisp, folder, table, ["u1", "y1"], 900, 500, more)
                for fitted, measured in found:
                    yield f"{kind}: {way}", fitted, measured, usable and fitted < 30


def main():
    wisp = pathlib.Path(sys.argv[1]).resolve()
    table = collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if sys.argv[2] == "--made":
            found = systems(wisp, int(sys.argv[3]), folder)
        else:
            found = public(wisp, pathlib.Path(sys.argv[2]), [float(word) for word in sys.argv[3:]] or [2 / 3], folder)
        for way, *row in found:
            table[way].append(row)
    print("| way | outputs | fitted start | measured start | wrong and usable |\n| --- | --- | --- | --- | --- |")
    for way, rows in table.items():
        fitted, measured, wrong = (sum(column) for column in zip(*rows))
        print(f"| {way} | {len(rows)} | {fitted / len(rows):.1f} | {measured / len(rows):.1f} | {wrong} |")


if __name__ == "__main__":
    main()
