#!/usr/bin/env python3
"""Where the plate of Andersen, Pesavento & Wang stops fluttering, by integrators that are not ours.

Written from the published equations, not from src/simulate. Prints, by DOP853 (errors bound to 1e-12), how far plates
turn after 200 units of time for starts and inertias around the transition, the same by an implicit method (Radau), what
becomes of either motion when the inertia is moved across, and a bisection. Needs scipy; takes some ten minutes.

    /usr/bin/python3 studies/leaf/verify_leaf_plate.py
"""

from math import cos, hypot, pi, sin

import numpy as np
from scipy.integrate import DOP853, Radau

C_T, C_R, A, B, MU_1, MU_2 = 1.2, pi, 1.4, 1.0, 0.2, 0.2


def rate(inertia):
    def of(_, state):
        _, _, angle, along, across, spin = map(float, state)
        speed = hypot(along, across)
        over = 1 / speed if speed > 0 else 0.0
        lift = 2 / pi * (-C_T * along * across * over + C_R * spin)
        drag = (A - B * (along**2 - across**2) * over**2) * speed / pi
        return np.array([
            along * cos(angle) - across * sin(angle),
            along * sin(angle) + across * cos(angle),
            spin,
            ((inertia + 1) * spin * across - lift * across - sin(angle) - drag * along) / inertia,
            (-inertia * spin * along + lift * along - cos(angle) - drag * across) / (inertia + 1),
            (-along * across - (MU_1 + MU_2 * abs(spin)) * spin) / (0.25 * (inertia + 0.5)),
        ])

    return of


def fall(inertia, start, end, method=DOP853, tolerance=1e-12):
    """Times, angles and the last state."""
    solver = method(rate(inertia), 0, start, end, rtol=tolerance, atol=tolerance / 10)
    times, angles = [], []
    while solver.status == "running":
        solver.step()
        times.append(solver.t)
        angles.append(solver.y[2])
    return np.array(times), np.array(angles), solver.y


def at_rest(angle):
    return np.array([0, 0, angle, 0, 0, 0.0])


def half_turns(inertia, start, since=200, end=300, **method):
    """How far the plate turns between two times, both ways together."""
    times, angles, _ = fall(inertia, start, end, **method)
    return np.ptp(angles[times >= since]) / pi


def main():
    print("half turns between 200 and 300 units of time; a fluttering plate rocks through 1.09")
    for inertia in (1.2190, 1.21913, 1.219145, 1.219148, 1.21916, 1.2193, 1.22):
        turns = [half_turns(inertia, at_rest(angle)) for angle in (0.01, 0.2, 1.0, 2.5)]
        print(f"  DOP853 1e-12, I* {inertia:.6f}:", *(f"{turn:.3f}" for turn in turns), flush=True)
    for inertia in (1.2190, 1.2191, 1.2192, 1.2193):
        turn = half_turns(inertia, at_rest(0.2), method=Radau, tolerance=1e-8)
        print(f"  Radau 1e-8, I* {inertia:.4f}: {turn:.3f}", flush=True)
    fluttering, tumbling = fall(1.2191, at_rest(0.2), 400)[2], fall(1.2205, at_rest(0.2), 400)[2]
    for inertia in (1.2193, 1.22, 1.225):
        print(f"  moved from flutter at 1.2191 to {inertia}: {half_turns(inertia, fluttering):.3f}", flush=True)
    for inertia in (1.2190, 1.2180, 1.215):
        print(f"  moved from tumbling at 1.2205 to {inertia}: {half_turns(inertia, tumbling):.3f}", flush=True)
    flutters, tumbles = 1.2191, 1.2192
    while tumbles - flutters > 5e-7:
        middle = (flutters + tumbles) / 2
        if half_turns(middle, at_rest(0.2)) < 2:
            flutters = middle
        else:
            tumbles = middle
    print(f"  the transition is between {flutters:.7f} and {tumbles:.7f}")


if __name__ == "__main__":
    main()
