// SPDX-License-Identifier: Apache-2.0
// From pointer, wheel and keys to a camera. The geometry is in orbit.ts, fly.ts and touch.ts.
import type { Aim } from "../aim";
import type { Camera } from "./camera";
import { isCommand, letterOf } from "./commands";
import { isScrolled, isSheetOpen, isText, isTyping, targetOf } from "./typing";
import type { Keys } from "./fly";
import { fly, isFlyKey, look } from "./fly";
import type { DistanceLimits } from "./orbit";
import { orbit, pan, zoom } from "./orbit";
import type { Point } from "./touch";
import { pinch } from "./touch";

/** What the controls move. */
export interface CameraHolder {
  readonly camera: Camera | null;
  readonly limits: DistanceLimits;
  /** `inputTime`: of the event that caused it, in ms of performance.now(). */
  move(camera: Camera, inputTime: number): void;
  goHome(inputTime: number): void;
  /** The last pointer was let go. */
  dragEnded(): void;
  /** A click, or a tap, that dragged nothing; offset from the canvas's upper left corner. */
  clicked(at: Point): void;
  doubleClicked(at: Point): void;
  /** What hands at a point of the canvas are on; undefined where the picture is the camera's own. */
  aimAt(at: Point): Aim | undefined;
  readonly isFlying: boolean;
  setFlying(isFlying: boolean): void;
  readonly isWalking: boolean;
  setWalking(isWalking: boolean): void;
  walk(keys: Keys, isFast: boolean, seconds: number, time: number): void;
  /** Makes the walker taller or smaller. */
  scaleWalker(factor: number, time: number): void;
}

const radiansPerPixel = 0.006;
const radiansPerKey = (4 * Math.PI) / 180;
const pixelsPerKey = 40;
const zoomPerKey = 0.9;
/** Of the wheel: one notch of a mouse is about 100 pixels, and zooms by a seventh. */
const zoomPerWheelPixel = 0.0015;
const largestWheelStep = 240;
/** Of a trackpad's pinch, which comes as a wheel with Ctrl: the scene follows the fingers. */
const zoomPerPinchPixel = 0.01;
/** A mouse's wheel turned with Ctrl cannot be told from a pinch, and is not to leap. */
const largestPinchStep = 50;
const pixelsPerLine = 33;

/** A hand that clicks moves the pointer by no more, in CSS pixels. */
const clickSlack = 4;

/** Two fingers, while walking. */
const walkSecondsPerPixel = 0.01;

/** The ground follows the fingers: down the screen is ahead. */
function keysOfFingers(dx: number, dy: number): Keys {
  if (Math.abs(dy) >= Math.abs(dx)) return new Set([dy > 0 ? "KeyW" : "KeyS"]);
  return new Set([dx > 0 ? "KeyA" : "KeyD"]);
}

interface Pointer extends Point {
  isPan: boolean;
  /** Where it went down, while it may yet become a click. */
  downAt: Point | undefined;
}

/** What of a click is left after the pointer has gone to `to`. */
export function clickAfter(downAt: Point | undefined, to: Point): Point | undefined {
  const isNear = downAt && Math.hypot(to.x - downAt.x, to.y - downAt.y) <= clickSlack;
  return isNear ? downAt : undefined;
}

export class Controls {
  private readonly pointers = new Map<number, Pointer>();
  private readonly keys = new Set<string>();
  private isFast = false;
  private flyFrame: number | undefined;
  private lastFlyTime = 0;
  private readonly ending = new AbortController();

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly holder: CameraHolder,
  ) {
    const { signal } = this.ending;
    canvas.addEventListener("pointerdown", (event) => this.pointerDown(event), { signal });
    canvas.addEventListener("pointermove", (event) => this.pointerMove(event), { signal });
    // The same at once, and not with the next animation frame; not in all browsers.
    canvas.addEventListener(
      "pointerrawupdate",
      (event) => this.pointerMove(event as PointerEvent),
      {
        signal,
      },
    );
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const)
      canvas.addEventListener(end, (event) => this.pointerEnd(event), { signal });
    canvas.addEventListener("dblclick", (event) => this.doubleClick(event), { signal });
    canvas.addEventListener("wheel", (event) => this.wheel(event), { signal, passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault(), { signal });
    window.addEventListener("keydown", (event) => this.keyDown(event), { signal });
    window.addEventListener("keyup", (event) => this.keyUp(event), { signal });
    window.addEventListener("blur", () => this.releaseKeys(), { signal });
  }

  close(): void {
    this.ending.abort();
    this.releaseKeys();
  }

  get isDragging(): boolean {
    return this.pointers.size > 0;
  }

  /** What hands at a point of the window are on. */
  private aimAt(point: Point): Aim {
    const box = this.canvas.getBoundingClientRect();
    const fromCentre = {
      x: point.x - box.left - box.width / 2,
      y: point.y - box.top - box.height / 2,
    };
    const aim = this.holder.aimAt(this.onCanvas(point));
    return aim ?? { ...fromCentre, perPixel: { x: 1, y: 1 } };
  }

  /** The scene follows a hand at `from` by so many pixels. */
  private panned(camera: Camera, from: Point, dx: number, dy: number): Camera {
    const { perPixel } = this.aimAt(from);
    return pan(camera, dx * perPixel.x, dy * perPixel.y, this.height);
  }

  private onCanvas(point: Point): Point {
    const box = this.canvas.getBoundingClientRect();
    return { x: point.x - box.left, y: point.y - box.top };
  }

  /** Of the canvas, in the window. */
  private get middle(): Point {
    const box = this.canvas.getBoundingClientRect();
    return { x: box.left + box.width / 2, y: box.top + box.height / 2 };
  }

  private get height(): number {
    return this.canvas.clientHeight;
  }

  // ---- Pointers

  private pointerDown(event: PointerEvent): void {
    if (event.pointerType === "mouse" && event.button > 2) return;
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    const isPan = event.button !== 0 || event.shiftKey;
    const [x, y] = [event.clientX, event.clientY];
    const downAt = isPan || this.isDragging ? undefined : { x, y };
    if (this.isDragging) for (const other of this.pointers.values()) other.downAt = undefined;
    this.pointers.set(event.pointerId, { x, y, isPan, downAt });
    event.preventDefault();
  }

  private pointerEnd(event: PointerEvent): void {
    const pointer = this.pointers.get(event.pointerId);
    if (pointer === undefined) return;
    this.pointers.delete(event.pointerId);
    if (!this.isDragging) this.holder.dragEnded();
    if (event.type === "pointerup" && pointer.downAt !== undefined)
      this.holder.clicked(this.onCanvas(pointer.downAt));
  }

  private doubleClick(event: MouseEvent): void {
    this.holder.doubleClicked(this.onCanvas({ x: event.clientX, y: event.clientY }));
  }

  private pointerMove(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    if (before === undefined) return;
    const to = { x: event.clientX, y: event.clientY };
    // What may be a click leaves the scene where it is; a drag starts from where it went down.
    if (clickAfter(before.downAt, to) !== undefined) return;
    const after = { ...before, ...to, downAt: undefined };
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId);
    this.pointers.set(event.pointerId, after);
    const other = others[0]?.[1];
    if (other === undefined) this.drag(before, after, event.timeStamp);
    else if (others.length === 1) this.pinch([before, other], [after, other], event.timeStamp);
  }

  private drag(before: Pointer, after: Pointer, time: number): void {
    const dx = after.x - before.x;
    const dy = after.y - before.y;
    if (dx === 0 && dy === 0) return;
    this.change(time, (camera) => {
      if (before.isPan && !this.holder.isWalking) return this.panned(camera, before, dx, dy);
      const [azimuth, elevation] = [-dx * radiansPerPixel, dy * radiansPerPixel];
      // The scene follows the pointer when orbiting; the view does when looking around.
      if (this.looksAround) return look(camera, azimuth, -elevation);
      return orbit(camera, azimuth, elevation);
    });
  }

  private pinch(before: [Point, Point], after: [Point, Point], time: number): void {
    const { dx, dy, factor, turn, centre } = pinch(before, after);
    if (this.holder.isWalking) {
      this.holder.scaleWalker(factor, time);
      const seconds = Math.max(Math.abs(dx), Math.abs(dy)) * walkSecondsPerPixel;
      return this.holder.walk(keysOfFingers(dx, dy), false, seconds, time);
    }
    const { x, y } = this.aimAt(centre);
    this.change(time, (camera) => {
      const shifted = this.panned(camera, centre, dx, dy);
      const nearer = zoom(shifted, factor, x, y, this.height, this.holder.limits);
      // The scene turns with the fingers, seen from above or from below.
      return orbit(nearer, camera.eye[2] >= camera.target[2] ? turn : -turn, 0);
    });
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const unit = event.deltaMode === 0 ? 1 : event.deltaMode === 1 ? pixelsPerLine : this.height;
    const isPinch = event.ctrlKey && event.deltaMode === 0;
    const [most, perPixel] = isPinch
      ? [largestPinchStep, zoomPerPinchPixel]
      : [largestWheelStep, zoomPerWheelPixel];
    const step = Math.max(-most, Math.min(most, event.deltaY * unit));
    const { x, y } = this.aimAt({ x: event.clientX, y: event.clientY });
    this.zoomBy(Math.exp(step * perPixel), x, y, event.timeStamp);
  }

  private get looksAround(): boolean {
    return this.holder.isFlying || this.holder.isWalking;
  }

  private zoomBy(factor: number, x: number, y: number, time: number): void {
    if (this.holder.isWalking) return this.holder.scaleWalker(factor, time);
    this.change(time, (camera) => zoom(camera, factor, x, y, this.height, this.holder.limits));
  }

  private change(time: number, by: (camera: Camera) => Camera): void {
    if (this.holder.camera !== null) this.holder.move(by(this.holder.camera), time);
  }

  // ---- Keys

  private keyDown(event: KeyboardEvent): void {
    this.isFast = event.shiftKey;
    if (event.ctrlKey || event.metaKey || event.altKey || isText(targetOf(event))) return;
    if (isFlyKey(event.code) && !isCommand(letterOf(event))) this.flyKeyDown(event);
    else if (this.otherKeyDown(event)) event.preventDefault();
  }

  /** True for a key that means something here. */
  private otherKeyDown(event: KeyboardEvent): boolean {
    const time = event.timeStamp;
    switch (letterOf(event)) {
      case "r":
      case "R":
        this.holder.goHome(time);
        return true;
      case "f":
      case "F":
        if (!event.repeat) this.holder.setFlying(!this.holder.isFlying);
        return true;
      case "t":
      case "T":
        if (!event.repeat) this.holder.setWalking(!this.holder.isWalking);
        return true;
      case "Escape":
        if (isSheetOpen()) return false;
        this.holder.setFlying(false);
        this.holder.setWalking(false);
        return false;
      case "+":
      case "=":
        this.zoomBy(zoomPerKey, 0, 0, time);
        return true;
      case "-":
      case "_":
        this.zoomBy(1 / zoomPerKey, 0, 0, time);
        return true;
      default:
        if (isTyping(targetOf(event)) || isScrolled(event.target)) return false;
        return this.placeKeyDown(event);
    }
  }

  /** Keys that move a slider, too, choose among radio buttons, or scroll the panel. */
  private placeKeyDown(event: KeyboardEvent): boolean {
    if (event.key === "Home") {
      this.holder.goHome(event.timeStamp);
      return true;
    }
    const x = Number(event.key === "ArrowRight") - Number(event.key === "ArrowLeft");
    const y = Number(event.key === "ArrowDown") - Number(event.key === "ArrowUp");
    if (x === 0 && y === 0) return false;
    this.change(event.timeStamp, (camera) => {
      if (event.shiftKey && !this.holder.isWalking)
        return this.panned(camera, this.middle, -x * pixelsPerKey, -y * pixelsPerKey);
      // To the right: the eye goes there, or looks there.
      if (this.looksAround) return look(camera, -x * radiansPerKey, -y * radiansPerKey);
      return orbit(camera, x * radiansPerKey, -y * radiansPerKey);
    });
    return true;
  }

  private keyUp(event: KeyboardEvent): void {
    this.isFast = event.shiftKey;
    this.keys.delete(event.code);
    // macOS does not tell which keys go up while Cmd is down.
    if (event.key === "Meta") this.keys.clear();
  }

  private releaseKeys(): void {
    this.keys.clear();
    this.pointers.clear();
  }

  private flyKeyDown(event: KeyboardEvent): void {
    event.preventDefault();
    if (!this.holder.isWalking) this.holder.setFlying(true);
    this.keys.add(event.code);
    if (this.flyFrame !== undefined) return;
    this.lastFlyTime = event.timeStamp;
    this.flyFrame = requestAnimationFrame((now) => this.flyStep(now));
  }

  /** Runs while a key is held. */
  private flyStep(now: number): void {
    const seconds = (now - this.lastFlyTime) / 1000;
    this.lastFlyTime = now;
    if (this.holder.isWalking) this.holder.walk(this.keys, this.isFast, seconds, now);
    else this.change(now, (camera) => fly(camera, this.keys, this.isFast, seconds));
    this.flyFrame =
      this.keys.size > 0 ? requestAnimationFrame((next) => this.flyStep(next)) : undefined;
  }
}
