// SPDX-License-Identifier: Apache-2.0
// Walks: asks for the ground ahead, in the data at their finest, and moves the eye over it.
import type { Camera, Vec3 } from "./camera/camera";
import { headingOfView, worldUp } from "./camera/camera";
import type { Keys } from "./camera/fly";
import type { Ground } from "./camera/walk";
import { eyeHeightBy, groundAt, seenFrom, stepOf, usualEyeHeight } from "./camera/walk";

export interface WalkerEvents {
  moved(camera: Camera, time: number | undefined): void;
  /** Asks for the ground between two places; false where it cannot be asked now. */
  ask(from: Ground["from"], to: Ground["to"], samples: number, answered: Answered): boolean;
  /** There is no ground where it would begin, or, not answered, none that is known. */
  failed(isAnswered: boolean): void;
}

/** Undefined where no answer comes. */
type Answered = (ground: Ground | undefined) => void;

const samples = 48;
/** So many eye heights ahead are asked for: two seconds at a run. */
const heightsAhead = 24;
/** More is asked for when less than this share of it is left. */
const leastLeft = 0.6;

/** Level, of length 1. */
function aheadOf(camera: Camera): Vec3 {
  const { azimuth } = headingOfView(camera);
  return [Math.cos(azimuth), Math.sin(azimuth), 0];
}

export class Walker {
  eyeHeight = usualEyeHeight;
  private ground: Ground | undefined;
  private isAsking = false;
  /** How often a question was given up. */
  private withdrawals = 0;
  private camera: Camera | undefined;

  constructor(private readonly events: WalkerEvents) {}

  /** Stands where the view looks at, looking level the same way; once the ground is known there. */
  begin(camera: Camera): void {
    this.eyeHeight = usualEyeHeight;
    this.end();
    const { target } = camera;
    const ahead = aheadOf(camera);
    const reach = 10 * this.eyeHeight;
    const there: Camera = {
      ...camera,
      up: worldUp,
      eye: target,
      target: [target[0] + reach * ahead[0], target[1] + reach * ahead[1], target[2]],
    };
    this.ask(there, ahead, (ground) => {
      const z = ground && groundAt(ground, there.eye, this.eyeHeight);
      if (typeof z !== "number") return this.events.failed(ground !== undefined);
      this.stand(there, [there.eye[0], there.eye[1]], z, undefined);
    });
  }

  end(): void {
    this.camera = undefined;
    this.ground = undefined;
    this.withdraw();
  }

  /** Stands on the ground as it is drawn now, once that is known. */
  groundChanged(): void {
    if (this.camera === undefined) return;
    this.withdraw();
    this.ground = undefined;
    this.ask(this.camera, aheadOf(this.camera), (ground) => {
      if (ground === undefined || this.camera === undefined) return; // with the next step, then
      const [x, y] = this.camera.eye;
      const z = groundAt(ground, [x, y], this.eyeHeight);
      if (typeof z === "number") this.stand(this.camera, [x, y], z, undefined);
      else this.events.failed(true);
    });
  }

  /** Whether the walk has begun: not before the ground is known. */
  get stands(): boolean {
    return this.camera !== undefined;
  }

  /** Whether the eye is where the walk has put it: a turned head walks on, a moved one does not. */
  isAt(camera: Camera): boolean {
    return !this.camera || this.camera.eye.every((value, i) => value === camera.eye[i]);
  }

  turned(camera: Camera): void {
    if (this.camera !== undefined) this.camera = camera;
  }

  walk(keys: Keys, isFast: boolean, seconds: number, time: number): void {
    const { camera } = this;
    if (camera === undefined) return;
    const lift = Number(keys.has("KeyE")) - Number(keys.has("KeyQ"));
    if (lift !== 0) this.scale(Math.exp(lift * Math.min(seconds, 0.1)), time);
    const [dx, dy] = stepOf(camera, keys, isFast, seconds, this.eyeHeight);
    if (dx === 0 && dy === 0) return;
    const to = [camera.eye[0] + dx, camera.eye[1] + dy] as const;
    const z = this.ground === undefined ? "beside" : groundAt(this.ground, to, this.eyeHeight);
    if (z === "beside" || this.isNearEnd(to)) this.ask(camera, [dx, dy, 0], () => {});
    // Where the ground is not known yet the eye waits; where it ends it stays.
    if (typeof z === "number") this.stand(camera, to, z, time);
  }

  /** A larger eye height, seen from above and walked at as much faster; or a smaller one. */
  scale(factor: number, time: number): void {
    const { camera } = this;
    if (camera === undefined) return;
    const before = this.eyeHeight;
    this.eyeHeight = eyeHeightBy(before, factor);
    const [x, y, z] = camera.eye;
    this.stand(camera, [x, y], z - before, time);
  }

  private stand(camera: Camera, at: Ground["from"], z: number, time: number | undefined): void {
    this.camera = seenFrom(camera, [at[0], at[1], z + this.eyeHeight]);
    this.events.moved(this.camera, time);
  }

  private isNearEnd(at: Ground["from"]): boolean {
    if (this.ground === undefined) return true;
    const { from: start, to } = this.ground;
    const whole = Math.hypot(to[0] - start[0], to[1] - start[1]);
    return Math.hypot(to[0] - at[0], to[1] - at[1]) < leastLeft * whole;
  }

  /** What was asked for is waited for no more. */
  private withdraw(): void {
    this.withdrawals += 1;
    this.isAsking = false;
  }

  private ask({ eye }: Camera, direction: Vec3, then: Answered): void {
    if (this.isAsking) return;
    const size = Math.hypot(direction[0], direction[1]) || 1;
    const reach = (heightsAhead * this.eyeHeight) / size;
    const start = [eye[0], eye[1]] as const;
    const to = [eye[0] + direction[0] * reach, eye[1] + direction[1] * reach] as const;
    const { withdrawals } = this;
    this.isAsking = this.events.ask(start, to, samples, (ground) => {
      if (withdrawals !== this.withdrawals) return;
      this.isAsking = false;
      if (ground !== undefined) this.ground = ground;
      then(ground);
    });
    if (!this.isAsking) then(undefined);
  }
}
