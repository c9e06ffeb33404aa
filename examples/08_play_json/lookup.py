"""Resampled residuals without a driving input: plays a block of rows, then jumps to a row where the model's state is similar."""
import math
from shared import F

TRAITS, PLACES, NEAREST, PARTS, NONE = 6, 128, 4, 32, F(1e30)


class Lookup:
    """Plays residuals row after row. After a random time it jumps to a row near in position and speed and rarely played."""

    def __init__(self, model, rows, left):
        self.rows, self.left, rate = rows, left, model["rate_hz"]
        steps = lambda seconds: max(1, math.floor(seconds * rate + 0.5))
        self.shortest, self.longest, self.beside, self.recent = map(steps, (0.4, 1.2, 0.3, 0.7))
        self.part_rows, count = -(-len(rows) // PARTS), len(rows)
        self.coverage = F(2 * count / (2 * self.part_rows))
        self.find_positions(model)
        least, ahead = min(max(left), self.shortest - 1), steps(0.5)
        all_rows = [row for row in range(count) if left[row] >= least]
        places = min(len(all_rows), PLACES)
        self.places = [all_rows[k * len(all_rows) // places] for k in range(places)]
        before = [row - 1 if row > 0 and left[row - 1] > 0 else row for row in self.places]
        self.traits = [self.position[b] + [self.quickness * (y - x) for x, y in zip(self.position[b], self.position[row])]
                       for b, row in zip(before, self.places)]
        self.ahead = [[min(row + k * ahead // 4, count - 1) // self.part_rows for k in (1, 3)] for row in self.places]
        self.played, self.length, self.best = [(0, 0)] * 4, 0, []  # (last row, rows) of blocks; (cost, place), cheapest first
        self.weight, self.counts = F(0), [F(0)] * PARTS

    def find_positions(self, model):  # of each row: the model's output after the rows before it, in the components that vary most
        d, shape = model["dynamics"], (model.get("view") or {}).get("shape")
        r, ny, states, begin = d["noise"]["resampled"], len(d["output_mean"]), [], 0
        for row, residual in enumerate(r["rows"]):
            states.append([])
            for i in range(ny):
                total = d["constant"][i] + residual[i] * r["scale"][i]
                for j in range(ny):
                    for lag, a in enumerate(d["A"][i][j][:row - begin], 1):
                        total = total - a * states[row - lag][j]
                states[row].append(total)
            begin = row + 1 if self.left[row] == 0 else begin
        weights, spread = [1.0] * ny, []
        if shape:
            even, odd, points, weights = shape["symmetric"], shape["antisymmetric"], len(shape["rest"]) // 2, [0.0] * ny
            for i in range(2 * points):
                first, columns = (i * even, range(even)) if i < points else (points * even + (i - points) * odd, range(even, ny))
                for at, k in enumerate(columns, first):
                    weights[k] += shape["basis"][at] * shape["basis"][at]
            weights = [math.sqrt(square) for square in weights]
        for k in range(ny):
            total = square = moved = 0.0
            for row in range(len(states)):
                value = weights[k] * states[row][k]
                total, square = total + value, square + value * value
                if self.left[row]:
                    step = weights[k] * states[row + 1][k] - value
                    moved = moved + step * step
            n = len(states)
            spread.append((max(0.0, square / n - total / n * (total / n)), moved / n))
        position = speed = 0.0
        for one in spread:
            position, speed = position + one[0], speed + one[1]
        order = sorted(range(ny), key=lambda k: -spread[k][0])[:TRAITS]
        scale = 1 / math.sqrt(position) if position > 0 else 0.0
        self.quickness = F(min(math.sqrt(position / speed), 1e6)) if speed > 0 else F(0)
        self.position = [[F(min(max(state[k] * weights[k] * scale, -1e6), 1e6)) for k in order] for state in states]

    def look(self):  # compares a few of the places with the end of the current block; a block's steps share the work
        (last, now), groups = self.played[0], -(-len(self.places) // 8)
        if now == 0 or now > self.length:
            return
        ahead = min(self.length - now, self.left[last])
        end = last + ahead
        on = self.left[end] > 0
        to, start = end + on, end - (not on and now + ahead >= 2 and end > 0)
        aim = self.position[end] + [self.quickness * (y - x) for x, y in zip(self.position[start], self.position[to])]
        for k in range(groups * (now - 1) // self.length * 8, min(groups * now // self.length * 8, len(self.places))):
            cost = F(0)
            for there, here in zip(self.traits[k], aim):
                cost = cost + (there - here) * (there - here)
            first, second = self.ahead[k]
            cost = cost + self.weight * (self.counts[first] + self.counts[second])
            if self.barred(self.places[k], end, ahead):
                cost = cost + F(10)
            if cost < NONE:
                self.best = sorted(self.best + [(cost, k)], key=lambda one: one[0])[:NEAREST]

    def barred(self, row, end, ahead):  # whether a row is near the natural successor, or was played within 0.7 s
        room = self.recent
        for k, (last, count) in enumerate(self.played):
            last, count = last + (ahead if k == 0 else 0), min(count + (ahead if k == 0 else 0), room)
            if last - count < row <= last:
                return True
            room -= count
        return end - self.beside < row <= end + 1 + self.beside

    def jump(self, words):
        last, played = self.played[0]
        if played:
            kept, total = max(F(0), F(1) - F(1e-3) * F(played)), F(0)
            for part in range(PARTS):
                self.counts[part] = self.counts[part] * kept
                rows = min(last + 1, (part + 1) * self.part_rows) - max(last + 1 - played, part * self.part_rows)
                if rows > 0:
                    self.counts[part] = self.counts[part] + F(rows)
                total = total + self.counts[part]
            self.weight = self.coverage / total
        place = self.best[words[0] * len(self.best) >> 32][1] if self.best else words[0] * len(self.places) >> 32
        row, self.best = self.places[place], []
        self.length = min(self.shortest + (words[1] * (self.longest - self.shortest + 1) >> 32), self.left[row] + 1)
        self.played = [(row, 1)] + self.played[:3]

    def step(self, words):
        self.look()
        row, count = self.played[0]
        if self.left[row] == 0 or count >= self.length:
            self.jump(words)
        else:
            self.played[0] = (row + 1, count + 1)
        return self.rows[self.played[0][0]]
