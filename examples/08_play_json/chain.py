"""Plays a chain of recorded segments: a walk over modes draws each segment; two joined segments each take half of the gap."""
import itertools, math, sys
import numpy as np
from shared import F, normals, regress, unit_of, words


def vector(*numbers): return np.array(numbers, F)


def dot(a, b):  # in this order of additions, which np.dot does not keep: results must agree to the bit
    total = a[0] * b[0]
    for x, y in zip(a[1:], b[1:]):
        total = total + x * y
    return total


def cross(a, b): return vector(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def turned(cos, sin, q): return vector(cos * q[0] - sin * q[3], cos * q[1] - sin * q[2], cos * q[2] + sin * q[1], cos * q[3] + sin * q[0])
def clamped(numbers, most): return np.clip(numbers, -F(most), F(most))
def share_of(word, count): return word * count >> 32


class Turn:  # a rotation about z: `half` is (cos, sin) of half the angle; `cos`, `sin` (angle) and `scaled` (half) include row scales
    def __init__(self, cos, sin, place, attitude):
        self.half = cos, sin
        self.cos, self.sin = (cos * cos - sin * sin) * place, cos * sin * (F(2) * place)
        self.scaled = cos * attitude, sin * attitude


class Spread:  # a fading offset of `steps` steps, two joined parabolas: factors that give the second difference of each
    def __init__(self, steps):
        m = (steps + 1) // 2
        n = steps - m
        way, slope = (m * m / 2 + n * (m - 0.5), n * (n + 1) / 2), (m - 0.5, n + 0.5)
        whole = way[0] * slope[1] - way[1] * slope[0]
        self.way = F(-slope[1] / whole), F(slope[0] / whole)
        self.change = F(way[1] / whole), F(-way[0] / whole)
        self.slope = F(-1 / (n + m - 1)) if steps > 1 else F(0)


class Segments:
    def __init__(self, model):
        d = model["dynamics"]
        self.place, self.attitude = F(d["row_scale"][0]), F(1 / 32767)
        self.speed, self.spin = map(F, d["rate_scale"])
        self.dt, self.free = F(1 / model["rate_hz"]), d["heading_free"]
        self.steps, self.modes, self.blend = d["segment_steps"], d["segment_modes"], d["blend_steps"]
        self.first = list(itertools.accumulate([s + 1 for s in self.steps], initial=0))
        self.rows, self.rates = d["rows"], d["rates"]

    def position(self, segment, row): return vector(*self.rows[self.first[segment] + row][:3])
    def rate(self, segment, end): return self.rates[2 * segment + end]

    def quaternion(self, segment, row):  # the stored quaternion, rescaled to the length 32767 and rounded
        q = self.rows[self.first[segment] + row][3:]
        square = float(sum(x * x for x in q))
        factor = 32767 / math.sqrt(square) if square > 0 else 0
        return vector(*(int(factor * x + (0.5 if factor * x >= 0 else -0.5)) for x in q))

    def change(self, segment, end):  # how the stored quaternion changes in half a step, at the start (0) or the end (1)
        spin, q = vector(*self.rate(segment, end)[3:]) * self.spin, self.quaternion(segment, end * self.steps[segment])
        v = spin * q[0] + cross(spin, q[1:])
        return vector(F(0) - dot(spin, q[1:]), *v) * F(0.5) * (F(0.5) * self.dt)

    def turn(self, cos, sin): return Turn(cos, sin, self.place, self.attitude)

    def turn_after(self, turn, before, segment):  # rotation of `segment` that joins it to `before`, which is rotated by `turn`
        a, b = self.quaternion(segment, 0), self.quaternion(before, self.steps[before])
        cos, sin = F(1), F(0)
        if not self.free:
            cos = F(-1) if dot(a, b) < 0 else F(1)
        else:
            c, s = dot(b, a), b[3] * a[0] - b[0] * a[3] + b[2] * a[1] - b[1] * a[2]
            cos, sin = (c, s) if max(abs(c), abs(s)) > F(1e-3) else (cos, sin)
        cos, sin = turn.half[0] * cos - turn.half[1] * sin, turn.half[0] * sin + turn.half[1] * cos
        square = cos * cos + sin * sin
        return self.turn(cos * (F(1) / np.sqrt(square)), sin * (F(1) / np.sqrt(square)))

    def gap(self, before, turn, segment, next_turn):  # half of the difference at a join: attitude, its change per step, step length
        def velocity(turn, v): return vector(turn.cos * v[0] - turn.sin * v[1], turn.sin * v[0] + turn.cos * v[1], v[2])
        slip = velocity(turn, vector(*self.rate(before, 1)[:3])) - velocity(next_turn, vector(*self.rate(segment, 0)[:3]))
        half = F(0.5) * self.dt * self.speed
        lean = turned(*turn.scaled, self.quaternion(before, self.steps[before])) - turned(*next_turn.scaled, self.quaternion(segment, 0))
        rate = turned(*turn.scaled, self.change(before, 1)) - turned(*next_turn.scaled, self.change(segment, 0))
        return clamped(lean * F(0.5), 1e9), clamped(rate, 1e9), clamped(slip * vector(half / self.place, half / self.place, half), 1e9)


class Walk:  # draws the next mode by a Markov chain, then a segment of that mode
    def __init__(self, d, noise):
        self.noise, self.breadth, self.follow = noise, d["best_of"], d["follow"]
        self.modes = len(d["initial"])
        self.history = d["history"]
        self.tops = [self.thresholds(row) for row in [d["initial"]] + d["probabilities"]]
        self.first = [sum(m < mode for m in d["segment_modes"]) for mode in range(self.modes + 1)]
        self.state = 0

    @staticmethod
    def thresholds(chances):
        last = max(k for k, p in enumerate(chances) if p > 0)
        return [2**32 - 1 if k >= last else int(min(s * 2.0**32, 2.0**32 - 1)) for k, s in enumerate(itertools.accumulate(chances))]

    def any(self, mode, word):
        count = self.first[mode + 1] - self.first[mode]
        return self.first[mode] + (share_of(word, count) if self.noise else 0)

    def mode(self, word):
        tops = self.tops[self.state]
        if not self.noise:
            widths = [top - below for top, below in zip(tops, [0] + tops)]
            return max(range(self.modes), key=lambda k: (widths[k], -k))
        return next((k for k, top in enumerate(tops[:-1]) if word < top), self.modes - 1)

    def draw(self, before, w):
        mode = self.mode(w[0])
        last = (self.state - 1) % self.modes  # rows of `tops`: the initial one, those after one mode, those after two
        self.state = 1 + mode + (self.modes * (1 + last) if self.history > 1 and self.state > 0 else 0)
        if before is None or self.breadth == 0:
            return self.any(mode, w[1])
        best = self.follow[before * self.modes + mode]
        return best[share_of(w[1], self.breadth) if self.noise else 0]


class Gust:  # change of the body's velocity due to wind, in m/s
    def __init__(self, d, model):
        low, high = min(i["range"][0] for i in model["inputs"]), max(i["range"][1] for i in model["inputs"])
        unit = unit_of({"range": [min(low, 0), max(high, 0)]})
        axes = [d["gust"][name] for name in ("ground", "ground", "vertical")]
        self.parts = [(F(a["change"]), F(a["wind"] * unit), F(4 * a["press"] * unit)) for a in axes]
        self.rest()

    def rest(self):
        self.change = self.wind = np.zeros(3, F)

    def blow(self, wind, q):
        if not any((abs(v) > F(1e-4)).any() for v in (wind, self.change, self.wind)):
            return self.rest()
        normal_half = vector(q[1] * q[3] + q[0] * q[2], q[2] * q[3] - q[0] * q[1], F(0.5) - (q[1] * q[1] + q[2] * q[2]))
        press = normal_half * dot(normal_half, wind - self.change)
        change = vector(*(kept * self.change[k] + of_wind * wind[k] + of_press * press[k]
                          for k, (kept, of_wind, of_press) in enumerate(self.parts)))
        self.wind, self.change = wind, clamped(change, 1e3)
        return self.change


def play_chain(model, winds, seed=1, noise=True):
    """Yields position and orientation of every frame."""
    d = model["dynamics"]
    if d["motion"] != "pose" or d["height"]:
        sys.exit("play.py: the chain moves a point, or its height is bounded; expected one of poses that goes on from where it is")
    of, walk, gust = Segments(model), Walk(d, noise), Gust(d, model) if d["gust"] else None
    blend, none = of.blend, (np.zeros(4, F), np.zeros(4, F), np.zeros(3, F))
    w = words(seed, 0, 1)
    segment, row, base, turn = walk.draw(None, w), 0, np.zeros(3, F), of.turn(F(1), F(0))
    x, y = normals(w[2])[0], normals(w[3])[0]
    size = np.sqrt(x * x + y * y)
    if of.free and size > F(1e-6):
        turn = of.turn(x / size, y / size)

    def prepare(w):  # draws the next segment; returns it, its rotation and half of the gap at the join
        after = walk.draw(segment, w)
        after_turn = of.turn_after(turn, segment, after)
        return after, after_turn, of.gap(segment, turn, after, after_turn) if blend else none

    def spread(steps, a, b):  # a fade from offsets `a` to -`b`: orientation offset with its first and second differences; velocity offset
        s = Spread(steps)
        way, change = b[0] + a[0] + F(steps) * a[1], b[1] + a[1]
        first, second = s.way[0] * way + s.change[0] * change, s.way[1] * way + s.change[1] * change
        return [a[0], a[1] + F(0.5) * first, first, second], [a[2], (b[2] + a[2]) * s.slope]

    def meet(a):
        steps = of.steps[segment]
        return spread(steps, a, gap) if steps < 2 * blend else spread(blend, a, none)

    def fades(row): return blend and (of.steps[segment] < 2 * blend or row < blend or row > of.steps[segment] - blend)

    def shown():
        at, q = of.position(segment, row), turned(*turn.scaled, of.quaternion(segment, row))
        place = base + vector(turn.cos * at[0] - turn.sin * at[1], turn.sin * at[0] + turn.cos * at[1], of.place * at[2])
        if fades(row):
            q = q + lean[0]
            q = q * (F(1) / np.sqrt(dot(q, q)))
        return clamped(place, 1e6), q

    lean, slip = [np.zeros(4, F)] * 4, [np.zeros(3, F)] * 2
    place, q = shown()
    after, after_turn, gap = prepare(words(seed, 0, 2))
    if blend:
        lean, slip = meet(none)
    for step, wind in enumerate(winds):
        if gust:
            change = gust.blow(vector(*(regress(i, "whole", 1, 0, value) for i, value in zip(model["inputs"], wind))), q)
            base = base if change is None else base + change * of.dt
        steps, before, row = of.steps[segment], row, row + 1
        if blend and steps >= 2 * blend and before == steps - blend:
            lean, slip = spread(blend, none, gap)
        if blend and (fades(before) or fades(row)):
            base, slip[0], lean[0] = base + slip[0], slip[0] + slip[1], lean[0] + lean[1]
            half = (blend + 1) // 2
            if row == (steps + 1) // 2 if steps < 2 * blend else row in (half, steps - blend + half):
                lean[2] = lean[3]
            lean[1] = lean[1] + lean[2]
        place, q = shown()
        yield [*place, *q]
        if row >= steps:
            missing = gap
            segment, row, base, turn = after, 0, place, after_turn
            after, after_turn, gap = prepare(words(seed, step, 0))
            if blend:
                lean, slip = meet(missing)
