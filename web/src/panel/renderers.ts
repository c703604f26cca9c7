// SPDX-License-Identifier: Apache-2.0
// Who drew what of the last picture, and how long it took: as a list, and over the picture.
import type { PartStatistics } from "../protocol/messages";
import type { State } from "../state";
import { byId, make } from "./element";
import { count, milliseconds } from "./format";
import { change } from "./look_controls";

export interface Share {
  renderer: string;
  milliseconds: number;
  triangles: number;
  /** CSS. */
  colour: string;
  parts: readonly PartStatistics[];
}

/** Whether the data were cut: the engine colours its ranges then. */
export function hasRanges(parts: readonly PartStatistics[]): boolean {
  return new Set(parts.map(({ rangeBegin, rangeEnd }) => `${rangeBegin} ${rangeEnd}`)).size > 1;
}

/** Whether the picture was cut. */
export function hasPlaces(parts: readonly PartStatistics[]): boolean {
  return (
    new Set(parts.map(({ left, bottom, width, height }) => [left, bottom, width, height].join()))
      .size > 1
  );
}

/** As the engine has it (renderer/draw/tint.cpp): the hue goes with the middle of the range. */
export function rangeColour(begin: number, end: number): string {
  const hue = Math.PI * (begin + end);
  const channels = [0, 1, 2].map((third) =>
    Math.round(255 * (0.55 + 0.4 * Math.cos(hue + (third * 2 * Math.PI) / 3))),
  );
  return `rgb(${channels.join(" ")})`;
}

/** Neighbours differ clearly: a golden section of the circle lies between them. */
const placeColour = (index: number): string =>
  `hsl(${Math.round(210 + 137.508 * index) % 360} 75% 60%)`;

/** By the renderers' ids; one that drew several parts did so one after the other. */
export function sharesOf(parts: readonly PartStatistics[]): Share[] {
  const byRange = hasRanges(parts);
  return [...new Set(parts.map(({ renderer }) => renderer))].sort().map((renderer, index) => {
    const own = parts.filter((part) => part.renderer === renderer);
    const [first] = own;
    return {
      renderer,
      milliseconds: own.reduce((sum, part) => sum + part.milliseconds, 0),
      triangles: own.reduce((sum, part) => sum + Number(part.triangles), 0),
      colour:
        byRange && first !== undefined
          ? rangeColour(first.rangeBegin, first.rangeEnd)
          : placeColour(index),
      parts: own,
    };
  });
}

function row(share: Share): HTMLElement {
  const swatch = make("span", "renderer-swatch");
  swatch.style.background = share.colour;
  return make(
    "li",
    "renderer",
    swatch,
    make("span", "renderer-name", share.renderer),
    make("span", "value", `${milliseconds(share.milliseconds)} · ${count(share.triangles)} △`),
  );
}

function rectangle(part: PartStatistics, colour: string): HTMLElement {
  const label = make("span", "", `${part.renderer} · ${milliseconds(part.milliseconds)}`);
  const element = make("div", "part", label);
  const percent = (share: number): string => `${(100 * share).toFixed(3)}%`;
  element.style.left = percent(part.left);
  element.style.bottom = percent(part.bottom);
  element.style.width = percent(part.width);
  element.style.height = percent(part.height);
  element.style.setProperty("--colour", colour);
  return element;
}

export function showRenderers(state: State): void {
  const list = make("ul", "renderers");
  list.setAttribute("aria-label", "Renderers of the last picture");
  const overlay = byId("parts", HTMLElement);
  const tint = make("button", "small", "Tint by renderer");
  tint.type = "button";
  tint.id = "tint";
  tint.title = "Show in the picture who drew what: by place, or by colour where the data are cut";
  let isTinted = false;

  const update = (): void => {
    const parts = state.numbers.value?.parts ?? [];
    const shares = sharesOf(parts);
    list.replaceChildren(...shares.map(row));
    // Through a wall or for two eyes there are several views: their places are not the picture's.
    const isOver = isTinted && hasPlaces(parts) && (state.shown.value?.seen ?? null) === null;
    overlay.replaceChildren(
      ...(isOver
        ? shares.flatMap((share) => share.parts.map((part) => rectangle(part, share.colour)))
        : []),
    );
    tint.setAttribute("aria-pressed", String(isTinted));
  };
  const tintRanges = (): void => {
    const parts = state.numbers.value?.parts ?? [];
    const rangeTint = isTinted && hasRanges(parts);
    // A picture says how it was cut; that one was not.
    if (parts.length > 0 && rangeTint !== state.look.value.rangeTint) change(state, { rangeTint });
  };
  tint.addEventListener("click", () => {
    isTinted = !isTinted;
    tintRanges();
    update();
  });
  // By a link, or by who leads.
  state.look.watch(({ rangeTint }) => {
    const isLed = state.isWatching && hasRanges(state.numbers.value?.parts ?? []);
    if (rangeTint || isLed) isTinted = rangeTint;
    tint.setAttribute("aria-pressed", String(isTinted));
  });
  byId("renderers", HTMLElement).append(
    make("h2", "heading", "Renderers"),
    list,
    make("div", "small-buttons field", tint),
  );
  let shown = 0;
  state.numbers.watch((numbers) => {
    if (numbers !== null && numbers.frameNumber === shown) return;
    shown = numbers?.frameNumber ?? 0;
    if (!state.isWatching) tintRanges();
    update();
  });
}
