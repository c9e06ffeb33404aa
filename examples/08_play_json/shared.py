"""Arithmetic of the players: single precision, random words and deviates, and the regressors of an input."""
import math
import numpy as np

F = np.float32  # all arithmetic of a step is in single precision


def kept(value): return F(0) if abs(value) < 1e-10 else F(value)
def bounded(value): return kept(min(max(value, -1e9), 1e9))
def settle(z): return F(0) if abs(z) < F(1e-20) else z
def clamp(z, low, high): return min(max(z, low), high)


def edges(item):  # limits of clamping: the range, extended on either side by half of its width
    low, high = item["range"]
    return low - 0.5 * (high - low), high + 0.5 * (high - low)


def unit_of(item):  # 1 where the range is 1/128 to 128 wide, else the largest power of two not above its width
    size = item["range"][1] - item["range"][0]
    return 1.0 if size <= 0 or 1 / 128 <= size <= 128 else 2.0 ** (math.frexp(size)[1] - 1)


FORMS = {"linear": [("whole", 1)],
         "even_odd": [(part, power) for part in ("size", "whole") for power in (1, 0.5, 2)]}


def regress(item, part, power, mean, u):  # one regressor of the input value u, in units and without its mean
    unit = unit_of(item)
    u = clamp(F(u), *map(F, edges(item)))
    u = abs(u) if part == "size" else u
    if power == 1:
        return settle((u - F(mean)) * F(1 / unit))
    size = abs(u) * F(1 / unit)
    size = np.sqrt(size) if power == 0.5 else size * size
    return settle((F(0) - size if u < 0 else size) - F(mean / unit**power))


def words(seed, step, group, stream=0):  # Philox4x32 of 7 rounds: four random words
    full = 0xFFFFFFFF
    w, key = [step & full, step >> 32 << 16 ^ group, stream & full, stream >> 32], [seed & full, seed >> 32]
    for _ in range(7):
        a, b = w[0] * 0xD2511F53, w[2] * 0xCD9E8D57
        w = [b >> 32 ^ w[1] ^ key[0], b & full, a >> 32 ^ w[3] ^ key[1], a & full]
        key = [key[0] + 0x9E3779B9 & full, key[1] + 0xBB67AE85 & full]
    return w


def normals(word):  # converts a random word to two standard normal deviates
    def polynomial(x, *c): return F(c[0]) + x * polynomial(x, *c[1:]) if c[1:] else F(c[0])
    bits = int((F(word & 0xFFFFF) + F(0.5)).view(np.uint32)) - 0x3F3504F3 - (20 << 23)
    place = np.uint32((bits & 0x7FFFFF) + 0x3F3504F3).view(F) - F(1)
    size = np.sqrt(F(-1.38629436) * F(bits >> 23) + place * polynomial(
        place, -2.00002551, 0.999701023, -0.664517462, 0.509449303, -0.446601391, 0.28639704))
    size = -size if word >> 20 & 1 else size
    angle = F((word >> 21) - (word >> 31 << 11)) + F(0.5)
    cosine = polynomial(angle * angle, 0.999993324, -1.17634249e-06, 2.29720431e-13, -1.65629298e-20)
    return size * cosine, size * (angle * polynomial(angle * angle, 0.00153397559, -6.015346e-10, 7.0551869e-17, -3.67027436e-24))
