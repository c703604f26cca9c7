// SPDX-License-Identifier: Apache-2.0
// A camera's path, as fabric/flight.h has it: the same cameras come out of both, and a test
// compares them. Between keys eye, target, up and field of view follow cubic Hermite curves with
// the slopes of Catmull and Rom, "A class of local interpolating splines" (1974), for keys unevenly
// spaced in time.
import type { Camera, Vec3 } from "../camera/camera";
import { add, clamp, isUsable, scale, subtract } from "../camera/camera";

export interface FlightKey {
  readonly seconds: number;
  readonly camera: Camera;
}

export interface Flight {
  readonly name: string;
  /** At least one; their times ascend. */
  readonly keys: readonly FlightKey[];
}

type Keys = readonly FlightKey[];

/** From the first key to the last. */
export const secondsOf = ({ keys }: Pick<Flight, "keys">): number =>
  (keys[keys.length - 1]?.seconds ?? 0) - (keys[0]?.seconds ?? 0);

/** Weights of the keys before, at both ends of, and after an interval, at a share of it. */
function weightsOf(times: readonly [number, number, number, number], s: number) {
  const [before, from, to, after] = times;
  const length = to - from;
  const s2 = s * s;
  const s3 = s2 * s;
  // At the ends `before` or `after` is the end itself: the slope is then that of the interval.
  const slopeFrom = (length / (to - before)) * (s3 - 2 * s2 + s);
  const slopeTo = (length / (after - from)) * (s3 - s2);
  return [-slopeFrom, 2 * s3 - 3 * s2 + 1 - slopeTo, 3 * s2 - 2 * s3 + slopeFrom, slopeTo] as const;
}

/** The last key that is not after `time`, or -1. */
function indexBefore(keys: Keys, time: number): number {
  let [low, high] = [0, keys.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((keys[middle]?.seconds ?? 0) <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** `seconds` after the first key; before it and after the last one, the camera of that key. */
export function cameraAt({ keys }: Pick<Flight, "keys">, seconds: number): Camera {
  const first = keys[0];
  if (first === undefined) throw new Error("a flight has at least one key");
  const time = first.seconds + seconds;
  const at = indexBefore(keys, time);
  const from = keys[at];
  const to = keys[at + 1];
  if (from === undefined) return first.camera;
  if (to === undefined || time === from.seconds) return from.camera;
  const before = keys[at - 1] ?? from;
  const after = keys[at + 2] ?? to;
  const weights = weightsOf(
    [before.seconds, from.seconds, to.seconds, after.seconds],
    (time - from.seconds) / (to.seconds - from.seconds),
  );
  const cameras = [before.camera, from.camera, to.camera, after.camera] as const;
  // What is far from the origin keeps its digits: differences are weighted, not places.
  const curve = (of: (camera: Camera) => Vec3): Vec3 => {
    const origin = of(from.camera);
    return cameras.reduce<Vec3>(
      (sum, camera, i) => add(sum, scale(subtract(of(camera), origin), weights[i] ?? 0)),
      origin,
    );
  };
  const fovy = cameras.reduce((sum, one, i) => sum + one.fovyDegrees * (weights[i] ?? 0), 0);
  return {
    eye: curve(({ eye }) => eye),
    target: curve(({ target }) => target),
    up: curve(({ up }) => up),
    fovyDegrees: clamp(fovy, 1, 170),
  };
}

/** As fabric/flight.h has it: later ones cannot be told apart. */
const latestSeconds = 1e15;

/** What makes a flight none that can be played, for the user to read, or undefined. */
export function problemOf(keys: Keys): string | undefined {
  if (keys.length === 0) return "it has no keys";
  for (const [i, { seconds, camera }] of keys.entries()) {
    if (!Number.isFinite(seconds)) return `key ${i + 1} has no time`;
    if (Math.abs(seconds) > latestSeconds)
      return `key ${i + 1} is at ${seconds} s; it must be within ${latestSeconds} s`;
    const before = keys[i - 1]?.seconds;
    if (before !== undefined && !(seconds > before))
      return `key ${i + 1}, at ${seconds} s, is not after the one before, at ${before} s`;
    if (!isUsable(camera)) return `the camera of key ${i + 1} spans no picture`;
  }
  return undefined;
}

// ---- Edits; each gives new keys

/** Puts a camera at a time, in place of a key that is there already. */
export function withKey(keys: Keys, key: FlightKey): FlightKey[] {
  const others = keys.filter(({ seconds }) => seconds !== key.seconds);
  return [...others, key].sort((a, b) => a.seconds - b.seconds);
}

export const withoutKey = (keys: Keys, index: number): FlightKey[] =>
  keys.filter((_, i) => i !== index);

/** Undefined where another key has the time, or it is none that a flight may have. */
export function withTime(keys: Keys, index: number, seconds: number): FlightKey[] | undefined {
  const key = keys[index];
  const isTaken = keys.some((one, i) => i !== index && one.seconds === seconds);
  const isTime = Number.isFinite(seconds) && Math.abs(seconds) <= latestSeconds;
  if (key === undefined || isTaken || !isTime) return undefined;
  return withKey(withoutKey(keys, index), { ...key, seconds });
}

export const withCamera = (keys: Keys, index: number, camera: Camera): FlightKey[] =>
  keys.map((key, i) => (i === index ? { ...key, camera } : key));
