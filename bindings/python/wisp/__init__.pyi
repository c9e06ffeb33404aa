"""Learns how a thing behaves from recordings of it, and plays that behaviour live."""

import os
from enum import Enum
from typing import Any, Callable, Mapping, Optional, Sequence, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

Path = Union[str, os.PathLike[str]]
# Hears the stage and its share that is done (negative: unknown); False ends the work.
Progress = Optional[Callable[[str, float], Optional[bool]]]

__version__: str
FREE_RUN: int

class Error(ValueError):
    """Bad data: one sentence that names the file, the place, what was found, what was expected."""

class Recording:
    """Inputs and outputs over time at one fixed rate; a missing sample is NaN."""

    def __init__(self, rate_hz: float, outputs: Mapping[str, ArrayLike], inputs: Optional[Mapping[str, ArrayLike]] = None,
                 episodes: Sequence[int] = ..., source: str = "") -> None: ...
    source: str
    rate_hz: float
    inputs: list[str]
    outputs: list[str]
    attributes: dict[str, str]
    def __len__(self) -> int: ...
    def __getitem__(self, channel: str) -> NDArray[np.float64]: ...
    def rows(self, first: int, last: int) -> Recording: ...
    def write_csv(self, path: Path) -> None: ...

def read_csv(path: Path, rate_hz: float = 0, inputs: Sequence[str] = ..., outputs: Sequence[str] = ...) -> Recording: ...

class Report:
    usable: Optional[bool]
    reason: str
    warnings: list[str]
    series: list[dict[str, Any]]
    def to_dict(self) -> dict[str, Any]: ...

class ArxOffset(Enum):
    MEAN = ...
    NONE = ...
    ESTIMATE = ...

class ArxFocus(Enum):
    PREDICTION = ...
    SIMULATION = ...
    AUTO = ...

class ArxKernel(Enum):
    NONE = ...
    TC = ...

class Coupling(Enum):
    FULL = ...
    DIAGONAL = ...
    BAND = ...

class OrderCriterion(Enum):
    FPE = ...
    AIC = ...
    AICC = ...
    BIC = ...
    VALIDATION = ...

class InitialState(Enum):
    MEASURED = ...
    ZERO = ...
    ESTIMATED = ...

class OrderRange:
    def __init__(self, first: int, last: int) -> None: ...
    first: int
    last: int

class ArxSearch:
    def __init__(self, **fields: Any) -> None: ...
    na: OrderRange
    nb: OrderRange
    nk: OrderRange
    by: OrderCriterion
    steps: int
    validation: list[Recording]

class ArxRecipe:
    def __init__(self, **fields: Any) -> None: ...
    name: str
    inputs: list[str]
    outputs: list[str]
    na: int
    nb: int
    nk: Optional[int]
    coupling: Coupling
    offset: ArxOffset
    ridge: float
    kernel: ArxKernel
    radius: float
    keep_unstable: bool
    search: Optional[ArxSearch]
    focus: ArxFocus
    responses: bool

class SwitchedRecipe:
    def __init__(self, **fields: Any) -> None: ...
    name: str
    inputs: list[str]
    outputs: list[str]
    modes: Optional[int]
    seed: int

class FlickerRecipe:
    def __init__(self, **fields: Any) -> None: ...
    name: str
    output: str
    rate_hz: float
    modes: int
    order: int
    seed: int

class OutlineRecipe:
    def __init__(self, **fields: Any) -> None: ...
    paper: int
    align: bool
    inputs: Optional[list[str]]
    holdout: float
    seed: int
    name: str

class FlameRecipe(OutlineRecipe): ...

class ChainRecipe:
    def __init__(self, **fields: Any) -> None: ...
    name: str
    event: str
    realisation: str
    modes: int
    history: int
    best_of: int
    min_seconds: float
    max_bytes: int
    holdout: float
    half_width: float
    half_length: float
    seed: int

class LeafRecipe(ChainRecipe): ...

Recipe = Union[ArxRecipe, SwitchedRecipe, FlickerRecipe, OutlineRecipe, FlameRecipe, ChainRecipe, LeafRecipe]

class ClipCapture:
    def __init__(self, **fields: Any) -> None: ...
    points: int
    dark: bool
    flame: int
    rate_hz: float

class FlameCapture(ClipCapture): ...

class Captured:
    recording: Recording
    report: Report

def capture(path: Path, options: ClipCapture = ..., *, progress: Progress = None) -> Captured: ...

class Model:
    """What a thing is like: equal where its file is."""

    def __init__(self, bytes: bytes) -> None: ...
    name: str
    rate_hz: float
    inputs: list[str]
    outputs: list[str]
    dynamics: str
    view: str
    usable: bool
    reason: str
    training: dict[str, Any]
    ranges: dict[str, tuple[float, float]]
    a: NDArray[np.float64]
    b: NDArray[np.float64]
    noise_sd: list[float]
    @property
    def poles(self) -> NDArray[np.complex128]: ...
    def write(self, path: Path) -> None: ...
    def export(self, path: Path, *, seconds: float = 4, loop: bool = False, instances: int = 1, seed: int = 1,
               noise: bool = True, inputs: Sequence[float] = ...) -> None: ...
    def __bytes__(self) -> bytes: ...
    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...

def simulate(model: Model, u: Optional[ArrayLike] = None, *, steps: Optional[int] = None, instances: int = 1, seed: int = 1,
             noise: float = 1.0) -> NDArray[np.float32]: ...
def read_model(path: Path) -> Model: ...

class Fit:
    model: Model
    report: Report

@overload
def learn(recording: Recording, recipe: Recipe, *, progress: Progress = None) -> Fit: ...
@overload
def learn(recordings: Sequence[Recording], recipe: Recipe, *, progress: Progress = None) -> Fit: ...

class ValidationOptions:
    def __init__(self, **fields: Any) -> None: ...
    steps: list[int]
    initial: InitialState
    responses: bool
    play_seconds: float
    fidelity: bool
    seed: int

def validate(model: Model, recording: Recording, options: ValidationOptions = ..., *, progress: Progress = None) -> Report: ...
def in_model_units(model: Model, recording: Recording, *, own_gain: bool = False) -> Recording: ...

class Bank:
    """Living instances of one model, stepped together. Rows of arrays are slots. An instance is an int."""

    def __init__(self, model: Model, instances: int = 1, *, seed: int = 1, polyline_points: int = 32,
                 capacity: Optional[int] = None) -> None: ...
    slots: int
    size: int
    capacity: int
    clamped: tuple[int, int]
    noise: float
    threads: int
    lit: list[bool]
    flame_sizes: NDArray[np.float32]
    can_steer: bool
    ground: Optional[float]
    def spawn(self, stream: Optional[int] = None) -> int: ...
    def end(self, instance: int) -> None: ...
    def alive(self, instance: int) -> bool: ...
    def at(self, slot: int) -> Optional[int]: ...
    def set_inputs(self, values: ArrayLike, instance: Optional[int] = None) -> None: ...
    def step(self, steps: int = 1) -> None: ...
    def play(self, steps: int, inputs: Optional[ArrayLike] = None) -> NDArray[np.float32]: ...
    def advance(self, seconds: float) -> int: ...
    def outputs(self, out: Optional[NDArray[np.float32]] = None, instance: Optional[int] = None) -> NDArray[np.float32]: ...
    def polylines(self, out: Optional[NDArray[np.float32]] = None, instance: Optional[int] = None) -> NDArray[np.float32]: ...
    def flame(self, instance: int) -> dict[str, Any]: ...
    def relight(self, instance: Optional[int] = None) -> None: ...
    def extinguish(self, instance: Optional[int] = None) -> None: ...
    def mode(self, instance: int) -> Optional[int]: ...
    def chain_place(self, instance: int) -> tuple[int, int, int]: ...
    def place(self, instance: int, position: Sequence[float], orientation: Sequence[float] = ...,
              velocity: Sequence[float] = ..., spin: Sequence[float] = ...) -> None: ...
    def steer(self, instance: int, position: Sequence[float], seconds: float, within: float = 0.1) -> None: ...
    def release(self, instance: int) -> None: ...
    def reset(self, instance: Optional[int] = None) -> None: ...
    def save(self) -> bytes: ...
    def restore(self, bytes: bytes) -> None: ...

class WindAsk(Enum):
    BREATHE_GENTLY = ...
    BLOW_HARD = ...

class WindLevel:
    """The wind that a microphone hears, as its sound comes."""

    def __init__(self, rate_hz: float = 44100, channels: int = 1, frame_rate_hz: float = 60) -> None: ...
    def feed(self, samples: ArrayLike) -> dict[str, NDArray[np.float32]]: ...
    def calibrate(self, ask: WindAsk, seconds: float = 3) -> None: ...
    calibrating: bool
    calibrated: bool
    room_rise_db: float
