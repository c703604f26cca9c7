// SPDX-License-Identifier: Apache-2.0
import type { Camera, Vec3 } from "./camera";
import {
  add,
  axesOf,
  clamp,
  directionOf,
  distance,
  headingOfView,
  metresPerPixel,
  scale,
  subtract,
  translate,
  worldUp,
} from "./camera";

/** How near and far the eye may be from the target, in metres. */
export interface DistanceLimits {
  min: number;
  max: number;
}

/**
 * Turns the eye about the target, in radians; positive moves it anticlockwise and upwards. A view
 * that was rolled stands upright from then on.
 */
export function orbit(camera: Camera, azimuth: number, elevation: number): Camera {
  const ahead = headingOfView(camera);
  const direction = directionOf({
    azimuth: ahead.azimuth + azimuth,
    elevation: ahead.elevation - elevation,
  });
  const eye = subtract(camera.target, scale(direction, distance(camera)));
  return { ...camera, eye, up: worldUp };
}

/** Looks at a point from where the eye is; what follows turns about it. */
export function lookAt(camera: Camera, point: Vec3): Camera {
  return { ...camera, target: point };
}

/**
 * Shifts the picture by pixels (x to the right, y downwards), so that the point at the target's
 * distance stays under the pointer.
 */
export function pan(camera: Camera, dx: number, dy: number, heightPixels: number): Camera {
  const { right, up } = axesOf(camera);
  const metres = metresPerPixel(camera, heightPixels);
  return translate(camera, add(scale(right, -dx * metres), scale(up, dy * metres)));
}

/**
 * Scales the distance to the target by `factor` and keeps what is under the pointer there.
 *
 * `x` and `y` are the pointer's offset from the picture's centre in pixels, y downwards. At the
 * smallest distance the target is pushed ahead instead, so that zooming in never gets stuck.
 */
export function zoom(
  camera: Camera,
  factor: number,
  x: number,
  y: number,
  heightPixels: number,
  limits: DistanceLimits,
): Camera {
  const before = distance(camera);
  // Links, walks and programs may have led beyond a limit: from there it goes no farther, or nearer.
  const wanted = Math.min(before * factor, Math.max(limits.max, before));
  const after = Math.max(wanted, Math.min(limits.min, before));
  const { right, up, forward } = axesOf(camera);
  const metres = metresPerPixel(camera, heightPixels);
  const cursor = add(scale(right, x * metres), scale(up, -y * metres));
  // The point under the pointer stays where it is when the rest shrinks towards it.
  const target = add(camera.target, scale(cursor, clamp(1 - after / before, -1, 1)));
  const eye = subtract(target, scale(forward, after));
  const ahead = factor < 1 && wanted < limits.min ? Math.min(before, limits.min) * (1 - factor) : 0;
  return translate({ ...camera, eye, target }, scale(forward, ahead));
}

/** Limits for a scene whose bounds have this diagonal, in metres. */
export function distanceLimits(sceneDiagonal: number): DistanceLimits {
  const size = sceneDiagonal > 0 ? sceneDiagonal : 1;
  return { min: size * 2e-3, max: size * 20 };
}
