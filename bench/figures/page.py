# SPDX-License-Identifier: Apache-2.0
"""What viewers in a browser see: Debian's Chromium on the same cores as all else."""
import re

from lab import SOURCES, Figure


def environment(lab):
    return {"EYRIE_BINARY": str(lab.eyrie), "EYRIE_SCENE": str(SOURCES / "demo/scene.json"),
            "EYRIE_FAKE_SERVER": str(lab.build / "tests/fake_server"),
            "EYRIE_WEB_FOLDER": str(lab.build / "share/eyrie/web"),
            "EYRIE_TEST_OUTPUT": str(lab.work)}


def link_line(output, name, besides=""):
    """Rate, latency, lateness, what is told besides, and kinds of pictures over a link."""
    return re.search(
        rf"^{name}: ([\d.]+) frames/s, input to drawn (\d+) ms median, longest gap \d+ ms, "
        rf"at most (\d+) ms late, {besides}width/quality (.*)$", output, re.M).groups()


def links(lab):
    output = lab.run(lab.build / "tests/network_link", "node",
                     SOURCES / "tests/browser/link_figures.mjs", environment=environment(lab)).output
    figures = []
    for name, most, least in (("20 Mbit/s, 50 ms", 90, 30), ("5 Mbit/s, 50 ms", 150, 15)):
        rate, latency, late, kinds = link_line(output, name)
        figures.append(Figure(f"the page over {name} of round trip: input to drawn",
                              f"≤ {most} ms, ≥ {least} frames/s, never 0.5 s late",
                              f"{latency} ms, {float(rate):.0f} frames/s, at most {late} ms late",
                              f"pixels/quality {kinds}",
                              int(latency) <= most and float(rate) >= least and int(late) <= 500,
                              lab.commands[-1]))
    _, _, late, settled, kinds = link_line(output, "50 then 5 Mbit/s, 50 ms",
                                           r"settled after ([\d.]+) s, ")
    figures.append(Figure("the page when its link falls from 50 to 5 Mbit/s: in time again",
                          "≤ 2 s, never 0.5 s late", f"{settled} s, at most {late} ms late",
                          f"pixels/quality {kinds}", float(settled) <= 2 and int(late) <= 500,
                          lab.commands[-1]))
    exact = re.search(r"^no limit:.*\n +from a key: drawn (\d+) ms, nearly exact (\d+) ms, exact "
                      r"(\d+) ms", output, re.M)
    drawn, fine, last = map(int, exact.groups())
    figures.append(Figure("from a key to quality 95 and to the exact picture",
                          "≤ 200 and 500 ms, and the render time (15 ms)",
                          f"{fine} and {last} ms (first drawn after {drawn})", "exact: lossless",
                          fine <= 215 and last <= 515, lab.commands[-1]))
    return figures


def latency(lab):
    output = lab.run("node", SOURCES / "tests/browser/latency_figures.mjs",
                     environment=environment(lab)).output
    figures = []
    for size, median, worst in (("1280x720", 10, 20), ("1920x1080", 18, 30)):
        middle, late, kind = re.search(
            rf"^{size}: input to drawn without rendering ([\d.]+) ms median, ([\d.]+) ms p95, "
            r"width/quality (.*)$", output, re.M).groups()
        figures.append(Figure(
            f"the page on loopback, {size.replace('x', '×')}: input to drawn, all but rendering",
            f"≤ {median} ms, p95 ≤ {worst}", f"{middle} ms, p95 {late}", f"pixels/quality {kind}",
            float(middle) <= median and float(late) <= worst, lab.commands[-1]))
    return figures


def start(lab):
    output = lab.run("node", SOURCES / "tests/browser/demo_test.mjs",
                     environment=environment(lab)).output
    time = int(re.search(r"first picture after (\d+) ms", output).group(1))
    return [Figure("the demo: first picture after the page opens", "≤ 1 s", f"{time} ms", "",
                   time <= 1000, lab.commands[-1])]


def idle(lab):
    output = lab.run("node", SOURCES / "tests/browser/idle_figures.mjs",
                     environment=environment(lab)).output
    shares = [float(share) for share in re.findall(r"([\d.]+) %", output)]
    return [Figure("the demo at rest: the busiest process", "≤ 2 % of a core",
                   f"{max(shares):.2f} %", "", max(shares) <= 2, lab.commands[-1])]
