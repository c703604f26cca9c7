// SPDX-License-Identifier: Apache-2.0
// A view as the fragment of a link: "#eye=1,2,3&at=4,5,6&tau=1". What is as usual is left out.
import type { Camera, Vec3 } from "./camera/camera";
import { isUsable } from "./camera/camera";
import type { Look, ObjectLook, Primitive, Shape, Sun } from "./look";
import { defaultLook, maxHeight, maxObjects, maxPrimitives } from "./look";
import { Shading } from "./protocol/messages";

/** Everything that makes a picture of a scene what it is, but for its size. */
export interface SharedView {
  camera: Camera;
  tau: number;
  /** Milliseconds a frame may take while the view moves; null: tau is kept. */
  budget: number | null;
  shading: Shading;
  /** Without a frozen cut: links do not hold those. */
  look: Look;
}

const shadings: readonly (readonly [string, Shading])[] = [
  ["smooth", Shading.SMOOTH],
  ["gouraud", Shading.GOURAUD],
  ["flat", Shading.FLAT],
  ["wireframe", Shading.WIREFRAME],
];

export function shadingName(shading: Shading): string {
  return shadings.find(([, one]) => one === shading)?.[0] ?? "smooth";
}

const isSame = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

function changedLook(look: Look): Partial<Look> {
  const entries = Object.entries({ ...look, frozen: null });
  return Object.fromEntries(
    entries.filter(([key, value]) => !isSame(value, defaultLook[key as keyof Look])),
  );
}

/** Without the "#". */
export function encodeView({ camera, tau, budget, shading, look }: SharedView): string {
  const fields: [string, string][] = [
    ["eye", camera.eye.join()],
    ["at", camera.target.join()],
    ["tau", String(tau)],
  ];
  if (!isSame(camera.up, [0, 0, 1])) fields.push(["up", camera.up.join()]);
  if (camera.fovyDegrees !== 45) fields.push(["fov", String(camera.fovyDegrees)]);
  if (budget !== null) fields.push(["budget", String(budget)]);
  if (shading !== Shading.SMOOTH) fields.push(["shading", shadingName(shading)]);
  const changed = changedLook(look);
  if (Object.keys(changed).length > 0)
    fields.push(["look", encodeURIComponent(JSON.stringify(changed))]);
  return fields.map(([name, value]) => `${name}=${value}`).join("&");
}

function numberOf(text: string | undefined, min: number, max: number): number | undefined {
  const value = text === undefined || text.trim() === "" ? Number.NaN : Number(text);
  return value >= min && value <= max ? value : undefined;
}

function vectorOf(text: string | undefined): Vec3 | undefined {
  // Some programs that pass links on encode their commas.
  const [x, y, z, more] = (text ?? "").split(/,|%2c/i).map((one) => numberOf(one, -1e12, 1e12));
  if (x === undefined || y === undefined || z === undefined || more !== undefined) return undefined;
  return [x, y, z];
}

const shapes: readonly Shape[] = ["blend", "box", "tent", "smooth"];
const isNumber = (value: unknown, min: number, max: number): boolean =>
  typeof value === "number" && value >= min && value <= max;

function isPrimitive(value: unknown): value is Primitive {
  const one = value as Partial<Primitive> | null;
  return (
    typeof one === "object" &&
    one !== null &&
    shapes.includes(one.shape as Shape) &&
    isNumber(one.centre, -maxHeight, maxHeight) &&
    isNumber(one.width, Number.MIN_VALUE, maxHeight) &&
    isNumber(one.opacity, 0, 1) &&
    isColour(one.colour)
  );
}

function isSun(value: unknown): value is Sun {
  const one = value as Partial<Sun> | null;
  return (
    typeof one === "object" &&
    one !== null &&
    isNumber(one.azimuth, -360, 360) &&
    isNumber(one.elevation, -90, 90)
  );
}

const isColour = (value: unknown): boolean =>
  Array.isArray(value) && value.length === 3 && value.every((channel) => isNumber(channel, 0, 1));

const isPosition = (value: unknown): boolean =>
  isNumber(value, 0, 2 ** 31 - 1) && Number.isInteger(value);

function isObjectLook(value: unknown): value is ObjectLook {
  const one = value as Partial<ObjectLook> | null;
  return (
    typeof one === "object" &&
    one !== null &&
    isPosition(one.object) &&
    (one.colour === null || isColour(one.colour)) &&
    (one.shading === null || shadings.some(([, shading]) => shading === one.shading))
  );
}

/** Ascending, none twice. */
const areObjectLooks = (value: unknown): boolean =>
  Array.isArray(value) &&
  value.length <= maxObjects &&
  value.every(isObjectLook) &&
  value.every(({ object }, i) => i === 0 || (value[i - 1]?.object ?? object) < object);

/** What each part of a look may be. */
const isPart: Record<keyof Look, (value: unknown) => boolean> = {
  exaggeration: (value) => isNumber(value, -1000, 1000),
  colouring: (value) => value === "tints" || value === "edited" || value === "bare",
  primitives: (value) =>
    Array.isArray(value) && value.length <= maxPrimitives && value.every(isPrimitive),
  unit: (value) => value === "relative" || value === "metres",
  slopeShading: (value) => isNumber(value, 0, 1),
  saturation: (value) => isNumber(value, 0, 2),
  contourMetres: (value) => value === 0 || isNumber(value, 1e-3, 1e5),
  contourPixels: (value) => isNumber(value, 0.25, 16),
  tileBounds: (value) => typeof value === "boolean",
  pageBounds: (value) => typeof value === "boolean",
  levelTint: (value) => typeof value === "boolean",
  rangeTint: (value) => typeof value === "boolean",
  frozen: (value) => value === null,
  underground: (value) => typeof value === "boolean",
  sun: (value) => value === null || isSun(value),
  hidden: (value) => Array.isArray(value) && value.length <= maxObjects && value.every(isPosition),
  objects: areObjectLooks,
};

function lookOf(text: string | undefined): Look | undefined {
  if (text === undefined) return defaultLook;
  try {
    const parts: unknown = JSON.parse(decodeURIComponent(text));
    if (typeof parts !== "object" || parts === null) return undefined;
    const isLook = Object.entries(parts).every(
      ([key, value]) => Object.hasOwn(isPart, key) && isPart[key as keyof Look](value),
    );
    if (!isLook) return undefined;
    const look = { ...defaultLook, ...(parts as Partial<Look>) };
    return { ...look, hidden: [...new Set(look.hidden)].sort((a, b) => a - b) };
  } catch {
    return undefined;
  }
}

/** The view of a link's fragment, with or without "#"; undefined where it is not one whole. */
export function decodeView(fragment: string): SharedView | undefined {
  const fields = new Map<string, string>();
  for (const field of fragment.replace(/^#/, "").split("&")) {
    const at = field.indexOf("=");
    if (at > 0) fields.set(field.slice(0, at), field.slice(at + 1));
  }
  const optional = <T>(name: string, read: (text: string) => T | undefined, usual: T) =>
    fields.has(name) ? read(fields.get(name) ?? "") : usual;
  const eye = vectorOf(fields.get("eye"));
  const target = vectorOf(fields.get("at"));
  const up = optional<Vec3>("up", vectorOf, [0, 0, 1]);
  const fovyDegrees = optional("fov", (text) => numberOf(text, 1, 170), 45);
  const tau = optional("tau", (text) => numberOf(text, 0.01, 1000), 1);
  const budget = optional<number | null>("budget", (text) => numberOf(text, 1, 10_000), null);
  const shading = optional(
    "shading",
    (text) => shadings.find(([name]) => name === text)?.[1],
    Shading.SMOOTH,
  );
  const look = lookOf(fields.get("look"));
  if (eye === undefined || target === undefined || up === undefined) return undefined;
  if (fovyDegrees === undefined || tau === undefined || budget === undefined) return undefined;
  if (shading === undefined || look === undefined) return undefined;
  const camera = { eye, target, up, fovyDegrees };
  return isUsable(camera) ? { camera, tau, budget, shading, look } : undefined;
}
