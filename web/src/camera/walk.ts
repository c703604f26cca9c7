// SPDX-License-Identifier: Apache-2.0
// A walk on the ground: the eye stays at its height above it, and goes only where the ground is
// known.
import type { Camera, Vec3 } from "./camera";
import { clamp, headingOfView, subtract, translate, worldUp } from "./camera";
import type { Keys } from "./fly";
import { flyDirection } from "./fly";

/** Heights of the ground at even steps from one place to another; undefined where there is none. */
export interface Ground {
  from: readonly [number, number];
  to: readonly [number, number];
  heights: readonly (number | undefined)[];
}

/** Of a person; smaller and larger ones walk as much slower and faster. */
export const usualEyeHeight = 1.7;
const leastEyeHeight = 0.05;
const mostEyeHeight = 10_000;
const eyeHeightsPerSecond = 3;
const fasterFactor = 4;
const longestStepSeconds = 0.1;
/** Eye heights beside the line for which its heights still stand. */
const reachBeside = 0.5;

export const eyeHeightBy = (height: number, factor: number): number =>
  clamp(height * factor, leastEyeHeight, mostEyeHeight);

/** "beside": not known there; undefined: known, and there is nothing. */
export function groundAt(
  { from, to, heights }: Ground,
  [x, y]: readonly [number, number, ...number[]],
  eyeHeight: number,
): number | undefined | "beside" {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const length = Math.hypot(dx, dy);
  if (!(length > 0)) return "beside";
  const [px, py] = [x - from[0], y - from[1]];
  const along = (px * dx + py * dy) / length;
  const across = Math.abs(px * dy - py * dx) / length;
  const slack = reachBeside * eyeHeight;
  if (across > slack || along < -slack || along > length) return "beside";
  const place = (clamp(along, 0, length) / length) * (heights.length - 1);
  const before = Math.min(Math.floor(place), heights.length - 2);
  const [low, high] = [heights[before], heights[before + 1]];
  if (low === undefined || high === undefined) return undefined;
  return low + (high - low) * (place - before);
}

/** How far the keys lead on the map, in metres. */
export function stepOf(
  camera: Camera,
  keys: Keys,
  isFast: boolean,
  seconds: number,
  eyeHeight: number,
): readonly [number, number] {
  const { azimuth } = headingOfView(camera);
  const level: Camera = {
    ...camera,
    eye: [0, 0, 0],
    target: [Math.cos(azimuth), Math.sin(azimuth), 0],
    up: worldUp,
  };
  const onGround = new Set([...keys].filter((key) => key !== "KeyE" && key !== "KeyQ"));
  const [x, y] = flyDirection(level, onGround);
  const speed = eyeHeightsPerSecond * eyeHeight * (isFast ? fasterFactor : 1);
  const metres = speed * clamp(seconds, 0, longestStepSeconds);
  return [x * metres, y * metres];
}

/** The same view from `eye`. */
export const seenFrom = (camera: Camera, eye: Vec3): Camera =>
  translate(camera, subtract(eye, camera.eye));
