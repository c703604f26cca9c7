// SPDX-License-Identifier: Apache-2.0

/** A place on the picture, in pixels. */
export interface Point {
  x: number;
  y: number;
}

/** What two fingers did: moved their middle, and changed their distance. */
export interface Pinch {
  dx: number;
  dy: number;
  /** Of the distance between the fingers, before by after: below 1 when they spread. */
  factor: number;
  /** Where their middle is now. */
  centre: Point;
}

/** Fingers closer than this, in pixels, are too near for a ratio to mean anything. */
const closestFingers = 10;

const middle = (a: Point, b: Point): Point => ({ x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 });
const apart = (a: Point, b: Point): number =>
  Math.max(closestFingers, Math.hypot(a.x - b.x, a.y - b.y));

/** Two fingers went from `before` to `after`. */
export function pinch(before: readonly [Point, Point], after: readonly [Point, Point]): Pinch {
  const from = middle(...before);
  const to = middle(...after);
  return {
    dx: to.x - from.x,
    dy: to.y - from.y,
    factor: apart(...before) / apart(...after),
    centre: to,
  };
}
