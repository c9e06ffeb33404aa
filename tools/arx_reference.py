#!/usr/bin/env python3
"""Writes tests/learn/fit/arx_made.json: reference estimates of ARX models on made data.

    tools/arx_reference.py > tests/learn/fit/arx_made.json

The data come from an integer random generator and a recursion, so that tests/learn/fit/made_sets.hpp makes the same ones.
The estimates use other methods than Wisp's: an explicit regressor matrix and numpy's lstsq (singular values) for the
coefficients, the inverse of its QR factor R for their standard errors, predictions by running the equation forward from
measured samples (Wisp sums shocks through the impulse response), poles as roots, scipy's lfilter for responses. Kernels:
the likelihood of the outputs from their full covariance, maximised by scipy's Nelder-Mead from several starts, and the
posterior mean from that covariance.
"""

import json

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize
from scipy.signal import lfilter


class Words:
    """A linear congruential generator modulo 2^32; the upper 24 bits of a word give a number in [-0.5, 0.5)."""

    def __init__(self, seed):
        self.word = seed

    def uniform(self):
        self.word = (1664525 * self.word + 1013904223) % 2**32
        return (self.word >> 8) / 2**24 - 0.5

    def normal(self):
        total = 0.0
        for _ in range(12):
            total += self.uniform()
        return total


# A set: rows, seed; `missing`: the first output lacks each row whose number is a multiple of it (0: none). `binary`:
# inputs are -1 or 1, else white. Per output: A[j] (from lag 1 on, with the equation's sign), B[k] (from lag `delay` on),
# the shock's standard deviation, mean and unit.
SETS = {
    "dryer": dict(rows=1000, seed=11, inputs=1, binary=True, missing=0, outputs=[
        dict(A=[[-1.274, 0.3935]], B=[[0.0666, 0.0445]], delay=3, shock=0.04, mean=4.9, unit=1.0)]),
    "resonant": dict(rows=2000, seed=12, inputs=1, binary=False, missing=0, outputs=[
        dict(A=[[-3.80, 5.51, -3.61, 0.9025]], B=[[0.01, 0.02, -0.01, 0.005]], delay=1, shock=0.002, mean=0.0,
             unit=1.0)]),
    "coupled": dict(rows=1500, seed=13, inputs=2, binary=False, missing=0, outputs=[
        dict(A=[[-1.3, 0.6], [0.2, 0.0]], B=[[0.5, 0.25], [-0.4, 0.1]], delay=1, shock=0.3, mean=10.0, unit=1.0),
        dict(A=[[0.1, 0.05], [-0.9, 0.3]], B=[[0.7, -0.2], [0.3, 0.6]], delay=1, shock=0.2, mean=-3.0, unit=1.0)]),
    # Large numbers far from zero, and missing samples.
    "holes": dict(rows=1200, seed=14, inputs=1, binary=False, missing=97, outputs=[
        dict(A=[[-0.8, 0.1]], B=[[0.9, 0.3]], delay=0, shock=0.5, mean=1000.0, unit=1e6)]),
}

CASES = [
    dict(set="dryer", rows=[0, 300], na=2, nb=2, nk=3, coupling="full"),
    dict(set="dryer", rows=[0, 1000], na=6, nb=6, nk=1, coupling="full"),
    dict(set="resonant", rows=[0, 2000], na=4, nb=4, nk=1, coupling="full"),
    dict(set="resonant", rows=[500, 900], na=8, nb=3, nk=2, coupling="full"),
    dict(set="coupled", rows=[0, 1500], na=2, nb=2, nk=1, coupling="full"),
    dict(set="coupled", rows=[0, 1500], na=3, nb=2, nk=1, coupling="diagonal"),
    dict(set="holes", rows=[0, 1200], na=2, nb=2, nk=0, coupling="full"),
]

KERNELS = [
    dict(set="dryer", rows=[0, 300], na=0, nb=50, nk=0, coupling="full"),
    dict(set="dryer", rows=[300, 500], na=8, nb=12, nk=1, coupling="full"),
    dict(set="coupled", rows=[0, 260], na=0, nb=20, nk=1, coupling="full"),
]


def make(name):
    """Inputs (rows x nu) and outputs (rows x ny)."""
    it = SETS[name]
    words = Words(it["seed"])
    ny, nu, rows = len(it["outputs"]), it["inputs"], it["rows"]
    u, x = np.zeros((rows, nu)), np.zeros((rows, ny))
    for t in range(rows):
        for k in range(nu):
            drawn = words.uniform()
            if it["binary"]:
                # Keeps its value in three of four steps, else draws -1 or 1.
                keep = t > 0 and drawn < 0.25
                u[t, k] = u[t - 1, k] if keep else (1.0 if words.uniform() < 0 else -1.0)
            else:
                u[t, k] = drawn
        for i, row in enumerate(it["outputs"]):
            value = row["shock"] * words.normal()
            for j in range(ny):
                for lag, a in enumerate(row["A"][j], 1):
                    if lag <= t:
                        value -= a * x[t - lag, j]
            for k in range(nu):
                for lag, b in enumerate(row["B"][k], row["delay"]):
                    if lag <= t:
                        value += b * u[t - lag, k]
            x[t, i] = value
    y = np.array([[(x[t, i] + row["mean"]) * row["unit"] for i, row in enumerate(it["outputs"])] for t in range(rows)])
    if it["missing"]:
        y[it["missing"] - 1::it["missing"], 0] = np.nan
    return u, y


def regression(u, y, case, i):
    """Regressor and target of output i: its lags of A, output by output, then those of B, input by input."""
    outputs = range(y.shape[1]) if case["coupling"] == "full" else [i]
    first = max(case["na"], case["nb"] + case["nk"] - 1)
    columns = [-y[first - lag:len(y) - lag, j] for j in outputs for lag in range(1, case["na"] + 1)]
    columns += [u[first - lag:len(u) - lag, k] for k in range(u.shape[1])
                for lag in range(case["nk"], case["nk"] + case["nb"])]
    X, target = np.column_stack(columns), y[first:, i]
    whole = np.isfinite(X).all(axis=1) & np.isfinite(target)
    return X, target, whole


def fit(u, y, case):
    rows, residuals, together = [], [], None
    parts = [regression(u, y, case, i) for i in range(y.shape[1])]
    for _, _, whole in parts:
        together = whole if together is None else together & whole
    for X, target, _ in parts:
        X, target = X[together], target[together]
        theta, _, _, singular = np.linalg.lstsq(X, target, rcond=None)
        e = target - X @ theta
        n, d = X.shape
        loss = float(e @ e / n)
        inverse = np.linalg.inv(np.linalg.qr(X)[1])
        error = np.sqrt((inverse**2).sum(axis=1) * (e @ e) / (n - d))
        rows.append(dict(theta=theta.tolist(), std_error=error.tolist(), V=loss, n=n,
                         fpe=loss * (1 + d / n) / (1 - d / n), condition=float(singular[0] / singular[-1])))
        residuals.append(e)
    E = np.array(residuals)
    n, total = E.shape[1], sum(len(row["theta"]) for row in rows)
    covariance = E @ E.T / n
    det = np.linalg.det(covariance)
    return rows, dict(noise_covariance=covariance.tolist(), fpe=det * (1 + total / n) / (1 - total / n),
                      aic=n * np.log(det) + 2 * total, bic=n * np.log(det) + total * np.log(n))


def coefficients(rows, case, ny, nu):
    """A[i][j][lag - 1] and B[i][k][lag - nk], zeros where a row has none."""
    A, B = np.zeros((ny, ny, case["na"])), np.zeros((ny, nu, case["nb"]))
    for i, row in enumerate(rows):
        theta = np.array(row["theta"])
        split = len(theta) - nu * case["nb"]
        outputs = range(ny) if case["coupling"] == "full" else [i]
        for at, j in enumerate(outputs):
            A[i, j] = theta[at * case["na"]:(at + 1) * case["na"]]
        B[i] = theta[split:].reshape(nu, case["nb"])
    return A, B


def run(A, B, nk, u, past, start, stop):
    """The equation without shocks over [start, stop); outputs before `start` are those of `past`."""
    x = past.copy()
    for t in range(start, stop):
        x[t] = [sum(-A[i, j] @ x[t - np.arange(1, A.shape[2] + 1), j] for j in range(x.shape[1]))
                + sum(B[i, k] @ u[t - nk - np.arange(B.shape[2]), k] for k in range(u.shape[1]))
                for i in range(x.shape[1])]
    return x


def predictions(A, B, case, u, y):
    """Mean squared error of predictions 1, 3 and 10 steps ahead, and of free simulation from measured samples."""
    first, out = max(case["na"], case["nb"] + case["nk"] - 1), {}
    for steps in (1, 3, 10):
        errors = [y[t] - run(A, B, case["nk"], u, y, t - steps + 1, t + 1)[t]
                  for t in range(first + steps - 1, len(y))]
        out[str(steps)] = (np.array(errors)**2).mean(axis=0).tolist()
    free = run(A, B, case["nk"], u, y, first, len(y))
    out["inf"] = ((y - free)[first:]**2).mean(axis=0).tolist()
    return out


def reference(case):
    u, y = make(case["set"])
    u, y = u[slice(*case["rows"])], y[slice(*case["rows"])]
    u, y = u - u.mean(axis=0), y - np.nanmean(y, axis=0)
    rows, whole = fit(u, y, case)
    A, B = coefficients(rows, case, y.shape[1], u.shape[1])
    found = dict(case, estimates=rows, **whole)
    if np.isfinite(y).all():
        found["mean_square"] = predictions(A, B, case, u, y)
    if y.shape[1] == 1:
        a, b = [1, *A[0, 0]], [0] * case["nk"] + list(B[0, 0])
        found["step"] = lfilter(b, a, np.ones(40)).tolist()
        found["radius"] = float(max(abs(np.roots(a))))
    return found


def kernel(case):
    """Coefficients of every output under the kernel of largest likelihood, and -2 ln of that likelihood."""
    u, y = make(case["set"])
    u, y = u[slice(*case["rows"])], y[slice(*case["rows"])]
    u, y = u - u.mean(axis=0), y - y.mean(axis=0)
    rows = []
    for i in range(y.shape[1]):
        X, target, _ = regression(u, y, case, i)
        sizes = [case["na"]] * (y.shape[1] if case["na"] else 0) + [case["nb"]] * u.shape[1]

        def prior(found):
            at, whole = 0, np.zeros((X.shape[1], X.shape[1]))
            for k, size in enumerate(sizes):
                lag = np.arange(size)
                decay = 1 / (1 + np.exp(-found[2 * k + 1]))
                whole[at:at + size, at:at + size] = np.exp(found[2 * k]) * decay**np.maximum.outer(lag, lag)
                at += size
            return whole

        def minus_two_log(found):
            with np.errstate(all="ignore"):
                covariance = X @ prior(found) @ X.T + np.eye(len(X))
                if not np.isfinite(covariance).all():
                    return np.inf
                try:
                    factor = cho_factor(covariance, lower=True)
                except np.linalg.LinAlgError:  # the prior is so large that adding the identity has no effect in doubles
                    return np.inf
                square = target @ cho_solve(factor, target)
                return 2 * np.log(np.diag(factor[0])).sum() + len(X) * np.log(square / len(X))

        best = min((minimize(minus_two_log, np.tile([np.log(scale), odds], len(sizes)),
                             method="Nelder-Mead", options=dict(maxiter=6000, maxfev=6000, xatol=1e-3, fatol=1e-4))
                    for scale in (0.1, 10.0) for odds in (0.5, 3.0)), key=lambda one: one.fun)
        covariance = X @ prior(best.x) @ X.T + np.eye(len(X))
        theta = prior(best.x) @ X.T @ np.linalg.solve(covariance, target)
        rows.append(dict(theta=theta.tolist(), minus_two_log=float(best.fun)))
    return dict(case, estimates=rows)


def grid():
    """Loss on the first half (fitted) and the second, for orders 1 to 4 and delays 0 to 4; each half less its mean."""
    u, y = make("dryer")
    halves = [(u[part] - u[part].mean(axis=0), y[part] - y[part].mean(axis=0))
              for part in (slice(0, 500), slice(500, 1000))]
    rows = []
    for na in range(1, 5):
        for nb in range(1, 5):
            for nk in range(0, 5):
                case = dict(na=na, nb=nb, nk=nk, coupling="full")
                (estimate,), _ = fit(*halves[0], case)
                X, target, _ = regression(*halves[1], case, 0)
                unseen = target - X @ np.array(estimate["theta"])
                rows.append([na, nb, nk, estimate["V"], estimate["fpe"], float(unseen @ unseen / len(unseen))])
    return rows


def main():
    made = {}
    for name in SETS:
        u, y = make(name)
        made[name] = dict(rows=len(y), last=[*u[-1].tolist(), *y[-1].tolist()])
    print(json.dumps(dict(
        about="Reference estimates of ARX models on the sets of made_sets.hpp, by tools/arx_reference.py: numpy "
              f"{np.__version__}. Means over the rows are removed first; rows are 0-based, the last one excluded.",
        sets=made, cases=[reference(case) for case in CASES], grid=grid(),
        kernels=[kernel(case) for case in KERNELS]), indent=1))


if __name__ == "__main__":
    main()
