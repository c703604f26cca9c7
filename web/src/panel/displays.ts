// SPDX-License-Identifier: Apache-2.0
// What of the configuration is seen here, and which layout its canvas shows for everybody.
import type { Configured } from "../command";
import type { Eye, Output, Stereo } from "../output";
import { queryOf } from "../output";
import type { CanvasState } from "../protocol/messages";
import type { State } from "../state";
import type { Viewer } from "../viewer";
import { byId, make } from "./element";

type Option = readonly [value: string, name: string];

function select(id: string, name: string, title: string, chosen: (value: string) => void) {
  const label = make("label", "label", name);
  const element = make("select", "select");
  element.id = label.htmlFor = id;
  label.title = title;
  element.addEventListener("change", () => chosen(element.value));
  const field = make("div", "field row", label, element);
  /** Shown where there is something to choose. */
  const offer = (options: readonly Option[], value: string): void => {
    element.replaceChildren(
      ...options.map(([each, text]) => {
        const option = make("option", "", text);
        option.value = each;
        return option;
      }),
    );
    element.value = value;
    field.hidden = options.length < 2;
  };
  return { field, offer };
}

const eyes: readonly Option[] = [
  ["", "As configured"],
  ["left", "Left"],
  ["right", "Right"],
  ["cyclop", "Middle"],
];
const stereos: readonly Option[] = [
  ["", "As configured"],
  ["anaglyph", "Anaglyph"],
  ["side-by-side", "Side by side"],
  ["top-bottom", "One above the other"],
];

/** The position of what is called `name`, as the server finds it: "#1" is always a position. */
function positionOf(names: readonly string[], name: string): number {
  const position = names.findIndex((_, i) => `#${i}` === name);
  const named = position >= 0 ? position : names.indexOf(name);
  return named >= 0 ? named : names.findIndex((_, i) => String(i) === name);
}

/** By name or position; undefined: there is none. */
export function canvasOf(canvases: readonly CanvasState[], name: string): CanvasState | undefined {
  if (name === "") return canvases[0];
  const names = canvases.map((canvas) => canvas.name);
  return canvases[positionOf(names, name)];
}

/** What the list of a canvas's segments calls the one that is seen; "" is all of them. */
export const segmentOf = (canvas: CanvasState | undefined, name: string): string =>
  canvas?.segments[positionOf(canvas.segments, name)] ?? "";

/** Somebody configured screens: it is not all made of the renderers there are. */
const hasScreens = (canvases: readonly CanvasState[], seen: CanvasState | undefined): boolean =>
  canvases.length > 1 || (seen?.segments.length ?? 0) > 1;

/** By what of a configuration the picture is seen; null where there is none but the usual. */
export function configuredFor(
  canvases: readonly CanvasState[],
  { canvas }: Output,
  throughWall: boolean,
): Configured | null {
  const seen = canvasOf(canvases, canvas);
  if (!throughWall && !hasScreens(canvases, seen)) return null;
  const hasChoice = seen !== undefined && seen.layouts.length > 1 && seen.layout !== "OFF";
  return { layout: hasChoice ? seen.layout : "" };
}

const named = (names: readonly string[]): Option[] => names.map((name) => [name, name]);

export function showDisplays(state: State, viewer: Viewer): void {
  const section = byId("displays", HTMLElement);
  const change = (by: Partial<Output>): void => state.output.set({ ...state.output.value, ...by });
  const layout = select("layout", "Layout", "How renderers share the work; for everybody", (to) => {
    const canvas = canvasOf(state.session.value?.canvases ?? [], state.output.value.canvas);
    if (canvas !== undefined && !viewer.switchLayout(canvas.name, to)) show();
  });
  const canvas = select("canvas", "Canvas", "Which canvas is seen here", (to) =>
    change({ canvas: to, segment: "" }),
  );
  const segment = select("segment", "Segment", "Which of its screens is seen here", (to) =>
    change({ segment: to }),
  );
  const eye = select("eye", "Eye", "Whose picture is seen here", (to) =>
    change({ eye: to as Eye }),
  );
  const stereo = select("stereo", "Both eyes", "How two eyes are put into one picture", (to) =>
    change({ stereo: to as Stereo }),
  );
  section.append(layout.field, canvas.field, segment.field, eye.field, stereo.field);

  const show = (): void => {
    const canvases = state.session.value?.canvases ?? [];
    const { output } = state;
    const seen = canvasOf(canvases, output.value.canvas);
    // Eyes matter there.
    const isConfigured = hasScreens(canvases, seen);
    layout.offer(named(seen?.layouts ?? []), seen?.layout ?? "");
    canvas.offer(named(canvases.map(({ name }) => name)), seen?.name ?? "");
    segment.offer(
      (seen?.segments.length ?? 0) < 2 ? [] : [["", "All"], ...named(seen?.segments ?? [])],
      segmentOf(seen, output.value.segment),
    );
    eye.offer(isConfigured || output.value.eye !== "" ? eyes : [], output.value.eye);
    stereo.offer(isConfigured || output.value.stereo !== "" ? stereos : [], output.value.stereo);
    section.hidden = [layout, canvas, segment, eye, stereo].every(({ field }) => field.hidden);
  };
  state.session.watch(show);
  state.output.watch((output) => {
    show();
    const { pathname, search, hash } = window.location;
    window.history.replaceState(null, "", `${pathname}${queryOf(output, search)}${hash}`);
  });
}
