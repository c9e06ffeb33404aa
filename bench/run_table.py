#!/usr/bin/env python3
"""One table of what stepping costs: every width of vectors, beside the machine's limits and SciPy's filter.

  bench/run_table.py build/release/bin/wisp_bench_run [FIGURES.json [PLOT.svg]]     needs python3-numpy and python3-scipy

Prints Markdown; all figures are processor time. With a second argument, the figures as JSON too; with a third, a plot of
what a step costs an instance in banks of 1 to 2^20 (needs python3-matplotlib).
"""

import json
import os
import pathlib
import re
import statistics
import subprocess
import sys

WIDTHS = ("baseline", "avx2")
OPERATIONS = 320 * 2  # a step of the flame: 20 products and sums for each of 16 outputs, without noise


ROUNDS = 3  # in turns, so that what else the machine does falls on all widths alike


def run(program, width):
    command = [program, "--benchmark_format=json", "--benchmark_min_time=0.1"]
    done = subprocess.run(command, env={**os.environ, "WISP_WIDTH": width}, capture_output=True, text=True)
    if done.returncode != 0 or "WISP_WIDTH is" in done.stderr:
        return None  # the machine has not that width
    return {one["name"]: one for one in json.loads(done.stdout)["benchmarks"]}


def median(runs):
    """Of every number of every benchmark the middle one."""
    def of(name, key):
        values = [one[name][key] for one in runs]
        return statistics.median(values) if isinstance(values[0], (int, float)) else values[0]
    return {name: {key: of(name, key) for key in runs[0][name]} for name in runs[0]}


def peers():
    script = pathlib.Path(__file__).parent / "peers" / "run.py"
    said = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True).stdout
    bare, noisy = re.findall(r"([0-9.]+) ms", said)
    return {"lfilter_ms": float(bare), "lfilter_noise_ms": float(noisy)}


def rows_of(figures):
    """Name of a row and its figure at a width, in nanoseconds an instance and step."""
    rows = ("flame_step/", "default_flame_step/", "flame_frame/", "shipped_frame/", "flame_steps/", "flame_far/")
    names = [name for name in figures["baseline"] if name.startswith(rows)]
    return [(name, {width: figures[width][name]["ns_each"] for width in figures}) for name in names]


def print_steps(figures):
    widths = list(figures)
    print("| ns an instance | " + " | ".join(widths) + " | " + " | ".join(f"{w} : baseline" for w in widths[1:]) + " |")
    print("| --- |" + " ---: |" * (2 * len(widths) - 1))
    for name, at in rows_of(figures):
        ratios = [f"{at[width] / at['baseline']:.2f}" for width in widths[1:]]
        print(f"| {name} | " + " | ".join([f"{at[width]:.1f}" for width in widths] + ratios) + " |")


def print_bodies(figures):
    print("\n| the page's flame, a step and its polyline, ns | in the plane | in the round | times |")
    print("| --- | ---: | ---: | ---: |")
    for width, at in figures.items():
        for many in (1, 1000):
            plane, body = (at[f"shipped_frame/flames:{many}/round:{kind}"]["ns_each"] for kind in (0, 1))
            print(f"| {width}, {many} at once | {plane:.0f} | {body:.0f} | {body / plane:.2f} |")


def print_limits(figures):
    print("\n| of the machine's limit | multiplies and adds, 10⁹ a second | a step without noise, 1,024 flames | share |")
    print("| --- | ---: | ---: | ---: |")
    for width, at in figures.items():
        limit = at[f"limit_{width}"]["operations"]
        reached = 1e9 * OPERATIONS / at["flame_step/flames:1024/noise:0"]["ns_each"]
        print(f"| {width} | {limit / 1e9:.1f} | {reached / 1e9:.1f} | {reached / limit:.2f} |")
    triad = figures["baseline"]["limit_triad"]["bytes_per_second"]
    print(f"\nMemory: triad {triad / 1e9:.1f} GB/s.")


def print_filter(figures, peer):
    print("\n| order 4, 10⁶ steps, ms | one instance | in one call | a bank of 1,000 | SciPy's lfilter | one call : SciPy | bank : SciPy |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    widest = figures[list(figures)[-1]]
    for noise, name in ((0, "lfilter_ms"), (1, "lfilter_noise_ms")):
        one, bank = (widest[f"filter/instances:{count}/noise:{noise}"]["cpu_time"] for count in (1, 1000))
        call = widest[f"filter_at_once/noise:{noise}"]["cpu_time"]
        label = "with Gaussian noise" if noise else "bare"
        ratios = f"{call / peer[name]:.2f} | {bank / peer[name]:.2f}"
        print(f"| {label} | {one:.1f} | {call:.1f} | {bank:.1f} | {peer[name]:.1f} | {ratios} |")


def draw(steps, path):
    """What a step costs an instance, by how many a bank has; `steps`: as rows_of() names them."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "wisp", "svg.fonttype": "none", "font.size": 10})
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4.2), layout="constrained")
    for width, color in zip(WIDTHS, ("tab:blue", "tab:orange")):
        for noise, line in ((1, "-o"), (0, "--o")):
            points = sorted((int(found[1]), at[width]) for name, at in steps.items() if width in at
                            and (found := re.fullmatch(rf"flame_step/flames:(\d+)/noise:{noise}", name)))
            if points:
                label = f"{width}, {'with' if noise else 'without'} noise"
                axes.plot(*zip(*points), line, color=color, markersize=3.5, linewidth=1.4, label=label)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("flames in a bank")
    axes.set_ylabel("ns a flame and step")
    ticks = (15, 20, 30, 50, 75, 100, 150, 200)
    axes.set_yticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, ncols=3, fontsize=9)
    figure.savefig(path, metadata={"Date": None})


def main():
    rounds = [{width: result for width in WIDTHS if (result := run(sys.argv[1], width))} for _ in range(ROUNDS)]
    figures = {width: median([one[width] for one in rounds]) for width in rounds[0]}
    peer = peers()
    print_steps(figures)
    print_bodies(figures)
    print_limits(figures)
    print_filter(figures, peer)
    if len(sys.argv) > 2:
        kept = {"steps": dict(rows_of(figures)), "peers": peer, "benchmarks": figures}
        pathlib.Path(sys.argv[2]).write_text(json.dumps(kept, indent=1) + "\n")
    if len(sys.argv) > 3:
        draw(dict(rows_of(figures)), sys.argv[3])


if __name__ == "__main__":
    main()
