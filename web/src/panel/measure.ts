// SPDX-License-Identifier: Apache-2.0
// Measuring by clicks: lengths, heights and areas between points, with how far off they may be, and
// the heights along the last line.
import type { Measure, MeasuredPoint } from "../measure";
import { mapArea, mapLength, pathLength, rise } from "../measure";
import { appearance } from "../pick";
import type { Profile, ProfileChart } from "../profile";
import { chartOf, heightAlong } from "../profile";
import type { Shown } from "../protocol/messages";
import type { State } from "../state";
import type { Viewer } from "../viewer";
import { axis, chartHeight, chartWidth, pathOf, svg } from "./chart";
import { byId, make, setText } from "./element";
import {
  areaWithError,
  coordinate,
  digitsOf,
  lengthAtMost,
  lengthText,
  lengthWithError,
  times,
} from "./format";
import { onKeys } from "./keys";

/** In the unit that people would use, and 0 in metres. */
const longText = (value: number): string => {
  if (Math.abs(value) >= 1000) return `${Number((value / 1000).toPrecision(5))} km`;
  return Math.abs(value) < 1e-9 ? "0 m" : lengthText(value);
};

const lengthOf = ({ value, error }: Measure): string => lengthWithError(value, error);

/** Name, value and what it means, of so many points. */
export function rowsOf(
  points: readonly MeasuredPoint[],
  exaggeration: number,
): readonly (readonly [string, string, string])[] {
  if (points.length < 2) return [];
  const drawn = exaggeration === 1 ? "" : `, as drawn with heights ${times(exaggeration)}`;
  const rows: (readonly [string, string, string])[] = [
    ["Length", lengthOf(pathLength(points)), `Straight from point to point${drawn}`],
    ["On the map", lengthOf(mapLength(points)), "The same without heights"],
    ["Rise", lengthOf(rise(points)), `From the first point to the last${drawn}`],
  ];
  if (points.length > 2) {
    const { value, error } = mapArea(points);
    rows.push(["Area", areaWithError(value, error), "Of the closed line, on the map"]);
  }
  return rows;
}

/** Where points are in a picture of 100 x 100; those that it cannot show part the line. */
export function overlayRuns(
  points: readonly MeasuredPoint[],
  shown: Shown | null,
): [number, number][][] {
  if (shown === null) return [];
  const runs: [number, number][][] = [[]];
  for (const { position } of points) {
    const at = appearance(shown, position);
    if (at !== undefined) runs[runs.length - 1]?.push([100 * at[0], 100 * at[1]]);
    else runs.push([]);
  }
  return runs.filter((run) => run.length > 0);
}

function keepOverlay(state: State): void {
  const overlay = byId("overlay", SVGSVGElement);
  const update = (): void => {
    const runs = overlayRuns(state.measured.value, state.shown.value);
    overlay.replaceChildren(
      ...["halo", "line"].map((name) =>
        svg("path", { class: `measure-${name}`, d: runs.map(pathOf).join("") }),
      ),
      // A line of no length has round ends: a dot that stays round however the picture is shaped.
      svg("path", {
        class: "measure-dots",
        d: runs
          .flat()
          .map(([x, y]) => `M${x.toFixed(2)},${y.toFixed(2)}h0`)
          .join(""),
      }),
    );
  };
  state.measured.watch(update);
  state.shown.watch(update);
}

const heightText = (height: number, error: number): string => `${coordinate(height, error)} m`;

/** What a profile's heights are worth: where the source is steep they may be off by more. */
export function captionOf({ lowest, highest, error }: ProfileChart): string {
  const off = error + 10 ** -digitsOf(error) / 2; // as they are written
  const range = `${heightText(lowest, error)} to ${heightText(highest, error)}`;
  return `${range}; each point within ${lengthAtMost(off)} of the source, in whatever direction`;
}

/** A chart of heights, and a slider that reads it. */
function profileChart(profile: Profile): HTMLElement {
  const chart = chartOf(profile);
  const figure = make("figure", "profile");
  if (chart.runs.length === 0) {
    figure.append("Nothing lies along the line.");
    return figure;
  }
  const x = axis(0, chart.length, chartWidth);
  const y = axis(chart.highest, chart.lowest, chartHeight - 4);
  const image = svg("svg", { viewBox: `0 0 ${chartWidth} ${chartHeight}`, class: "chart" });
  image.setAttribute("aria-hidden", "true");
  const cursor = svg("path", { class: "line muted" });
  const lines = chart.runs.map((run) =>
    pathOf(run.map(([way, height]) => [x(way), 2 + y(height)])),
  );
  image.append(svg("path", { class: "line", d: lines.join("") }), cursor);
  const slider = make("input", "slider");
  slider.type = "range";
  slider.min = "0";
  slider.max = "1";
  slider.step = String(1 / (profile.samples.length - 1));
  slider.value = "0";
  slider.setAttribute("aria-label", "Place along the line");
  const reading = make("p", "note");
  const read = (): void => {
    const share = Number(slider.value);
    const height = heightAlong(profile, share);
    const text = `${longText(share * chart.length)} along: ${height === undefined ? "nothing" : heightText(height, chart.error)}`;
    setText(reading, text);
    slider.setAttribute("aria-valuetext", text);
    cursor.setAttribute("d", `M${(share * chartWidth).toFixed(1)},0v${chartHeight}`);
  };
  slider.addEventListener("input", read);
  read();
  const ends = make("figcaption", "note");
  ends.textContent = captionOf(chart);
  figure.append(image, slider, reading, ends);
  return figure;
}

function keepProfile(state: State): HTMLElement {
  const place = make("div", "");
  place.setAttribute("aria-live", "polite");
  state.profile.watch((profile) => {
    if (profile === null) place.replaceChildren();
    else if (profile.kind === "asking") place.replaceChildren("Looking along the line …");
    else if (profile.kind === "problem") place.replaceChildren(profile.text);
    else place.replaceChildren(profileChart(profile));
  });
  return place;
}

function keepRows(state: State): HTMLElement[] {
  const hint = make("p", "note");
  const list = make("dl", "numbers");
  state.measured.watch((points) => {
    const rows = rowsOf(points, points[0]?.exaggeration ?? 1);
    list.replaceChildren(
      ...rows.flatMap(([name, value, meaning]) => {
        const term = make("dt", "label", name);
        term.title = meaning;
        return [term, make("dd", "value", value)];
      }),
    );
    setText(
      hint,
      rows.length > 0
        ? "± is what the points' errors come to"
        : points.length === 0
          ? "Click two points or more, or press Space at the middle"
          : "One more point",
    );
  });
  return [list, hint];
}

export function showMeasure(state: State, viewer: Viewer): void {
  const card = byId("measure", HTMLElement);
  const toggle = byId("measure-toggle", HTMLButtonElement);
  const setMeasuring = (isOn: boolean): void => {
    state.measuring.set(isOn);
    state.measured.set([]);
    state.profile.set(null);
  };
  const button = (text: string, title: string, action: () => void): HTMLButtonElement => {
    const element = make("button", "small", text);
    element.type = "button";
    element.title = title;
    element.addEventListener("click", action);
    return element;
  };
  const undo = (): void => state.measured.set(state.measured.value.slice(0, -1));
  const profile = (): void => {
    const [from, to] = state.measured.value.slice(-2);
    if (from !== undefined && to !== undefined)
      viewer.questions.profile(from.position, to.position);
  };
  const profileButton = button("Profile", "Heights along the last line (V)", profile);
  const undoButton = button("Undo", "Take the last point away (Backspace)", undo);
  const close = button("Close", "End measuring (M)", () => setMeasuring(false));
  card.append(
    make("h2", "pick-title", "Measure"),
    ...keepRows(state),
    keepProfile(state),
    make("div", "small-buttons", profileButton, undoButton, close),
  );
  keepOverlay(state);
  state.measuring.watch((isOn) => {
    card.hidden = !isOn;
    toggle.setAttribute("aria-pressed", String(isOn));
  });
  state.measured.watch((points) => {
    profileButton.disabled = points.length < 2;
    undoButton.disabled = points.length === 0;
    state.profile.set(null);
  });
  toggle.addEventListener("click", () => setMeasuring(!state.measuring.value));
  onKeys({
    m: () => setMeasuring(!state.measuring.value),
    v: profile,
    backspace: undo,
  });
}
