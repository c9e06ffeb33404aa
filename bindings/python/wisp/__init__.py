"""Learns how a thing behaves from recordings of it, and plays that behaviour live."""

from collections import namedtuple as _namedtuple

import numpy as _numpy

from . import _wisp
from ._wisp import *  # noqa: F401,F403  (every name without an underscore: the stubs list them)
from ._wisp import __version__  # noqa: F401

for _each in vars(_wisp).copy().values():
    if getattr(_each, "__module__", None) == "wisp._wisp":
        _each.__module__ = "wisp"
Error = _wisp.Error

# Films need FFmpeg's libraries. They are loaded at first use, so that learning and playing work without them.
_of_films = ("capture", "Captured", "ClipCapture", "FlameCapture")


def __getattr__(name):
    if name not in _of_films:
        raise AttributeError(f"module 'wisp' has no attribute '{name}'")
    try:
        from . import _capture
    except ImportError as why:
        raise ImportError(f"wisp.{name} reads films with wispflame-capture and FFmpeg's libraries (libavformat 59), which cannot "
                          f"be loaded: {why}; the rest of wisp does without") from why
    for each in _of_films:
        globals()[each] = getattr(_capture, each)
    return globals()[name]


def __dir__():
    return sorted({*globals(), *_of_films})


def _poles(self):
    """Roots of the denominator, complex; stable if all magnitudes are below 1. One row per mode of a switched model."""
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

Verdict = _namedtuple("Verdict", "usable reason")
Verdict.__doc__ = "Whether a model may be used, and why or why not."
Model.verdict = property(lambda self: Verdict(self.usable, self.reason), doc=Verdict.__doc__)  # noqa: F405


def _time(self):
    """Seconds since the first row."""
    return _numpy.arange(len(self)) / self.rate_hz


def _to_pandas(self):
    """A pandas frame with a column per channel, inputs first, indexed by seconds."""
    import pandas

    return pandas.DataFrame({name: self[name] for name in self.inputs + self.outputs},
                            index=pandas.Index(self.time, name="time"))


def _to_xarray(self):
    """An xarray dataset with a variable per channel over the coordinate `time`, seconds; attributes list the inputs."""
    import xarray

    return xarray.Dataset({name: ("time", self[name]) for name in self.inputs + self.outputs}, {"time": self.time},
                          {"rate_hz": self.rate_hz, "inputs": self.inputs, "outputs": self.outputs})


Recording.time = property(_time)  # noqa: F405
Recording.to_pandas = _to_pandas  # noqa: F405
Recording.to_xarray = _to_xarray  # noqa: F405


def simulate(model, u=None, *, steps=None, instances=1, seed=1, noise=1.0):
    """Simulates a model: y (steps x outputs) for an input u (steps x inputs; a single column may be a vector).

    With `instances` above 1 y is steps x instances x outputs, and u may be steps x instances x inputs. Without u all inputs
    are 0 for `steps` steps. noise=0 leaves the response to the input alone. A pandas frame or an xarray dataset with a
    column per input (for one instance) gives one of the outputs, over the same times.
    """
    if hasattr(u, "data_vars") or hasattr(u, "columns"):
        if instances != 1:
            raise ValueError("a frame or a dataset goes with one instance")
        missing = [name for name in model.inputs if name not in u]
        if missing:
            raise ValueError(f"u: found {list(u)}, expected the inputs {model.inputs}")
        y = simulate(model, _numpy.stack([_numpy.asarray(u[name]) for name in model.inputs], 1), seed=seed, noise=noise)
        if hasattr(u, "columns"):
            return type(u)(y, index=u.index, columns=model.outputs)
        (over,) = u[model.inputs[0]].dims
        return type(u)({name: (over, column) for name, column in zip(model.outputs, y.T)}, {over: u[over]})
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


def film_strip(rows, times=None):
    """A film strip as a matplotlib figure: `rows` maps captions to outlines (frames x points x 2, such as bank.polylines() of
    one flame frame by frame); `times` are the columns' labels, seconds.
    """
    import matplotlib.pyplot as plt

    strips = {caption: _numpy.asarray(outlines) for caption, outlines in dict(rows).items()}
    for caption, outlines in strips.items():
        if outlines.ndim != 3 or outlines.shape[2] != 2:
            raise ValueError(f"{caption}: found shape {outlines.shape}, expected (frames, points, 2)")
    points = _numpy.concatenate([outlines.reshape(-1, 2) for outlines in strips.values()])
    low, high = points.min(0) - 0.1, points.max(0) + 0.1
    columns = max(len(outlines) for outlines in strips.values())
    figure, axes = plt.subplots(len(strips), columns, squeeze=False, facecolor="black",
                                figsize=(columns * (high - low)[0] * 1.6, len(strips) * (high - low)[1] * 1.6))
    for row, (caption, outlines) in zip(axes, strips.items()):
        for axis in row:
            axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
            axis.axis("off")
        for axis, outline in zip(row, outlines):
            axis.fill(*outline.T, facecolor="#ffb347", edgecolor="#fff2c0")
        row[0].set_title(caption, color="white", loc="left")
    for axis, time in zip(axes[-1], times if times is not None else ()):
        axis.text(_numpy.mean((low[0], high[0])), low[1], f"{time:.2f} s", color="white", ha="center", va="top")
    return figure
