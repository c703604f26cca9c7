// SPDX-License-Identifier: Apache-2.0
// From many views of a hand to the few keys of a curve that passes by all of them. As Douglas and
// Peucker, "Algorithms for the reduction of the number of points" (1973), but against the curve
// that is played: the worst view of each interval becomes a key until none is off by more than
// asked for.
import type { Camera } from "../camera/camera";
import { distance, length, subtract } from "../camera/camera";
import type { FlightKey } from "./flight";
import { cameraAt } from "./flight";

/** How far eye or target are off, as a share of the distance that is looked at. */
export function offBy(wanted: Camera, found: Camera): number {
  const eye = length(subtract(wanted.eye, found.eye));
  const target = length(subtract(wanted.target, found.target));
  return Math.max(eye, target) / distance(wanted);
}

export interface Fit {
  keys: FlightKey[];
  /** The largest `offBy` of all views. */
  error: number;
}

/** Keys among `views`, whose times ascend, so that each view is off by `tolerance` at most. */
export function fitKeys(views: readonly FlightKey[], tolerance: number): Fit {
  const last = views.length - 1;
  const chosen = new Set([0, last].filter((i) => i >= 0));
  const start = views[0]?.seconds ?? 0;
  for (;;) {
    const indices = [...chosen].sort((a, b) => a - b);
    const keys = indices.flatMap((i) => views[i] ?? []);
    let error = 0;
    for (const [k, from] of indices.entries()) {
      let [worst, worstError] = [-1, tolerance];
      for (let i = from + 1; i < (indices[k + 1] ?? 0); ++i) {
        const view = views[i];
        if (view === undefined) continue;
        const off = offBy(view.camera, cameraAt({ keys }, view.seconds - start));
        error = Math.max(error, off);
        if (off > worstError) [worst, worstError] = [i, off];
      }
      if (worst >= 0) chosen.add(worst);
    }
    if (chosen.size === indices.length) return { keys, error };
  }
}
