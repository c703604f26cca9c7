// SPDX-License-Identifier: Apache-2.0
import type { Camera, Vec3 } from "./camera";
import {
  add,
  axesOf,
  directionOf,
  distance,
  headingOfView,
  length,
  scale,
  translate,
  worldUp,
} from "./camera";

/** Keys held down, as KeyboardEvent.code. */
export type Keys = ReadonlySet<string>;

const moves: ReadonlyMap<string, { right: number; forward: number; up: number }> = new Map([
  ["KeyW", { right: 0, forward: 1, up: 0 }],
  ["KeyS", { right: 0, forward: -1, up: 0 }],
  ["KeyD", { right: 1, forward: 0, up: 0 }],
  ["KeyA", { right: -1, forward: 0, up: 0 }],
  ["KeyE", { right: 0, forward: 0, up: 1 }],
  ["KeyQ", { right: 0, forward: 0, up: -1 }],
]);

const metresPerSecondPerMetre = 0.5;
const fasterFactor = 4;
/** A longer pause between two frames counts as this, so that nothing jumps. */
const longestStepSeconds = 0.1;

export const isFlyKey = (code: string): boolean => moves.has(code);

/** The unit direction that the keys ask for; zero when none or opposite ones are held. */
export function flyDirection(camera: Camera, keys: Keys): Vec3 {
  const { right, forward } = axesOf(camera);
  let direction: Vec3 = [0, 0, 0];
  for (const key of keys) {
    const move = moves.get(key);
    if (move === undefined) continue;
    direction = add(direction, scale(right, move.right));
    direction = add(direction, scale(forward, move.forward));
    direction = add(direction, [0, 0, move.up]);
  }
  const size = length(direction);
  return size > 1e-9 ? scale(direction, 1 / size) : [0, 0, 0];
}

/**
 * Moves for `seconds`: half the distance to the target a second, so speed suits the scale at which
 * the scene is seen; four times that with `fast`.
 */
export function fly(camera: Camera, keys: Keys, fast: boolean, seconds: number): Camera {
  const speed = distance(camera) * metresPerSecondPerMetre * (fast ? fasterFactor : 1);
  const step = speed * Math.min(Math.max(seconds, 0), longestStepSeconds);
  return translate(camera, scale(flyDirection(camera, keys), step));
}

/**
 * Turns the view about the eye, in radians; positive looks left and up. A view that was rolled
 * stands upright from then on.
 */
export function look(camera: Camera, azimuth: number, elevation: number): Camera {
  const ahead = headingOfView(camera);
  const direction = directionOf({
    azimuth: ahead.azimuth + azimuth,
    elevation: ahead.elevation + elevation,
  });
  const target = add(camera.eye, scale(direction, distance(camera)));
  return { ...camera, target, up: worldUp };
}
