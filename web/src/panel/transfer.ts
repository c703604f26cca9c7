// SPDX-License-Identifier: Apache-2.0
// The editor of the elevation transfer function: a strip that shows it, and a row a primitive.
import { groundHeights } from "../drawn_bounds";
import type { Primitive, Shape, Unit } from "../look";
import { defaultPrimitives, evaluate, fromHex, maxHeight, maxPrimitives, toHex } from "../look";
import type { State } from "../state";
import { make, setText } from "./element";
import { change } from "./look_controls";

const shapes: readonly (readonly [Shape, string])[] = [
  ["blend", "Blend"],
  ["box", "Box"],
  ["tent", "Tent"],
  ["smooth", "Bell"],
];

/** How heights of a unit are typed in: `typed` of them are one. */
interface Scale {
  sign: string;
  of: string;
  typed: number;
  digits: number;
  lowest: number;
  highest: number;
  narrowest: number;
}

const scales: Readonly<Record<Unit, Scale>> = {
  relative: {
    sign: "%",
    of: "% of the relief",
    typed: 100,
    digits: 0,
    lowest: 0,
    highest: 1,
    narrowest: 0.01,
  },
  metres: {
    sign: "m",
    of: "metres of elevation",
    typed: 1,
    digits: 1,
    lowest: -maxHeight,
    highest: maxHeight,
    narrowest: 0.1,
  },
};

/** A height as it is typed in. */
export const typedHeight = (height: number, unit: Unit): string =>
  String(Number((height * scales[unit].typed).toFixed(scales[unit].digits)));

/** The height that was typed in, not below `least`; undefined where that is no number. */
export function heightTyped(text: string, unit: Unit, least: number): number | undefined {
  const typed = text === "" ? Number.NaN : Number(text);
  if (!Number.isFinite(typed)) return undefined;
  return Math.min(scales[unit].highest, Math.max(least, typed / scales[unit].typed));
}

/** The lowest and the highest ground, in the look's unit. */
export function groundOf({ look, session }: Pick<State, "look" | "session">): [number, number] {
  const known = look.value.unit === "metres" && session.value && groundHeights(session.value);
  return known || [0, 1];
}

const stripWidth = 256;
/** What shows through where nothing is opaque: the server's bare ground, as displayed. */
const bare = [0.548, 0.539, 0.52] as const;

/**
 * The pixels of the strip, `lowest` to `highest`, as r, g, b, a one by one. No primitive is lost
 * between two.
 */
export function stripPixels(
  primitives: readonly Primitive[],
  width: number,
  [lowest, highest]: readonly [number, number],
): Uint8ClampedArray {
  const pixels = new Uint8ClampedArray(4 * width);
  const step = (highest - lowest) / (width - 1);
  const shown = primitives.map((one) => ({ ...one, width: Math.max(one.width, step) }));
  for (let x = 0; x < width; ++x) {
    const [r, g, b, a] = evaluate(shown, lowest + step * x);
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
  const draw = (): void => {
    const image = new ImageData(stripWidth, 1);
    image.data.set(stripPixels(state.look.value.primitives, stripWidth, groundOf(state)));
    context?.putImageData(image, 0, 0);
  };
  state.look.watch(draw);
  state.session.watch(draw);
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

/** `of`: whose it is, for screen readers. */
function heightField(
  name: string,
  of: string,
  leastOf: (scale: Scale) => number,
  changed: (height: number) => void,
) {
  const input = make("input", "percent");
  input.type = "number";
  let unit: Unit = "relative";
  input.addEventListener("change", () => {
    const height = heightTyped(input.value, unit, leastOf(scales[unit]));
    if (height !== undefined) changed(height);
    else input.value = input.defaultValue;
  });
  const show = (height: number, shownIn: Unit): void => {
    unit = shownIn;
    const { of: measure, typed, digits, highest } = scales[unit];
    input.min = String(leastOf(scales[unit]) * typed);
    input.max = String(highest * typed);
    input.step = digits === 0 ? "1" : "any";
    input.title = `${name}, ${measure}`;
    input.setAttribute("aria-label", `${name} of ${of}, ${measure}`);
    // What is typed in and is no number leads back to the default value.
    input.value = input.defaultValue = typedHeight(height, unit);
  };
  return { input, show };
}

interface Row {
  element: HTMLElement;
  show(primitive: Primitive, unit: Unit): void;
}

/** `position`, from 1 on, is how screen readers tell it from others. */
function makeRow(position: number, change: (by?: Partial<Primitive>) => void): Row {
  const colour = make("input", "swatch");
  colour.type = "color";
  colour.title = "Colour";
  colour.setAttribute("aria-label", `Colour ${position}`);
  colour.addEventListener("input", () => change({ colour: fromHex(colour.value) }));
  const shape = make("select", "shape");
  shape.title = "Shape";
  shape.setAttribute("aria-label", `Shape of colour ${position}`);
  for (const [value, name] of shapes) {
    const option = make("option", "", name);
    option.value = value;
    shape.append(option);
  }
  shape.addEventListener("change", () => change({ shape: shape.value as Shape }));
  const centre = heightField(
    "Centre",
    `colour ${position}`,
    ({ lowest }) => lowest,
    (value) => change({ centre: value }),
  );
  const width = heightField(
    "Width from the centre",
    `colour ${position}`,
    ({ narrowest }) => narrowest,
    (value) => change({ width: value }),
  );
  const remove = make("button", "step", "×");
  remove.type = "button";
  remove.title = "Remove";
  remove.setAttribute("aria-label", `Remove colour ${position}`);
  remove.addEventListener("click", () => change());
  const show = (primitive: Primitive, unit: Unit): void => {
    colour.value = toHex(primitive.colour);
    shape.value = primitive.shape;
    centre.show(primitive.centre, unit);
    width.show(primitive.width, unit);
  };
  const element = make("div", "primitive", colour, shape, centre.input, width.input, remove);
  return { element, show };
}

export function transferEditor(state: State): HTMLElement {
  const rows: Row[] = [];
  const list = make("div", "primitives");
  const set = (primitives: readonly Primitive[]): void => change(state, { primitives });
  const button = (text: string, clicked: () => void): HTMLButtonElement => {
    const made = make("button", "small", text);
    made.type = "button";
    made.addEventListener("click", clicked);
    return made;
  };
  const add = button("Add colour", () => {
    const [lowest, highest] = groundOf(state);
    const centre = (lowest + highest) / 2;
    const width = (highest - lowest) / 10 || 1;
    set([
      ...state.look.value.primitives,
      { shape: "smooth", centre, width, colour: [0.8, 0.3, 0.2], opacity: 1 },
    ]);
  });
  const reset = button("Start over", () =>
    change(state, { primitives: defaultPrimitives, unit: "relative" }),
  );
  const centreName = make("span", "");
  const widthName = make("span", "");
  const none = (): HTMLElement => make("span", "");
  const names = make("div", "primitive names", none(), none(), centreName, widthName, none());
  const editor = make("div", "transfer", strip(state), names, list, make("div", "row", add, reset));
  state.look.watch(({ primitives, colouring, unit }) => {
    setText(centreName, `centre ${scales[unit].sign}`);
    setText(widthName, `width ${scales[unit].sign}`);
    editor.hidden = colouring !== "edited";
    while (rows.length > primitives.length) rows.pop()?.element.remove();
    for (let i = rows.length; i < primitives.length; ++i) {
      const row = makeRow(i + 1, (by) => set(edited(state.look.value.primitives, i, by)));
      rows.push(row);
      list.append(row.element);
    }
    primitives.forEach((primitive, i) => rows[i]?.show(primitive, unit));
    add.disabled = primitives.length >= maxPrimitives;
  });
  return editor;
}
