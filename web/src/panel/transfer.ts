// SPDX-License-Identifier: Apache-2.0
// The editor of the elevation transfer function: a strip that shows it, and a row a primitive.
import type { Primitive, Shape } from "../look";
import { defaultPrimitives, evaluate, fromHex, maxPrimitives, toHex } from "../look";
import type { State } from "../state";
import { make } from "./element";

const shapes: readonly (readonly [Shape, string])[] = [
  ["blend", "Blend"],
  ["box", "Box"],
  ["tent", "Tent"],
  ["smooth", "Bell"],
];

const stripWidth = 256;
/** What shows through where nothing is opaque: the server's bare ground, as displayed. */
const bare = [0.548, 0.539, 0.52] as const;

/** The pixels of the strip, lowest to highest, as r, g, b, a one by one. */
export function stripPixels(primitives: readonly Primitive[], width: number): Uint8ClampedArray {
  const pixels = new Uint8ClampedArray(4 * width);
  for (let x = 0; x < width; ++x) {
    const [r, g, b, a] = evaluate(primitives, x / (width - 1));
    [r, g, b].forEach((channel, i) => {
      const mixed = (bare[i] ?? 0) ** 2 * (1 - a) + channel ** 2 * a;
      pixels[4 * x + i] = 255 * Math.sqrt(mixed);
    });
    pixels[4 * x + 3] = 255;
  }
  return pixels;
}

function strip(state: State): HTMLElement {
  const canvas = make("canvas", "strip");
  canvas.width = stripWidth;
  canvas.height = 1;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "Colours from the lowest to the highest ground");
  const context = canvas.getContext("2d");
  state.look.watch(({ primitives }) => {
    const image = new ImageData(stripWidth, 1);
    image.data.set(stripPixels(primitives, stripWidth));
    context?.putImageData(image, 0, 0);
  });
  return canvas;
}

/** A copy with one entry changed, or, without `by`, left out. */
export function edited(
  primitives: readonly Primitive[],
  at: number,
  by?: Partial<Primitive>,
): readonly Primitive[] {
  if (by === undefined) return primitives.filter((_, i) => i !== at);
  return primitives.map((primitive, i) => (i === at ? { ...primitive, ...by } : primitive));
}

function percentField(name: string, least: number, changed: (share: number) => void) {
  const input = make("input", "percent");
  input.type = "number";
  input.min = String(least);
  input.max = "100";
  input.step = "1";
  input.title = `${name}, % of the relief`;
  input.setAttribute("aria-label", input.title);
  input.addEventListener("change", () => {
    const percent = Number(input.value);
    if (input.value !== "" && Number.isFinite(percent))
      changed(Math.min(100, Math.max(least, percent)) / 100);
    else input.value = input.defaultValue;
  });
  return input;
}

interface Row {
  element: HTMLElement;
  show(primitive: Primitive): void;
}

function makeRow(change: (by?: Partial<Primitive>) => void): Row {
  const colour = make("input", "swatch");
  colour.type = "color";
  colour.title = "Colour";
  colour.addEventListener("input", () => change({ colour: fromHex(colour.value) }));
  const shape = make("select", "shape");
  shape.title = "Shape";
  for (const [value, name] of shapes) {
    const option = make("option", "", name);
    option.value = value;
    shape.append(option);
  }
  shape.addEventListener("change", () => change({ shape: shape.value as Shape }));
  const centre = percentField("Centre", 0, (value) => change({ centre: value }));
  const width = percentField("Width from the centre", 1, (value) => change({ width: value }));
  const remove = make("button", "step", "×");
  remove.type = "button";
  remove.title = "Remove";
  remove.addEventListener("click", () => change());
  const show = (primitive: Primitive): void => {
    colour.value = toHex(primitive.colour);
    shape.value = primitive.shape;
    // What is typed in and is no number leads back to the default value.
    centre.value = centre.defaultValue = String(Math.round(primitive.centre * 100));
    width.value = width.defaultValue = String(Math.round(primitive.width * 100));
  };
  return { element: make("div", "primitive", colour, shape, centre, width, remove), show };
}

export function transferEditor(state: State): HTMLElement {
  const rows: Row[] = [];
  const list = make("div", "primitives");
  const set = (primitives: readonly Primitive[]): void =>
    state.look.set({ ...state.look.value, primitives });
  const button = (text: string, clicked: () => void): HTMLButtonElement => {
    const made = make("button", "small", text);
    made.type = "button";
    made.addEventListener("click", clicked);
    return made;
  };
  const add = button("Add colour", () => {
    const { primitives } = state.look.value;
    set([
      ...primitives,
      { shape: "smooth", centre: 0.5, width: 0.1, colour: [0.8, 0.3, 0.2], opacity: 1 },
    ]);
  });
  const reset = button("Start over", () => set(defaultPrimitives));
  const names = make("div", "primitive names");
  for (const name of ["", "", "centre %", "width %", ""]) names.append(make("span", "", name));
  const editor = make("div", "transfer", strip(state), names, list, make("div", "row", add, reset));
  state.look.watch(({ primitives, colouring }) => {
    editor.hidden = colouring !== "edited";
    while (rows.length > primitives.length) rows.pop()?.element.remove();
    for (let i = rows.length; i < primitives.length; ++i) {
      const row = makeRow((by) => set(edited(state.look.value.primitives, i, by)));
      rows.push(row);
      list.append(row.element);
    }
    primitives.forEach((primitive, i) => rows[i]?.show(primitive));
    add.disabled = primitives.length >= maxPrimitives;
  });
  return editor;
}
