"""Measures what Python costs: learning against the program, and reading a bank of 1,000 instances against the C ABI.

    WISP_PROGRAM=build/release/bin/wisp WISP_LIBRARY=build/release/src/c/libwisp.so python3 bindings/python/bench.py

Prints the fastest of several runs of each, and their ratio; asserts no time.
"""

import ctypes
import os
import pathlib
import subprocess
import tempfile
import time

import numpy as np

import wisp

root = pathlib.Path(__file__).resolve().parents[2]
program = os.environ.get("WISP_PROGRAM", str(root / "build/release/bin/wisp"))
library = os.environ.get("WISP_LIBRARY", str(root / "build/release/src/c/libwisp.so"))
flame = root / "apps/web/public/models/flame-4.wisp"
instances, frames = 1000, 300


def best(work, runs):
    times = []
    for _ in range(runs):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return min(times)


def learning():
    with tempfile.TemporaryDirectory() as folder:
        clip, table, model = (os.path.join(folder, name) for name in ("clip.mp4", "clip.csv", "flame.wisp"))
        quiet = {"check": True, "stdout": subprocess.DEVNULL}
        subprocess.run([program, "simulate", "candle", "-o", clip, "--seconds", "20", "--quiet"], **quiet)
        subprocess.run([program, "capture", "flame", clip, "-o", table, "--quiet"], **quiet)
        by_program = best(lambda: subprocess.run([program, "learn", "flame", table, "-o", model, "--quiet"], **quiet), 3)

        def in_python():
            wisp.learn(wisp.read_csv(table), wisp.FlameRecipe()).model.write(model)

        by_module = best(in_python, 3)
    print(f"learning a flame of 20 s    program {by_program:.2f} s    Python {by_module:.2f} s    ratio {by_module / by_program:.2f}")


def over_c():
    c = ctypes.CDLL(library)
    model, bank, instance = ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_uint64()
    data = flame.read_bytes()

    class Options(ctypes.Structure):
        _fields_ = [(name, ctypes.c_uint32) for name in ("size", "capacity", "polyline_points", "reserved")]
        _fields_ += [("seed", ctypes.c_uint64), ("memory", ctypes.c_void_p), ("memory_size", ctypes.c_size_t)]

    options = Options(ctypes.sizeof(Options), instances, 32, 0, 1, None, 0)
    assert c.wisp_model_load(data, ctypes.c_size_t(len(data)), ctypes.byref(model)) == 0
    assert c.wisp_bank_create(model, ctypes.byref(options), ctypes.byref(bank)) == 0
    for _ in range(instances):
        assert c.wisp_bank_spawn(bank, ctypes.byref(instance)) == 0
    values = np.zeros((instances, 16), np.float32)
    pointer, count = values.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(values.size)

    def play():
        for _ in range(frames):
            c.wisp_bank_step(bank)
            c.wisp_bank_outputs(bank, pointer, count)

    return play, values


def over_python():
    bank = wisp.Bank(wisp.read_model(flame), instances, seed=1)
    values = np.zeros((instances, 16), np.float32)

    def play():
        for _ in range(frames):
            bank.step()
            bank.outputs(values)

    return play, values


def reading():
    (c, of_c), (python, of_python) = over_c(), over_python()
    by_c, by_python = best(c, 7), best(python, 7)
    assert np.array_equal(of_c, of_python), "the two play other numbers"
    each = 1e6 / frames
    print(f"a frame of {instances} flames    C ABI {by_c * each:.1f} us    Python {by_python * each:.1f} us    ratio {by_python / by_c:.2f}")


if __name__ == "__main__":
    learning()
    reading()
