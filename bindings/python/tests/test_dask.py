"""examples/10_dask_fit.py on two workers, one of which is killed half-way, gives one machine's model to the byte.

    WISP_PROGRAM=build/release/bin/wisp python3 -m unittest discover bindings/python/tests
"""

import importlib.util
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

root = pathlib.Path(__file__).resolve().parents[3]
program = os.environ.get("WISP_PROGRAM", str(root / "build/release/bin/wisp"))
example = root / "examples/10_dask_fit.py"
flags = ["--inputs", "wind", "--outputs", "p3.x,p3.y", "--na", "2", "--nb", "2", "--nk", "1", "--offset", "estimate"]  # a part does not know the other parts' means
there = importlib.util.find_spec("distributed") is not None


@unittest.skipUnless(there, "Dask's distributed is not there (script/bootstrap --verify installs it)")
class Dask(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.at = pathlib.Path(folder.name)
        os.environ["WISP"] = program
        cls.clips = []
        for seed in range(1, 6):
            clip = cls.at / f"clip{seed}.mp4"
            words = [program, "simulate", "candle", "-o", clip, "--seconds", 3, "--seed", seed, "--quiet"]
            subprocess.run(list(map(str, words)), check=True, stdout=subprocess.DEVNULL)
            cls.clips.append(str(clip))
        # The models of one machine. A model stores its recordings' names, so both runs call them work/….
        for name in ("alone", "spread"):
            (cls.at / name / "work").mkdir(parents=True)
        for model, kind, more in (("tip.wisp", "arx", flags), ("flame.wisp", "flame", [])):
            words = [sys.executable, example, "work", model, *cls.clips, "--kind", kind, "--workers", 0, "--", *more]
            subprocess.run(list(map(str, words)), check=True, capture_output=True, cwd=cls.at / "alone")

    def module(self):
        found = importlib.util.spec_from_file_location("dask_fit", example)
        module = importlib.util.module_from_spec(found)
        found.loader.exec_module(module)
        return module

    def test_a_worker_that_dies_half_way_changes_no_byte_of_an_arx_model(self):
        self.spread_with_a_death("arx", "tip.wisp", flags)

    def test_a_worker_that_dies_half_way_changes_no_byte_of_a_flame(self):
        self.spread_with_a_death("flame", "flame.wisp", [])

    def spread_with_a_death(self, kind, name, more):
        from distributed import Client, LocalCluster, as_completed

        fit = self.module()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.at / "spread")
        tasks = []

        def submit(run, *of):
            tasks.append(client.submit(run, *of, pure=False, retries=3))
            return tasks[-1]

        # The workers receive the example's code with the task, since they cannot import it as a module.
        import cloudpickle

        sys.modules["dask_fit"] = fit
        cloudpickle.register_pickle_by_value(fit)
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster:
            with Client(cluster) as client:
                model = fit.graph(submit, kind, "work", name, self.clips, more)
                pids = client.run(os.getpid)
                next(iter(as_completed(tasks)))
                self.assertFalse(model.done(), "nothing was left to do when the worker was killed")
                os.kill(list(pids.values())[0], signal.SIGKILL)
                model.result(timeout=300)
        self.assertEqual((self.at / "spread" / name).read_bytes(), (self.at / "alone" / name).read_bytes())

    def test_a_flame_of_parts_is_that_of_all_recordings(self):
        recordings = sorted(str(path.relative_to(self.at / "alone")) for path in (self.at / "alone/work").glob("clip*.csv"))
        (self.at / "once").mkdir()
        words = [program, "learn", "flame", *recordings, "-o", self.at / "once/flame.wisp", "--quiet"]
        subprocess.run(list(map(str, words)), check=True, capture_output=True, cwd=self.at / "alone")
        self.assertEqual((self.at / "once/flame.wisp").read_bytes(), (self.at / "alone/flame.wisp").read_bytes())

    def test_without_a_cluster_it_is_the_fit_of_all_rows(self):
        recordings = sorted(map(str, (self.at / "alone/work").glob("clip*.csv")))
        words = [program, "learn", "arx", *recordings, *flags, "-o", self.at / "once.wisp", "--quiet"]
        subprocess.run(list(map(str, words)), check=True, capture_output=True)

        def coefficients(model):
            said = subprocess.run([program, "info", str(self.at / model), "--json"], check=True, capture_output=True).stdout
            dynamics = json.loads(said)["dynamics"]
            return [c for part in ("A", "B") for row in dynamics[part] for lags in row for c in lags]

        for alone, once in zip(coefficients("alone/tip.wisp"), coefficients("once.wisp")):
            self.assertAlmostEqual(alone, once, delta=1e-9)


if __name__ == "__main__":
    unittest.main()
