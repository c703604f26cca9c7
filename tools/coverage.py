#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which lines of the core logic the tests of a build have run.

usage: coverage.py BUILD [--at-least PERCENT] [--missed FOLDER]

BUILD was configured with EYRIE_COVERAGE=ON and its tests were run. Prints the share of each folder
that counts lines (cmake/coverage.cmake), and ends with 1 where one is below PERCENT. --missed
prints the lines of FOLDER that were not run, as FILE:LINE. Needs GCC's gcov; the standard library
does the rest.
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


def reports(notes):
    """gcov's answers for some .gcno files, with what was counted beside them."""
    made = subprocess.run(
        ["gcov", "--json-format", "--stdout", *map(str, notes)],
        check=True, capture_output=True, text=True, cwd=notes[0].parent)
    return [json.loads(line) for line in made.stdout.splitlines() if line.strip()]


def source_of(report, name):
    """A file of this project below ROOT; None: of others, or made by the build."""
    path = pathlib.Path(os.path.normpath(pathlib.Path(report["current_working_directory"]) / name))
    if not path.is_relative_to(ROOT) or path.is_relative_to(ROOT / "build"):
        return None
    return path.relative_to(ROOT)


def folder_of(path):
    return "/".join(path.parts[:2])


def line_counts(build):
    """{file: {line: how often it was run}}. Headers are in many objects: theirs are added up."""
    notes = sorted(build.rglob("*.gcno"))
    if not notes:
        sys.exit(f"coverage: nothing in {build} counts lines; configure it with EYRIE_COVERAGE=ON")
    if next(build.rglob("*.gcda"), None) is None:
        sys.exit(f"coverage: nothing was counted in {build}; run its tests first")
    parts = [notes[i:i + FILES_AT_ONCE] for i in range(0, len(notes), FILES_AT_ONCE)]
    counts = collections.defaultdict(lambda: collections.defaultdict(int))
    own = set()  # folders that count; others have headers in them only
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for report in (one for part in pool.map(reports, parts) for one in part):
            for file in report["files"]:
                path = source_of(report, file["file"])
                if path is None:
                    continue
                if path.suffix == ".cpp":
                    own.add(folder_of(path))
                for line in file["lines"]:
                    counts[path][line["line_number"]] += line["count"]
    return {path: lines for path, lines in counts.items() if folder_of(path) in own}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--at-least", type=float, default=0, metavar="PERCENT")
    parser.add_argument("--missed", metavar="FOLDER")
    options = parser.parse_args()
    folders = collections.defaultdict(lambda: [0, 0])
    for path, lines in sorted(line_counts(options.build.resolve()).items()):
        total = folders[folder_of(path)]
        total[0] += sum(count > 0 for count in lines.values())
        total[1] += len(lines)
        if options.missed and path.is_relative_to(options.missed):
            for line in sorted(number for number, count in lines.items() if count == 0):
                print(f"{path}:{line}")
    below = []
    for folder, (run, all_lines) in sorted(folders.items()):
        percent = 100 * run / all_lines
        print(f"{folder:28} {run:6} of {all_lines:6} lines  {percent:5.1f} %")
        if percent < options.at_least:
            below.append(folder)
    if below:
        sys.exit(f"coverage: less than {options.at_least:g} % of {', '.join(below)}")


main()
