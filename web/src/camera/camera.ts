// SPDX-License-Identifier: Apache-2.0
// A pinhole camera in world space (metres, right-handed, z up) and the vectors it needs.

export type Vec3 = readonly [number, number, number];

export interface Camera {
  readonly eye: Vec3;
  /** What is looked at, and orbited about; never the eye. */
  readonly target: Vec3;
  readonly up: Vec3;
  /** The whole vertical field of view. */
  readonly fovyDegrees: number;
}

/** View axes in world space; unit length. */
export interface Axes {
  right: Vec3;
  up: Vec3;
  forward: Vec3;
}

/** Up in the picture, once hands have turned the view. */
export const worldUp: Vec3 = [0, 0, 1];

/** How near the view direction may come to straight up or down, in radians. */
export const poleMargin = 0.01;

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const isFinite3 = (a: Vec3): boolean => a.every(Number.isFinite);

export const clamp = (value: number, low: number, high: number): number =>
  Math.min(high, Math.max(low, value));

const unit = (a: Vec3): Vec3 => scale(a, 1 / length(a));

/** From eye to target, in metres. */
export const distance = (camera: Camera): number => length(subtract(camera.target, camera.eye));

/** Where a direction points: azimuth anticlockwise from +x, elevation above the horizon. */
export interface Heading {
  azimuth: number;
  elevation: number;
}

export function headingOf(direction: Vec3): Heading {
  return {
    azimuth: Math.atan2(direction[1], direction[0]),
    elevation: Math.atan2(direction[2], Math.hypot(direction[0], direction[1])),
  };
}

/** Unit vector; the elevation is kept off the poles, so that "up" stays meaningful. */
export function directionOf({ azimuth, elevation }: Heading): Vec3 {
  const limit = Math.PI / 2 - poleMargin;
  const e = clamp(elevation, -limit, limit);
  return [Math.cos(e) * Math.cos(azimuth), Math.cos(e) * Math.sin(azimuth), Math.sin(e)];
}

/** As the picture lies, whatever is up in it. */
export function axesOf(camera: Camera): Axes {
  const forward = unit(subtract(camera.target, camera.eye));
  const right = unit(cross(forward, camera.up));
  return { right, up: cross(right, forward), forward };
}

/** Where a camera looks; straight up or down, by what is up in the picture, as maps have north. */
export function headingOfView(camera: Camera): Heading {
  const { right, forward } = axesOf(camera);
  const { azimuth, elevation } = headingOf(forward);
  const isAtPole = Math.abs(elevation) > Math.PI / 2 - poleMargin;
  return { azimuth: isAtPole ? headingOf(right).azimuth + Math.PI / 2 : azimuth, elevation };
}

/** World metres that one pixel spans at the target, for a picture of `heightPixels`. */
export function metresPerPixel(camera: Camera, heightPixels: number): number {
  const halfFov = (camera.fovyDegrees * Math.PI) / 360;
  return (2 * distance(camera) * Math.tan(halfFov)) / Math.max(1, heightPixels);
}

/** A world point from the eye: x right, y up, -z ahead. */
export function againstAxes(camera: Camera, point: Vec3): Vec3 {
  const { right, up, forward } = axesOf(camera);
  const offset = subtract(point, camera.eye);
  return [dot(offset, right), dot(offset, up), -dot(offset, forward)];
}

/**
 * Where a world point appears, as a share of the picture's width and height from its upper left
 * corner; undefined behind the eye.
 */
export function project(camera: Camera, point: Vec3, aspect: number): [number, number] | undefined {
  const [x, y, z] = againstAxes(camera, point);
  if (!(z < 0)) return undefined;
  const halfHeight = -z * Math.tan((camera.fovyDegrees * Math.PI) / 360);
  return [0.5 + x / (2 * halfHeight * aspect), 0.5 - y / (2 * halfHeight)];
}

/** Moves eye and target together. */
export function translate(camera: Camera, by: Vec3): Camera {
  return { ...camera, eye: add(camera.eye, by), target: add(camera.target, by) };
}

/** True for a camera that the server would accept. */
export function isUsable(camera: Camera): boolean {
  const { eye, target, up, fovyDegrees } = camera;
  if (!isFinite3(eye) || !isFinite3(target) || !isFinite3(up)) return false;
  if (!(fovyDegrees >= 1 && fovyDegrees <= 170) || !(distance(camera) > 0)) return false;
  return length(cross(unit(subtract(target, eye)), unit(up))) > 1e-9;
}
