#!/usr/bin/env python3
"""Plays a model from nothing but what `wisp info MODEL.wisp --json` says of it: a player in another language.

    wisp info MODEL.wisp --json | python3 08_play_json.py [FRAMES] [WIND] [SEED] [on|off] >play.csv

The numbers are those of `wisp run MODEL.wisp --frames FRAMES --wind WIND --seed SEED --noise on|off`, to the bit: for
ARX models with Gaussian noise or resampled residuals and for switched ones. WIND is a number, or a file with one a line.
Chains are refused, and no flame goes out. docs/reference/model-file.md ("How a model is played") says the same in words.
"""
import itertools, json, math, sys
import numpy as np

F = np.float32  # all arithmetic of a step is in single precision


def kept(value): return F(0) if abs(value) < 1e-10 else F(value)
def bounded(value): return kept(min(max(value, -1e9), 1e9))
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


class Resampled:
    """Residuals as they were: row after row, and a jump where another row's past is more like the input's."""

    def __init__(self, d, unit):
        ny, r = len(d["output_mean"]), d["noise"]["resampled"]
        self.lags, self.longest, self.toward, self.against = r["lags"], r["longest"], r["toward"], r["against"]
        self.rows = [[bounded(x * (scale / u)) for x, scale, u in zip(row, r["scale"], unit)] for row in r["rows"]]
        self.sides = [[(i, F(1)) for i in range(ny)]]
        if r["mirror"]:
            self.sides += [[(abs(m) - 1, bounded((-1 if m < 0 else 1) * unit[abs(m) - 1] / u)) for m, u in zip(r["mirror"], unit)]]
        stretches = list(enumerate(zip([0] + r["ends"], r["ends"])))
        self.left = [end - 1 - row for _, (begin, end) in stretches for row in range(begin, end)]
        self.at, self.played = (0, 0), [(0, self.longest)] + [(0, 0)] * 3  # (row, side); (last row, steps) of blocks
        if self.toward < 0:
            return
        scale, of, depth = unit[ny + self.toward], d["input_mean"], self.lags[-1]
        mean = (of[self.toward] - (of[self.against] if self.against >= 0 else 0)) / scale
        winds = [bounded(w * (r["wind_scale"] / scale) - mean) for w in r["winds"]]
        now = [row + (k + 1) * depth for k, (begin, end) in stretches for row in range(begin, end)]
        self.pasts = [[winds[place - lag] for lag in self.lags] for place in now]
        self.turned = [len(self.sides) > 1 and sum(past, F(0)) < 0 for past in self.pasts]
        self.tolerance, self.margin = bounded(len(self.lags) * r["tolerance"] / scale), bounded(r["margin"] / scale)
        self.heard = [F(0)] * (depth + 1)
        least = min(max(self.left), 6)
        self.order, self.nodes, leaves = [row for row, left in enumerate(self.left) if left >= least], {}, 1
        while (len(self.order) + leaves - 1) // leaves > 8:
            leaves *= 2
        self.grow(0, 0, len(self.order), leaves - 1)

    def past(self, row, k):
        return -self.pasts[row][k] if self.turned[row] else self.pasts[row][k]

    def grow(self, node, begin, end, nodes):  # a balanced tree over the pasts: halves by the lag that spreads widest
        if node >= nodes:
            return
        spread = [max(column) - min(column) for column in
                  ([self.past(row, k) for row in self.order[begin:end]] for k in range(len(self.lags)))]
        k, middle = spread.index(max(spread)), begin + (end - begin) // 2
        self.order[begin:end] = sorted(self.order[begin:end], key=lambda row: (self.past(row, k), row * 0x9E3779B1 % 2**32))
        low, high = self.past(self.order[middle - (middle > begin)], k), self.past(self.order[middle], k)
        self.nodes[node] = F(0.5) * (low + high), k
        self.grow(2 * node + 1, begin, middle, nodes)
        self.grow(2 * node + 2, middle, end, nodes)

    def hear(self, regressors):
        if self.toward >= 0:
            wind = regressors[self.toward] - (regressors[self.against] if self.against >= 0 else F(0))
            self.heard = [wind] + self.heard[:-1]

    def apart(self, row, side):  # how far the input's past is from a row's
        total = F(0)
        for then, lag in zip(self.pasts[row], self.lags):
            total = total + abs(then + self.heard[lag] if side else then - self.heard[lag])
        return total

    def leaf(self, turned, word):
        begin, end, node = 0, len(self.order), 0
        while node in self.nodes:
            value, k = self.nodes[node]
            away = F(0) - value - self.heard[self.lags[k]] if turned else self.heard[self.lags[k]] - value
            right = word >> 31 if abs(away) <= self.margin else int(away > 0)
            middle = begin + (end - begin) // 2
            begin, end = (middle, end) if right else (begin, middle)
            node, word = 2 * node + 1 + right, (word << 1 | word >> 31) & 0xFFFFFFFF
        return self.order[begin:end]

    def jump(self, on, ahead, words):  # where to go on; `ahead`: what staying costs, None where that cannot be
        if self.toward < 0:
            return words[0] * len(self.left) >> 32, 0
        turned = len(self.sides) > 1 and sum((self.heard[lag] for lag in self.lags), F(0)) < 0
        found = [(row, int(turned != self.turned[row])) for row in self.leaf(turned, words[0])]
        fresh = [at for at in found if not any(n > 0 and at[0] <= last + 1 and at[0] + n > last for last, n in self.played)]
        nearest = sorted(((self.apart(*at), at) for at in fresh), key=lambda one: one[0])[:3]
        if not nearest:
            return found[-1] if ahead is None else on
        if ahead is not None and ahead - nearest[0][0] <= self.tolerance:
            return on
        return nearest[words[1] * len(nearest) >> 32][1]

    def step(self, words):  # what is added to every output
        (row, side), steps = self.at, self.played[0][1]
        forced, on = steps >= self.longest or self.left[row] == 0, (row + 1, side)
        ahead = None if forced else self.apart(*on) if self.toward >= 0 else F(0)
        self.at = self.jump(on, ahead, words) if forced or self.toward >= 0 and ahead > self.tolerance else on
        if self.at == on and not forced:
            self.played[0] = (self.at[0], steps + 1)
        else:
            self.played = [(self.at[0], 1)] + self.played[:3]
        return [factor * self.rows[self.at[0]][i] for i, factor in self.sides[self.at[1]]]


def play(model, frames, wind, seed=1, noise=True):
    """Yields the outputs of every frame; `wind` is the value of all inputs, or one value a frame."""
    d, outputs, ny = model["dynamics"], model["outputs"], len(model["outputs"])
    if d["kind"] == "chain":
        sys.exit("08_play_json.py: this model is a chain, which is not played here; expected an ARX or switched model")
    winds = wind if isinstance(wind, list) else [wind] * frames
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
    mode, resampled = None, Resampled(d, unit) if (d.get("noise") or {}).get("resampled") else None
    for step in range(frames):
        now = [F(0)] * ny + [regress(*form, mean, winds[step]) for form, mean in zip(forms, d["input_mean"])]
        past = [now] + past[:-1]
        if regions:
            mode = max(range(len(regions)), key=lambda k: (score(regions[k]), -k))
        elif "transitions" in d:
            word = words(seed, step, (ny + 3) // 4)[0] if noise else None
            mode = likely(d["initial"] if mode is None else d["transitions"][mode], word)
        drawn = None
        if resampled:
            resampled.hear(now[ny:])
            drawn = resampled.step(words(seed, step, 0)) if noise else [F(0)] * ny
        deviates = [] if resampled else [normal(w, model["random"]["normal_table"]) for g in range(groups) for w in words(seed, step, g)]
        for i, (total, taps, shocks) in enumerate(rows[mode or 0]):
            if drawn:
                total = total + drawn[i]
            for size, k in shocks if noise and not drawn else []:
                total = total + size * deviates[k]
            for weight, channel, lag in taps:
                total = total + weight * past[lag][channel]
            now[i] = settle(clamp(total, *held[i]))
        yield [clamp(F(mean) + F(u) * z, *map(F, edges(o))) for o, mean, u, z in zip(outputs, d["output_mean"], unit, now)]


if __name__ == "__main__":
    frames, wind, seed, noise = sys.argv[1:] + ["100", "0", "1", "on"][len(sys.argv) - 1:]
    of = json.load(sys.stdin)
    print(",".join(o["name"] for o in of["outputs"]))
    try:
        winds = [float(wind)] * int(frames)
    except ValueError:
        winds = [float(line) for line in open(wind)][: int(frames)]
    for values in play(of, len(winds), winds, int(seed), noise == "on"):
        print(",".join(repr(float(v)) for v in values))
