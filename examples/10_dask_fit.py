#!/usr/bin/env python3
"""One model from many clips, on as many machines as Dask has workers: each clip is captured by whichever worker is free.
Of an ARX model each recording then becomes a small part, and parts are merged as a tree; a flame or an outline is learned
from the folder of recordings. The result is the same wherever its tasks run and however often one is run again.

    10_dask_fit.py FOLDER MODEL.wisp CLIP_OR_REC… [--kind flame] [--scheduler tcp://HOST:8786] [--workers N]
                   [-- flags of wisp learn KIND]
    10_dask_fit.py work tip.wisp clips/*.mp4 -- --inputs wind --outputs p3.x,p3.y --na 2 --nb 2 --nk 1
    10_dask_fit.py work flame.wisp clips/*.mp4 --kind flame

Workers share FOLDER and nothing else, as those of 06_parallel_fit do. Without --scheduler the workers are processes of
this machine; with --workers 0 the same tasks run in this process, one after the other. WISP names the program.
"""
import argparse
import os
import pathlib
import subprocess
import sys


def wisp(*words):
    subprocess.run([os.environ.get("WISP", "wisp"), *map(str, words), "--quiet"], check=True, stdout=subprocess.DEVNULL)


def captured(folder, clip):
    """The recording of a clip; a table is one already."""
    if clip.endswith(".csv"):
        return clip
    recording = pathlib.Path(folder, pathlib.Path(clip).stem + ".csv")
    wisp("capture", "flame", clip, "-o", recording)
    return str(recording)


def part_of(folder, recording, flags):
    """The products of a recording's rows: a file whose size does not grow with the recording."""
    part = pathlib.Path(folder, pathlib.Path(recording).stem + ".part")
    wisp("learn", "arx", recording, "--partial", part, *flags)
    return str(part)


def merged(folder, name, *parts):
    """The sum of two parts."""
    both = pathlib.Path(folder, name + ".part")
    wisp("learn", "arx", "--merge", *parts, "--partial", both)
    return str(both)


def finished(part, model, count, flags):
    """The model from the merged part; the operating point is computed here, from the sums of all rows."""
    offset = flags[flags.index("--offset") :][:2] if "--offset" in flags else []
    wisp("learn", "arx", "--merge", part, "--expect", count, "-o", model, *offset)
    return str(model)


def learned(kind, model, flags, *recordings):
    """A model of all recordings, in the order of their names."""
    wisp("learn", kind, *sorted(recordings), "-o", model, *flags)
    return str(model)


def graph(do, kind, folder, model, clips, flags):
    """Submits all tasks by do(function, …), whose return value (a result or a future) is an argument of later tasks."""
    recordings = [do(captured, folder, clip) for clip in clips]
    if kind != "arx":
        return do(learned, kind, model, flags, *recordings)
    parts = [do(part_of, folder, recording, flags) for recording in recordings]
    level = 0
    while len(parts) > 1:
        level += 1
        pairs = [parts[k : k + 2] for k in range(0, len(parts), 2)]
        parts = [
            do(merged, folder, f"level{level}_{k}", *pair) if len(pair) == 2 else pair[0]
            for k, pair in enumerate(pairs)
        ]
    return do(finished, parts[0], model, len(clips), flags)


def on_cluster(client, *task):
    """The model's future. A task whose worker dies is run again elsewhere: it writes the same file again."""
    return graph(lambda run, *of: client.submit(run, *of, pure=False, retries=3), *task)


def main():
    words, flags = sys.argv[1:], []
    if "--" in words:
        words, flags = words[: words.index("--")], words[words.index("--") + 1 :]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("model")
    parser.add_argument("clips", nargs="+")
    parser.add_argument("--kind", default="arx", choices=["arx", "outline", "flame"])
    parser.add_argument("--scheduler")
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args(words)
    pathlib.Path(given.folder).mkdir(parents=True, exist_ok=True)
    task = (given.kind, given.folder, given.model, given.clips, flags)
    if given.workers == 0 and not given.scheduler:
        return graph(lambda run, *of: run(*of), *task)
    from distributed import Client, LocalCluster

    cluster = given.scheduler or LocalCluster(n_workers=given.workers, threads_per_worker=1, dashboard_address=None)
    with Client(cluster) as client:
        return on_cluster(client, *task).result()


if __name__ == "__main__":
    print("wrote", main())
