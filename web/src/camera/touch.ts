// SPDX-License-Identifier: Apache-2.0

/** A place on the picture, in pixels. */
export interface Point {
  x: number;
  y: number;
}

/** What two fingers did: moved their middle, changed their distance, and turned. */
export interface Pinch {
  dx: number;
  dy: number;
  /** Of the distance between the fingers, before by after: below 1 when they spread. */
  factor: number;
  /** Radians, clockwise as seen. */
  turn: number;
  /** Where their middle is now. */
  centre: Point;
}

/** Fingers closer than this, in pixels, are too near for a ratio to mean anything. */
const closestFingers = 10;

const middle = (a: Point, b: Point): Point => ({ x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 });
const apart = (a: Point, b: Point): number =>
  Math.max(closestFingers, Math.hypot(a.x - b.x, a.y - b.y));

/** Clockwise, for y goes downwards; fingers in one place point nowhere. */
function turnBetween([a, b]: readonly [Point, Point], [c, d]: readonly [Point, Point]): number {
  const [ux, uy, vx, vy] = [b.x - a.x, b.y - a.y, d.x - c.x, d.y - c.y];
  if (Math.hypot(ux, uy) < closestFingers || Math.hypot(vx, vy) < closestFingers) return 0;
  return Math.atan2(ux * vy - uy * vx, ux * vx + uy * vy);
}

/** Two fingers went from `before` to `after`. */
export function pinch(before: readonly [Point, Point], after: readonly [Point, Point]): Pinch {
  const from = middle(...before);
  const to = middle(...after);
  return {
    dx: to.x - from.x,
    dy: to.y - from.y,
    factor: apart(...before) / apart(...after),
    turn: turnBetween(before, after),
    centre: to,
  };
}
