// SPDX-License-Identifier: Apache-2.0
// From a point of the canvas to a direction of the view that is seen there, for hands that move it.
import type { Point } from "./camera/touch";
import { coverOf, placeOf, seenPlace } from "./pick";
import type { Shown, Sight } from "./protocol/messages";
import type { Size } from "./view/size";

/**
 * How far off the camera's axis a point of the canvas is, y downwards, in pixels of the canvas as
 * they were if the picture were the camera's own.
 */
export interface Aim extends Point {
  /** That many of them a pixel of the canvas is there, across and down. */
  perPixel: Point;
}

/** What is farther aside comes no nearer by going ahead. */
const widest = Math.tan(Math.PI / 3);

/** The middle of the picture; where it is seen by several sights, of the first of them. */
export function middleOf(shown: Shown | null, canvas: Size): Point {
  const area = shown?.seen?.find(({ sight }) => sight !== undefined);
  if (shown === null || area === undefined) return { x: canvas.width / 2, y: canvas.height / 2 };
  const cover = coverOf(canvas, shown);
  return {
    x: cover.x + (area.x + area.width / 2) * cover.width,
    y: cover.y + (1 - area.y - area.height / 2) * cover.height,
  };
}

/** Off the camera's axis at unit distance, y upwards, of a ray at unit distance against the view's. */
function offAxis({ viewFromCamera }: Sight, x: number, y: number): Point {
  if (viewFromCamera.length === 0) return { x, y };
  const row = (k: number): number =>
    [x, y, -1].reduce((sum, value, i) => sum + (viewFromCamera[3 * i + k] ?? 0) * value, 0);
  const ahead = -row(2);
  const at = { x: row(0) / ahead, y: row(1) / ahead };
  return ahead > 0 && Math.hypot(at.x, at.y) <= widest ? at : { x: 0, y: 0 };
}

/** Undefined where the picture is the camera's own. Straight ahead where nothing is seen. */
export function aimAt(
  shown: Shown | null,
  at: Point,
  canvas: Size,
  fovyDegrees: number,
): Aim | undefined {
  if (shown === null || shown.seen === null) return undefined;
  const placeAt = (point: Point) => seenPlace(shown, placeOf(point, canvas, shown));
  const place = placeAt(at);
  const { sight, width, height } = place ?? placeAt(middleOf(shown, canvas)) ?? {};
  if (sight?.frustum === undefined || width === undefined || height === undefined) return undefined;
  const { left, right, bottom, top } = sight.frustum;
  const cover = coverOf(canvas, shown);
  // Pixels at unit distance, if the picture were the camera's own.
  const pixels = canvas.height / (2 * Math.tan((fovyDegrees * Math.PI) / 360));
  const perPixel = {
    x: (pixels * (right - left) * shown.width) / (width * cover.width),
    y: (pixels * (top - bottom) * shown.height) / (height * cover.height),
  };
  if (place === undefined) return { x: 0, y: 0, perPixel };
  const across = left + ((right - left) * place.x) / width;
  const up = bottom + ((top - bottom) * place.y) / height;
  const { x, y } = offAxis(sight, across, up);
  return { x: pixels * x, y: -pixels * y, perPixel };
}
