"""Learns how a thing behaves from recordings of it, and plays that behaviour live."""

import numpy as _numpy

from . import _wisp
from ._wisp import *  # noqa: F401,F403  (every name without an underscore: the stubs list them)
from ._wisp import __version__  # noqa: F401

for _each in vars(_wisp).copy().values():
    if getattr(_each, "__module__", None) == "wisp._wisp":
        _each.__module__ = "wisp"
Error = _wisp.Error

# Films need FFmpeg's libraries. They are loaded at their first use, so that learning and playing work without them.
_of_films = ("capture", "Captured", "ClipCapture", "FlameCapture")


def __getattr__(name):
    if name not in _of_films:
        raise AttributeError(f"module 'wisp' has no attribute '{name}'")
    try:
        from . import _capture
    except ImportError as why:
        raise ImportError(f"wisp.{name} reads films with FFmpeg's libraries (libavformat 59), which cannot be loaded: "
                          f"{why}; the rest of wisp does without") from why
    for each in _of_films:
        globals()[each] = getattr(_capture, each)
    return globals()[name]


def __dir__():
    return sorted({*globals(), *_of_films})


def _poles(self):
    """The roots of the model's denominator, complex: below 1 in size it is stable. One row a mode of a switched model."""
    a = self.a
    if a.ndim == 4:
        return _numpy.stack([_poles_of(each) for each in a])
    return _poles_of(a)


def _poles_of(a):
    lags, outputs = a.shape[0], a.shape[1]
    companion = _numpy.zeros((lags * outputs, lags * outputs))
    companion[:outputs] = -_numpy.concatenate(list(a), axis=1) if lags else 0
    companion[outputs:, : (lags - 1) * outputs] = _numpy.eye(max(lags - 1, 0) * outputs)
    return _numpy.linalg.eigvals(companion)


Model.poles = property(_poles)  # noqa: F405


def simulate(model, u=None, *, steps=None, instances=1, seed=1, noise=1.0):
    """What a model does in an input: y (steps x outputs) for u (steps x inputs; one column may be a vector).

    With `instances` above 1 y is steps x instances x outputs, and u may be steps x instances x inputs. Without u it plays
    `steps` steps in calm. noise=0 is what follows from the input alone.
    """
    bank = Bank(model, instances, seed=seed)  # noqa: F405
    bank.noise = noise
    width = len(model.inputs)
    if u is None:
        if steps is None:
            raise TypeError("simulate() needs an input u, or a number of steps")
        u = _numpy.zeros((steps, width), _numpy.float32)
    u = _numpy.asarray(u, _numpy.float32)
    if u.ndim == 1 and width == 1:
        u = u[:, None]
    if u.ndim == 2 and u.shape[1] == width:
        u = _numpy.repeat(u[:, None, :], instances, axis=1)
    if u.ndim != 3 or u.shape[1:] != (instances, width):
        raise ValueError(f"u: found shape {u.shape}, expected (steps, {width}) or (steps, {instances}, {width})")
    y = bank.play(len(u), u)
    return y[:, 0] if instances == 1 else y
