#!/usr/bin/env python3
"""Plants small faults one at a time, and sees whether the tests notice.

  tools/mutate.py [--of player|strangers] [--most N] [--only PART-OF-A-PATH] [--jobs N] [--these K,K…]

`player` is src/run and the checks of src/model; `strangers` is the code that reads untrusted files: src/record,
src/matfile, src/sound, src/capture/media and src/capture/clip.

All mutants are compiled at once, into a copy of the tree in build/mutants: each is a branch that the environment
variable WISP_MUTANT takes (R. H. Untch, A. J. Offutt, M. J. Harrold, "Mutation analysis using mutant schemata", ISSTA
1993). Conditions are negated, comparison and arithmetic operators replaced by similar ones, statements left out. Mutants
that do not compile are dropped. For each of the others the golden hash (`player` only), then the tests of its layer, then
those of the layers above run until one fails.
Prints the surviving mutants with their numbers, and counts. After a test was written, `--these` tries given numbers again;
a single test is run with a mutant by WISP_MUTANT=K. docs/studies/hardening.md has the results.
"""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "mutants"
TREE = WORK / "tree"
LONGEST = {}  # limit in processor seconds of a layer's tests with a mutant: 5 s + 4 times what they take without
# Per kind: sources; the layers whose tests must notice a fault, by the start of the source's path; build options to turn off.
KINDS = {
    "player": (["src/run", "src/model/check.cpp", "src/model/arx.cpp", "src/model/chain.cpp",
                "src/model/model.cpp"],
               {"src": ["model", "run"]},
               ["LEARN", "MEDIA", "MATFILE", "SIMULATE", "APPS", "SHARED"]),
    "strangers": (["src/record", "src/matfile", "src/sound", "src/capture/media", "src/capture/clip"],
                  {"src/record": ["record", "matfile"], "src/matfile": ["matfile"], "src/sound": ["sound", "capture_clip"],
                   "src/capture/media": ["capture_media", "clips"], "src/capture/clip": ["capture_clip", "clips"]},
                  ["APPS", "SHARED"]),
}
SWAPS = [(" < ", " <= "), (" <= ", " < "), (" > ", " >= "), (" >= ", " > "), (" == ", " != "), (" != ", " == "),
         (" + ", " - "), (" - ", " + "), (" * ", " + "), (" / ", " * "), (" % ", " / "), (" && ", " || "),
         (" || ", " && "), ("std::min(", "std::max("), ("std::max(", "std::min("), ("smaller(", "larger("),
         ("larger(", "smaller("), ("true", "false"), ("false", "true"), (" ^ ", " & "), (" & ", " | ")]
HEADER = """#pragma once
#include <cstdlib>
inline const int wisp_mutant = [] { const char* one = std::getenv("WISP_MUTANT"); return one ? std::atoi(one) : -1; }();
#define MUTANT(k) (wisp_mutant == (k))
"""
SKIPPED = re.compile(r"constexpr|static_assert|template|#|operator|//|\bcase\b|assert\(|using |enum |std::to_string")
Mutant = collections.namedtuple("Mutant", "file line after shown")


def closing(text, start):
    """Index of the parenthesis that closes the one at `start`, or -1."""
    depth = 0
    for k in range(start, len(text)):
        depth += {"(": 1, ")": -1}.get(text[k], 0)
        if depth == 0:
            return k
    return -1


def expressions(line):
    """Yields (begin, end) of the expressions of a line that can become an operand of ?: beside their mutant."""
    body = line.rstrip("\n")
    condition = re.match(r"\s*(?:\} else )?(?:if|while) \(", body)
    if condition:
        begin = condition.end()
        end = closing(body, begin - 1)
        if end > 0:
            begin += body[begin:end].rfind(";") + 1
            if "=" not in re.sub(r"[=!<>]=", "", body[begin:end]):
                yield begin, end
    told = re.match(r"\s*return ([^{;]+);$", body)
    if told:
        yield told.start(1), told.end(1)
    made = re.match(r"\s*(?:const )?[\w:<>&*\[\]\.\-]+(?: [\w\[\]\.]+)? (?:[+\-|&]?=) ([^{;]+);$", body)
    if made and "&" not in body[: made.start(1)].replace("&=", ""):
        yield made.start(1), made.end(1)


def mutants_of_line(line):
    """Yields each mutated line, with K in place of the mutant's number, and the mutant as it is printed."""
    if SKIPPED.search(line) or line.lstrip().startswith(("*", "///")):
        return
    for begin, end in expressions(line):
        whole = line[begin:end]
        if re.match(r"\s*(?:\} else )?if", line):
            yield line[:begin] + f"MUTANT(K) != static_cast<bool>({whole})" + line[end:], f"!({whole.strip()})"
        for before, after in SWAPS:
            for found in re.finditer(re.escape(before), whole):
                other = whole[: found.start()] + after + whole[found.end():]
                yield line[:begin] + f" (MUTANT(K) ? ({other}) : ({whole}))" + line[end:], other.strip()
    if re.match(r"\s+(?:[\w\.\[\]\*\->]+ [+\-|&]?= |[\w\.\->:]+\(|\+\+|--)[^{}]*;$", line) and not re.match(r"\s+(return|const)\b", line):
        indent = len(line) - len(line.lstrip())
        yield line[:indent] + "{ if (!MUTANT(K)) " + line[indent:] + " }", "(left out)"


DEFINED = {"WISP_VECTOR_LANES": True, "WISP_LONG_WORDS": True, "__AVX2__": False, "__AVX512F__": False, "__AVX512VL__": False,
           "__wasm__": False, "WISP_WIDE_PATHS": False, "WISP_FRAME_PATH": False, "WISP_LONG_PARTS": False}


def compiled(lines):
    """Indices of the lines that this build compiles; only the macros of DEFINED are evaluated."""
    state, numbers = [], set()
    for number, line in enumerate(lines):
        if line.startswith(("#ifdef", "#ifndef", "#if ")):
            known = [macro for macro in DEFINED if re.search(rf"\b{macro}\b", line)]
            holds = all(DEFINED[macro] != (line.startswith("#ifndef") or f"!defined({macro})" in line) for macro in known)
            state.append((holds, not known))
        elif line.startswith(("#else", "#elif")) and state:
            holds, always = state[-1]
            state[-1] = (always or not holds, always)
        elif line.startswith("#endif") and state:
            state.pop()
        elif all(holds for holds, _ in state):
            numbers.add(number)
    return numbers


def plan(kind, most, only):
    found = []
    for source in KINDS[kind][0]:
        path = ROOT / source
        for file in sorted(path.rglob("*.?pp")) if path.is_dir() else [path]:
            name = str(file.relative_to(ROOT))
            if only and only not in name or name.endswith(("counting.hpp", "cost.cpp")):
                continue
            lines = file.read_text().split("\n")
            for number in sorted(compiled(lines)):
                line = lines[number]
                choices = list(mutants_of_line(line))
                # At most one mutant per line, since all are compiled together.
                if choices:
                    after, shown = random.Random(f"{name}{line}").choice(choices)
                    found.append(Mutant(name, number, after, shown))
    # A random choice that depends on each line alone: a changed line does not change the choice of other mutants.
    found.sort(key=lambda one: random.Random(f"{one[0]}{one[3]}{one[2]}").random())
    return sorted(found[:most])


def plant(chosen):
    """Writes all mutants into the copy of the tree."""
    files = collections.defaultdict(dict)
    for k, (name, number, after, _) in enumerate(chosen):
        if after:
            files[name][number] = after.replace("MUTANT(K)", f"MUTANT({k})")
    for source in {name for name, *_ in chosen}:
        lines = (ROOT / source).read_text().split("\n")
        for number, after in files[source].items():
            lines[number] = after
        text = f'#include "{WORK / "mutant.hpp"}"\n#line 1\n' + "\n".join(lines)
        if (TREE / source).read_text() != text:
            (TREE / source).write_text(text)


def copy_tree(chosen):
    """Copies the tree. Unchanged files are not written again, so that only changed ones are compiled."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True,
                            check=True).stdout.decode().split("\0")
    wanted = {name for name in listed if name and (ROOT / name).is_file()}
    for file in TREE.rglob("*"):
        if file.is_file() and str(file.relative_to(TREE)) not in wanted:
            file.unlink()
    planted = {name for name, *_ in chosen}
    for name in wanted:
        source, copy = ROOT / name, TREE / name
        if copy.exists() and (name in planted or copy.read_bytes() == source.read_bytes()):
            continue
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, copy)
    if not (WORK / "mutant.hpp").exists():
        (WORK / "mutant.hpp").write_text(HEADER)


def rooms_after(kind, file):
    """Layers whose tests run for a mutant of a file."""
    return next(rooms for place, rooms in KINDS[kind][1].items() if file.startswith(place))


def compile_all(kind, chosen, jobs):
    """Compiles the tests, and drops mutants that do not compile until the rest does."""
    # The other kind's build may have been in this folder: what it left out is named too.
    parts = [f"-DWISP_BUILD_{part}={'OFF' if part in KINDS[kind][2] else 'ON'}" for part in sorted(KINDS["player"][2])]
    tests = sorted({f"wisp_tests_{test}" for one in chosen for test in rooms_after(kind, one.file)})
    if kind == "player":
        tests.append("wisp_run_frames")
    # One vector width only: another test compares the bits of all widths.
    flags = "-O1 -w -ftemplate-depth=2000"
    subprocess.run(["cmake", "-S", TREE, "-B", WORK / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DWISP_NARROW=ON",
                    "-DWISP_UNITY_BUILD=ON", f"-DCMAKE_CXX_FLAGS={flags}", "-DWISP_BUILD_TESTS=ON", *parts], check=True, stdout=subprocess.DEVNULL)
    for _ in range(20):
        plant(chosen)
        made = subprocess.run(["ninja", "-C", WORK / "build", "-k", "0", f"-j{jobs}", *tests], capture_output=True, text=True)
        if made.returncode == 0:
            return
        place = r"/tree/(src/[\w/.]+):(\d+):\d+"  # a compiler cache may name it from elsewhere
        wrong = set(re.findall(place + ": error", made.stdout)) or set(re.findall(place + ":   required from", made.stdout))
        before = sum(1 for one in chosen if one[2])
        for k, (name, number, after, shown) in enumerate(chosen):
            if (name, str(number + 1)) in wrong:
                chosen[k] = Mutant(name, number, None, shown)
        if before == sum(1 for one in chosen if one[2]):
            sys.exit("the tree does not compile:\n" + made.stdout[-4000:] + made.stderr[-4000:])
    sys.exit("what does not compile could not be dropped")


def notices(kind, k, file, golden):
    """Which tests notice mutant k of a file: a layer, "golden hash", "time" (over the limit), or None."""
    environment = {**os.environ, "WISP_MUTANT": str(k)}
    tests = WORK / "build" / "tests"
    commands = [("golden hash", [tests / "run" / "wisp_run_frames"])] if kind == "player" else []
    for room in rooms_after(kind, file):
        commands.append((room, [tests / f"wisp_tests_{room}", "--gtest_fail_fast", "--gtest_brief=1"]))
    for name, command in commands:
        # Limits processor time, so that a busy machine has no effect; a test that only waits is killed after an hour.
        limit = ["prlimit", f"--cpu={LONGEST[name]}", "--"] if name in LONGEST else []
        began = os.times()
        try:
            done = subprocess.run([*limit, *command], env=environment, capture_output=True, text=True, timeout=3600)
        except subprocess.TimeoutExpired:
            return "time"
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            return "time"
        if done.returncode != 0 or (name == "golden hash" and done.stdout.strip() != golden):
            return name
        if k < 0:
            ended = os.times()
            LONGEST[name] = 5 + int(4 * (ended.children_user + ended.children_system - began.children_user - began.children_system))
    return None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--of", choices=sorted(KINDS), default="player")
    parser.add_argument("--most", type=int, default=300)
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--these", default="")
    options = parser.parse_args()
    golden = re.search(r"set\(golden (\w+)\)", (ROOT / "tests/run/bits/bits.cmake").read_text()).group(1)
    chosen = plan(options.of, options.most, options.only)
    copy_tree(chosen)
    compile_all(options.of, chosen, options.jobs)
    for place in {place for place in KINDS[options.of][1] if any(one.file.startswith(place) for one in chosen)}:
        if by := notices(options.of, -1, place, golden):
            sys.exit(f"without any mutant the tests fail: {by}")
    these = {int(k) for k in options.these.split(",") if k} or set(range(len(chosen)))
    counts = collections.Counter()
    alive = [k for k in sorted(these) if chosen[k].after]
    if len(alive) < len(these):
        counts["did not compile"] = len(these) - len(alive)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for k, by in zip(alive, pool.map(lambda k: notices(options.of, k, chosen[k].file, golden), alive)):
            counts[by or "survived"] += 1
            if not by:
                name, line, _, shown = chosen[k]
                was = (ROOT / name).read_text().split("\n")[line].strip()
                print(f"survived: {k}: {name}:{line + 1}: {was}  ->  {shown}", flush=True)
    print(", ".join(f"{count} {what}" for what, count in counts.most_common()))


if __name__ == "__main__":
    main()
