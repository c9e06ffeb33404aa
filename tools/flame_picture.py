#!/usr/bin/env python3
"""Makes src/export/flame.png, the texture of the shells of an exported flame, and prints the colours of a Lottie flame.

    tools/flame_picture.py [HEIGHT]

Each column is a shell of src/export/gltf.cpp, the outermost first; rows go from the tip (top) to DROP below the base.
Seen through each other the shells show a flame from the side: translucent blue at the base, dark around the wick, bright
in the middle, orange at the rim and the tip. Colours and opacities are fitted to that (least squares) in the two ways in
which shells are composited: in display colours in the order of the mesh, the innermost last (three.js and others that do
not sort), and in linear light in the order of a ray, the outermost first (Blender's Cycles). Profiles as in src/draw/flame.
"""
import math
import pathlib
import struct
import sys
import zlib

import numpy as np
from scipy.optimize import least_squares

ACROSS, DROP = 1.75, 0.12
SHELLS = (1.0, 0.93, 0.82, 0.66, 0.46, 0.22)
STRENGTH = 5  # kEmissiveStrength
# Emission x, displayed as 1 - exp(-x): linear, sRGB primaries.
RIM, BODY, CORE, BASE = (1.9, 0.27, 0.014), (3.0, 0.83, 0.07), (3.0, 3.0, 1.6), (0.09, 0.50, 3.0)


def step(low, high, value):
    t = min(1, max(0, (value - low) / (high - low)))
    return t * t * (3 - 2 * t)


def encoded(linear):
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055


def colour(along, across):
    """sRGB and opacity, 0 to 1, at a height (0 base, 1 tip) and a distance from the axis (1: the outline)."""
    side, t = min(1, abs(across)), min(1, max(0, along))
    thick = math.sqrt(1 - side * side)
    shell = 0.5 * (1 - step(0.05, 0.34, t))
    rise = 0.04 + 0.34 * step(0.04, 0.22, t) + 0.62 * step(0.14, 0.44, t)
    soot = max(0, thick - shell) / (1 - shell) * rise * (1 - 0.45 * step(0.74, 1.04, t))
    rim, body, core = step(0, 0.42, soot), step(0.30, 0.66, soot), step(0.56, 0.94, soot)
    mantle = 0.22 * (math.exp(-5 * thick * thick) + 0.07) * (1 - step(0, 0.27, t))
    beyond = math.hypot(max(0, abs(across) - 1) / (ACROSS - 1), max(0, along - 1, -along - DROP) / 0.2)
    edge, halo = 1 - step(0, 0.12, beyond), 0.012 * max(0, 1 - beyond) ** 2 * step(0.05, 0.4, t)
    shown = []
    for k in range(3):
        light = (1 - core) * ((1 - body) * rim * RIM[k] + body * BODY[k]) + core * CORE[k]
        shown.append(encoded(1 - math.exp(-edge * (light + mantle * BASE[k]) - halo * RIM[k])))
    brightest = max(shown)
    return [*(each / brightest if brightest else 0 for each in shown), brightest]


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def composited(shells):
    """What the first 1, 2, … shells show: composited in display colours, in linear light, and that light itself."""
    light = STRENGTH * np.where(shells[:, :3] <= 0.04045, shells[:, :3] / 12.92, ((shells[:, :3] + 0.055) / 1.055) ** 2.4)
    drawn, traced, through, seen = np.zeros(3), np.zeros(3), 1.0, []
    for emitted, opacity in zip(light, shells[:, 3]):
        drawn = opacity * screen(emitted) + (1 - opacity) * drawn
        traced = traced + through * opacity * emitted
        through *= 1 - opacity
        seen.append((drawn, screen(traced), traced))
    return map(np.array, zip(*seen))


def screen(light):
    shown = np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)
    return np.where(shown > 1, 1 + 0.02 * np.tanh(shown - 1), shown)  # clipped softly, so that the fit has a gradient


def fitted(along, start, pull):
    """Fits sRGB and opacity of each shell, 0 to 1, near `start`; returns them and the mean errors, drawn and traced."""
    rings = [colour(along, (shell + inner) / 2) for shell, inner in zip(SHELLS, SHELLS[1:] + (0,))]
    # A ring in front of a fainter inner one is made fainter too: the shells in front of it must let it appear dark.
    wanted = np.array([[math.sqrt(seen * min(ring[3] for ring in rings[at:])) * each for each in (red, green, blue)]
                       for at, (red, green, blue, seen) in enumerate(rings)])

    def misses(flat):
        shells = flat.reshape(-1, 4)
        drawn, traced, light = composited(shells)
        hue = drawn[:, 1:] * wanted[:, :1] - wanted[:, 1:] * drawn[:, :1]
        return np.concatenate([(drawn - wanted).ravel(), (traced - wanted).ravel(), 2 * hue.ravel(),
                               0.03 * np.maximum(0, light - 1.5).ravel(), pull * (shells - start).ravel()])

    found = least_squares(misses, np.clip(start, 0.011, 0.979).ravel(), bounds=(0.01, 0.98)).x.reshape(-1, 4)
    drawn, traced, _ = composited(found)
    return found, np.abs(drawn - wanted).mean(), np.abs(traced - wanted).mean()


def main():
    width, height = len(SHELLS), int((sys.argv[1:] or [96])[0])
    places = [1 - (1 + DROP) * (y + 0.5) / height for y in range(height)]
    picture = np.full((height, width, 4), 0.5)
    for y, along in enumerate(places):
        picture[y] = fitted(along, picture[max(0, y - 1)], 0.4)[0]
    # Fits again from the mean of neighbouring rows: where two solutions are equally good, the first fits jump between them.
    first, misses = picture.copy(), []
    for y, along in enumerate(places):
        picture[y], *miss = fitted(along, first[max(0, y - 6):y + 7].mean(0), 1)
        misses.append(miss)
    rows = b"".join(bytes([0]) + row.tobytes() for row in np.rint(255 * picture).astype(np.uint8))
    png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))
    png += chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b"")
    pathlib.Path(__file__).resolve().parents[1].joinpath("src/export/flame.png").write_bytes(png)
    print("mean miss, of 1: drawn {:.3f}, traced {:.3f}".format(*np.mean(misses, axis=0)))
    for along in (-DROP, 0, 0.08, 0.16, 0.25, 0.4, 0.6, 0.8, 1):
        r, g, b, a = colour(along, 0.75)
        print(f"{{{along}, {r:.3f}, {g:.3f}, {b:.3f}, {max(a, 0.35):.3f}}},")
    print("core", [round(each, 3) for each in colour(0.55, 0)])


if __name__ == "__main__":
    main()
