// SPDX-License-Identifier: Apache-2.0
// Camera paths of older programs, as text:
// - eqPly's: a model rotation (3 degrees), then steps "frames x y z heading pitch roll", metres in
//   a model that is fitted into a box of 2, turned first and moved then; linear in between;
// - one camera a line: eye, up and view-plane normal, nine numbers.
// Neither says how long a frame is: 30 of them are a second. fabric/camera_path.h reads the same, and
// a test compares them.
import type { Camera, Vec3 } from "../camera/camera";
import { add, dot, length, scale, subtract } from "../camera/camera";
import type { Bounds } from "../camera/standard";
import type { Flight, FlightKey } from "./flight";
import { problemOf } from "./flight";

export const framesPerSecond = 30;

/** More are two hours, and taken for a mistake. */
const mostKeys = 250_000;

/** Between two steps a key at least so often, so that the curve keeps to the straight way. */
const keysPerStep = 8;
const degreesPerKey = 3;

/** Of a path that is read: `note` says what had to be assumed, for the user to read. */
export interface ReadPath {
  flight: Flight;
  note: string;
}

type Rows = readonly (readonly number[])[];

/** Rows, as rotations multiply. */
type Matrix = readonly [Vec3, Vec3, Vec3];

const times = (m: Matrix, v: Vec3): Vec3 => [dot(m[0], v), dot(m[1], v), dot(m[2], v)];
const transposed = ([a, b, c]: Matrix): Matrix => [
  [a[0], b[0], c[0]],
  [a[1], b[1], c[1]],
  [a[2], b[2], c[2]],
];
const product = (a: Matrix, b: Matrix): Matrix => {
  const columns = transposed(b);
  const row = (v: Vec3): Vec3 => times(columns, v);
  return [row(a[0]), row(a[1]), row(a[2])];
};

/** About x, then y, then z, each about the axis as it has been turned. */
function turned([x, y, z]: Vec3): Matrix {
  const [cx, cy, cz] = [Math.cos(x), Math.cos(y), Math.cos(z)];
  const [sx, sy, sz] = [Math.sin(x), Math.sin(y), Math.sin(z)];
  const aboutX: Matrix = [
    [1, 0, 0],
    [0, cx, -sx],
    [0, sx, cx],
  ];
  const aboutY: Matrix = [
    [cy, 0, sy],
    [0, 1, 0],
    [-sy, 0, cy],
  ];
  const aboutZ: Matrix = [
    [cz, -sz, 0],
    [sz, cz, 0],
    [0, 0, 1],
  ];
  return product(product(aboutX, aboutY), aboutZ);
}

const centreOf = ({ min, max }: Bounds): Vec3 => scale(add(min, max), 0.5);

/** As far ahead as the scene's middle is, so that orbiting goes on about it. */
function lookingAlong(eye: Vec3, ahead: Vec3, up: Vec3, bounds: Bounds, fovy: number): Camera {
  const centre = centreOf(bounds);
  const size = length(subtract(bounds.max, bounds.min)) || 1;
  const reach = Math.max(length(subtract(centre, eye)), 0.05 * size) / (length(ahead) || 1);
  return { eye, target: add(eye, scale(ahead, reach)), up, fovyDegrees: fovy };
}

interface Step {
  frame: number;
  position: Vec3;
  /** Radians about x, y and z. */
  rotation: Vec3;
}

const radians = (degrees: number): number => (degrees * Math.PI) / 180;
const mix = (a: Vec3, b: Vec3, share: number): Vec3 => add(a, scale(subtract(b, a), share));

function stepsOf(rows: Rows): Step[] {
  let frame = 0;
  return rows.map(([frames = 0, x = 0, y = 0, z = 0, heading = 0, pitch = 0, roll = 0]) => {
    frame += Math.max(1, Math.trunc(frames));
    const rotation: Vec3 = [radians(-pitch), radians(heading), radians(roll)];
    return { frame, position: [x, y, z], rotation };
  });
}

/** How many keys the way from one step to the next has, its end left out. */
function keysBetween(from: Step, to: Step): number {
  const angle = Math.max(...subtract(to.rotation, from.rotation).map(Math.abs));
  // Turns of whole keys come out of radians with rounding, which is not to make one more of them.
  const wanted = Math.max(keysPerStep, Math.ceil(angle / radians(degreesPerKey) - 1e-9));
  return Math.min(to.frame - from.frame, wanted);
}

const tooManyKeys = () =>
  new Error(`the path has more than ${mostKeys} cameras; cut it into several`);

/** Linear from step to step, at whole frames. */
function sampled(steps: readonly Step[]): Step[] {
  let keys = 0;
  return steps.flatMap((from, i) => {
    const to = steps[i + 1];
    if (to === undefined) return [from];
    const frames = to.frame - from.frame;
    const count = keysBetween(from, to);
    keys += count;
    if (!(keys < mostKeys)) throw tooManyKeys();
    return Array.from({ length: count }, (_, k) => ({
      frame: from.frame + (frames * k) / count,
      position: mix(from.position, to.position, k / count),
      rotation: mix(from.rotation, to.rotation, k / count),
    }));
  });
}

function eqPlyPath(rows: Rows, bounds: Bounds, fovy: number): FlightKey[] {
  const [x = 0, y = 0, z = 0] = rows[0] ?? [];
  const model = turned([radians(x), radians(y), radians(z)]);
  const steps = sampled(stepsOf(rows.slice(1)));
  const half = Math.max(...subtract(bounds.max, bounds.min)) / 2 || 1;
  return steps.map(({ frame, position, rotation }) => {
    // view = rotation * (model * world + position), so the way back is of the transposed.
    const worldFromView = transposed(product(turned(rotation), model));
    const eye = scale(times(transposed(model), position), -half);
    return {
      seconds: (frame - (steps[0]?.frame ?? 0)) / framesPerSecond,
      camera: lookingAlong(
        add(centreOf(bounds), eye),
        times(worldFromView, [0, 0, -1]),
        times(worldFromView, [0, 1, 0]),
        bounds,
        fovy,
      ),
    };
  });
}

interface Normals {
  keys: FlightKey[];
  pointAhead: boolean;
}

/** The normal points at the eye or away from it, as programs had it: whichever sees the scene. */
function normalsPath(rows: Rows, bounds: Bounds, fovy: number): Normals {
  if (rows.length > mostKeys) throw tooManyKeys();
  const lines = rows.map((row): [Vec3, Vec3, Vec3] => {
    const [a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0, i = 0] = row;
    return [
      [a, b, c],
      [d, e, f],
      [g, h, i],
    ];
  });
  const centre = centreOf(bounds);
  const votes = lines.map(([eye, , normal]) => Math.sign(dot(normal, subtract(centre, eye))));
  const pointAhead = votes.reduce((sum, vote) => sum + vote, 0) > 0;
  const keys = lines.map(([eye, up, normal], i) => {
    const ahead = pointAhead ? normal : scale(normal, -1);
    return { seconds: i / framesPerSecond, camera: lookingAlong(eye, ahead, up, bounds, fovy) };
  });
  return { keys, pointAhead };
}

const decimal = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

const numberIn = (word: string): number => (decimal.test(word) ? Number(word) : Number.NaN);

function numbersOf(text: string): Rows {
  return text
    .split("\n")
    .map((line) => line.replace(/^[ \t\v\f\r]+|[ \t\v\f\r]+$/g, ""))
    .flatMap((line, i) => {
      if (line === "") return [];
      const numbers = line.split(/[ \t\v\f\r,]+/).map(numberIn);
      if (numbers.every(Number.isFinite)) return [numbers];
      throw new Error(`line ${i + 1} has something else than numbers`);
    });
}

/** The path in a text; throws an Error for the user to read where it is none. */
export function pathOf(text: string, name: string, bounds: Bounds, fovyDegrees: number): ReadPath {
  const rows = numbersOf(text);
  const isEqPly = rows[0]?.length === 3 && rows.slice(1).every(({ length }) => length === 7);
  const isNormals = rows.every(({ length }) => length === 9);
  if (rows.length < 2 || (!isEqPly && !isNormals))
    throw new Error(
      "a path has a line of 3 numbers and then lines of 7 (eqPly), or lines of 9 (eye, up, normal)",
    );
  const rate = `${framesPerSecond} frames a second`;
  let keys: FlightKey[];
  let note: string;
  if (isEqPly) {
    keys = eqPlyPath(rows, bounds, fovyDegrees);
    note = `An eqPly path, at ${rate}, the scene as its model`;
  } else {
    const found = normalsPath(rows, bounds, fovyDegrees);
    keys = found.keys;
    note = `Eyes, ups and normals, at ${rate}; the normals point ${found.pointAhead ? "ahead" : "at the eye"}`;
  }
  const problem = problemOf(keys);
  if (problem !== undefined) throw new Error(problem);
  return { flight: { name, keys }, note };
}
