#!/usr/bin/env python3
"""Plays a model from nothing but what `wisp info MODEL.wisp --json` says of it: a player in another language.

    wisp info MODEL.wisp --json | python3 08_play_json.py [FRAMES] [WIND] [SEED] [on|off] >play.csv

The numbers are those of `wisp run MODEL.wisp --frames FRAMES --wind WIND --seed SEED --noise on|off`, to the bit: for
ARX models with Gaussian noise and for switched ones; without noise for models with resampled residuals too. Chains are
refused, and no flame goes out. docs/reference/model-file.md ("How a model is played") says the same in words.
"""
import itertools, json, math, sys
import numpy as np

F = np.float32  # all arithmetic of a step is in single precision


def kept(value): return F(0) if abs(value) < 1e-10 else F(value)
def settle(z): return F(0) if abs(z) < F(1e-20) else z
def clamp(z, low, high): return min(max(z, low), high)


def edges(item):  # the range and half of it more on either side
    low, high = item["range"]
    return low - 0.5 * (high - low), high + 0.5 * (high - low)


def unit_of(item):  # a power of two near the range
    size = item["range"][1] - item["range"][0]
    return 1.0 if size <= 0 or 1 / 128 <= size <= 128 else 2.0 ** (math.frexp(size)[1] - 1)


def bend(u, item):  # an input's curve: straight pieces between its knots
    at, value = item["curve"]["at"], item["curve"]["value"]
    y = F(value[0])
    if not u > F(at[0]):
        return u
    for k in range(len(at) - 1):
        width, slope = F(at[k + 1] - at[k]), F((value[k + 1] - value[k]) / (at[k + 1] - at[k]))
        if u < F(at[k + 1]):
            return y + slope * min(u - F(at[k]), width)
        y = y + slope * width
    return y + (u - F(at[-1]))


def regress(item, sign, power, mean, u):  # one of the numbers that the dynamics see of an input
    unit = unit_of(item)
    u = clamp(F(u), *map(F, edges(item)))
    u = max(F(sign) * u, F(0)) if sign else u
    u = bend(u, item) if "curve" in item else u
    if power == 1:
        return settle((u - F(mean)) * F(1 / unit))
    u = u * F(1 / unit)
    return settle((np.sqrt(u) if power == 0.5 else u * u) - F(mean / unit**power))


def words(seed, step, group, stream=0):  # Philox4x32 of 7 rounds: four random words
    full = 0xFFFFFFFF
    w, key = [step & full, step >> 32 << 16 ^ group, stream & full, stream >> 32], [seed & full, seed >> 32]
    for _ in range(7):
        a, b = w[0] * 0xD2511F53, w[2] * 0xCD9E8D57
        w = [b >> 32 ^ w[1] ^ key[0], b & full, a >> 32 ^ w[3] ^ key[1], a & full]
        key = [key[0] + 0x9E3779B9 & full, key[1] + 0xBB67AE85 & full]
    return w


def normal(word, table):  # the deviate that a word stands for
    bits = int((F(word ^ 0xFFFFFFFF if word >> 31 else word) + F(0.5)).view(np.uint32))
    c0, c1, c2 = map(F, table[(bits >> 19) - (126 << 4)])
    z = c0 + F(bits & 0x7FFFF) * (c1 + F(bits & 0x7FFFF) * c2)
    return -z if word >> 31 else z


def likely(chances, word):  # a step of a Markov chain; without a word the likeliest
    last = max(k for k, p in enumerate(chances) if p > 0)
    sums = [min(math.floor(s * 2**32), 2**32 - 2) for s in itertools.accumulate(chances)]
    tops = [2**32 - 1 if k >= last else s for k, s in enumerate(sums)]
    if word is None:
        return max(range(len(tops)), key=lambda k: (tops[k] - (tops[k - 1] if k else 0), -k))
    return next(k for k, top in enumerate(tops) if top == 2**32 - 1 or word < top)


def play(model, frames, wind, seed=1, noise=True):
    """Yields the outputs of every frame; `wind` is the value of all inputs."""
    d, outputs, ny = model["dynamics"], model["outputs"], len(model["outputs"])
    if d["kind"] == "chain" or noise and (d.get("noise") or {}).get("resampled"):
        sys.exit("08_play_json.py: chains are not played, and resampled residuals only without noise (`off`)")
    forms = [(item, sign, power) for item in model["inputs"] for sign in ([1, -1] if "split" in item["form"] else [0])
             for power in ([1, 0.5, 2] if "powers" in item["form"] else [1])]
    unit = [unit_of(o) for o in outputs] + [unit_of(item) ** power for item, _, power in forms]
    held = [[F((edge - mean) / u) for edge in edges(o)] for o, mean, u in zip(outputs, d["output_mean"], unit)]

    def row(mode, i):  # of one output: its constant, its taps (weight, channel, lag), its shocks (size, deviate)
        taps = [(-a * unit[j] / unit[i], j, 1 + lag) for j in range(ny) for lag, a in enumerate(mode["A"][i][j])]
        taps += [(b * unit[ny + k] / unit[i], ny + k, d["nk"][i][k] + lag)
                 for k in range(len(forms)) for lag, b in enumerate(mode["B"][i][k])]
        if "shock" in mode:
            shocks = list(enumerate(mode["shock"][i][: i + 1]))
        else:
            shocks = [(i, d["noise"]["sd"][i])] + list(enumerate(d["noise"]["mixing"][i], ny))
        return kept(mode["constant"][i] / unit[i]), [(kept(w), c, lag) for w, c, lag in taps], \
            [(kept(size / unit[i]), k) for k, size in shocks]

    rows = [[row(mode, i) for i in range(ny)] for mode in d.get("modes", [d])]
    groups = 1 + max(k for mode in rows for _, _, shocks in mode for _, k in shocks) // 4
    names = [name.strip(")").split("(t-") for name in d.get("region_columns", [])[1:]]
    samples = [(int(name[1:]) + (ny if name[0] == "u" else 0), int(lag)) for name, lag in names]
    regions = [[r[0]] + [w * unit[c] for w, (c, _) in zip(r[1:], samples)] for r in d.get("regions", [])]
    most = max((abs(w) for r in regions for w in r), default=0) or 1

    def score(region):  # of a mode's region: an affine function of the past
        total = kept(region[0] * (1 / most))
        for w, (c, lag) in zip(region[1:], samples):
            total = total + kept(w * (1 / most)) * past[lag][c]
        return total

    past = [[settle(clamp(F(0), *h)) for h in held] + [F(0)] * len(forms) for _ in range(d["history"] + 1)]
    mode = None
    for step in range(frames):
        now = [F(0)] * ny + [regress(*form, mean, wind) for form, mean in zip(forms, d["input_mean"])]
        past = [now] + past[:-1]
        if regions:
            mode = max(range(len(regions)), key=lambda k: (score(regions[k]), -k))
        elif "transitions" in d:
            word = words(seed, step, (ny + 3) // 4)[0] if noise else None
            mode = likely(d["initial"] if mode is None else d["transitions"][mode], word)
        deviates = [normal(w, model["random"]["normal_table"]) for g in range(groups) for w in words(seed, step, g)]
        for i, (total, taps, shocks) in enumerate(rows[mode or 0]):
            for size, k in shocks if noise else []:
                total = total + size * deviates[k]
            for weight, channel, lag in taps:
                total = total + weight * past[lag][channel]
            now[i] = settle(clamp(total, *held[i]))
        yield [clamp(F(mean) + F(u) * z, *map(F, edges(o))) for o, mean, u, z in zip(outputs, d["output_mean"], unit, now)]


if __name__ == "__main__":
    frames, wind, seed, noise = sys.argv[1:] + ["100", "0", "1", "on"][len(sys.argv) - 1:]
    of = json.load(sys.stdin)
    print(",".join(o["name"] for o in of["outputs"]))
    for values in play(of, int(frames), float(wind), int(seed), noise == "on"):
        print(",".join(repr(float(v)) for v in values))
