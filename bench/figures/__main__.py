#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures Eyrie's figures on this machine and writes them as one table: what is asked, what was
reached, at which error, and the command. Standard library only.

Data are made once (some 4 GB) and kept in --work. Let nothing else run: processes that draw take
all cores. All together take about 20 minutes on two cores.
"""
import argparse
import datetime
import pathlib
import platform
import sys
import traceback

import farm
import meshes
import page
import terrain
from lab import Lab

FIGURES = {
    "mesh-orbit": meshes.orbit,
    "mesh-growth": meshes.growth,
    "mesh-file": meshes.bytes_on_disk,
    "mesh-import": meshes.imports,
    "mesh-budget": meshes.budget,
    "terrain-flight": terrain.flight,
    "terrain-growth": terrain.growth,
    "terrain-loading": terrain.loading,
    "terrain-budget": terrain.budget,
    "terrain-pages": terrain.pages,
    "terrain-import": terrain.imports,
    "distribution": farm.distribution,
    "faults": farm.faults,
    "merging": farm.merging,
    "stills": farm.stills,
    "start": page.start,
    "links": page.links,
    "latency": page.latency,
    "idle": page.idle,
}


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as text:
        models = [line.split(":")[1].strip() for line in text if line.startswith("model name")]
    with open("/proc/meminfo", encoding="utf-8") as text:
        memory = int(text.readline().split()[1]) / 2 ** 20
    model = models[0] if models else platform.processor()
    return f"{len(models)} cores of {model}, {memory:.0f} GB, {platform.freedesktop_os_release()['PRETTY_NAME']}"


def table(figures):
    lines = [f"Measured {datetime.date.today()} on {machine()}. **Bold**: not reached.", "",
             "| what | asked | reached | at what error | command |", "|---|---|---|---|---|"]
    for figure in figures:
        reached = figure.reached if figure.met else f"**{figure.reached}**"
        lines.append(f"| {figure.what} | {figure.asked} | {reached} | {figure.error} | "
                     f"`{figure.command}` |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(prog="figures", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release", help="its programs are measured")
    parser.add_argument("--work", default="build/figures", help="where data and reports go")
    parser.add_argument("--only", nargs="+", choices=FIGURES, metavar="NAME",
                        help="these alone: " + ", ".join(FIGURES))
    parser.add_argument("-o", "--output", type=pathlib.Path, help="the table, as Markdown")
    options = parser.parse_args()
    lab = Lab(options.build, options.work)
    figures, failed = [], False
    for name in options.only or FIGURES:
        print(f"== {name}", flush=True)
        try:
            measured = FIGURES[name](lab)
        except Exception:  # one that fails leaves the others
            traceback.print_exc()
            failed = True
            continue
        figures += measured
        for figure in measured:
            print(f"{figure.what}: {figure.reached} (asked {figure.asked})"
                  f"{'; ' + figure.error if figure.error else ''}"
                  f"{'' if figure.met else '  NOT REACHED'}", flush=True)
    if options.output:
        options.output.write_text(table(figures), encoding="utf-8")
    sys.exit(1 if failed else 0)


main()
