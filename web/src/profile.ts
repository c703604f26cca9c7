// SPDX-License-Identifier: Apache-2.0
// Heights along a line: what a chart of them shows, and the ground for a walk.
import type { Vec3 } from "./camera/camera";
import { length, subtract } from "./camera/camera";
import type { Ground } from "./camera/walk";
import type { ViewerProfiled } from "./protocol/messages";

export interface ProfileSample {
  position: Vec3;
  /** The source's surface is so near to it, in whatever direction, metres. */
  error: number;
}

/** The topmost points above a line on the map, evenly spaced; undefined where there is nothing. */
export interface Profile {
  from: Vec3;
  to: Vec3;
  samples: readonly (ProfileSample | undefined)[];
}

export interface ProfileChart {
  /** On the map, metres. */
  length: number;
  lowest: number;
  highest: number;
  /** The largest of the points' errors. */
  error: number;
  /** Of points one after the other: way from the start and height, metres. */
  runs: [number, number][][];
}

/** World metres, not exaggerated. */
export const heightOf = (sample: ProfileSample): number => sample.position[2];

export function chartOf({ from, to, samples }: Profile): ProfileChart {
  const [dx, dy] = subtract(to, from);
  const whole = length([dx, dy, 0]);
  const found = samples.filter((sample) => sample !== undefined);
  const runs: [number, number][][] = [[]];
  samples.forEach((sample, i) => {
    const way = (whole * i) / Math.max(1, samples.length - 1);
    if (sample !== undefined) runs[runs.length - 1]?.push([way, heightOf(sample)]);
    else if (runs[runs.length - 1]?.length !== 0) runs.push([]);
  });
  return {
    length: whole,
    lowest: Math.min(...found.map(heightOf)),
    highest: Math.max(...found.map(heightOf)),
    error: Math.max(0, ...found.map(({ error }) => error)),
    runs: runs.filter((run) => run.length > 0),
  };
}

/** At a share of the way, that of the nearest sample. */
export function heightAlong({ samples }: Profile, share: number): number | undefined {
  const sample = samples[Math.round(share * (samples.length - 1))];
  return sample === undefined ? undefined : heightOf(sample);
}

/**
 * The ground as it is drawn; undefined where the answer is none. Exaggerated heights are those of
 * terrain that its scene does not scale.
 */
export function groundOf(
  answer: ViewerProfiled,
  from: Ground["from"],
  to: Ground["to"],
  exaggeration: number,
): Ground | undefined {
  if (answer.problem !== "" || answer.samples.length < 2) return undefined;
  const heights = answer.samples.map(({ point }) =>
    point?.position === undefined
      ? undefined
      : point.position.z + (exaggeration - 1) * (point.elevation ?? 0),
  );
  return { from, to, heights };
}
