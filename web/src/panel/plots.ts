// SPDX-License-Identifier: Apache-2.0
// Plots of the last frames: time by stage, error, bandwidth, and speed against error. They are
// drawn a few times a second while they are seen, and cost nothing otherwise.
import type { State } from "../state";
import type { Entry } from "../view/history";
import { arrivalsKept, bandwidth, FrameHistory } from "../view/history";
import { axis, bandOf, chartHeight, chartWidth, largest, logAxis, pathOf, svg } from "./chart";
import { byId, make, setText } from "./element";
import { milliseconds, pixels } from "./format";
import { onKeys } from "./keys";

const updateEvery = 250;
const bandwidthSpan = 500;
const bandwidthSpans = arrivalsKept / bandwidthSpan;

/** An SVG element, before it is one. */
interface Part {
  tag: "path" | "circle";
  attributes: Readonly<Record<string, string | number>>;
}

interface Drawing {
  parts: Part[];
  text: string;
}

const path = (className: string, d: string): Part => ({
  tag: "path",
  attributes: { class: className, d },
});

/** One under the other: cut, drawing, readback, and the rest of the way to the browser. */
export function stagesDrawing(entries: readonly Entry[]): Drawing {
  const x = axis(0, Math.max(1, entries.length - 1), chartWidth);
  const y = axis(
    largest(
      entries.map(({ total }) => total),
      1,
    ),
    0,
    chartHeight,
  );
  const sums = entries.map(({ cull, draw, readback, total }) => [
    0,
    cull,
    cull + draw,
    cull + draw + readback,
    Math.max(total, cull + draw + readback),
  ]);
  const line = (stage: number) =>
    sums.map((sum, i) => [x(i), y(sum[stage] ?? 0)] as [number, number]);
  const parts = ["cull", "draw", "readback", "rest"].map((name, i) =>
    path(`band ${name}`, bandOf(line(i + 1), line(i))),
  );
  const last = entries[entries.length - 1];
  const text =
    last === undefined
      ? "–"
      : `${milliseconds(last.total)}: cut ${last.cull.toFixed(0)}, drawing ` +
        `${last.draw.toFixed(0)}, readback ${last.readback.toFixed(0)}`;
  return { parts, text };
}

export function errorDrawing(entries: readonly Entry[]): Drawing {
  const x = axis(0, Math.max(1, entries.length - 1), chartWidth);
  const all = entries.flatMap(({ tauAsked, tauAchieved }) => [tauAsked, tauAchieved]);
  const up = logAxis(0.05, largest(all, 1) * 1.2, chartHeight);
  const line = (of: (entry: Entry) => number) =>
    pathOf(entries.map((entry, i) => [x(i), chartHeight - up(of(entry))]));
  const last = entries[entries.length - 1];
  return {
    parts: [
      path(
        "line muted",
        line(({ tauAsked }) => tauAsked),
      ),
      path(
        "line",
        line(({ tauAchieved }) => tauAchieved),
      ),
    ],
    text:
      last === undefined ? "–" : `${pixels(last.tauAchieved)} of ${pixels(last.tauAsked)} asked`,
  };
}

export function bandwidthDrawing({ entries, arrivals }: FrameHistory, now: number): Drawing {
  const rates = bandwidth(arrivals, now, bandwidthSpan, bandwidthSpans);
  const x = axis(0, bandwidthSpans - 1, chartWidth);
  const y = axis(largest(rates, 1e6), 0, chartHeight);
  const last = rates[rates.length - 1] ?? 0;
  const link = 8 * (entries[entries.length - 1]?.linkBytesPerSecond ?? 0);
  const carries =
    link > 0 ? `, the link carries ${Number((link / 1e6).toPrecision(2))} or more` : "";
  return {
    parts: [path("line", pathOf(rates.map((rate, i) => [x(i), y(rate)])))],
    text: `${(last / 1e6).toFixed(1)} Mbit/s${link > 1e9 ? "" : carries}`,
  };
}

/** Down and to the left is better. */
export function speedErrorDrawing(entries: readonly Entry[]): Drawing {
  const totals = entries.map(({ total }) => total);
  const errors = entries.map(({ tauAchieved }) => tauAchieved);
  const x = logAxis(1, largest(totals, 100), chartWidth - 6);
  const y = logAxis(0.05, largest(errors, 16), chartHeight - 6);
  const parts = entries.map(({ total, tauAchieved }, i): Part => {
    const isLast = i === entries.length - 1;
    return {
      tag: "circle",
      attributes: {
        class: isLast ? "dot last" : "dot",
        cx: (3 + x(total)).toFixed(1),
        cy: (chartHeight - 3 - y(tauAchieved)).toFixed(1),
        r: isLast ? 3 : 1.6,
      },
    };
  });
  const last = entries[entries.length - 1];
  const text =
    last === undefined ? "–" : `${milliseconds(last.total)} at ${pixels(last.tauAchieved)}`;
  return { parts, text };
}

const plots: readonly (readonly [string, string, (history: FrameHistory) => Drawing])[] = [
  [
    "Frame time",
    "On the server: the cut, drawing, readback and composition",
    ({ entries }) => stagesDrawing(entries),
  ],
  [
    "Error",
    "Drawn, and asked for (grey); by orders of magnitude",
    ({ entries }) => errorDrawing(entries),
  ],
  [
    "Bandwidth",
    "Pictures that came in the last half minute",
    (history) => bandwidthDrawing(history, performance.now()),
  ],
  [
    "Speed and error",
    "One dot a frame: to the left is faster, down is finer; both by orders of magnitude",
    ({ entries }) => speedErrorDrawing(entries),
  ],
];

export function showPlots(state: State): void {
  const history = new FrameHistory();
  const details = make("details", "plots", make("summary", "heading", "Plots"));
  details.title = "Live plots (G)";
  const updates = plots.map(([name, title, draw]) => {
    const chart = svg("svg", { viewBox: `0 0 ${chartWidth} ${chartHeight}`, class: "chart" });
    chart.setAttribute("aria-hidden", "true"); // its numbers are beside it
    const value = make("span", "value");
    const label = make("span", "label", name);
    label.title = title;
    details.append(make("div", "field", make("div", "row", label, value), chart));
    return (): void => {
      const { parts, text } = draw(history);
      chart.replaceChildren(...parts.map(({ tag, attributes }) => svg(tag, attributes)));
      setText(value, text);
    };
  });
  byId("plots", HTMLElement).append(details);
  const update = (): void => {
    for (const one of updates) one();
  };
  let drawnAt = 0;
  let timer: number | undefined;
  const updateSoon = (): void => {
    if (!details.open || timer !== undefined) return;
    const wait = Math.max(0, drawnAt + updateEvery - performance.now());
    timer = window.setTimeout(() => {
      timer = undefined;
      drawnAt = performance.now();
      update();
    }, wait);
  };
  let lastFrame = 0;
  state.numbers.watch((numbers) => {
    // What changes without a frame, the rate, is no entry.
    if (numbers === null || numbers.frameNumber === lastFrame) return;
    lastFrame = numbers.frameNumber;
    history.add({
      time: performance.now(),
      cull: numbers.cullMilliseconds,
      draw: numbers.drawMilliseconds,
      readback: numbers.readbackMilliseconds,
      total: numbers.renderMilliseconds,
      tauAsked: numbers.tauAsked,
      tauAchieved: numbers.tauAchieved,
      bytes: numbers.pictureBytes,
      linkBytesPerSecond: numbers.linkBytesPerSecond,
    });
    updateSoon();
  });
  details.addEventListener("toggle", updateSoon);
  onKeys({ g: () => (details.open = !details.open) });
}
