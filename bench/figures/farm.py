# SPDX-License-Identifier: Apache-2.0
"""What several renderer processes cost, bring and survive, and how fast stills come."""
import re

from lab import SOURCES, Figure


def distribution(lab):
    figures = []
    for what, path, compound in (("terrain, 2D", lab.terrain(4096), "2D"),
                                 ("mesh, DB", lab.mesh(lab.scan(2)), "DB")):
        output = lab.run(lab.tool("distribution"), lab.eyrie, path, compound, 60, "1280x720", 1,
                         3).output
        # name, fps, least, most, error, triangles, share, processor times
        legs = re.findall(r"^(\S.*?) +([\d.]+) +[\d.]+ +[\d.]+ +([\d.]+) +\d+ +[\d.]+ +[\d.]+ ms",
                          output, re.M)
        rates = {name: (float(rate), float(error)) for name, rate, error in legs}
        different = int(re.search(r"^(\d+) pixels of 8 pictures differ", output, re.M).group(1))
        figures += compared(what, rates, different, lab.commands[-1])
    return figures


def compared(what, rates, different, command):
    names = list(rates)
    local, flying, pinned, both = names[0], names[2], names[3], names[4]
    share = rates[flying][0] / rates[local][0]
    gain = rates[both][0] / rates[pinned][0]
    exact = f"{different} pixels of 8 pictures differ; promised {rates[both][1]:.3f} px"
    return [Figure(f"one renderer through the coordinator, {what}", "≥ 0.95 of the local rate",
                   f"{share:.2f} ({rates[flying][0]:.1f} of {rates[local][0]:.1f} frames/s)",
                   exact, share >= 0.95 and different == 0, command),
            Figure(f"two renderers of one core each, {what}", "≥ 1.8 times one",
                   f"{gain:.2f} times ({rates[both][0]:.1f} of {rates[pinned][0]:.1f} frames/s)",
                   exact, gain >= 1.8 and different == 0, command)]


def faults(lab):
    path = lab.mesh(lab.ball(150_000))
    output = lab.run(lab.tool("faults"), lab.eyrie, path, "2D", 100, 60, 3, 3000).output
    frames, hit, wrong, failed = map(int, re.search(
        r"^(\d+) frames, (\d+) with faults: (\d+) wrong pixels in \d+ of them, \d+ incomplete, "
        r"(\d+) failed", output, re.M).groups())
    late = re.search(r"^kill: to the next complete picture +\d+ +([\d.]+) +([\d.]+) +([\d.]+)",
                     output, re.M)
    p50, p95, most = map(float, late.groups())
    return [Figure("100 renderers killed: the next complete picture", "≤ 500 ms (p95)",
                   f"{p50:.0f} ms, p95 {p95:.0f}, most {most:.0f}",
                   f"{wrong} wrong pixels in {frames} frames, {hit} of them with faults",
                   p95 <= 500 and wrong == 0 and failed == 0, lab.commands[-1])]


def stills(lab):
    output = lab.run("python3", SOURCES / "bench/stills.py", lab.eyrie,
                     SOURCES / "demo/scene.json", 60).output
    own = float(re.search(r"([\d.]+) stills/s", output).group(1))
    error = re.search(r"achieved ([\d.]+)", output).group(1)
    figures = []
    for form, rate, share in re.findall(r"^(\w+) +([\d.]+) stills/s, +(\d+) %", output, re.M):
        figures.append(Figure(f"stills by REST, {form}, 1280×720, four requests in flight",
                              "≥ 90 % of the renderer's own rate",
                              f"{share} % ({rate} of {own} stills/s)", f"promised {error} px",
                              int(share) >= 90, lab.commands[-1]))
    return figures


def merging(lab):
    output = lab.run(lab.tool("compositing"), lab.mesh(lab.scan(2))).output
    merges = [float(ms) for ms in re.findall(r"merge of two halves of the data: ([\d.]+) ms", output)]
    shares = [float(share) for share in re.findall(r"drawn, +([\d.]+) at half", output)]
    encodes = [float(rate) for rate in re.findall(r"at half\), encode ([\d.]+) GB/s", output)]
    return [Figure("depth merge of two layers; codec of colour and depth, 1280×720",
                   "≤ 0.4 ms; ≥ 1 GB/s, ≤ 20 % of raw at half coverage",
                   f"{max(merges):.2f} ms; {min(encodes):.1f} GB/s, {max(shares):.0f} %",
                   "lossless", max(merges) <= 0.4 and min(encodes) >= 1 and max(shares) <= 20,
                   lab.commands[-1])]
