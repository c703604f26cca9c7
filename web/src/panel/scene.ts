// SPDX-License-Identifier: Apache-2.0
// What the scene is made of: each object shown or left out, alone, or brought into view; and where
// its light comes from.
import { usualSun, withHidden } from "../look";
import type { Sun } from "../look";
import type { ObjectState } from "../protocol/messages";
import { ObjectKind } from "../protocol/messages";
import type { State } from "../state";
import type { Viewer } from "../viewer";
import { button, byId, make, setText } from "./element";
import { count } from "./format";
import { onKeys } from "./keys";
import { change, slider } from "./look_controls";

/** "Terrain · 1.74 M triangles"; "" while that is not known. */
export function objectText(object: ObjectState | undefined): string {
  if (object === undefined) return "";
  const kind = object.kind === ObjectKind.TERRAIN ? "Terrain" : "Mesh";
  return `${kind} · ${count(Number(object.triangles))} triangles`;
}

/** All but one; what is alone already brings the others back. */
export function alone(hidden: readonly number[], object: number, objects: number): number[] {
  const others = Array.from({ length: objects }, (_, i) => i).filter((i) => i !== object);
  const isAlone = !hidden.includes(object) && others.every((one) => hidden.includes(one));
  return isAlone ? [] : others;
}

function objectRow(state: State, viewer: Viewer, object: number): HTMLElement {
  const { objectNames = [], objects = [] } = state.session.value ?? {};
  const name = objectNames[object] ?? "";
  const isShown = make("input", "");
  isShown.type = "checkbox";
  isShown.addEventListener("change", () =>
    change(state, { hidden: withHidden(state.look.value.hidden, object, !isShown.checked) }),
  );
  isShown.checked = !state.look.value.hidden.includes(object);
  const title = make("span", "object-name", name);
  title.title = name;
  const label = make("label", "object-label", isShown, title);
  const only = button("Only", `Show ${name} alone, or all again`, () =>
    change(state, { hidden: alone(state.look.value.hidden, object, objectNames.length) }),
  );
  const go = button("Go to", `Bring ${name} into view`, () => viewer.goToObject(object));
  only.ariaLabel = only.title;
  go.ariaLabel = go.title;
  const facts = make("span", "note object-facts", objectText(objects[object]));
  return make("li", "object", label, only, go, facts);
}

function objectTree(state: State, viewer: Viewer): HTMLElement {
  const list = make("ul", "objects");
  list.id = "objects";
  list.ariaLabel = "Objects of the scene";
  let shown = "";
  state.session.watch((session) => {
    const { objectNames = [], objects = [] } = session ?? {};
    const key = JSON.stringify([objectNames, objects.map(objectText)]);
    if (key === shown) return;
    shown = key;
    list.replaceChildren(...objectNames.map((_, i) => objectRow(state, viewer, i)));
  });
  state.look.watch(({ hidden }) =>
    list.querySelectorAll<HTMLInputElement>("input").forEach((input, i) => {
      input.checked = !hidden.includes(i);
    }),
  );
  return list;
}

const compass = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"] as const;

/** "315° NW". */
export function azimuthText(degrees: number): string {
  const round = ((Math.round(degrees) % 360) + 360) % 360;
  return `${round}° ${compass[Math.round(round / 45) % 8] ?? ""}`;
}

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
      placeOf: ({ sun }) => sunOf(sun).azimuth,
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
