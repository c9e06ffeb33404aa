#!/usr/bin/env python3
"""Makes src/export/flame.png, the picture on the mesh of an exported flame, and prints the colours of a Lottie flame.

    tools/flame_picture.py [WIDTH HEIGHT]

Across from -1.75 to 1.75 half widths, along from 0.2 below the base (0) to 0.2 above the tip (1): translucent blue at the
base, dark around the wick, bright in the middle, orange at the rim and the tip, a faint halo. Profiles as src/draw/flame.
"""
import math
import pathlib
import struct
import sys
import zlib

ACROSS, LOW, HIGH, DROP = 1.75, -0.2, 1.2, 0.12
# Emission in terms of the sum that 1 - exp(-x) shows, linear, sRGB's primaries.
RIM, BODY, CORE, BASE = (1.9, 0.27, 0.014), (3.0, 0.83, 0.07), (3.0, 3.0, 1.6), (0.09, 0.50, 3.0)


def step(low, high, value):
    t = min(1, max(0, (value - low) / (high - low)))
    return t * t * (3 - 2 * t)


def encoded(linear):
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055


def colour(along, across):
    """sRGB and opacity, 0 to 1."""
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


def main():
    width, height = map(int, sys.argv[1:3] or (48, 96))
    rows = bytearray()
    for y in range(height):
        rows.append(0)
        for x in range(width):
            here = colour(HIGH + (LOW - HIGH) * (y + 0.5) / height, ACROSS * (2 * (x + 0.5) / width - 1))
            rows += bytes(round(255 * each) for each in here)
    png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))
    png += chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b"")
    pathlib.Path(__file__).resolve().parents[1].joinpath("src/export/flame.png").write_bytes(png)
    for along in (-DROP, 0, 0.08, 0.16, 0.25, 0.4, 0.6, 0.8, 1):
        r, g, b, a = colour(along, 0.75)
        print(f"{{{along}, {r:.3f}, {g:.3f}, {b:.3f}, {max(a, 0.35):.3f}}},")
    print("core", [round(each, 3) for each in colour(0.55, 0)])


if __name__ == "__main__":
    main()
