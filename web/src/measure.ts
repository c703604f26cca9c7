// SPDX-License-Identifier: Apache-2.0
// Lengths and areas between picked points, and how far off they may be because the points are: each
// is somewhere within its error of where it was picked, in any direction. docs/errors.md#measuring.
import type { Vec3 } from "./camera/camera";
import { length, subtract } from "./camera/camera";

export interface MeasuredPoint {
  position: Vec3;
  /** Metres. */
  error: number;
}

/** A number and how far the true one may be from it. */
export interface Measure {
  value: number;
  error: number;
}

const pairs = <T>(list: readonly T[]): [T, T][] =>
  list.slice(1).map((one, i) => [list[i] as T, one]);

const flat = ({ position: [x, y] }: MeasuredPoint): Vec3 => [x, y, 0];

function along(points: readonly MeasuredPoint[], of: (point: MeasuredPoint) => Vec3): Measure {
  const sum = { value: 0, error: 0 };
  for (const [a, b] of pairs(points)) {
    sum.value += length(subtract(of(b), of(a)));
    sum.error += a.error + b.error;
  }
  return sum;
}

/** Along the straight lines from each point to the next. */
export const pathLength = (points: readonly MeasuredPoint[]): Measure =>
  along(points, ({ position }) => position);

/** The same on the map, whatever the heights. */
export const mapLength = (points: readonly MeasuredPoint[]): Measure => along(points, flat);

/** How much higher the last point is than the first. */
export function rise(points: readonly MeasuredPoint[]): Measure {
  const [first, last] = [points[0], points[points.length - 1]];
  if (first === undefined || last === undefined) return { value: 0, error: 0 };
  return { value: last.position[2] - first.position[2], error: first.error + last.error };
}

/**
 * Of the polygon through the points, on the map, by L. A. J. Meister's formula (1769); where its
 * sides cross, parts count twice or against each other.
 */
export function mapArea(points: readonly MeasuredPoint[]): Measure {
  const at = (i: number): MeasuredPoint =>
    points[(i + points.length) % points.length] as MeasuredPoint;
  const origin = points[0]?.position ?? [0, 0, 0]; // world coordinates are large, areas are not
  let twice = 0;
  let error = 0;
  points.forEach((point, i) => {
    const [before, after] = [at(i - 1), at(i + 1)];
    const [x, y] = subtract(point.position, origin);
    const [nextX, nextY] = subtract(after.position, origin);
    twice += x * nextY - nextX * y;
    // Moving one point changes the area by half its way times the line beside it; two points that
    // move, by half the product of their ways more.
    error +=
      (point.error * length(subtract(flat(after), flat(before)))) / 2 +
      (point.error * after.error) / 2;
  });
  return { value: Math.abs(twice) / 2, error };
}
