// SPDX-License-Identifier: Apache-2.0
// From a click to a place of the picture, and from the answer to what the page says of it.
import type { Point } from "./camera/touch";
import type { Camera, Vec3 } from "./camera/camera";
import { againstAxes, project } from "./camera/camera";
import type { Place, Shown, Sight, ViewerPicked, ViewerProfiled } from "./protocol/messages";
import type { Pick as Picked, ProfileState } from "./state";
import type { Size } from "./view/size";

/** A picture's size, and whether it is of two eyes. */
type Covering = Size & Partial<Pick<Shown, "isPacked">>;

/**
 * Where a picture lies that covers a canvas, in the canvas's pixels and from its upper left corner:
 * as large as fills it, in the middle. Of one of another shape, as of who leads from another window,
 * two sides are beyond the canvas. One of two eyes is all there, as screens that part it want it.
 */
export function coverOf(canvas: Size, picture: Covering): Point & Size {
  if (picture.isPacked === true) return { x: 0, y: 0, ...canvas };
  const [width, height] = [Math.max(1, picture.width), Math.max(1, picture.height)];
  const scale = Math.max(canvas.width / width, canvas.height / height);
  return {
    x: (canvas.width - scale * width) / 2,
    y: (canvas.height - scale * height) / 2,
    width: scale * width,
    height: scale * height,
  };
}

/**
 * Pixels of a picture, from its lower left corner, y upwards, of a point `at` from the upper left
 * corner of the canvas that it covers; what lies beside it counts to its edge.
 */
export function placeOf(at: Point, canvas: Size, picture: Covering): Point {
  const cover = coverOf(canvas, picture);
  const share = (value: number, whole: number): number =>
    Math.min(1, Math.max(0, value / Math.max(1, whole)));
  return {
    x: share(at.x - cover.x, cover.width) * picture.width,
    y: (1 - share(at.y - cover.y, cover.height)) * picture.height,
  };
}

/**
 * A place of a picture as one of what it is seen by there; undefined where nothing is shown. As
 * fabric::pickIn.
 */
export function seenPlace(shown: Shown, place: Point): Place | undefined {
  const { width, height, seen } = shown;
  if (seen === null) return { ...place, width, height, sight: undefined };
  const x = place.x / width;
  const y = place.y / height;
  const area = [...seen]
    .reverse()
    .find(
      (each) => x >= each.x && y >= each.y && x <= each.x + each.width && y <= each.y + each.height,
    );
  if (area?.sight === undefined) return undefined;
  const view = {
    width: Math.max(1, Math.round(area.width * width)),
    height: Math.max(1, Math.round(area.height * height)),
  };
  const within = (share: number, pixels: number): number =>
    Math.min(pixels, Math.max(0, share * pixels));
  return {
    x: within((x - area.x) / area.width, view.width),
    y: within((y - area.y) / area.height, view.height),
    ...view,
    sight: area.sight,
  };
}

/** Where a sight shows a point, as shares from its lower left corner; undefined behind its eye. */
function throughSight(
  { eye, viewFromCamera, frustum }: Sight,
  camera: Camera,
  point: Vec3,
): [number, number] | undefined {
  const fromEye = againstAxes(camera, point).map((value, i) => value - (eye[i] ?? 0));
  const row = (i: number): number =>
    viewFromCamera.length === 0
      ? (fromEye[i] ?? 0)
      : fromEye.reduce((sum, value, k) => sum + (viewFromCamera[3 * i + k] ?? 0) * value, 0);
  const [x, y, depth] = [row(0), row(1), -row(2)];
  if (!(depth > 0) || frustum === undefined) return undefined;
  const { left, right, bottom, top } = frustum;
  return [(x / depth - left) / (right - left), (y / depth - bottom) / (top - bottom)];
}

const isShare = (value: number): boolean => value >= 0 && value <= 1;

/**
 * Where a world point appears in a picture, as shares of it from its upper left corner; undefined
 * behind the eye, and where none of the picture's sights shows it.
 */
export function appearance(shown: Shown, point: Vec3): [number, number] | undefined {
  const { camera, width, height, seen } = shown;
  if (seen === null) return project(camera, point, width / height);
  for (const area of [...seen].reverse()) {
    const at = area.sight && throughSight(area.sight, camera, point);
    if (at?.every(isShare))
      return [area.x + at[0] * area.width, 1 - (area.y + at[1] * area.height)];
  }
  return undefined;
}

export function pickOf(
  answer: ViewerPicked,
  objectNames: readonly string[],
  exaggeration: number,
): Picked {
  if (answer.problem !== "") return { kind: "problem", text: answer.problem };
  const { point } = answer;
  if (point?.position === undefined) return { kind: "nothing" };
  const { x, y, z } = point.position;
  return {
    kind: "point",
    object: objectNames[point.object] ?? "",
    position: [x, y, z],
    elevation: point.elevation,
    elevationError: point.elevationError,
    error: point.error,
    distance: point.distance,
    nearest: point.nearest,
    farthest: point.farthest,
    exaggeration,
  };
}

export function profileOf(answer: ViewerProfiled, from: Vec3, to: Vec3): ProfileState {
  if (answer.problem !== "") return { kind: "problem", text: answer.problem };
  const samples = answer.samples.map(({ point }) => {
    if (point?.position === undefined) return undefined;
    const { x, y, z } = point.position;
    return { position: [x, y, z] as const, error: point.error };
  });
  return { kind: "found", from, to, samples };
}
