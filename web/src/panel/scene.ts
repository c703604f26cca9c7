// SPDX-License-Identifier: Apache-2.0
// What the scene is made of, and where its light comes from.
import { usualSun } from "../look";
import type { Sun } from "../look";
import type { State } from "../state";
import type { Viewer } from "../viewer";
import { button, byId, make, setText } from "./element";
import { onKeys } from "./keys";
import { change, slider } from "./look_controls";
import { objectTree } from "./objects";

const compass = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"] as const;

/** "315° NW". */
export function azimuthText(degrees: number): string {
  const round = ((Math.round(degrees) % 360) + 360) % 360;
  return `${round}° ${compass[Math.round(round / 45) % 8] ?? ""}`;
}

/** On a slider from 0 to 360; programs count from -360. */
export const azimuthPlace = (degrees: number): number => (degrees < 0 ? degrees + 360 : degrees);

/** Of the sliders, from `sun` or where it would first stand. */
const sunOf = (sun: Sun | null): Sun => sun ?? usualSun;

function sunControls(state: State, toggle: () => void): HTMLElement {
  const moved = make("input", "");
  moved.type = "checkbox";
  moved.id = "sun";
  moved.addEventListener("change", toggle);
  const label = make("label", "object-label", moved, make("span", "", "Move the sun"));
  label.title = "Light from where the sliders say, in place of the scene's first light (J)";
  const sliders = make(
    "div",
    "",
    slider(state, {
      id: "sun-azimuth",
      name: "Sun from",
      title: "Clockwise from north (double-click: north-west)",
      min: 0,
      max: 360,
      step: 5,
      placeOf: ({ sun }) => azimuthPlace(sunOf(sun).azimuth),
      text: ({ sun }) => azimuthText(sunOf(sun).azimuth),
      change: (azimuth) => ({ sun: { ...sunOf(state.look.value.sun), azimuth } }),
    }),
    slider(state, {
      id: "sun-elevation",
      name: "Sun's height",
      title: "Above the horizon (double-click: half way up)",
      min: 0,
      max: 90,
      step: 1,
      placeOf: ({ sun }) => sunOf(sun).elevation,
      text: ({ sun }) => `${Math.round(sunOf(sun).elevation)}°`,
      change: (elevation) => ({ sun: { ...sunOf(state.look.value.sun), elevation } }),
    }),
  );
  state.look.watch(({ sun }) => {
    moved.checked = sun !== null;
    sliders.hidden = sun === null;
  });
  return make("div", "field", label, sliders);
}

export function showScene(state: State, viewer: Viewer): void {
  const toggleSun = (): void =>
    change(state, { sun: state.look.value.sun === null ? usualSun : null });
  const summary = make("h2", "heading", "Scene");
  const all = button("Show all", "Show every object", () => change(state, { hidden: [] }));
  state.look.watch(({ hidden }) => {
    all.hidden = hidden.length === 0;
    setText(summary, hidden.length === 0 ? "Scene" : `Scene · ${hidden.length} hidden`);
  });
  byId("scene", HTMLElement).append(
    summary,
    objectTree(state, viewer),
    all,
    sunControls(state, toggleSun),
  );
  onKeys({ j: toggleSun });
}
