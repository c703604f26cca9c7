# SPDX-License-Identifier: Apache-2.0
"""The terrain engine's figures."""
import re
import statistics

from lab import MIB, Figure

SIDE = 8192


def imports(lab):
    source = lab.elevations(SIDE)
    runs = [lab.run(lab.eyrie, "import", "terrain", source, "-o", "import.eyt", "--fresh",
                      "--quiet") for _ in range(3)]
    rate = SIDE * SIDE / statistics.median(run.seconds for run in runs) / 1e6
    peak = max(run.peak_bytes for run in runs) / MIB
    error = lab.info(lab.work / "import.eyt")["errorMetres"]
    return [Figure(f"terrain import, {SIDE}² float heights", "≥ 8 M samples/s, ≤ 512 MiB",
                   f"{rate:.1f} M samples/s, {peak:.0f} MiB",
                   f"{error['finest']:.3g} m at the finest level", rate >= 8 and peak <= 512,
                   lab.commands[-1])]


def pages(lab):
    path = lab.terrain(2048)
    output = lab.run(lab.tool("page_codec"), path, 5).output
    bits, _, rate = map(float, re.search(r"\| ours +\|([\d. ]+)\|([\d. ]+)\|([\d. ]+)\|",
                                         output).groups())
    return [Figure("terrain geometry on disk; its decoding on one core",
                   "≤ 8 bits a triangle; ≥ 20 M triangles/s",
                   f"{bits:.1f} bits; {rate:.0f} M triangles/s", "heights in 1/64 m",
                   bits <= 8 and rate >= 20, lab.commands[-1])]


def flight(lab):
    run = lab.bench(lab.terrain(SIDE), "--flight", "walkthrough", "--tau", 1, "--frames", 60,
                    "--repeats", 3, "--reference", "--reference-frames", 2)
    return [Figure(f"flight over {SIDE}² posts, 1280×720", "≥ 20 frames/s",
                   f"{run['fpsMedian']:.1f} frames/s, p95 {run['frameMs']['p95']:.0f} ms",
                   promised_and_measured(run), run["fpsMedian"] >= 20 and run[
                       "measuredWithinPromise"], lab.commands[-1])]


def growth(lab):
    """By turns, so that what else the machine does falls on both."""
    figures = []
    for flown in ("orbit", "walkthrough"):
        times = {1024: [], SIDE: []}
        error = 0
        for _ in range(3):
            for side, taken in times.items():
                run = lab.bench(lab.terrain(side), "--flight", flown, "--tau", 1, "--frames", 60,
                                "--repeats", 2)
                taken.append(run["frameMs"]["p50"])
                error = max(error, run["tauAchievedMax"])
        small, large = (statistics.median(taken) for taken in times.values())
        figures.append(Figure(f"64 times the posts (1024² and {SIDE}²), {flown}",
                              "≤ 1.3 times the frame", f"{large / small:.2f} times "
                              f"({small:.1f} and {large:.1f} ms)", f"promised {error:.3f} px",
                              large / small <= 1.3, lab.commands[-1]))
    return figures


def loading(lab):
    output = lab.run(lab.tool("cold_flight"), lab.terrain(SIDE), 150).output
    late, loaded, by_itself, frames = map(int, re.search(
        r"all is loaded: (\d+) of (\d+) frames that loaded pages, (\d+) of (\d+)", output).groups())
    return [Figure("frames of a cold flight that are longer than 1.5 times the median only while "
                   "they load", "none beyond what the machine does by itself",
                   f"{late} of {loaded}; {by_itself} of {frames} that load nothing", "",
                   late * frames <= by_itself * loaded, lab.commands[-1])]


def budget(lab):
    run = lab.bench(lab.terrain(SIDE), "--flight", "walkthrough", "--budget-ms", 33, "--frames",
                    120, "--repeats", 2)
    return [Figure("frames held to 33 ms, terrain: within 39.6 ms", "≥ 95 %",
                   f"{100 * run['withinBudget']:.1f} %",
                   f"promised {run['tauAchieved']['p50']:.2f} px (median)",
                   run["withinBudget"] >= 0.95, lab.commands[-1])]


def promised_and_measured(run):
    pixels = run["errorPx"]
    return (f"promised {run['tauAchievedMax']:.3f}, measured {pixels['p99']:.3f} (p99) and "
            f"{pixels['max']:.3f} px at most")
