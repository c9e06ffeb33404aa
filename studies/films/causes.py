#!/usr/bin/env python3
"""Which cause a refusal names, against the true one: films spoiled in one way each.

  studies/films/causes.py WISP SCENES FOLDER [STREET…] [--only CAUSE…]

WISP and SCENES: the programs wisp and wisp_verify_scenes; FOLDER: real films, as ../shared/data/flame; STREET: films without a flame,
as those of opencv-doc. A few seconds of every film and of drawn flames are spoiled, small, and captured. Not to refuse is right too
where the outline is still the film's. Ends with the table, exit status 1 where fewer than 90 % are right. Needs ffmpeg and altered.py's packages.
"""

import collections
import os
import re
import subprocess
import sys
import tempfile

import cv2
import numpy as np

from altered import captured, shared

SECONDS, HEIGHT, AGREES = 3, 240, 0.75
SMALL = f"scale=trunc(iw*min(1\\,{HEIGHT}/ih)/2)*2:trunc(ih*min(1\\,{HEIGHT}/ih)/2)*2:flags=area"
# What a sentence names, the first that fits.
NAMES = {"no flame": "there is no flame", "upside down": "upside down", "on its side": "on its side", "repeated": "repeat the one before",
         "cut": "the film is cut", "border": "leave room", "too bright": "lower the exposure", "too dark": "too dark", "small": "film it from nearer",
         "short": "longer clip", "irregular": "irregularly", "shaken": "keep the camera still", "missing": "missing in|only now and then"}
# True cause, names that are right: a list of filters. {rate}: the film's; {x}, {y}, {w}, {h}: the box of its outline.
CAUSES = {
    "upside down": (["upside down"], ["vflip"]),
    "on its side": (["on its side"], ["transpose=1", "transpose=2"]),
    "twice": (["repeated"], ["fps={twice},noise=alls=4:allf=t"]),
    "slow motion": (["repeated"], ["setpts=4*PTS,fps={rate},noise=alls=3:allf=t"]),
    "too dark": (["too dark"], ["lutyuv=y=16+(val-16)*0.09:u=128+(val-128)*0.09:v=128+(val-128)*0.09,noise=alls=2:allf=t"]),
    "too bright": (["too bright"], ["lutrgb=r=val*5:g=val*5:b=val*5"]),
    "glare": (["too bright"], ["split[a][b];[b]lutrgb=r=2*val:g=2*val:b=2*val,gblur=sigma={glow}[c];[a][c]blend=all_mode=addition:all_opacity=1,format=gbrp,"
                               "lutrgb=r=val*3:g=val*3:b=val*3"]),
    "cut": (["cut"], ["fps={rate},scale=320:240:force_original_aspect_ratio=decrease,pad=320:240,setsar=1,trim=0:2.2[a];movie={street},scale=320:240,setsar=1,fps={rate},"
                      "trim=0:1.8,setpts=PTS-STARTPTS[b];[a][b]concat"]),
    "shaken": (["shaken"], ["crop=iw*0.75:ih*0.75:'iw*0.125*(1+0.6*sin(11*t)+0.4*sin(31*t+1))':'ih*0.125*(1+0.6*sin(13*t)+0.4*sin(27*t))'",
                            "crop=iw*0.7:ih*0.7:'iw*0.15*(1+sin(n*n*7.3))':'ih*0.15*(1+sin(n*n*3.1+1))'"]),
    "irregular": (["irregular"], ["select='gt(random(1),0.35)'"]),
    "small": (["small"], ["scale=trunc(iw*6/{h}/2)*2:-2:flags=area,scale=iw*4:-2,pad=320:240:40:20"]),
    "short": (["short"], ["trim=end_frame=13"]),
    "border": (["border"], ["crop=trunc((iw-{x}-{w}/2)/2)*2:ih:{x}+{w}/2:0", "crop=iw:trunc((ih-{y}-{h}*0.3)/2)*2:0:{y}+{h}*0.3"]),
    "covered": (["missing"], ["drawbox=color=black:t=fill:enable='lt(mod(t+0.4,1),0.3)'"]),
}


def film_of(source, path, how, seconds=SECONDS):
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-t", str(seconds), "-i", source, "-filter_complex", how, "-an", "-fps_mode", "passthrough", "-c:v",
                    "libx264", "-crf", "20", "-pix_fmt", "yuv420p", path], check=True, timeout=30)


def named(usable, reason):
    return "usable" if usable else next((name for name, words in NAMES.items() if re.search(words, reason)), "other")


def drawn(scenes, folder, seed=4711, count=3):
    """A few drawn flames of a set that nothing was chosen on, as files."""
    plain = [f"{k} {kind}" for k in range(80) for kind in ("plain", "soft", "wall", "glass", "table", "pool")]
    for name in plain:
        if count == 0:
            return
        made = subprocess.run([scenes, "raw", "fresh", str(seed), name], capture_output=True)
        if not made.stdout:
            continue
        width, height, rate = made.stderr.decode().split()
        path = os.path.join(folder, f"drawn {name}.mp4")
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", rate, "-i", "-", "-vf",
                        "scale=trunc(iw/2)*2:trunc(ih/2)*2", "-c:v", "libx264", "-crf", "16", "-pix_fmt", "yuv420p", path], input=made.stdout, check=True)
        count -= 1
        yield path


def main():
    arguments = sys.argv[1:]
    only = []
    if "--only" in arguments:
        at = arguments.index("--only")
        arguments, only = arguments[:at], arguments[at + 1:]
    wisp, scenes, folder, *streets = arguments
    table = collections.defaultdict(collections.Counter)
    right = total = 0

    def put(cause, good, film, usable, reason):
        nonlocal right, total
        name = named(usable, reason)
        right, total = right + bool(good(name)), total + 1
        table[cause][name] += 1
        print(f"{'   ' if good(name) else 'NOT'} {cause:12s} {film:26s} {name:12s} {reason}", flush=True)

    with tempfile.TemporaryDirectory() as scratch:
        films = [os.path.join(at, name) for at, _, names in sorted(os.walk(folder)) for name in sorted(names) if name.endswith(".mp4")]
        clip, copy = os.path.join(scratch, "film.mp4"), os.path.join(scratch, "copy.mp4")
        for source in films + list(drawn(scenes, scratch)):
            film = os.path.basename(source)[:24]
            film_of(source, clip, SMALL)
            known, (usable, reason) = captured(wisp, clip, scratch)
            if not usable:
                print(f"--- {film}: {reason}")
                continue
            curves = [curve for curve in known if curve is not None]
            low, high = np.median([c.min(0) for c in curves], 0), np.median([c.max(0) for c in curves], 0)
            rate = cv2.VideoCapture(clip).get(5)
            values = dict(rate=rate, twice=2 * rate, glow=high[1] - low[1], street=streets[-1] if streets else "", x=int(low[0]), y=int(low[1]),
                          w=int(high[0] - low[0]), h=int(high[1] - low[1]))
            for cause, (names, filters) in CAUSES.items():
                if (only and cause not in only) or (cause == "small" and values["h"] > HEIGHT / 3):
                    continue
                for how in filters:
                    try:
                        film_of(clip, copy, how.format(**values))
                    except (subprocess.CalledProcessError, subprocess.TimeoutExpired):
                        print("cannot be made:", cause, film)
                        continue
                    found, (usable, reason) = captured(wisp, copy, scratch)
                    pairs = [shared(a, b) for a, b in zip(known, found) if a is not None and b is not None] if cause in ("too dark", "too bright", "glare", "covered") else []
                    still_right = cause == "shaken" or (len(pairs) > 10 and np.mean(np.array(pairs) > AGREES) > 0.95)
                    put(cause, lambda name: name in names or (name == "usable" and still_right), film, usable, reason)
        for film in streets if not only or "no flame" in only else []:
            for start in (0, 3, 6):
                for how in ("null", "crop=iw/2:ih/2", "crop=iw/3:ih/3:0:0"):
                    film_of(film, copy, f"trim=start={start},setpts=PTS-STARTPTS,{how},{SMALL}", SECONDS + start)
                    if os.path.getsize(copy) < 3000:
                        continue
                    _, (usable, reason) = captured(wisp, copy, scratch)
                    put("no flame", lambda name: name == "no flame", os.path.basename(film)[:20] + f" {start}", usable, reason)
    columns = sorted({name for row in table.values() for name in row})
    print("\n| true cause | " + " | ".join(columns) + " |\n|" + " --- |" * (len(columns) + 1))
    for cause, row in table.items():
        print(f"| {cause} | " + " | ".join(str(row[name] or "") for name in columns) + " |")
    print(f"\n{right} of {total} right, {100 * right / max(total, 1):.0f} % (90 wanted)")
    sys.exit(right < 0.9 * total)


main()
