"""Resampled residuals: the recorded residuals are played in blocks instead of Gaussian noise."""
from lookup import Lookup
from shared import F, bounded


class Resampled:
    """Plays recorded residuals row after row, and jumps where another row's recorded input resembles the recent input more."""

    def __init__(self, model, unit):
        d = model["dynamics"]
        ny, r = len(d["output_mean"]), d["noise"]["resampled"]
        self.lags, self.longest, self.toward = r["lags"], r["longest"], r["toward"]
        self.rows = [[bounded(x * (scale / u)) for x, scale, u in zip(row, r["scale"], unit)] for row in r["rows"]]
        self.sides = [[(i, F(1)) for i in range(ny)]]
        if r["mirror"]:
            self.sides += [[(abs(m) - 1, bounded((-1 if m < 0 else 1) * unit[abs(m) - 1] / u)) for m, u in zip(r["mirror"], unit)]]
        stretches = list(enumerate(zip([0] + r["ends"], r["ends"])))
        self.left = [end - 1 - row for _, (begin, end) in stretches for row in range(begin, end)]
        self.at, self.played = (0, 0), [(0, self.longest)] + [(0, 0)] * 3  # (row, side); (last row, steps) of blocks
        if self.toward < 0:
            self.lookup = Lookup(model, self.rows, self.left)
            return
        scale, of, depth = unit[ny + self.toward], d["input_mean"], self.lags[-1]
        mean = of[self.toward] / scale
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

    def grow(self, node, begin, end, nodes):  # a balanced k-d tree over the rows' input pasts: splits at the lag of widest range
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
            self.heard = [regressors[self.toward]] + self.heard[:-1]

    def apart(self, row, side):  # distance of the recent input from a row's past: sum of absolute differences over the lags
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

    def jump(self, on, ahead, words):  # the next (row, side); `ahead`: the distance of `on`, None if the block cannot continue
        turned = len(self.sides) > 1 and sum((self.heard[lag] for lag in self.lags), F(0)) < 0
        found = [(row, int(turned != self.turned[row])) for row in self.leaf(turned, words[0])]
        fresh = [at for at in found if not any(n > 0 and at[0] <= last + 1 and at[0] + n > last for last, n in self.played)]
        nearest = sorted(((self.apart(*at), at) for at in fresh), key=lambda one: one[0])[:3]
        if not nearest:
            return found[-1] if ahead is None else on
        if ahead is not None and ahead - nearest[0][0] <= self.tolerance:
            return on
        return nearest[words[1] * len(nearest) >> 32][1]

    def step(self, words):  # returns the residual of every output, in units
        if self.toward < 0:
            return self.lookup.step(words)
        (row, side), steps = self.at, self.played[0][1]
        forced, on = steps >= self.longest or self.left[row] == 0, (row + 1, side)
        ahead = None if forced else self.apart(*on)
        self.at = self.jump(on, ahead, words) if forced or ahead > self.tolerance else on
        if self.at == on and not forced:
            self.played[0] = (self.at[0], steps + 1)
        else:
            self.played = [(self.at[0], 1)] + self.played[:3]
        return [factor * self.rows[self.at[0]][i] for i, factor in self.sides[self.at[1]]]
