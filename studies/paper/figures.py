#!/usr/bin/env python3
"""The paper's figures from what script/paper learned and played, in the paper's order, as one page.

usage: figures.py DATA OUT    DATA has the recordings, OUT the models, plays and films; writes OUT/index.html beside its pictures.
"""
import json, pathlib, subprocess, sys
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

DATA, OUT = map(pathlib.Path, sys.argv[1:3])
RED, BLUE, GREEN = "#b5452c", "#2c5f8a", "#2f8a3c"


def table(path):
    """A recording: its comments as a dictionary, its columns by bare names."""
    said, rows, names = {}, [], None
    for line in open(path):
        line = line.rstrip("\n")
        if line.startswith("#"):
            key, _, value = line[2:].partition(" ")
            said[key] = value
        elif names is None:
            names = [n.split(":")[-1].split("[")[0] for n in line.split(",")]
        elif line:
            rows.append([float(x) if x else np.nan for x in line.split(",")])
    return said, dict(zip(names, np.array(rows).T))


def film(path, frames, width=180):
    """Some frames of a film as pictures in a row."""
    chosen = "+".join(f"eq(n,{k})" for k in frames)
    filters = f"select='{chosen}',scale={width}:-2"
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", str(path), "-vf", filters, "-vsync", "0", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                         stdout=subprocess.PIPE, check=True).stdout
    height = len(raw) // (len(frames) * width * 3)
    return np.frombuffer(raw, np.uint8).reshape(len(frames), height, width, 3)


def strip(name, path, frames):
    pictures = film(path, frames)
    plt.imsave(OUT / name, np.concatenate(list(pictures), axis=1))


def gust_frames(wind, count, apart):
    """Rows in and after the strongest gust, evenly apart."""
    peak = int(np.nanargmax(np.convolve(np.nan_to_num(np.abs(wind)), np.ones(20), "same")))
    first = max(0, min(peak - count * apart // 3, len(wind) - count * apart - 1))
    return [first + apart * k for k in range(count)]


def rotated(q, v):
    w, x, y, z = q
    once = 2 * np.cross([x, y, z], v)
    return v + w * once + np.cross([x, y, z], once)


def pose_of(fall, row):
    return np.array([fall["pos." + a][row] for a in "xyz"]), [fall["q." + a][row] for a in "wxyz"]


def episodes(fall):
    ids = fall.get("episode", np.zeros(len(fall["pos.x"])))
    return [{name: values[ids == k] for name, values in fall.items()} for k in dict.fromkeys(ids)]


def draw_fall(axes, fall, half, every=2, rows=70):
    """A fall from the side: its path, and the leaf's long axis every few frames."""
    rows = min(rows, len(fall["pos.x"]))
    start, _ = pose_of(fall, 0)
    path = np.array([pose_of(fall, row)[0] - start for row in range(rows)])
    axes.plot(path[:, 0], path[:, 2], color="#bbb", lw=.8)
    for row in range(0, rows, every):
        centre, q = pose_of(fall, row)
        arm = rotated(np.array(q), np.array([0, half, 0]))
        ends = np.array([centre - start - arm, centre - start + arm])
        axes.plot(ends[:, 0], ends[:, 2], color=GREEN, lw=1.4)
    axes.set_aspect("equal"); axes.set_xlabel("x, m")


def one_scale(all_axes):
    low = [min(f(a)[0] for a in all_axes) for f in (plt.Axes.get_xlim, plt.Axes.get_ylim)]
    high = [max(f(a)[1] for a in all_axes) for f in (plt.Axes.get_xlim, plt.Axes.get_ylim)]
    for a in all_axes:
        a.set_xlim(low[0], high[0]); a.set_ylim(low[1], high[1])


def save(name):
    plt.tight_layout(); plt.savefig(OUT / name, dpi=110); plt.close()


def figures_1_2():
    _, seen = table(DATA / "unseen.csv")
    frames = gust_frames(seen["wind"], 8, 4)
    strip("figure-1.png", DATA / "unseen.mp4", frames)
    strip("figure-2.png", OUT / "played.mp4", frames)
    return frames


def figure_3():
    said, recorded = table(DATA / "fresh.csv")
    half = float(said["leaf_length_width_density"].split()[0]) / 2
    real, played = episodes(recorded), table(OUT / "falls.csv")[1]
    made = [{n.split(".", 1)[1]: v for n, v in played.items() if n.startswith(f"i{k}.")} for k in range(4)]
    made = [m for m in made if "pos.x" in m] or episodes(played)
    fig, axes = plt.subplots(1, 4, figsize=(13, 8))
    for a, fall, title in zip(axes, real[:2] + made[:2], ["(a) original", "(b) original", "(c) synthesized", "(d) synthesized"]):
        draw_fall(a, fall, half); a.set_title(title)
    one_scale(axes); axes[0].set_ylabel("height, m")
    save("figure-3.png")


def forward_speed(fall, rate):
    velocity = np.gradient(np.array([fall["pos." + a] for a in "xyz"]).T, axis=0) * rate
    forward = [rotated(np.array([q, -x, -y, -z]), v)[1] for q, x, y, z, v in zip(*(fall["q." + a] for a in "wxyz"), velocity)]
    return np.array(forward)


def figure_4():
    """Stalls of a recorded fall, and joins of a played one with its modes, on equal scales."""
    said, recorded = table(DATA / "fresh.csv")
    rate = float(said["rate_hz"])
    model = json.loads(subprocess.run([WISP, "info", str(OUT / "modes.wisp"), "--json"], stdout=subprocess.PIPE, check=True).stdout)
    chain = model["dynamics"]
    fall = episodes(recorded)[0]
    forward = forward_speed(fall, rate)
    stalls = [k for k in range(1, len(forward)) if forward[k - 1] * forward[k] < 0]
    scale, steps, modes = chain["row_scale"][0], chain["segment_steps"], chain["segment_modes"]
    first = np.cumsum([0] + [s + 1 for s in steps])
    fig, axes = plt.subplots(1, 2, figsize=(12, 8))
    rows = min(100, len(fall["pos.x"]))
    x, z = fall["pos.x"] - fall["pos.x"][0], fall["pos.z"] - fall["pos.z"][0]
    axes[0].plot(x[:rows], z[:rows], color="#555", lw=1)
    axes[0].plot([x[k] for k in stalls if k < rows], [z[k] for k in stalls if k < rows], "o", mfc="none", color=RED)
    axes[0].set_title("motion, cut where the leaf stalls")
    colours = plt.cm.tab10(np.arange(10))
    count = max(modes) + 1
    for mode in range(count):
        own = [k for k, m in enumerate(modes) if m == mode]
        for k in own[:: max(1, len(own) // 12)][:12]:
            part = np.array(chain["rows"][first[k]: first[k + 1]], float)[:, :3] * scale
            axes[1].plot(part[:, 0] + .5 * (mode % 2), part[:, 2] - .45 * (mode // 2), color=colours[mode], lw=.8)
        axes[1].text(.5 * (mode % 2), .04 - .45 * (mode // 2), f"{mode}: {len(own)}", color=colours[mode])
    axes[1].set_title("segments of each mode, along their own direction")
    for a in axes:
        a.set_aspect("equal"); a.set_xlabel("m")
    one_scale(axes)
    save("figure-4.png")
    chance = np.array(chain["probabilities"][:count])
    return chance


def figure_5():
    said, _ = table(DATA / "unseen.csv")
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", str(DATA / "unseen.mp4"), "-frames:v", "1", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                         stdout=subprocess.PIPE, check=True).stdout
    picture = np.frombuffer(raw, np.uint8).reshape(int(said["height"]), int(said["width"]), 3)
    channel = {"red": 0, "green": 1, "blue": 2}.get(said.get("channel"), None)
    grey = picture.mean(2) if channel is None else picture[..., channel]
    fig, axes = plt.subplots(1, 2, figsize=(10, 4.5), gridspec_kw={"width_ratios": [1, 2]})
    axes[0].imshow(picture); axes[0].axis("off")
    axes[1].hist(grey.ravel(), bins=128, color=BLUE, log=True)
    axes[1].axvline(float(said["threshold"]), color=RED); axes[1].set_xlabel(f"brightness ({said.get('channel', 'grey')}), the threshold that capture chose"); axes[1].set_ylabel("pixels")
    save("figure-5.png")


def figure_6():
    said, _ = table(DATA / "unseen.csv")
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", str(DATA / "unseen.mp4"), "-ac", "1", "-ar", "22050", "-f", "f32le", "-"], stdout=subprocess.PIPE, check=True).stdout
    sound, rate = np.frombuffer(raw, np.float32), float(said["rate_hz"])
    per = int(22050 / rate)
    rms = np.sqrt((sound[: len(sound) // per * per].reshape(-1, per) ** 2).mean(1))
    fig, axes = plt.subplots(1, 2, figsize=(12, 3.5))
    axes[0].plot(np.arange(len(sound)) / 22050, sound, lw=.2, color=BLUE); axes[0].set_title("raw amplitude")
    axes[1].plot(np.arange(len(rms)) / rate, rms, color=BLUE); axes[1].set_title("root mean square, frame by frame")
    for a in axes: a.set_xlabel("seconds")
    save("figure-6.png")


def figure_7():
    noise = json.load(open(OUT / "paper.json"))["dynamics"]["noise"]
    sd, interval = np.array(noise["sd"]), np.array(noise["sd_ci95"])
    points = np.arange(1, len(sd) // 2 + 1)
    plt.figure(figsize=(8, 4.5))
    for k, style, label in ((1, "-", "vertical"), (0, "--", "horizontal")):
        plt.plot(points, sd[k::2], style, color=BLUE if k else RED, label=label)
        if interval.size:
            for edge in (0, 1): plt.plot(points, interval[k::2, edge], "_", ms=9, color=BLUE if k else RED)
    plt.xlabel("control point"); plt.ylabel("standard deviation of the residual, flame heights"); plt.legend()
    save("figure-7.png")


CAPTIONS = [
    ("figure-1.png", "Figure 1. A flame in a gust, as filmed (the candle rig's camera, a clip that nothing was learned from)."),
    ("figure-2.png", "Figure 2. The learned flame in the same wind, the same frames: from the sound alone."),
    ("figure-3.png", "Figure 3. Falls from the side, the leaf drawn along its path: (a), (b) the original dynamics; (c), (d) synthesized."),
    ("figure-4.png", "Figure 4. Motion is cut where the leaf stalls (circles), and its segments are clustered into modes. Both halves have one scale."),
    ("figure-5.png", "Figure 5. A frame and the histogram of its brightness; the flame is the part right of the threshold."),
    ("figure-6.png", "Figure 6. The clip's sound: raw amplitude, and its root mean square frame by frame."),
    ("figure-7.png", "Figure 7. Standard deviations of the residuals of each control point (the paper's systems of order 4), with their 95 % intervals."),
    ("gusts/gusts-above.png", "Figure 8. Falls in gusts, seen from above: recorded and played; where the wind blows is marked."),
]

if __name__ == "__main__":
    import os
    WISP = os.environ.get("WISP", "wisp")
    figures_1_2(); figure_3(); chance = figure_4(); figure_5(); figure_6(); figure_7()
    rows = "".join("<tr>" + "".join(f"<td>{p:.2f}</td>" for p in row) + "</tr>" for row in chance)
    body = "".join(f'<figure><img src="{name}"><figcaption>{text}</figcaption>'
                   + (f"<table><caption>how often each mode follows each</caption>{rows}</table>" if name == "figure-4.png" else "")
                   + "</figure>" for name, text in CAPTIONS)
    body += "".join(f'<figure><video src="{name}" controls loop muted></video><figcaption>{text}</figcaption></figure>' for name, text in (
        ("flamevalidation.mp4", "flamevalidation: the clip with the captured outline and the one simulated from its sound."),
        ("leafexamples.mp4", "leafexamples: recorded falls beside synthesized ones.")))
    (OUT / "index.html").write_text("<!doctype html><meta charset=utf-8><title>The paper's figures</title><style>body{max-width:1100px;margin:2em auto;"
                                    "font:16px/1.5 sans-serif}img,video{max-width:100%}figure{margin:3em 0}td{padding:0 .5em}</style><h1>The paper's figures</h1>" + body)
