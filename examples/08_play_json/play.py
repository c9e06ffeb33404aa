#!/usr/bin/env python3
"""Plays a model from the output of `wisp info MODEL.wisp --json` alone: a pattern for players in other languages.

    wisp info MODEL.wisp --json | python3 play.py [FRAMES] [WIND] [SEED] [on|off] >play.csv

The numbers are those of `wisp run MODEL.wisp --frames FRAMES --wind WIND --seed SEED --noise on|off`, to the bit. WIND is a
number, or a file with a line per frame: one number per input, separated by commas. docs/reference/model-file.md ("How a model
is played") says the same in words. This file plays ARX and switched models; resampled.py and chain.py have the rest.
"""
import itertools, json, math, sys
from chain import play_chain
from resampled import Resampled
from shared import FORMS, F, clamp, edges, kept, normals, regress, settle, unit_of, words


def likely(chances, word):  # one step of a Markov chain by a random word; without a word, the most probable state
    last = max(k for k, p in enumerate(chances) if p > 0)
    sums = [min(math.floor(s * 2**32), 2**32 - 2) for s in itertools.accumulate(chances)]
    tops = [2**32 - 1 if k >= last else s for k, s in enumerate(sums)]
    if word is None:
        return max(range(len(tops)), key=lambda k: (tops[k] - (tops[k - 1] if k else 0), -k))
    return next(k for k, top in enumerate(tops) if top == 2**32 - 1 or word < top)


class Life:
    """Extinction: wind adds harm, at harm 1 the flame goes out: its last shape is then scaled by the sizes of a recorded event."""

    def __init__(self, rule, model, seed):
        step, self.input = 1 / model["rate_hz"], [i["name"] for i in model["inputs"]].index(rule["input"])
        harm, haste, self.level = min(step / rule["seconds"], 0.5), rule["haste"], F(rule["level"])
        self.most = F((min(3, 1 + (0.5 / harm - 1) / haste) if haste > 0 else 3) * rule["level"])
        self.base, self.slope = kept(harm * (1 - haste)), kept(harm * haste / rule["level"])
        self.recovery, ends, sizes = kept(step / rule["recovery"]), rule["dying"]["ends"], rule["dying"]["sizes"]
        self.events = [sizes[begin:end] for begin, end in zip([0] + ends, ends)]
        self.seed, self.harm, self.event, self.shape = seed, F(0), None, None

    def seen(self, shown, inputs, step):
        wind = min(abs(F(inputs[self.input])), self.most)
        self.harm = clamp(self.harm + (-self.recovery if wind < self.level else self.base + self.slope * wind), F(0), F(1))
        if self.shape is None and self.harm >= 1:
            self.shape, drawn = shown, words(self.seed, step + 1, 0xFFFF)[0]
            self.event = iter(self.events[drawn % len(self.events)])
        if self.shape is not None:
            size = F(next(self.event, 0)) / F(255)
            return [size * value if size > 0 else F(0) for value in self.shape]
        return shown


def points_of(shape, components):
    """Control points of a shape: rest + basis · components; left and right points in pairs, symmetric coordinates first."""
    points, even, odd = len(shape["rest"]) // 2, shape["symmetric"], shape["antisymmetric"]

    def coordinate(i):
        first, own = (i * even, components[:even]) if i < points else (points * even + (i - points) * odd, components[even:])
        total = kept(shape["rest"][i])
        for k, z in enumerate(own):
            weight = kept(shape["basis"][first + k])
            total = total + weight * z if weight != 0 else total
        return clamp(total, *map(kept, shape["coordinates"][i]))

    out = [F(0)] * (2 * points)
    for p in range(points // 2):
        for axis in range(2):
            even_one, odd_one = coordinate(2 * p + axis), coordinate(points + 2 * p + axis)
            half, middle = (even_one, odd_one) if axis == 0 else (odd_one, even_one)
            out[2 * p + axis], out[2 * (points - 1 - p) + axis] = settle(middle - half), settle(middle + half)
    if points % 2:
        out[points - 1], out[points] = settle(coordinate(2 * points - 1)), settle(coordinate(points - 1))
    return out


def play(model, winds, seed=1, noise=True):
    """Yields the outputs of every frame; `winds` has each frame's inputs."""
    d, outputs, shape = model["dynamics"], model["outputs"], (model.get("view") or {}).get("shape")
    if shape:  # the dynamics' outputs are components of the shape
        outputs = [{"range": r} for r in shape["components"]]
    ny = len(outputs)
    if d["kind"] == "chain":
        yield from play_chain(model, winds, seed, noise)
        return
    forms = [(item, *form) for item in model["inputs"] for form in FORMS[item["form"]]]
    unit = [unit_of(o) for o in outputs] + [unit_of(item) ** power for item, _, power in forms]
    clamped = [[F((edge - mean) / u) for edge in edges(o)] for o, mean, u in zip(outputs, d["output_mean"], unit)]

    def row(mode, i):  # of output i: constant, taps (weight, channel, lag), shocks (standard deviation, index of the deviate)
        taps = [(b * unit[ny + k] / unit[i], ny + k, d["nk"][i][k] + lag)
                for k in range(len(forms)) for lag, b in reversed(list(enumerate(mode["B"][i][k])))]
        taps += [(-a * unit[j] / unit[i], j, 1 + lag)
                 for j in range(ny) for lag, a in reversed(list(enumerate(mode["A"][i][j])))]
        if "shock" in mode:
            shocks = list(enumerate(mode["shock"][i][: i + 1]))
        else:
            shocks = [(i, d["noise"]["sd"][i])]
        return kept(mode["constant"][i] / unit[i]), [(kept(w), c, lag) for w, c, lag in taps], \
            [(kept(size / unit[i]), k) for k, size in shocks]

    rows = [[row(mode, i) for i in range(ny)] for mode in d.get("modes", [d])]
    groups = 1 + max(k for mode in rows for _, _, shocks in mode for _, k in shocks) // 8
    past = [[settle(clamp(F(0), *h)) for h in clamped] + [F(0)] * len(forms) for _ in range(d["history"] + 1)]
    mode, resampled = None, Resampled(model, unit) if (d.get("noise") or {}).get("resampled") else None
    life = Life(model["extinction"], model, seed) if model.get("extinction") else None
    for step, wind in enumerate(winds):
        now = [F(0)] * ny + [regress(*form, mean, wind[model["inputs"].index(form[0])]) for form, mean in zip(forms, d["input_mean"])]
        past = [now] + past[:-1]
        if "transitions" in d:
            word = words(seed, step, (ny + 7) // 8)[0] if noise else None
            mode = likely(d["initial"] if mode is None else d["transitions"][mode], word)
        drawn = None
        if resampled:
            resampled.hear(now[ny:])
            drawn = resampled.step(words(seed, step, 0)) if noise else [F(0)] * ny
        deviates = [] if resampled else [z for g in range(groups) for w in words(seed, step, g) for z in normals(w)]
        for i, (total, taps, shocks) in enumerate(rows[mode or 0]):
            if drawn:
                total = total + drawn[i]
            for size, k in shocks if noise and not drawn else []:
                total = total + size * deviates[k]
            for weight, channel, lag in taps:
                total = total + weight * past[lag][channel]
            now[i] = settle(clamp(total, *clamped[i]))
        shown = [clamp(F(mean) + F(u) * z, *map(F, edges(o))) for o, mean, u, z in zip(outputs, d["output_mean"], unit, now)]
        shown = points_of(shape, shown) if shape else shown
        yield life.seen(shown, wind, step) if life else shown


if __name__ == "__main__":
    frames, wind, seed, noise = sys.argv[1:] + ["100", "0", "1", "on"][len(sys.argv) - 1:]
    of = json.load(sys.stdin)
    print(",".join(o["name"] for o in of["outputs"]))
    try:
        winds = [[float(wind)] * len(of["inputs"])] * int(frames)
    except ValueError:
        winds = [list(map(float, line.split(","))) for line in itertools.islice(open(wind), int(frames))]
    for values in play(of, winds, int(seed), noise == "on"):
        print(",".join(repr(float(v)) for v in values))
