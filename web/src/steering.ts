// SPDX-License-Identifier: Apache-2.0
import type { Aim } from "./aim";
import { aimAt, middleOf } from "./aim";
import type { Camera, Vec3 } from "./camera/camera";
import { add, isUsable } from "./camera/camera";
import type { CameraHolder } from "./camera/controls";
import { Controls } from "./camera/controls";
import type { Keys } from "./camera/fly";
import type { DistanceLimits } from "./camera/orbit";
import { distanceLimits } from "./camera/orbit";
import type { Bounds, Direction } from "./camera/standard";
import { directionOfView, standardCamera, standardViews } from "./camera/standard";
import type { Point } from "./camera/touch";
import { seenFrom } from "./camera/walk";
import { homeOf, objectBounds, wholeBounds } from "./drawn_bounds";
import type { State } from "./state";
import type { Size } from "./view/size";
import type { WalkerEvents } from "./walker";
import { Walker } from "./walker";

export interface SteeringEvents {
  /** There is another camera; `inputTime`: of the event that caused it, if one did. */
  moved(inputTime: number | undefined): void;
  /** The same camera shows something else: a walk has begun or ended. */
  changed(): void;
  /** The picture was clicked at; `turns`: the camera is to turn there. */
  clicked(at: Point, turns: boolean): void;
  /** Asks for the ground on which a walk goes on. */
  ask: WalkerEvents["ask"];
  /** No view was sent since the one of that sequence. */
  isNewest(sequence: number): boolean;
  /** In CSS pixels. */
  canvasSize(): Size;
}

/** The camera, and all that moves it: hands, keys, walks, flights, and views of the scene. */
export class Steering implements CameraHolder {
  camera: Camera | null = null;
  limits: DistanceLimits = distanceLimits(1);

  /** How often the camera was moved, by whomever. */
  movements = 0;

  private readonly controls: Controls;
  private readonly walker: Walker;
  /** What the last frame said of the camera of its view. */
  private lifted: { camera: Camera | undefined; sequence: number } = {
    camera: undefined,
    sequence: 0,
  };
  /** How far its eye is below where others may be, where it may be there. */
  private lift: Vec3 | undefined;
  /** The camera with which a walk has ended. */
  private walked: Camera | null = null;
  /** The last camera of a flight. */
  private flown: Camera | null = null;
  /** Hands steer on from a flight, or from another's view, under ground, and have not come out of it. */
  private staysUnderground = false;
  private readonly unwatch: readonly (() => void)[];

  constructor(
    canvas: HTMLCanvasElement,
    private readonly state: State,
    private readonly events: SteeringEvents,
  ) {
    this.controls = new Controls(canvas, this);
    this.walker = new Walker({
      moved: (camera, time) => this.moveTo(camera, time),
      ask: (from, to, samples, answered) => events.ask(from, to, samples, answered),
      failed: (isAnswered) => this.walkFailed(isAnswered),
    });
    this.unwatch = [
      state.walking.watch((isWalking) => this.walkingChanged(isWalking)),
      this.keepWalkerOnGround(),
    ];
  }

  close(): void {
    for (const end of this.unwatch) end();
    this.controls.close();
  }

  get isDragging(): boolean {
    return this.controls.isDragging;
  }

  /** Another moves the view, or nobody: this page only sees it. */
  get isWatching(): boolean {
    return this.state.isWatching;
  }

  get watchingText(): string {
    return this.state.watchingText("move the view");
  }

  get isFlying(): boolean {
    return this.state.flying.value;
  }

  setFlying(isFlying: boolean): void {
    if (isFlying && this.isWatching) return this.state.notice.set(this.watchingText);
    if (isFlying) this.state.walking.set(false);
    this.state.flying.set(isFlying);
  }

  get isWalking(): boolean {
    return this.state.walking.value;
  }

  setWalking(isWalking: boolean): void {
    if (isWalking && this.isWatching) return this.state.notice.set(this.watchingText);
    if (isWalking && this.camera === null) return this.walkFailed(false);
    if (isWalking) this.state.flying.set(false);
    this.state.walking.set(isWalking);
  }

  private walkFailed(isAnswered: boolean): void {
    this.state.walking.set(false);
    this.state.notice.set(
      isAnswered
        ? "There is no ground to stand on there"
        : "The ground cannot be asked for now: try again when pictures come",
    );
  }

  walk(keys: Keys, isFast: boolean, seconds: number, time: number): void {
    this.walker.walk(keys, isFast, seconds, time);
  }

  scaleWalker(factor: number, time: number): void {
    this.walker.scale(factor, time);
  }

  private walkingChanged(isWalking: boolean): void {
    if (isWalking) this.staysUnderground = false;
    if (isWalking && this.camera !== null) this.walker.begin(this.camera);
    else {
      this.walker.end();
      this.comeOut();
      this.walked = this.camera;
    }
    this.events.changed();
  }

  /** To where the server would lift the eye, before it does: no picture looks down from there. */
  private comeOut(): void {
    const isFree = this.goesUnderground || this.state.look.value.underground;
    if (this.camera === null || this.lift === undefined || isFree) return;
    this.camera = seenFrom(this.camera, add(this.camera.eye, this.lift));
  }

  /** Returns how to end that. */
  private keepWalkerOnGround(): () => void {
    const { look } = this.state;
    let [exaggeration, hidden] = [look.value.exaggeration, look.value.hidden];
    return look.watch((now) => {
      const isSame = now.exaggeration === exaggeration && now.hidden === hidden;
      ({ exaggeration, hidden } = now);
      if (!isSame) this.walker.groundChanged();
    });
  }

  move(camera: Camera, inputTime?: number): void {
    if (this.isFlown) this.staysUnderground = this.lift !== undefined;
    if (this.isWalking && isUsable(camera)) {
      if (this.walker.isAt(camera)) this.walker.turned(camera);
      else this.state.walking.set(false);
    }
    this.moveTo(camera, inputTime);
  }

  private moveTo(camera: Camera, inputTime?: number): void {
    if (!isUsable(camera)) return;
    if (this.isWatching) {
      if (inputTime !== undefined) this.state.notice.set(this.watchingText);
      return;
    }
    this.camera = camera;
    this.movements += 1;
    this.events.moved(inputTime);
  }

  /** To a view that does not go on from the last one; one that is under ground may have it so. */
  jumpTo(camera: Camera, inputTime?: number, staysUnderground = false): void {
    this.flown = null;
    this.staysUnderground = staysUnderground;
    this.callOffWalk();
    this.move(camera, inputTime);
  }

  /** The camera is led no more, and stays where it is, until it comes out of the ground if it is there. */
  stayUnderground(): void {
    this.staysUnderground = true;
  }

  /** To a camera of a flight, which may have been recorded walking: nothing lifts it. */
  moveAlong(camera: Camera): void {
    this.flown = camera;
    this.callOffWalk();
    this.move(camera);
  }

  /** One that still asks for its ground would lead back to where it was to begin. */
  private callOffWalk(): void {
    if (!this.walker.stands) this.state.walking.set(false);
  }

  goHome(inputTime?: number): void {
    const session = this.state.session.value;
    const home = session && homeOf(session, this.state.look.value.exaggeration, this.aspect);
    if (home) this.jumpTo(home, inputTime);
  }

  /** From where maps and drawings show things; `index` in standardViews. */
  goTo(index: number, inputTime?: number): void {
    const [view, session] = [standardViews[index], this.state.session.value];
    const bounds = session && wholeBounds(session, this.state.look.value.exaggeration);
    if (view !== undefined && bounds) this.frame(bounds, view, inputTime);
  }

  /** One object in the middle of the picture, from the direction that it is seen from now. */
  goToObject(object: number): void {
    const { session, look } = this.state;
    const bounds = objectBounds(session.value?.objects[object], look.value.exaggeration);
    if (bounds === undefined || this.camera === null) return;
    this.frame(bounds, directionOfView(this.camera), performance.now());
  }

  private frame(bounds: Bounds, from: Direction, inputTime: number | undefined): void {
    const fovyDegrees = this.camera?.fovyDegrees ?? 45;
    this.jumpTo(standardCamera(from, bounds, this.aspect, fovyDegrees), inputTime);
  }

  private get aspect(): number {
    const { width, height } = this.events.canvasSize();
    return width / Math.max(1, height);
  }

  clicked(at: Point): void {
    this.events.clicked(at, false);
  }

  /** Turns to the point and, from then on, about it. */
  doubleClicked(at: Point): void {
    this.events.clicked(at, true);
  }

  /** Clicks at the middle of the picture, for those without a pointer. */
  clickMiddle(): void {
    this.clicked(middleOf(this.state.shown.value, this.events.canvasSize()));
  }

  aimAt(at: Point): Aim | undefined {
    if (this.camera === null) return undefined;
    const { fovyDegrees } = this.camera;
    return aimAt(this.state.shown.value, at, this.events.canvasSize(), fovyDegrees);
  }

  /**
   * Nothing lifts a walk out of the ground, which is nearer to it than the server would let, nor what
   * is shown of a flight, nor who steers on from there.
   */
  get goesUnderground(): boolean {
    return this.isWalking || this.isFlown || this.staysUnderground;
  }

  private get isFlown(): boolean {
    return this.camera !== null && this.camera === this.flown;
  }

  /**
   * A frame says that the server has lifted the camera of its view out of the ground, or not; or how
   * far it would have, where it may not.
   */
  liftedTo(camera: Camera | undefined, lift: Vec3 | undefined, sequence: number): void {
    this.lifted = { camera, sequence };
    this.lift = lift;
    if (lift === undefined) this.staysUnderground = false;
    this.adoptLifted();
  }

  dragEnded(): void {
    this.adoptLifted();
  }

  /**
   * Goes on from the camera that the server lifted out of the ground, so that the next movement
   * starts from what is seen; not while a newer view is on its way, nor during a drag, which so
   * leads back to where it came from.
   */
  private adoptLifted(): void {
    const { camera, sequence } = this.lifted;
    const isNewest = this.events.isNewest(sequence);
    if (camera === undefined || !isNewest || this.isDragging) return;
    // What a walk looks at is near: with the eye alone lifted one would look down at it.
    if (this.camera !== null && this.camera === this.walked)
      this.moveTo(seenFrom(this.camera, camera.eye));
    else this.camera = camera;
  }
}
