"""Compares the module with the program: the same files, the same bytes, the same figures.

    WISP_PROGRAM=build/release/bin/wisp python3 -m unittest discover bindings/python/tests
"""

import ast
import importlib.util
import json
import os
import pathlib
import pickle
import re
import shutil
import signal
import struct
import subprocess
import tempfile
import threading
import unittest
import zlib

import numpy as np

import wisp

root = pathlib.Path(__file__).resolve().parents[3]
program = os.environ.get("WISP_PROGRAM", str(root / "build/release/bin/wisp"))
flame = root / "tests/c/models/flame.wisp"


def run(*words):
    return subprocess.run([program, *map(str, words)], check=True, capture_output=True, text=True).stdout


def made_system(rows=2000, seed=1):
    """y(t) = 1.5 y(t-1) - 0.7 y(t-2) + u(t-1) + 0.5 u(t-2) + e"""
    random = np.random.default_rng(seed)
    u, e = np.sign(random.standard_normal(rows)), 0.05 * random.standard_normal(rows)
    y = np.zeros(rows)
    for t in range(2, rows):
        y[t] = 1.5 * y[t - 1] - 0.7 * y[t - 2] + u[t - 1] + 0.5 * u[t - 2] + e[t]
    return wisp.Recording(10, {"y": y}, {"u": u})


recipe = wisp.ArxRecipe(inputs=["u"], outputs=["y"], na=2, nb=2, nk=1)


class Learning(unittest.TestCase):
    def test_a_table_gives_the_programs_model_to_the_byte(self):
        table = root / "tests/examples/dryer.csv"
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "model.wisp"
            run("learn", "arx", table, "-o", path, "--inputs", "u1", "--outputs", "y1", "--dt", "0.08",
                "--na", "2", "--nb", "2", "--nk", "3", "--quiet")
            recording = wisp.read_csv(table, rate_hz=1 / 0.08, inputs=["u1"], outputs=["y1"])
            fit = wisp.learn(recording, wisp.ArxRecipe(name="model", inputs=["u1"], outputs=["y1"], na=2, nb=2, nk=3))
            self.assertEqual(bytes(fit.model), path.read_bytes())

    def test_a_linear_system_is_exported_as_by_the_program(self):
        model = wisp.learn(made_system(), recipe).model
        with tempfile.TemporaryDirectory() as folder:
            here, there = pathlib.Path(folder) / "here", pathlib.Path(folder) / "there"
            here.mkdir()
            there.mkdir()
            model.write(here / "system.wisp")
            for name in ("system.c", "system.json"):
                run("export", here / "system.wisp", "-o", there / name)
                model.export(here / name)
            for name in ("system.c", "system.h", "system.json"):
                self.assertEqual((here / name).read_bytes(), (there / name).read_bytes(), name)

    def test_arrays_are_learned_from(self):
        fit = wisp.learn(made_system(), recipe)
        self.assertIsInstance(fit.report.usable, bool)
        self.assertGreater(len(fit.report.reason), 10)
        report = wisp.validate(fit.model, made_system(seed=2), wisp.ValidationOptions(steps=[1, wisp.FREE_RUN]))
        self.assertGreater(report.to_dict()["channels"][0]["fit_percent"]["inf"], 90)
        self.assertIn("y", str(report))

    def test_samples_are_not_copied_out(self):
        recording = made_system()
        recording["y"][5] = 7
        self.assertEqual(recording["y"][5], 7)
        self.assertFalse(recording["y"].flags.owndata)

    def test_a_light_flickers_as_the_programs_does(self):
        random = np.random.default_rng(3)
        light = np.ones(4000)
        for t in range(1, len(light)):
            light[t] = 1 + 0.9 * (light[t - 1] - 1) + (0.05 if t // 60 % 3 == 0 else 0.005) * random.standard_normal()
        with tempfile.TemporaryDirectory() as folder:
            table, model = os.path.join(folder, "light.csv"), os.path.join(folder, "light.wisp")
            wisp.Recording(50, {"brightness": light}).write_csv(table)
            run("learn", "flicker", table, "-o", model)
            fit = wisp.learn(wisp.read_csv(table), wisp.FlickerRecipe(name="light"))
            self.assertEqual(bytes(fit.model), pathlib.Path(model).read_bytes())

    def test_bad_data_is_one_sentence(self):
        with self.assertRaisesRegex(wisp.Error, "nosuch"):
            wisp.learn(made_system(), wisp.ArxRecipe(inputs=["nosuch"], outputs=["y"]))
        with self.assertRaises(TypeError):
            wisp.ArxRecipe(ordre=3)
        with self.assertRaises(wisp.Error):
            wisp.Recording(10, {"y": [1.0, 2.0]}, {"u": [1.0]})
        with self.assertRaisesRegex(wisp.Error, "found 1 episode ids, expected one for each of the 2 rows"):
            wisp.Recording(10, {"y": [1.0, 2.0]}, episodes=[1])
        with self.assertRaises(wisp.Error):
            wisp.read_model(root / "README.md")

    def test_progress_is_heard_and_may_stop(self):
        heard = []
        wisp.learn(made_system(), recipe, progress=lambda stage, share: heard.append(stage))
        with self.assertRaisesRegex(wisp.Error, "stopped"):
            wisp.learn(made_system(), recipe, progress=lambda stage, share: False)
        with self.assertRaises(ZeroDivisionError):
            wisp.learn(made_system(), recipe, progress=lambda stage, share: 1 / 0)
        self.assertTrue(heard)
        for answer in ("on", [1]):
            wisp.learn(made_system(), recipe, progress=lambda stage, share: answer)
        with self.assertRaisesRegex(ValueError, "ambiguous"):
            wisp.learn(made_system(), recipe, progress=lambda stage, share: np.zeros(2))


class Capturing(unittest.TestCase):
    def test_a_film_gives_the_programs_flame_to_the_byte(self):
        with tempfile.TemporaryDirectory() as folder:
            clip, path = pathlib.Path(folder) / "candle.mp4", pathlib.Path(folder) / "model.wisp"
            run("simulate", "candle", "-o", clip, "--seconds", "3", "--seed", "5", "--quiet")
            run("learn", "flame", clip, "-o", path, "--quiet")
            captured = wisp.capture(clip)
            fit = wisp.learn(captured.recording, wisp.FlameRecipe(name="model"))
            self.assertEqual(bytes(fit.model), path.read_bytes())
            self.assertIn("usable", captured.report.to_dict())

    def test_ctrl_c_ends_it(self):
        # A process that a shell starts in the background ignores the signal.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        with tempfile.TemporaryDirectory() as folder:
            clip = pathlib.Path(folder) / "candle.mp4"
            run("simulate", "candle", "-o", clip, "--seconds", "20", "--seed", "5", "--quiet")
            timer = threading.Timer(0.3, lambda: signal.raise_signal(signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                for _ in range(100):
                    wisp.capture(clip)


class Playing(unittest.TestCase):
    def test_a_bank_reads_into_one_array(self):
        bank = wisp.Bank(wisp.read_model(flame), 5, seed=3)
        out = np.zeros_like(bank.outputs())
        for _ in range(10):
            bank.set_inputs([0.5])
            bank.step()
            self.assertIs(bank.outputs(out), out)
        self.assertEqual(out.shape[0], 5)
        self.assertTrue(np.isfinite(out).all() and np.abs(out).max() > 0)
        self.assertEqual(bank.polylines().shape, (5, 32, 2))

    def test_a_flame_in_the_round_leans_into_the_picture(self):
        with self.assertRaisesRegex(wisp.Error, "about the vertical"):
            wisp.read_model(flame).in_the_round()
        shipped = pathlib.Path(__file__).parents[3] / "apps/web/public/models/flame.wisp"
        bank = wisp.Bank(wisp.read_model(shipped).in_the_round())
        bank.set_inputs([0.0, -0.6])
        bank.step(60)
        rings = bank.rings(bank.at(0))
        self.assertEqual(rings.shape, (16, 6))
        self.assertLess(rings[-1, 2], -0.2)
        bank.look(0, -1)
        np.testing.assert_allclose(bank.polylines()[0, 15:17].mean(0)[0], -rings[-1, 2], atol=1e-5)
        vertices, triangles = bank.mesh(bank.at(0), segments=8)
        self.assertEqual(vertices.shape, (16 * 8, 6))
        self.assertEqual(triangles.max(), len(vertices) - 1)
        np.testing.assert_allclose(np.linalg.norm(vertices[:, 3:], axis=1), 1, atol=1e-5)
        light = bank.light(bank.at(0))
        self.assertLess(light["position"][2], -0.05)
        self.assertAlmostEqual(light["kelvin"], 1900, delta=60)
        self.assertFalse(bank.flame(bank.at(0))["went_out"])
        bank.extinguish()
        self.assertTrue(bank.flame(bank.at(0))["went_out"])
        self.assertLessEqual(wisp.Bank(wisp.read_model(shipped), longest_advance=0.1).advance(5), 6)
        with self.assertRaisesRegex(wisp.Error, "longest advance"):
            wisp.Bank(wisp.read_model(shipped), longest_advance=0)

    def test_the_same_seed_is_the_same_life_and_a_saved_bank_goes_on(self):
        model = wisp.read_model(flame)
        one, two = wisp.Bank(model, seed=3), wisp.Bank(pickle.loads(pickle.dumps(model)), seed=3)
        one.step(50)
        two.restore(one.save())
        one.step(50)
        two.step(50)
        np.testing.assert_array_equal(one.outputs(), two.outputs())

    def test_a_recording_drives_it_as_the_programs_does(self):
        with tempfile.TemporaryDirectory() as folder:
            clip, played = pathlib.Path(folder) / "candle.mp4", pathlib.Path(folder) / "played.csv"
            run("simulate", "candle", "-o", clip, "--seconds", "4", "--seed", "5", "--quiet")
            captured = wisp.capture(clip)
            model = wisp.learn(captured.recording, wisp.FlameRecipe()).model
            path, recorded = pathlib.Path(folder) / "model.wisp", pathlib.Path(folder) / "candle.csv"
            path.write_bytes(bytes(model))
            run("capture", "flame", clip, "-o", recorded, "--quiet")
            run("run", path, "--input", recorded, "-o", played, "--quiet")
            wind = wisp.in_model_units(model, captured.recording)["wind"]
            self.assertFalse(np.array_equal(wind, captured.recording["wind"]))
            np.testing.assert_allclose(wisp.read_csv(played)["wind"], wind, rtol=1e-6)

    def test_strong_wind_puts_it_out(self):
        bank = wisp.Bank(wisp.read_model(flame))
        bank.set_inputs([3.0])
        bank.step(60)
        self.assertEqual(bank.lit, [False])
        bank.relight()
        self.assertEqual(bank.lit, [True])

    def test_inputs_of_another_shape_are_refused(self):
        bank = wisp.Bank(wisp.read_model(flame), 5)
        with self.assertRaisesRegex(ValueError, "expected 1 for all or 1 for each of 5 slots"):
            bank.set_inputs([1, 2, 3])
        # An array with a row per input instead of a row per slot would reach the wrong leaves.
        leaves = wisp.Bank(wisp.read_model(root / "apps/web/public/models/leaf.wisp"), 10)
        leaves.set_inputs(np.zeros((10, 3)))
        leaves.set_inputs([0, 0, 1])
        with self.assertRaisesRegex(ValueError, r"found shape \(3, 10\)"):
            leaves.set_inputs(np.zeros((3, 10)))
        with self.assertRaises(ValueError):
            bank.outputs(np.zeros((4, 16), np.float32))


class EveryModel(unittest.TestCase):
    def test_shipped_models_are_played_by_single_instances(self):
        paths = [path for folder in ("apps/web/public/models", "apps/web/tests/models", "tests/model/golden", "tests/c/models")
                 for path in sorted((root / folder).glob("*.wisp"))]
        self.assertGreater(len(paths), 10)
        for path in paths:
            with self.subTest(path.name):
                model = wisp.read_model(path)
                self.assertEqual(wisp.Model(path.read_bytes()), model)
                self.assertIn(model.dynamics, repr(model))
                bank = wisp.Bank(model, 2, capacity=3)
                third = bank.spawn(7)
                with self.assertRaisesRegex(ValueError, "full"):
                    bank.spawn()
                bank.set_inputs(np.zeros((3, len(model.inputs))))
                bank.set_inputs(np.zeros(len(model.inputs)), third)
                width = len(model.inputs)
                for shape in ((width + 1,), (3 * width + 1,), (2, width + 1), (3, width + 1), (width + 4, 3)):
                    with self.assertRaises(ValueError, msg=shape):
                        bank.set_inputs(np.zeros(shape))
                    with self.assertRaises(ValueError, msg=shape):
                        bank.set_inputs(np.zeros(shape), third)
                    with self.assertRaises(ValueError, msg=shape):
                        bank.play(4, np.zeros((4, *shape)))
                for shape in ((2, len(model.outputs)), (3, len(model.outputs) + 1), (3 * len(model.outputs),)):
                    with self.assertRaises(ValueError, msg=shape):
                        bank.outputs(np.zeros(shape, np.float32))
                self.assertEqual(bank.play(4).shape, (4, 3, len(model.outputs)))
                np.testing.assert_array_equal(bank.outputs()[2], bank.outputs(instance=third))
                saved = bank.save()
                one = bank.play(3)
                bank.restore(saved)
                bank.threads = 2
                np.testing.assert_array_equal(bank.play(3, np.zeros((3, 3, len(model.inputs)))), one)
                bank.end(third)
                self.assertFalse(bank.alive(third))
                with self.assertRaises(KeyError):
                    bank.outputs(instance=third)
                if model.dynamics == "switched":
                    self.assertEqual(np.shape(model.noise_sd), (len(model.a), len(model.outputs)))
                if model.dynamics == "chain":
                    first = bank.at(0)
                    bank.ground = -2
                    bank.place(first, [0, 0, 1], velocity=[0.5, 0, 0])
                    place = bank.chain_place(first)
                    self.assertEqual((bank.ground, place["lies"], place["landed"]), (-2, False, False))
                    self.assertEqual((place["velocity"].shape, place["spin"].shape), ((3,), (3,)))
                    if bank.can_steer:
                        bank.steer(first, [0, 0, -1], 2)
                        bank.release(first)
                else:
                    self.assertLess(np.abs(model.poles).max(), 1)

    def test_simulate_is_the_filter_that_the_coefficients_say(self):
        of = made_system()
        model = wisp.learn(of, recipe).model
        u = np.sign(np.sin(np.arange(300) / 9.0))
        y = wisp.simulate(model, u, noise=0)[:, 0]
        a, b = model.a[:, 0, 0], model.b[:, 0, 0]
        self.assertEqual((model.a.shape, model.b.shape), ((2, 1, 1), (3, 1, 1)))
        self.assertAlmostEqual(a[0], -1.5, 1)
        y0, u0 = np.mean(of["y"]), np.mean(of["u"])
        expected = np.zeros(300)
        for t in range(300):
            past = sum(-a[l] * (expected[t - 1 - l] if t > l else 0) for l in range(2))
            expected[t] = past + sum(b[l] * ((u[t - l] if t >= l else 0) - u0) for l in range(3))
        np.testing.assert_allclose(y[50:], expected[50:] + y0, atol=1e-3)
        with self.assertRaisesRegex(ValueError, "found shape"):
            wisp.simulate(model, np.zeros((10, 2)))

    def test_a_wrong_field_is_named(self):
        with self.assertRaisesRegex(TypeError, "ArxRecipe.na"):
            wisp.ArxRecipe(na="three")
        self.assertIn("lags of outputs", wisp.ArxRecipe.na.__doc__)

    def test_help_says_what_each_field_is(self):
        options = [each for each in vars(wisp).values() if isinstance(each, type) and "**kwargs" in (each.__init__.__doc__ or "")]
        self.assertGreater(len(options), 8)
        for each in (*options, wisp.ClipCapture):
            for name in dir(each):
                if not name.startswith("_"):
                    self.assertTrue(getattr(each, name).__doc__, f"{each.__name__}.{name}")

    def test_names_and_time_are_kept(self):
        of = made_system()
        model = wisp.learn(of, recipe).model
        self.assertEqual(model.verdict, (model.usable, model.reason))
        self.assertIn("2000 rows at 10.0 Hz, inputs ['u'], outputs ['y']", repr(of))
        y = wisp.simulate(model, of["u"], noise=0)
        for library, frame in (("pandas", lambda: of.to_pandas()), ("xarray", lambda: of.to_xarray())):
            if not importlib.util.find_spec(library):
                continue
            given = frame()
            simulated = wisp.simulate(model, given, noise=0)
            self.assertEqual(list(simulated), ["y"])
            np.testing.assert_array_equal(np.asarray(simulated["y"]), y[:, 0])
            over = simulated.index if library == "pandas" else simulated["time"].values
            np.testing.assert_array_equal(over, of.time)
            again = wisp.Recording(of.rate_hz, given[["y"]], given[["u"]])
            self.assertEqual(bytes(wisp.learn(again, recipe).model), bytes(model))
            with self.assertRaisesRegex(ValueError, "expected the inputs"):
                wisp.simulate(model, given[["y"]])
        self.assertGreater(of.time[-1], 199)

    def test_a_report_is_a_page_and_a_film_strip_a_figure(self):
        self.assertIn("<", wisp.learn(made_system(), recipe).report.to_html())
        if not importlib.util.find_spec("matplotlib"):
            self.skipTest("no matplotlib; script/bootstrap --verify brings it")
        os.environ["MPLBACKEND"] = "Agg"
        bank, outlines = wisp.Bank(wisp.read_model(flame)), []
        for _ in range(5):
            bank.step(4)
            outlines.append(bank.polylines()[0])
        figure = wisp.film_strip({"played": outlines, "again": outlines[:3]}, times=[0, 0.1])
        self.assertEqual(len(figure.axes), 10)
        self.assertEqual([len(axis.patches) for axis in figure.axes], [1, 1, 1, 1, 1, 1, 1, 1, 0, 0])
        self.assertEqual(figure.axes[6].texts[0].get_text(), "0.10 s")
        with self.assertRaisesRegex(ValueError, "frames, points, 2"):
            wisp.film_strip({"played": outlines[0]})

    def test_an_exported_flame_is_bright_inside_and_orange_outside_however_it_is_composited(self):
        shipped = wisp.read_model(root / "apps/web/public/models/flame.wisp")
        with tempfile.TemporaryDirectory() as folder:
            shipped.export(folder + "/flame.glb", seconds=1, loop=True)
            glb = pathlib.Path(folder, "flame.glb").read_bytes()
        length = struct.unpack_from("<I", glb, 12)[0]
        document = json.loads(glb[20:20 + length])
        strength = document["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]
        view = document["bufferViews"][document["images"][0]["bufferView"]]
        picture = glb[28 + length + view["byteOffset"]:][:view["byteLength"]]
        width, height = struct.unpack_from(">II", picture, 16)
        at = picture.index(b"IDAT")
        data = picture[at + 4:][:struct.unpack_from(">I", picture, at - 4)[0]]
        shells = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, 1 + 4 * width)[:, 1:].reshape(height, width, 4) / 255
        shells = shells[height // 3]  # below the tip, above the base
        light = strength * np.where(shells[:, :3] < 0.04, shells[:, :3] / 12.92, ((shells[:, :3] + 0.055) / 1.055) ** 2.4)

        def screen(linear):
            return np.minimum(1, np.where(linear < 0.0031, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055))

        for through in (1, width):  # shells that a ray meets at the rim, and in the middle
            drawn, traced, left = np.zeros(3), np.zeros(3), 1.0
            for emitted, opacity in zip(light[:through], shells[:through, 3]):
                drawn = opacity * screen(emitted) + (1 - opacity) * drawn  # in display colours, innermost last (three.js)
                traced, left = traced + left * opacity * emitted, left * (1 - opacity)  # in light, outermost first (Cycles)
            for red, green, blue in (drawn, screen(traced)):
                self.assertGreater(red, 0.6)
                if through == 1:
                    self.assertLess(green, 0.75 * red)
                else:
                    self.assertGreater(min(green, blue), 0.7)


class Guide(unittest.TestCase):
    """The programs in docs/guide/python.md run."""

    def test_its_programs_run_from_a_film_and_from_a_table(self):
        if not importlib.util.find_spec("matplotlib"):
            self.skipTest("no matplotlib; script/bootstrap --verify brings it")
        os.environ["MPLBACKEND"] = "Agg"
        programs = re.findall(r"```python\n(.*?)```", (root / "docs/guide/python.md").read_text(), re.S)
        self.assertGreaterEqual(len(programs), 2)
        here = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                run("simulate", "candle", "-o", "candle.mp4", "--seconds", "12", "--seed", "5", "--quiet")
                of = made_system(1000)
                np.savetxt("dryer.csv", np.column_stack([of["u"], of["y"]]), delimiter=",", header="u1,y1", comments="")
                names = {}
                exec(programs[0], names)
                self.assertTrue(pathlib.Path("flame.wisp").exists())
                self.assertEqual(names["outlines"].shape, (1000, 32, 2))
                self.assertGreater(np.abs(names["outlines"]).max(), 0.5)
                exec(programs[1], names)
                self.assertTrue(names["plt"].get_fignums())
                names["plt"].close("all")
                exec(programs[2], names)
                self.assertEqual(names["same"], names["fit"].model)
            finally:
                os.chdir(here)

    def test_frames_and_datasets_are_as_good_as_arrays(self):
        if not importlib.util.find_spec("pandas") or not importlib.util.find_spec("xarray"):
            self.skipTest("no pandas or xarray; script/bootstrap --verify brings them")
        import pandas
        import xarray

        of = made_system()
        frame = pandas.DataFrame({"u": of["u"], "y": of["y"]})
        dataset = xarray.Dataset({"u": ("t", of["u"]), "y": ("t", of["y"])})
        fit = wisp.learn(of, recipe)
        played = wisp.simulate(fit.model, u=of["u"], noise=0)
        for columns in (frame, dataset):
            recording = wisp.Recording(10, columns[["y"]], columns[["u"]])
            self.assertEqual(bytes(fit.model), bytes(wisp.learn(recording, recipe).model))
            prepared = wisp.prepare(recording, wisp.Preparation(detrend=True))
            self.assertLess(abs(np.polyfit(np.arange(2000), prepared["y"], 1)[0]), 1e-9)
            np.testing.assert_array_equal(wisp.simulate(fit.model, u=columns["u"], noise=0), played)

    def test_advice_names_what_spoils_a_model(self):
        of = made_system()
        y = np.array(of["y"])
        y[100:110] = -999
        said = wisp.advise(wisp.Recording(10, {"y": y}, {"u": of["u"]})).to_dict()
        self.assertIn("stands for a missing sample", said["remarks"][0]["cause"])
        self.assertEqual(wisp.advise(of).to_dict()["remarks"], [])

    def test_mypy_finds_the_stubs_and_agrees_with_its_programs(self):
        if not shutil.which("mypy"):
            self.skipTest("no mypy; script/bootstrap --verify brings it")
        programs = re.findall(r"```python\n(.*?)```", (root / "docs/guide/python.md").read_text(), re.S)
        with tempfile.TemporaryDirectory() as folder:
            whole, wrong = pathlib.Path(folder) / "whole.py", pathlib.Path(folder) / "wrong.py"
            whole.write_text("\n".join(["import numpy", "block = numpy.zeros(800, numpy.float32)", *programs]))
            wrong.write_text("import wisp\nwisp.Bank('flame.wisp').polyline(3)\n")
            said = {}
            for path in (whole, wrong):
                # MYPYPATH stands for an installation, where mypy finds the package by its marker py.typed.
                done = subprocess.run(["mypy", "--ignore-missing-imports", "--no-error-summary", "--cache-dir", folder, path],
                                      env={**os.environ, "MYPYPATH": str(pathlib.Path(wisp.__file__).parents[1])},
                                      capture_output=True, text=True)
                said[path] = done.stdout + done.stderr
        self.assertEqual(said[whole], "")
        self.assertIn('has incompatible type "str"; expected "Model"', said[wrong])
        self.assertIn('has no attribute "polyline"', said[wrong])

    def test_its_stubs_name_what_the_module_has(self):
        said = {node.name: node for node in ast.parse((root / "bindings/python/wisp/__init__.pyi").read_text()).body
                if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        there = {name for name in dir(wisp) if not name.startswith("_") and callable(getattr(wisp, name))}
        self.assertEqual(set(said), there)
        for name, node in said.items():
            methods = {part.name for part in getattr(node, "body", []) if isinstance(part, ast.FunctionDef)}
            self.assertLessEqual(methods, set(dir(getattr(wisp, name))) | {"__init__"}, name)


class Threads(unittest.TestCase):
    def test_other_threads_run_while_it_learns_and_plays(self):
        turns, over = [0], threading.Event()

        def count():
            while not over.wait(0.001):
                turns[0] += 1

        thread = threading.Thread(target=count)
        thread.start()
        recording = made_system(200000)
        bank = wisp.Bank(wisp.read_model(flame), 1000)
        try:
            for work in (lambda: wisp.learn(recording, recipe), lambda: bank.step(3000)):
                before = turns[0]
                work()
                # If a call kept the interpreter's lock, the other thread would run at most once, just before it.
                self.assertGreater(turns[0] - before, 3)
        finally:
            over.set()
            thread.join()


class Hearing(unittest.TestCase):
    def test_blocks_give_the_frames_of_the_whole(self):
        sound = 0.05 * np.random.default_rng(1).standard_normal(44100).astype(np.float32)
        whole = wisp.WindLevel(44100).feed(sound)
        level = wisp.WindLevel(44100)
        pieces = [level.feed(block)["rms"] for block in np.array_split(sound, 17)]
        np.testing.assert_array_equal(np.concatenate(pieces), whole["rms"])
        self.assertEqual(len(whole["wind"]), 60)

    def test_half_a_row_of_channels_is_refused(self):
        level = wisp.WindLevel(44100, channels=2)
        level.feed(np.zeros((441, 2), np.float32))
        with self.assertRaisesRegex(ValueError, "found 883 samples, expected whole rows of 2 channels"):
            level.feed(np.zeros(883, np.float32))


if __name__ == "__main__":
    unittest.main()
