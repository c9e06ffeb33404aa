#!/usr/bin/env python3
"""Fits the weights of the verdict on an outline: src/capture/vision/outline_verdict_weights.hpp.

  tools/fit_verdict.py gather FACTS.txt WISP SCENES FILMS [STREETS…]   makes clips, captures them, writes their facts
  tools/fit_verdict.py fit FACTS.txt… > outline_verdict_weights.hpp    fits, prints its figures to standard error

WISP and SCENES: the programs wisp and wisp_verify_scenes; FILMS: ../shared/data/flame; STREETS: films without a flame, as those of
opencv-doc. A line of facts: family/name;flame;right;fact=value;…  Lines of `wisp_verify_scenes fresh SEED facts` are read as they
are. A fact's curve is linear between five knots and monotone; both models are logistic, their weights not negative, with a penalty
on their sum. Turned films are not used for the flame's model, films with a hand in front for neither. Needs ffmpeg, NumPy and SciPy.
"""

import json
import os
import subprocess
import sys
import tempfile

import numpy as np
from scipy.optimize import minimize

# The knots of each fact, in the order of outline_verdict.cpp: from the worst value to the value above which there is no further
# improvement. Values of right and of wrong outlines, in films and in rendered scenes, lie between them.
FACTS = {"movement": (0.003, 0.008, 0.016, 0.03, 0.06), "over_noise": (1, 2, 4, 8, 16),
         "wander": (6, 3, 1.5, 0.8, 0.3), "still": (0.6, 0.45, 0.3, 0.15, 0), "steadiness": (0.48, 0.54, 0.6, 0.7, 0.8),
         "taper": (0, 0.2, 0.32, 0.42, 0.52), "light": (0.75, 0.85, 0.9, 0.94, 0.97), "contrast": (10, 25, 50, 80, 120),
         "width": (1.3, 1, 0.8, 0.65, 0.5), "misfit": (0.35, 0.2, 0.1, 0.04, 0), "lean": (80, 60, 45, 25, 10), "lost": (0.3, 0.15, 0.08, 0.04, 0),
         "repeated": (0.5, 0.35, 0.25, 0.15, 0.05), "elsewhere": (0.4, 0.2, 0.1, 0.05, 0), "missing": (0.2, 0.08, 0.04, 0.02, 0),
         "jumps": (0.15, 0.06, 0.03, 0.01, 0), "border": (0.4, 0.15, 0.06, 0.03, 0), "height": (6, 9, 12, 18, 30), "tracked": (10, 15, 20, 30, 50)}
FLAME = list(FACTS)[:11]  # the facts that decide whether it is a flame
# Facts of which a single bad value makes an outline wrong. Every sixth right capture is repeated once per fact, as an example of a
# wrong one, with that fact at its second knot.
MUST = ["still", "taper", "width", "misfit", "lean", "lost", "repeated", "elsewhere", "missing", "jumps", "border", "height",
        "tracked"]
KNOTS = 5
PENALTY = 0.0015  # times the sum of weights, added to the mean loss
CODERS = (["-c:v", "mpeg4", "-q:v", "8", "-g", "30"], ["-c:v", "libx264", "-crf", "23"], ["-c:v", "mpeg4", "-q:v", "16", "-g", "12"],
          ["-c:v", "libx264", "-crf", "33"], ["-c:v", "mjpeg", "-q:v", "12"])


def encode(raw, path, size, rate, coder):
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", str(rate), "-i", "-", *coder,
                    "-pix_fmt", "yuv420p", path], input=raw, check=True)


def facts_of(wisp, clip, scratch, *flags):
    done = subprocess.run([wisp, "capture", "flame", clip, "-o", os.path.join(scratch, "x.csv"), "--json", "--quiet", *flags], capture_output=True, text=True)
    if done.returncode != 0:
        return None, done.stderr.strip()
    report = json.loads(done.stdout)
    return {fact["fact"]: fact["value"] for fact in report["facts"]}, report["usable"]["reason"]


def altered(source, path, how, seconds=4, start=0):
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-ss", str(start), "-t", str(seconds), "-i", source, "-filter_complex", how, "-an", "-c:v", "libx264",
                    "-crf", "22", "-pix_fmt", "yuv420p", path], check=True)


SMALL = "scale=trunc(iw*min(1\\,360/ih)/2)*2:trunc(ih*min(1\\,360/ih)/2)*2:flags=area"
# Name: (filter of ffmpeg, whether the outline remains right). Encoders need even sizes.
ALTERED = {"small": ("null", 1), "mirrored": ("hflip", 1), "grey": ("hue=s=0", 1), "noise": ("noise=alls=12:allf=t", 1),
           "gamma": ("eq=gamma=0.75", 1), "slow": ("setpts=3*PTS", 1), "down": ("vflip", 0), "side": ("transpose=1", 0),
           "doubled": ("fps={rate},fps={twice},noise=alls=4:allf=t", 0), "dropped": ("select='gt(random(1),0.35)'", 0),
           "jolted": ("crop=iw*0.75:ih*0.75:'if(mod(floor(n/3),2),iw*0.25,0)':'if(mod(floor(n/5),2),ih*0.25,0)'", 0),
           "tiny": ("scale=trunc(iw*0.06)*2:-2:flags=area,scale=iw*2:-2", 0),
           "cut": ("scale=320:240:force_original_aspect_ratio=decrease,pad=320:240,fps=25,trim=0:2[a];movie={street},scale=320:240,fps=25,"
                   "trim=0:2,setpts=PTS-STARTPTS[b];[a][b]concat", 0)}
RATES = {"tiny_red": 12, "snuffed": 24, "yellow": 25, "red_candle": 25}


def gather(out, wisp, scenes, films, *streets):
    file = open(out, "a")

    def put(family, name, flame, right, clip, scratch):
        facts, reason = facts_of(wisp, clip, scratch)
        if facts is None:
            print(f"{family}/{name}: {reason}", file=sys.stderr, flush=True)
            return
        file.write(f"{family}/{name};{flame};{right};" + ";".join(f"{k}={v:.5g}" for k, v in facts.items()) + "\n")
        file.flush()

    with tempfile.TemporaryDirectory() as scratch:
        clip = os.path.join(scratch, "clip.avi")
        kinds = ["street", "cartoon", "tree", "sky", "pane", "lamp", "bulb", "dimmed", "cup", "fireworks", "glow", "flag"]
        for seed in range(1, 8):
            for k, kind in enumerate(kinds):
                for coder in CODERS[seed % 5:][:1] if kind not in ("lamp", "bulb") else CODERS:
                    encode(subprocess.run([scenes, "raw", "none", kind, str(seed)], capture_output=True, check=True).stdout, clip, "240x200", 25, coder)
                    put(f"none {kind}", f"{seed} {coder[1]} {coder[3]}", 0, 0, clip, scratch)
        for film in sorted(os.path.join(at, name) for at, _, names in os.walk(films) for name in names if name.endswith(".mp4")):
            for name, (how, right) in ALTERED.items():
                rate = next((value for part, value in RATES.items() if part in film), 30)
                altered(film, clip, f"{SMALL}," + how.format(rate=rate, twice=2 * rate, street=streets[-1]))
                put("film " + os.path.basename(film)[:12], name, 1, right, clip, scratch)
        for film in streets:
            for start in (0, 4, 8):
                altered(film, clip, SMALL, start=start)
                put("street " + os.path.basename(film)[:12], str(start), 0, 0, clip, scratch)
                altered(film, clip, "crop=iw/2:ih/2,scale=trunc(iw/2)*2:trunc(ih/2)*2", start=start)
                put("street " + os.path.basename(film)[:12], f"{start} crop", 0, 0, clip, scratch)


def family_of(name):
    """The group of a capture, which cross-validation leaves out as a whole: a film, a kind of flameless film, a kind of scene."""
    if "/" in name:
        return name.split("/")[0]
    if name.startswith("unfair"):
        return "unfair " + name.split(":")[1].split(",")[0].strip()
    return "scene " + name.lstrip("0123456789 ").split(",")[0].split(" ")[0]


def read(paths):
    names, labels, rows = [], [], []
    for path in paths:
        for line in open(path):
            name, flame, right, *facts = line.strip().split(";")
            if len(facts) < len(FACTS) or "a hand in front" in name:
                continue
            values = dict(fact.split("=") for fact in facts)
            values["missing"] = max(0, float(values["missing"]) - float(values["lost"]))  # lost frames count as `lost` only
            names.append(name)
            labels.append((int(flame), int(right)))
            rows.append([float(values[fact]) for fact in FACTS])
    return names, np.array(labels), np.array(rows)


def ramps(values, knots):
    """For each interval between knots, the share (0 to 1) that a value falls short of its good end; the worst interval first."""
    return np.array([np.clip((values - good) / (bad - good), 0, 1) for bad, good in zip(knots, knots[1:])]).T


def fit(design, labels, weights):
    def loss(p):
        odds = p[0] - design @ p[1:]
        value = np.sum(weights * np.logaddexp(0, np.where(labels, -odds, odds)))
        slope = weights * (1 / (1 + np.exp(-odds)) - labels)
        return value + PENALTY * p[1:].sum(), np.r_[slope.sum(), -design.T @ slope + PENALTY]

    bounds = [(-20, 20)] + [(0, 30)] * design.shape[1]
    return minimize(loss, np.r_[1, np.full(design.shape[1], 0.05)], jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": 400}).x


def balanced(labels, families):
    """Weights: a family weighs as the root of its size, and each label half of the total."""
    sizes = {family: families.count(family) for family in set(families)}
    weights = np.array([sizes[family] ** -0.5 for family in families])
    for label in (0, 1):
        weights[labels == label] /= 2 * max(weights[labels == label].sum(), 1e-9)
    return weights


def table(odds, labels, name):
    likely = 1 / (1 + np.exp(-odds))
    wrong, refused = np.sum((likely > 0.5) & (labels == 0)), np.sum((likely <= 0.5) & (labels == 1))
    print(f"{name}: wrong and yes {wrong} of {np.sum(labels == 0)}, right and no {refused} of {np.sum(labels == 1)}", file=sys.stderr)
    for low in np.arange(0, 1, 0.2):
        those = (likely >= low) & (likely < low + 0.2 + (low > 0.7))
        if those.any():
            print(f"  said {likely[those].mean():.2f}  true {labels[those].mean():.2f}  of {those.sum()}", file=sys.stderr)


def main_fit(paths):
    names, labels, rows = read(paths)
    families = [family_of(name) for name in names]
    real = len(names)
    for k in [k for k in np.flatnonzero(labels[:, 1])][::6]:
        for fact in MUST:
            worse = rows[k].copy()
            worse[list(FACTS).index(fact)] = FACTS[fact][1]
            rows, labels = np.vstack([rows, worse]), np.vstack([labels, [1, 0]])
            names, families = names + [names[k]], families + [families[k]]
    made = np.where(np.arange(len(names)) < real, 1, 0.3)
    parts = [ramps(rows[:, k], knots) for k, knots in enumerate(FACTS.values())]
    flame_design, right_design = np.hstack(parts[: len(FLAME)]), np.hstack(parts)
    is_flame, is_right = labels[:, 0], labels[:, 1]
    print(f"{real} captures of {len(set(families))} families", file=sys.stderr)
    upright = np.array([not name.endswith(("/down", "/side")) for name in names]) & (made == 1)
    held = {"flame": np.zeros(len(names)), "right": np.zeros(len(names))}
    for family in sorted(set(families)):
        out = np.array([f == family for f in families])
        kept = [f for f in families if f != family]
        for what, design, label in (("flame", flame_design, is_flame), ("right", right_design, is_right)):
            p = fit(design[~out], label[~out], balanced(label[~out], kept) * (made if what == "right" else upright)[~out])
            held[what][out] = p[0] - design[out] @ p[1:]
    table(held["flame"][upright], is_flame[upright], "a flame, its family left out")
    table(held["right"][:real], is_right[:real], "right, its family left out")
    for name, odds, right in zip(names[:real], held["right"], is_right):
        if (odds > 0) != bool(right):
            print(f"    {'usable' if odds > 0 else 'refused'} {odds:6.2f}  {name}", file=sys.stderr)
    both = {}
    for what, design, label in (("flame", flame_design, is_flame), ("right", right_design, is_right)):
        p = fit(design, label, balanced(label, families) * (made if what == "right" else upright))
        table((p[0] - design @ p[1:])[upright], label[upright], f"{what}, fitted on all")
        both[what] = p
    write(both)


def penalties(p, k):
    steps = p[1 + (KNOTS - 1) * k:][: KNOTS - 1] if len(p) > 1 + (KNOTS - 1) * k else np.zeros(KNOTS - 1)
    return np.r_[np.cumsum(steps[::-1])[::-1], 0]


def write(both):
    row = lambda values: "{" + ", ".join(f"{value:.4g}" for value in values) + "}"
    print("""#pragma once
// Fitted by tools/fit_verdict.py: do not edit.

#include <array>
#include <cstddef>

namespace wisp {

inline constexpr std::size_t kVerdictKnots = 5;

/// A fact's knots, and how much it lowers the two log odds at each of them.
struct VerdictCurve {
  std::array<double, kVerdictKnots> knots;
  std::array<double, kVerdictKnots> against_flame;
  std::array<double, kVerdictKnots> against_right;
};

// One fact per row; its name is in the comment.
// clang-format off""")
    print(f"inline constexpr double kFlameOdds = {both['flame'][0]:.4g};\ninline constexpr double kRightOdds = {both['right'][0]:.4g};\n")
    print(f"inline constexpr std::array<VerdictCurve, {len(FACTS)}> kVerdictCurves{{{{")
    for k, (fact, knots) in enumerate(FACTS.items()):
        order = slice(None) if knots[0] < knots[-1] else slice(None, None, -1)
        curves = [penalties(both[what], k)[order] for what in ("flame", "right")]
        print(f"    {{{row(knots[order])}, {row(curves[0])}, {row(curves[1])}}},  // {fact}")
    print("}};\n// clang-format on\n\n}  // namespace wisp")


if __name__ == "__main__":
    if len(sys.argv) > 2 and sys.argv[1] == "fit":
        main_fit(sys.argv[2:])
    elif len(sys.argv) > 5 and sys.argv[1] == "gather":
        gather(*sys.argv[2:])
    else:
        sys.exit(__doc__)
