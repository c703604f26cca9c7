// SPDX-License-Identifier: Apache-2.0
import type { Camera } from "./camera/camera";
import { fitToAspect, isUsable } from "./camera/camera";
import { Controls } from "./camera/controls";
import type { CameraHolder } from "./camera/controls";
import type { DistanceLimits } from "./camera/orbit";
import { distanceLimits, lookAt } from "./camera/orbit";
import type { Point } from "./camera/touch";
import { pickOf, placeOf } from "./pick";
import type { Frame, SessionState, Shown, ViewerPicked } from "./protocol/messages";
import { cameraOf } from "./protocol/messages";
import { Socket } from "./protocol/socket";
import type { State } from "./state";
import { PictureCanvas } from "./view/canvas";
import { FrameRate, Latency, limitingStage } from "./view/measure";
import type { Size } from "./view/size";
import { pictureSize, softwarePixels } from "./view/size";

/** A view without its picture for so long is stale. */
const staleAfter = 2000;
const hardwarePixels = 4096 * 4096;

/**
 * A scene on a canvas: sends views, draws frames, moves the camera. Works without any panel:
 *
 *     const state = new State();
 *     new Viewer(canvas, "ws://127.0.0.1:8080/ws", state);
 */
export class Viewer implements CameraHolder {
  camera: Camera | null = null;
  limits: DistanceLimits = distanceLimits(1);

  private readonly canvas: PictureCanvas;
  private readonly socket: Socket;
  private readonly controls: Controls;
  private readonly rate = new FrameRate();
  private readonly latency = new Latency();
  private readonly frames = new Map<number, Frame>();
  private readonly ticker: number;

  private size: Size;
  private sequence = 0;
  /** Views that were sent and not drawn yet. */
  private readonly sentViews = new Map<number, Shown>();
  private pickSequence = 0;
  /** The pick that the camera is to turn to. */
  private turnTo = 0;
  /** Of the last view, as text; empty before any on this connection. */
  private sentContent = "";
  /** What the last frame said of the camera of its view. */
  private lifted: { camera: Camera | undefined; sequence: number } = {
    camera: undefined,
    sequence: 0,
  };
  private sendAt: number | undefined;
  private inputTime: number | undefined;
  private sceneKey = "";

  constructor(
    canvas: HTMLCanvasElement,
    url: string,
    private readonly state: State,
  ) {
    this.canvas = new PictureCanvas(canvas, {
      drawn: (frameNumber, time) => this.drawn(frameNumber, time),
      failed: (frameNumber) => this.acknowledge(frameNumber),
      resized: () => this.resize(),
    });
    this.size = this.wantedSize();
    this.controls = new Controls(canvas, this);
    this.socket = new Socket(url, {
      opened: () => this.opened(),
      lost: () => this.lost(),
      state: (session) => this.sessionChanged(session),
      frame: (frame) => this.frameArrived(frame),
      picked: (answer) => this.picked(answer),
    });
    state.tau.watch(() => this.requestView(performance.now()));
    state.budget.watch(() => this.requestView(performance.now()));
    state.shading.watch(() => this.requestView(performance.now()));
    state.look.watch(() => this.requestView(performance.now()));
    this.ticker = window.setInterval(() => this.tick(), 250);
  }

  close(): void {
    window.clearInterval(this.ticker);
    this.controls.close();
    this.socket.close();
    this.canvas.close();
  }

  // ---- CameraHolder

  get isFlying(): boolean {
    return this.state.flying.value;
  }

  setFlying(isFlying: boolean): void {
    this.state.flying.set(isFlying);
  }

  move(camera: Camera, inputTime?: number): void {
    if (!isUsable(camera)) return;
    this.camera = camera;
    this.requestView(inputTime);
  }

  goHome(inputTime?: number): void {
    const home = cameraOf(this.state.session.value?.home);
    if (home === undefined) return;
    const { width, height } = this.canvas.size();
    this.move(fitToAspect(home, width / Math.max(1, height)), inputTime);
  }

  // ---- Views

  /**
   * Sends the view with the next animation frame: at most one a frame, always the newest.
   * `inputTime` is of the input that caused it, if one did.
   */
  private requestView(inputTime?: number): void {
    this.inputTime ??= inputTime;
    this.sendAt ??= requestAnimationFrame(() => this.sendView());
  }

  private sendView(): void {
    this.sendAt = undefined;
    const inputTime = this.inputTime;
    this.inputTime = undefined;
    if (this.camera === null) return;
    const view = {
      camera: this.camera,
      ...this.size,
      tauPixels: this.state.tau.value,
      budgetMilliseconds: this.state.budget.value,
      shading: this.state.shading.value,
      look: this.state.look.value,
    };
    // The server draws what has changed: it would not answer the same view again.
    const content = JSON.stringify(view);
    if (content === this.sentContent) return;
    const isSent = this.socket.sendView({ sequence: this.sequence + 1, ...view });
    // A view that cannot go now goes when the connection opens, or with the next frame.
    if (!isSent) {
      if (this.state.connection.value.kind === "connected") this.requestView(inputTime);
      return;
    }
    this.sentContent = content;
    this.sequence += 1;
    this.sentViews.set(this.sequence, {
      camera: view.camera,
      ...this.size,
      exaggeration: view.look.exaggeration,
    });
    this.latency.sent(this.sequence, performance.now(), inputTime);
  }

  private wantedSize(): Size {
    const renderers = this.state.session.value?.renderers ?? [];
    const isSoftware = renderers.some((renderer) => renderer.alive && renderer.device?.software);
    const limit = isSoftware || renderers.length === 0 ? softwarePixels : hardwarePixels;
    return pictureSize(this.canvas.size(), window.devicePixelRatio, limit);
  }

  private resize(): void {
    const size = this.wantedSize();
    if (size.width === this.size.width && size.height === this.size.height) return;
    this.size = size;
    this.requestView();
  }

  // ---- The server

  private opened(): void {
    this.state.connection.set({ kind: "connected" });
    this.requestView();
  }

  private lost(): void {
    this.latency.reset();
    this.frames.clear();
    if (this.state.pick.value?.kind === "asking") this.state.pick.set(null);
    this.inputTime = undefined;
    this.sentContent = "";
    this.state.connection.set({ kind: "lost", since: performance.now() });
  }

  private sessionChanged(session: SessionState): void {
    this.state.session.set(session);
    const { min, max } = session.sceneBounds ?? {};
    if (min !== undefined && max !== undefined) {
      const diagonal = Math.hypot(max.x - min.x, max.y - min.y, max.z - min.z);
      this.limits = distanceLimits(diagonal);
      const key = [min.x, min.y, min.z, max.x, max.y, max.z].join();
      // Another scene starts at its own home; after a reconnection the camera stays.
      if (this.camera === null || key !== this.sceneKey) this.goHome();
      this.sceneKey = key;
    }
    this.resize();
  }

  private frameArrived(frame: Frame): void {
    const frameNumber = Number(frame.frameNumber);
    const jpeg = frame.jpeg as Uint8Array<ArrayBuffer>;
    this.frames.set(frameNumber, { ...frame, jpeg: new Uint8Array() });
    this.canvas.show(frameNumber, jpeg);
  }

  private acknowledge(frameNumber: number): void {
    this.socket.acknowledge(frameNumber);
    for (const known of this.frames.keys()) if (known <= frameNumber) this.frames.delete(known);
  }

  private drawn(frameNumber: number, time: number): void {
    const frame = this.frames.get(frameNumber);
    this.acknowledge(frameNumber);
    if (frame === undefined) return; // of a connection that is gone
    this.rate.drawn(time);
    this.latency.drawn(Number(frame.viewSequence), time);
    this.lifted = { camera: cameraOf(frame.liftedCamera), sequence: Number(frame.viewSequence) };
    this.adoptLifted();
    this.noteShown(frame);
    const { statistics } = frame;
    this.state.numbers.set({
      frameNumber,
      viewSequence: Number(frame.viewSequence),
      width: frame.width,
      height: frame.height,
      still: frame.still,
      tauAsked: statistics?.tauAsked ?? 0,
      budgetMilliseconds: statistics?.budget?.milliseconds ?? 0,
      predictedMilliseconds: statistics?.budget?.predictedMilliseconds ?? 0,
      budgetTau: statistics?.budget?.tauPixels ?? 0,
      tauAchieved: statistics?.tauAchieved ?? 0,
      complete: statistics?.complete ?? true,
      pagesMissing: Number(statistics?.pagesMissing ?? 0n),
      pagesFailed: Number(statistics?.pagesFailed ?? 0n),
      triangles: Number(statistics?.triangles ?? 0n),
      renderMilliseconds: statistics?.milliseconds?.total ?? 0,
      limitedBy:
        limitingStage(statistics?.milliseconds) || (this.state.numbers.value?.limitedBy ?? ""),
      fps: this.rate.perSecond(time),
      inputToDrawnMilliseconds: this.latency.median(),
      frozen: this.state.look.value.frozen !== null,
    });
  }

  private noteShown(frame: Frame): void {
    const sequence = Number(frame.viewSequence);
    const sent = this.sentViews.get(sequence);
    for (const known of this.sentViews.keys()) if (known < sequence) this.sentViews.delete(known);
    if (sent === undefined) return;
    const camera = cameraOf(frame.liftedCamera) ?? sent.camera;
    this.state.shown.set({ ...sent, camera, width: frame.width, height: frame.height });
  }

  // ---- Picks

  clicked(at: Point): void {
    this.pick(at);
  }

  /** Turns to the point and, from then on, about it. */
  doubleClicked(at: Point): void {
    if (this.pick(at)) this.turnTo = this.pickSequence;
  }

  private pick(at: Point): boolean {
    const shown = this.state.shown.value;
    if (shown === null) return false;
    const place = placeOf(at, this.canvas.size(), shown);
    if (!this.socket.pick(this.pickSequence + 1, shown, place)) return false;
    this.pickSequence += 1;
    this.state.pick.set({ kind: "asking" });
    return true;
  }

  private picked(answer: ViewerPicked): void {
    if (Number(answer.sequence) !== this.pickSequence || this.state.pick.value === null) return;
    const exaggeration = this.state.shown.value?.exaggeration ?? 1;
    const pick = pickOf(answer, this.state.session.value?.objectNames ?? [], exaggeration);
    this.state.pick.set(pick);
    if (pick.kind === "point" && this.turnTo === this.pickSequence && this.camera !== null)
      this.move(lookAt(this.camera, pick.position));
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
    const isNewest = sequence === this.sequence && this.sendAt === undefined;
    if (camera !== undefined && isNewest && !this.controls.isDragging) this.camera = camera;
  }

  /** Holds the cut as this camera has it, or lets it follow the view again. */
  setFrozen(isFrozen: boolean): void {
    this.state.look.set({ ...this.state.look.value, frozen: isFrozen ? this.camera : null });
  }

  /** What changes although no frame comes. */
  private tick(): void {
    const now = performance.now();
    const numbers = this.state.numbers.value;
    const fps = this.rate.perSecond(now);
    if (numbers !== null && numbers.fps !== fps) this.state.numbers.set({ ...numbers, fps });
    const waitingSince = this.latency.waitingSince();
    this.state.stale.set(waitingSince !== undefined && now - waitingSince > staleAfter);
  }
}
