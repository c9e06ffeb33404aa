#!/usr/bin/env python3
"""Free simulation of held-out rows with --focus prediction and auto, on public data sets.

    studies/focus/focus.py WISP DATA [SHARE…] [--na N …]    # the program, the folder of the data sets, shares that are
                                                            # learned from, flags of wisp learn arx

Every model has order 4 and delay 1, where no flag says otherwise, and is learned from the first SHARE of the rows (two thirds); the rest is simulated
from the fitted initial state and from measured samples.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

SETS = ["robotarm", "heating", "evaporator", "cdplayer", "hairdryer", "flutter", "glassfurnace"]


def run(*words):
    said = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    return json.loads(said.stdout) if said.returncode == 0 else None


def fits(wisp, folder, table, rows, unseen, focus, coupling, flags):
    names = table[1]
    model = folder / "m.wisp"
    begin = time.time()
    fit = run(wisp, "learn", "arx", table[0], "-o", model, "--rate", 1, "--focus", focus, "--coupling", coupling,
              "--inputs", ",".join(n for n in names if n[0] == "u"),
              "--outputs", ",".join(n for n in names if n[0] == "y"), "--range", rows, "--json", *flags)
    seconds = time.time() - begin
    found = []
    for initial in ("estimated", "measured"):
        told = run(wisp, "validate", model, unseen[0], "--rate", 1, "--steps", "inf", "--initial", initial,
                   "--range", unseen[1], "--json")
        found.append([one["fit_percent"]["inf"] for one in told["channels"]])
    ways = {}
    for one in fit.get("focus", {}).get("outputs", []):
        for name in [n for n in names if n[0] == "y"] if one["outputs"] == "all" else one["outputs"].split(", "):
            ways[name] = one["chosen"]
    return found, ways, seconds


def header(path):
    with open(path) as table:
        names = table.readline().strip().split(",")
        return names, sum(1 for _ in table)


def main():
    wisp, data = sys.argv[1], pathlib.Path(sys.argv[2])
    words = sys.argv[3:]
    first = next((k for k, word in enumerate(words) if word.startswith("--")), len(words))
    shares, flags = [float(word) for word in words[:first]] or [2 / 3], words[first:]
    print("| learned from | data | coupling | output | least squares: fitted, measured start | auto | chosen |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    worse = count = 0
    gained = [0.0, 0.0]
    with tempfile.TemporaryDirectory() as name:
        cases = []
        for share in shares:
            for one in SETS:
                path = data / f"{one}.csv"
                names, rows = header(path)
                cut = round(share * rows)
                cases.append((f"{share:.2f}", one, (path, names), f"1:{cut}", (path, f"{cut + 1}:{rows}")))
        est, val = data / "cascaded_tanks_est.csv", data / "cascaded_tanks_val.csv"
        names, rows = header(est)
        cases.append(("its own", "tanks", (est, names), f"1:{rows}", (val, f"1:{rows}")))
        for share, one, table, rows, unseen in cases:
            outputs = [n for n in table[1] if n[0] == "y"]
            for coupling in ["full", "diagonal"] if len(outputs) > 1 else ["full"]:
                plain, _, _ = fits(wisp, pathlib.Path(name), table, rows, unseen, "prediction", coupling, flags)
                auto, ways, _ = fits(wisp, pathlib.Path(name), table, rows, unseen, "auto", coupling, flags)
                for k, output in enumerate(outputs):
                    print(f"| {share} | {one} | {coupling} | {output} | {plain[0][k]:.1f}, {plain[1][k]:.1f} "
                          f"| {auto[0][k]:.1f}, {auto[1][k]:.1f} | {ways.get(output, 'least squares')} |", flush=True)
                    count += 1
                    for s in (0, 1):
                        gained[s] += max(auto[s][k], -100) - max(plain[s][k], -100)
                    worse += any(plain[s][k] > 0 and max(auto[s][k], 0) < plain[s][k] - 2 for s in (0, 1))
    print(f"\n{worse} of {count} outputs are more than 2 points below least squares that were above 0; "
          f"mean gain {gained[0] / count:.1f}, {gained[1] / count:.1f}")


if __name__ == "__main__":
    main()
