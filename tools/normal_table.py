#!/usr/bin/env python3
"""Writes src/run/lanes/normal_table.inc: the inverse normal distribution as a table of quadratics.

A 32-bit word w stands for the probability (w + 1/2) / 2^32. Folded about one half, p = (m + 1/2) / 2^32 with
m < 2^31, and f = float(m) + 0.5f. The bits of f above its 19 lowest are the segment: an octave of p and a sixteenth of
it. The 19 lowest are the place t in the segment. Each segment holds x(p) = c0 + c1 t + c2 t^2, interpolated at the
three Chebyshev nodes, which is within a few per cent of the minimax quadratic; its error is at most 1.12e-6, largest in
the octave next to one half. x(p) is Python's statistics.NormalDist (Wichura's algorithm AS 241, 1e-16).
"""

import math
import pathlib
import struct
from statistics import NormalDist

PARTS = 16  # segments an octave
STEPS = 1 << 19  # places in a segment
FIRST, LAST = -1, 31  # octaves of f: from 0.5 up to 2^31, which stands for p = 1/2


def quadratic(low, high):
    """c0, c1, c2 over t in [0, STEPS) for p from low to high."""
    nodes = [0.5 + 0.5 * math.cos(math.pi * (2 * k + 1) / 6) for k in range(3)]
    values = [NormalDist().inv_cdf(low + (high - low) * s) for s in nodes]
    first = (values[1] - values[0]) / (nodes[1] - nodes[0])
    second = ((values[2] - values[1]) / (nodes[2] - nodes[1]) - first) / (nodes[2] - nodes[0])
    c1 = first - second * (nodes[0] + nodes[1])
    c0 = values[0] - first * nodes[0] + second * nodes[0] * nodes[1]
    return c0, c1 / STEPS, second / STEPS**2


def as_float(value):
    return struct.unpack("f", struct.pack("f", value))[0].hex() + "f"


def main():
    rows = []
    for octave in range(FIRST, LAST):
        for part in range(PARTS):
            edges = [math.ldexp(1 + (part + k) / PARTS, octave - 32) for k in (0, 1)]
            rows.append("{" + ", ".join(as_float(c) for c in quadratic(*edges)) + "},")
    rows.append("{0.0f, 0.0f, 0.0f},")
    text = "// Written by tools/normal_table.py; see there for what it holds.\n// clang-format off\n"
    text += "\n".join(rows) + "\n// clang-format on\n"
    target = pathlib.Path(__file__).resolve().parent.parent / "src" / "run" / "lanes" / "normal_table.inc"
    target.write_text(text)


if __name__ == "__main__":
    main()
