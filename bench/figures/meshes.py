# SPDX-License-Identifier: Apache-2.0
"""The mesh engine's figures."""
import statistics

from lab import MIB, Figure
from terrain import promised_and_measured


def imports(lab):
    source = lab.ball(4_000_000)
    runs = [lab.run(lab.eyrie, "import", "mesh", source, "-o", "import.eym", "--quiet")
            for _ in range(3)]
    info = lab.info(lab.work / "import.eym")
    rate = info["triangles"] / statistics.median(run.seconds for run in runs) / 1e6
    peak = max(run.peak_bytes for run in runs) / MIB
    return [Figure("mesh import with all levels and their measured errors, 4 M triangles",
                   "≥ 0.5 M triangles/s", f"{rate:.2f} M triangles/s, {peak:.0f} MiB",
                   f"{info['errorMetres']['finest']:.2g} m at the finest level", rate >= 0.5,
                   lab.commands[-1])]


def bytes_on_disk(lab):
    figures = []
    for source in (lab.scan(2), lab.ball(4_000_000)):
        lab.run(lab.eyrie, "import", "mesh", source, "-o", "coarse.eym", "--bits", 17, "--quiet")
        info = lab.info(lab.work / "coarse.eym")
        size = info["bytes"] / info["triangles"]
        figures.append(Figure(f"mesh file with all levels, {source.stem}",
                              "≤ 9 bytes a triangle at 2⁻¹⁶ of the extent", f"{size:.2f} bytes",
                              f"{info['errorMetres']['finest']:.2g} m at the finest level",
                              size <= 9, lab.commands[-1]))
    return figures


def orbit(lab):
    run = lab.bench(lab.mesh(lab.scan(2)), "--flight", "orbit", "--tau", 1, "--frames", 60,
                    "--repeats", 3, "--reference", "--reference-frames", 2)
    time = run["frameMs"]["p50"]
    return [Figure("scan of 1.29 M triangles filling the picture's height, 1280×720", "≤ 33 ms",
                   f"{time:.1f} ms, p95 {run['frameMs']['p95']:.0f}", promised_and_measured(run),
                   time <= 33 and run["measuredWithinPromise"], lab.commands[-1])]


def by_turns(lab, what, files):
    """By turns, so that what else the machine does falls on both."""
    times = {name: [] for name in files}
    error = 0
    for _ in range(3):
        for name, path in files.items():
            run = lab.bench(path, "--flight", "orbit", "--tau", 1, "--frames", 48, "--repeats", 2)
            times[name].append(run["frameMs"]["p50"])
            error = max(error, run["tauAchievedMax"])
    small, large = (statistics.median(taken) for taken in times.values())
    return Figure(f"16 times the triangles ({what} of {' and '.join(files)}), orbit",
                  "≥ 0.75 of the rate", f"{small / large:.2f} ({small:.1f} and {large:.1f} ms)",
                  f"promised {error:.3f} px", small / large >= 0.75, lab.commands[-1])


def growth(lab):
    return [by_turns(lab, "balls", {"1.00 M": lab.mesh(lab.smooth_ball(1_000_000)),
                                    "16.0 M": lab.mesh(lab.smooth_ball(16_000_000))}),
            by_turns(lab, "scans", {"1.29 M": lab.mesh(lab.scan(2)),
                                    "20.6 M": lab.mesh(lab.scan(4))})]


def budget(lab):
    run = lab.bench(lab.mesh(lab.scan(2)), "--flight", "worst", "--budget-ms", 33, "--frames", 120,
                    "--repeats", 2)
    return [Figure("frames held to 33 ms, mesh, hard cuts: within 39.6 ms", "≥ 95 %",
                   f"{100 * run['withinBudget']:.1f} %",
                   f"promised {run['tauAchieved']['p50']:.2f} px (median)",
                   run["withinBudget"] >= 0.95, lab.commands[-1])]
