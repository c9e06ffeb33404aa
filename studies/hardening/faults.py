#!/usr/bin/env python3
"""Makes allocations and writes fail, one at a time, over capture, learn, run, export and the C ABI.

  studies/hardening/faults.py BIN [FAULTS]     BIN: the folder of the program wisp; FAULTS of each kind for each job (60)

Of every job one allocation fails, or all from one on, or no file may grow beyond some size. Then it must end by itself,
with a status: 0 and its output is what it always is, or not 0 and one line says why, what was there before is
untouched (or the new output whole), and nothing half-written lies about. Prints a table; exit status 1 where that was not so.
"""

import os
import pathlib
import random
import resource
import signal
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
MODELS = HERE.parent.parent / "apps" / "web" / "public" / "models"
OLD = b"what was there before\n"
SECONDS = 120


def table(path, rows=400):
    """A recording of a system of order 2, so that there is something to learn."""
    chance, y, before, u = random.Random(5), 0.0, 0.0, 0.0
    lines = ["# rate: 30", "t,u:wind,y:flame"]
    for row in range(rows):
        if row % 7 == 0:
            u = chance.random()
        y, before = 1.3 * y - 0.5 * before + 0.2 * u + 0.01 * chance.gauss(0, 1), y
        lines.append(f"{row / 30:.6f},{u:.6f},{y:.6f}")
    path.write_text("\n".join(lines) + "\n")


def jobs(wisp, c_abi, work):
    """Name, command without its output, the output's name or nothing."""
    table(work / "table.csv")
    films = [wisp, "simulate", "candle", "--seconds", "2", "--seed", "3", "-o", str(work / "clip.mp4"), "--quiet"]
    subprocess.run(films, check=True, stdout=subprocess.DEVNULL)
    flame, leaf = MODELS / "flame-4.wisp", MODELS / "leaf.wisp"
    return [
        ("capture flame", [wisp, "capture", "flame", str(work / "clip.mp4"), "--quiet"], "out.csv"),
        ("learn arx", [wisp, "learn", "arx", str(work / "table.csv"), "--inputs", "wind", "--outputs", "flame",
                       "--rate", "30", "--quiet"], "out.wisp"),
        ("run flame", [wisp, "run", str(flame), "--frames", "60", "--quiet"], "out.csv"),
        ("run leaf", [wisp, "run", str(leaf), "--frames", "60", "--quiet"], "out.csv"),
        ("export glTF", [wisp, "export", str(leaf), "--seconds", "1", "--quiet"], "out.glb"),
        ("info --json", [wisp, "info", str(flame), "--json"], None),
        ("C ABI", [c_abi, str(flame)], None),
    ]


class Job:
    def __init__(self, name, command, output, work, preload):
        self.name, self.output, self.work, self.preload = name, output, work, preload
        self.command = command + (["-o", str(work / "out" / output)] if output else [])

    def run(self, environment=None, max_bytes=None):
        """Status, and what was wrong."""
        out = self.work / "out"
        for old in out.iterdir():
            old.unlink()
        if self.output:
            (out / self.output).write_bytes(OLD)

        def limits():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            if max_bytes is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (max_bytes, max_bytes))

        variables = {**os.environ, "LD_PRELOAD": str(self.preload), "OMP_NUM_THREADS": "1", **(environment or {})}
        try:
            done = subprocess.run(self.command, env=variables, capture_output=True, timeout=SECONDS, preexec_fn=limits)
        except subprocess.TimeoutExpired:
            return None, "did not end"
        return done, self.judge(done, out)

    def judge(self, done, out):
        if done.returncode < 0:
            return f"ended by signal {-done.returncode}"
        kept = (out / self.output).read_bytes() if self.output and (out / self.output).exists() else None
        left = [path.name for path in out.iterdir() if path.name != self.output]
        if left:
            return f"left {left[0]}"
        if done.returncode == 0:
            now = (done.stdout, kept)
            if hasattr(self, "sound") and now != self.sound:
                return "status 0, but what it made is not what it makes"
            return None
        said = done.stderr.decode(errors="replace").strip().splitlines()
        # It may be that only what is said at the end failed.
        if self.output and kept != OLD and not (hasattr(self, "sound") and kept == self.sound[1]):
            return "what was there before is gone"
        if len(said) != 1:
            return f"said {len(said)} lines: {said[:2]}"
        return None

    def measure(self):
        count = self.work / "count"
        done, wrong = self.run({"WISP_COUNT_TO": str(count)})
        if wrong or done.returncode != 0:
            sys.exit(f"{self.name} fails by itself: {wrong} {done.stderr.decode()}")
        path = self.work / "out" / self.output if self.output else None
        self.sound = (done.stdout, path.read_bytes() if path else None)
        self.allocations = int(count.read_text())
        self.bytes = len(self.sound[1]) if path else 0


def numbers(count, wanted, chance):
    """The first, the last, and some between, early ones more often."""
    some = set(range(min(wanted // 4, count))) | {count - 1}
    while len(some) < min(wanted, count):
        some.add(int(count ** chance.random()) % count if chance.random() < 0.5 else chance.randrange(count))
    return sorted(some)


def attack(job, faults, chance):
    job.measure()
    outcomes = {"survived": 0, "said why": 0}
    wrongs = []
    trials = [("allocation %d fails" % n, {"WISP_FAIL_AT": str(n)}, None)
              for n in numbers(job.allocations, faults, chance)]
    # The library that writes JSON needs memory to give memory back, and ends the program where there is none at all.
    if "--json" not in job.command:
        trials += [("allocations from %d on fail" % n, {"WISP_FAIL_AT": str(n), "WISP_FAIL_ON": "1"}, None)
                   for n in numbers(job.allocations, faults // 3, chance)]
    trials += [("files end at %d bytes" % n, None, n) for n in (numbers(job.bytes, faults // 3, chance) if job.bytes else [])]
    for what, environment, most in trials:
        done, wrong = job.run(environment, most)
        if wrong:
            wrongs.append(f"{job.name}, {what}: {wrong}")
            print(wrongs[-1], file=sys.stderr, flush=True)
        else:
            outcomes["survived" if done.returncode == 0 else "said why"] += 1
    print(f"| {job.name} | {job.allocations} | {len(trials)} | {outcomes['said why']} | {outcomes['survived']} | {len(wrongs)} |",
          flush=True)
    return wrongs


def main():
    binaries = pathlib.Path(sys.argv[1]).resolve()
    faults = int(sys.argv[2]) if len(sys.argv) > 2 else 60
    chance = random.Random(20)
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "out").mkdir()
        preload = work / "fail_allocation.so"
        subprocess.run(["cc", "-O1", "-shared", "-fPIC", HERE / "fail_allocation.c", "-o", preload, "-ldl"], check=True)
        c_abi = work / "c_abi"
        libraries = next(binaries.parent.glob("**/libwisp.so")).parent
        root = HERE.parent.parent
        subprocess.run(["cc", root / "examples" / "05_c_abi.c", f"-I{root / 'include'}", f"-L{libraries}", "-lwisp",
                        f"-Wl,-rpath,{libraries}", "-o", c_abi], check=True)
        print("| job | allocations | faults | said why | survived | wrong |\n| --- | ---: | ---: | ---: | ---: | ---: |")
        wrongs = []
        only = set(sys.argv[3:])
        for name, command, output in jobs(str(binaries / "wisp"), str(c_abi), work):
            if not only or name in only:
                wrongs += attack(Job(name, command, output, work, preload), faults, chance)
    print("\n".join(["", *wrongs]) if wrongs else "")
    sys.exit(1 if wrongs else 0)


if __name__ == "__main__":
    main()
