#!/usr/bin/env python3
"""Lines and branches that the tests reach, layer by layer, from the counts that a build with gcc's --coverage wrote.

  tools/coverage.py BUILD [LAYER…]     default: model run record c; a layer is src/LAYER and include/wisp/LAYER

Prints a table, and the files with most unreached lines. Branches that only an exception takes are not counted. A line of
a template counts as reached if any instance of it is.
"""

import collections
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def gathered(build):
    """Returns the count of each line, [file][line], and of each branch, [file][(line, index)]."""
    lines = collections.defaultdict(dict)
    branches = collections.defaultdict(dict)
    with tempfile.TemporaryDirectory() as folder:
        for notes in (build / "src").rglob("*.gcda"):
            subprocess.run(["gcov", "--json-format", "--branch-probabilities", str(notes)], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            for packed in pathlib.Path(folder).glob("*.gcov.json.gz"):
                for file in json.loads(gzip.open(packed).read())["files"]:
                    take(file, lines, branches)
                packed.unlink()
    return lines, branches


def take(file, lines, branches):
    path = pathlib.Path(file["file"])
    path = path if path.is_absolute() else ROOT / path
    try:
        name = str(path.resolve().relative_to(ROOT))
    except ValueError:
        return
    if not name.startswith(("src/", "include/")):
        return
    for line in file["lines"]:
        number = line["line_number"]
        lines[name][number] = lines[name].get(number, 0) + line["count"]
        for place, branch in enumerate(one for one in line["branches"] if not one["throw"]):
            key = (number, place)
            branches[name][key] = branches[name].get(key, 0) + branch["count"]


def share(counts):
    return f"{100 * sum(1 for count in counts if count) / len(counts):.1f} %" if counts else "–"


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    folders = sys.argv[2:] or ["model", "run", "record", "c"]
    lines, branches = gathered(build)
    print("| folder | lines | reached | branches | taken |\n| --- | ---: | ---: | ---: | ---: |")
    least = []
    for folder in folders:
        of = [name for name in lines
              if name.startswith((f"src/{folder}/", f"include/wisp/{folder}/")) and not name.endswith("_generated.h")]
        all_lines = [count for name in of for count in lines[name].values()]
        all_branches = [count for name in of for count in branches[name].values()]
        print(f"| {folder}/ | {len(all_lines)} | {share(all_lines)} | {len(all_branches)} | {share(all_branches)} |")
        least += [(sum(1 for count in lines[name].values() if not count), name) for name in of]
    for missed, name in sorted(least, reverse=True)[:8]:
        if missed:
            numbers = [str(number) for number, count in sorted(lines[name].items()) if not count]
            print(f"{name}: {missed} lines not reached: {' '.join(numbers[:25])}{' …' if missed > 25 else ''}")


if __name__ == "__main__":
    main()
