#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which lines of the libraries the tests of a build have run.

usage: coverage.py BUILD [--at-least PERCENT] [--missed FOLDER]

BUILD was configured with EYRIE_COVERAGE=ON and its tests were run. Prints the share of each folder
that counts lines (cmake/coverage.cmake), and ends with 1 where one of the core logic is below
PERCENT. --missed prints the lines of FOLDER that were not run, as FILE:LINE. Needs GCC's gcov; the
standard library does the rest.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FILES_AT_ONCE = 16

# What computes pictures, their parts, places and shares, what of the data they need, and what
# processes say to each other. CONTRIBUTING.md says what is not in it, and why.
CORE = {
    "coordinator/composite", "coordinator/compound", "coordinator/config", "coordinator/frame",
    "proto/access", "proto/fabric", "proto/wire",
    "renderer/codec", "renderer/lod", "renderer/mesh", "renderer/page", "renderer/terrain",
}


def reports(notes):
    """gcov's answers for some .gcno files, with what was counted beside them."""
    made = subprocess.run(
        ["gcov", "--json-format", "--stdout", *map(str, notes)],
        capture_output=True, text=True, cwd=notes[0].parent)
    if made.returncode != 0:
        sys.exit(f"coverage: {made.stderr.strip()}\ncoverage: build again, run the tests, then this")
    return [json.loads(line) for line in made.stdout.splitlines() if line.strip()]


def source_of(report, name):
    """A source of this project below ROOT; None: of others, made by the build, or a header.

    Inline functions of headers are in tests, too, which count nothing, and the linker takes
    whichever copy comes first: what would be told of them would depend on that.
    """
    path = pathlib.Path(os.path.normpath(pathlib.Path(report["current_working_directory"]) / name))
    is_own = path.is_relative_to(ROOT) and not path.is_relative_to(ROOT / "build")
    return path.relative_to(ROOT) if is_own and path.suffix == ".cpp" else None


def folder_of(path):
    """Two levels deep at most."""
    return "/".join(path.parts[:-1][:2])


def line_counts(build):
    """{file: {line: how often it was run}}, of sources; instances of templates are added up."""
    notes = sorted(build.rglob("*.gcno"))
    if not notes:
        sys.exit(f"coverage: nothing in {build} counts lines; configure it with EYRIE_COVERAGE=ON")
    if next(build.rglob("*.gcda"), None) is None:
        sys.exit(f"coverage: nothing was counted in {build}; run its tests first")
    parts = [notes[i:i + FILES_AT_ONCE] for i in range(0, len(notes), FILES_AT_ONCE)]
    counts = collections.defaultdict(lambda: collections.defaultdict(int))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for report in (one for part in pool.map(reports, parts) for one in part):
            for file in report["files"]:
                path = source_of(report, file["file"])
                for line in file["lines"] if path else []:
                    counts[path][line["line_number"]] += line["count"]
    return counts


def share(lines):
    run, all_lines = lines
    return 100 * run / all_lines if all_lines else 0


def print_rows(title, total, rows):
    for name, lines in [(title, total)] + sorted(("  " + name, row) for name, row in rows.items()):
        print(f"{name:28} {lines[0]:6} of {lines[1]:6} lines  {share(lines):5.1f} %")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--at-least", type=float, default=0, metavar="PERCENT")
    parser.add_argument("--missed", metavar="FOLDER")
    options = parser.parse_args()
    folders = collections.defaultdict(lambda: [0, 0])
    totals = {True: [0, 0], False: [0, 0]}  # by whether it is core logic
    for path, lines in sorted(line_counts(options.build.resolve()).items()):
        run = sum(count > 0 for count in lines.values())
        folder = folder_of(path)
        for total in (folders[folder], totals[folder in CORE]):
            total[0] += run
            total[1] += len(lines)
        if options.missed and path.is_relative_to(options.missed):
            for line in sorted(number for number, count in lines.items() if count == 0):
                print(f"{path}:{line}")
    print_rows("The core logic", totals[True], {name: folders[name] for name in CORE})
    print_rows("Others", totals[False], {name: folders[name] for name in set(folders) - CORE})
    below = [folder for folder in CORE if share(folders[folder]) < options.at_least]
    if below:
        sys.exit(f"coverage: less than {options.at_least:g} % of {', '.join(sorted(below))}")


main()
