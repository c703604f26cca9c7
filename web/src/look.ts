// SPDX-License-Identifier: Apache-2.0
// How terrain is shown: the page's side of look.proto.
import type { Camera } from "./camera/camera";
import type { Shading } from "./protocol/gen/eyrie/v1/shading_pb";

export type Shape = "blend" | "box" | "tent" | "smooth";

/** Of heights: shares of the terrain's relief, or metres of elevation. */
export type Unit = "relative" | "metres";

/** One colour at some heights, in the look's unit. */
export interface Primitive {
  shape: Shape;
  centre: number;
  /** From the centre to where it ends. */
  width: number;
  /** As displayed, 0 to 1. */
  colour: readonly [number, number, number];
  opacity: number;
}

export type Colouring = "tints" | "edited" | "bare";

/** Where light comes from: degrees clockwise from north, and above the horizon. */
export interface Sun {
  azimuth: number;
  elevation: number;
}

/** How one object is shown. */
export interface ObjectLook {
  /** Its position in the scene. */
  readonly object: number;
  /** As displayed, 0 to 1; null: those of its data. */
  readonly colour: readonly [number, number, number] | null;
  /** Null: the picture's. */
  readonly shading: Shading | null;
}

export interface Look {
  exaggeration: number;
  colouring: Colouring;
  /** Used while `colouring` is "edited". */
  primitives: readonly Primitive[];
  /** Of the primitives' heights. */
  unit: Unit;
  /** How far steep ground shows rock, 0 to 1. */
  slopeShading: number;
  saturation: number;
  /** Metres between contour lines; 0 for none. */
  contourMetres: number;
  /** How wide they are. */
  contourPixels: number;
  tileBounds: boolean;
  pageBounds: boolean;
  levelTint: boolean;
  rangeTint: boolean;
  /** The camera whose cut is held; null while it follows the view. */
  frozen: Camera | null;
  underground: boolean;
  /** Null: the scene's lights as they are. */
  sun: Sun | null;
  /** Positions in the scene of objects that are not drawn, ascending. */
  hidden: readonly number[];
  /** Of single objects, ascending. */
  objects: readonly ObjectLook[];
}

/** As displayed; those of the server's built-in tints, from lowest to highest. */
const tints: readonly (readonly [number, number, number])[] = [
  [0.346, 0.436, 0.245],
  [0.265, 0.374, 0.224],
  [0.469, 0.458, 0.3],
  [0.5, 0.436, 0.361],
  [0.583, 0.557, 0.529],
  [0.927, 0.943, 0.964],
];

export const defaultPrimitives: readonly Primitive[] = tints.map((colour, i) => ({
  shape: "blend",
  centre: i / (tints.length - 1),
  width: 1 / (tints.length - 1),
  colour,
  opacity: 1,
}));

/** As the server has them. */
export const maxPrimitives = 32;
export const maxHeight = 1e6;

export const defaultLook: Look = {
  exaggeration: 1,
  colouring: "tints",
  primitives: defaultPrimitives,
  unit: "relative",
  slopeShading: 1,
  saturation: 1,
  contourMetres: 0,
  contourPixels: 1,
  tileBounds: false,
  pageBounds: false,
  levelTint: false,
  rangeTint: false,
  frozen: null,
  underground: false,
  sun: null,
  hidden: [],
  objects: [],
};

/** Objects that may be hidden, and that may have a look of their own, at a time. */
export const maxObjects = 1000;

/** Where the sun first stands: as maps are lit, from the north-west and half way up. */
export const usualSun: Sun = { azimuth: 315, elevation: 45 };

/** `hidden` with an object in it, or not. */
export function withHidden(
  hidden: readonly number[],
  object: number,
  isHidden: boolean,
): readonly number[] {
  const others = hidden.filter((one) => one !== object);
  return isHidden ? [...others, object].sort((a, b) => a - b) : others;
}

/** `look` without what it says of objects that a scene of so many lacks; itself where that is nothing. */
export function ofScene(look: Look, count: number): Look {
  const hidden = look.hidden.filter((object) => object < count);
  const objects = look.objects.filter(({ object }) => object < count);
  const isWhole = hidden.length === look.hidden.length && objects.length === look.objects.length;
  return isWhole ? look : { ...look, hidden, objects };
}

/** Of an object, whether `looks` have it or not. */
export function objectLook(looks: readonly ObjectLook[], object: number): ObjectLook {
  return looks.find((one) => one.object === object) ?? { object, colour: null, shading: null };
}

/** `looks` with that one; without it where it says nothing. */
export function withObjectLook(
  looks: readonly ObjectLook[],
  look: ObjectLook,
): readonly ObjectLook[] {
  const others = looks.filter((one) => one.object !== look.object);
  if (look.colour === null && look.shading === null) return others;
  return [...others, look].sort((a, b) => a.object - b.object);
}

/** Opacity of a primitive at `distance`, in widths, from its centre, 0 to 1. */
export function shapeAt(shape: Shape, distance: number): number {
  const d = Math.abs(distance);
  if (!(d < 1)) return 0;
  switch (shape) {
    case "blend":
      return d <= 0.5 ? 1 : (1 - d) / d;
    case "box":
      return 1;
    case "tent":
      return 1 - d;
    case "smooth":
      return (1 - d * d) ** 2;
  }
}

/** Mean colour by opacity, in linear light, and the largest opacity: [r, g, b, a] as displayed. */
export function evaluate(
  primitives: readonly Primitive[],
  height: number,
): [number, number, number, number] {
  const sums = [0, 0, 0];
  let total = 0;
  let largest = 0;
  for (const { shape, centre, width, colour, opacity } of primitives) {
    const weight = opacity * shapeAt(shape, (height - centre) / width);
    colour.forEach((channel, i) => (sums[i] = (sums[i] ?? 0) + weight * channel * channel));
    total += weight;
    largest = Math.max(largest, weight);
  }
  const channel = (i: number): number => (total > 0 ? Math.sqrt((sums[i] ?? 0) / total) : 0);
  return [channel(0), channel(1), channel(2), largest];
}

export function toHex(colour: readonly [number, number, number]): string {
  const byte = (channel: number): string =>
    Math.round(channel * 255)
      .toString(16)
      .padStart(2, "0");
  return `#${colour.map(byte).join("")}`;
}

export function fromHex(hex: string): [number, number, number] {
  const at = (i: number): number => Number.parseInt(hex.slice(1 + 2 * i, 3 + 2 * i), 16) / 255;
  return [at(0), at(1), at(2)];
}

/**
 * The exaggeration at a slider's place from -1 to 1, and back: a tenth of the true height at -1,
 * the true one at 0, ten times it at 1; each step is the same factor.
 */
export const exaggerationAt = (place: number): number => 10 ** place;
export const placeOf = (exaggeration: number): number => Math.log10(Math.max(exaggeration, 0.1));

/** The sensible intervals of contour lines, in metres. */
const intervals = [1, 2, 5, 10, 20, 25, 50, 100, 200, 250, 500, 1000];

/** What an interval of about a thirtieth of the relief comes to. */
export function suggestedInterval(reliefMetres: number): number {
  return intervals.find((interval) => interval * 30 >= reliefMetres) ?? 1000;
}

/**
 * The next interval up (+1) or down (-1), also from one between two or beyond the last; 0, for none,
 * comes before the first.
 */
export function nextInterval(metres: number, step: 1 | -1): number {
  if (step === 1) return intervals.find((interval) => interval > metres) ?? metres;
  return intervals.filter((interval) => interval < metres).at(-1) ?? 0;
}
