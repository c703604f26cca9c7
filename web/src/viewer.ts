// SPDX-License-Identifier: Apache-2.0
import type { Camera } from "./camera/camera";
import type { Keys } from "./camera/fly";
import type { Look } from "./look";
import { ofScene } from "./look";
import { isUsable } from "./camera/camera";
import { Controls } from "./camera/controls";
import type { CameraHolder } from "./camera/controls";
import type { DistanceLimits } from "./camera/orbit";
import { distanceLimits, lookAt } from "./camera/orbit";
import type { Point } from "./camera/touch";
import type { Bounds, Direction } from "./camera/standard";
import { directionOfView, standardCamera, standardViews } from "./camera/standard";
import { seenFrom } from "./camera/walk";
import { homeOf, objectBounds, wholeBounds } from "./drawn_bounds";
import type { Frame, SessionState } from "./protocol/messages";
import type { LedView } from "./protocol/led_view";
import { ledViewOf } from "./protocol/led_view";
import { cameraOf } from "./protocol/messages";
import { Socket } from "./protocol/socket";
import type { Output } from "./output";
import { isPacked, queryOf } from "./output";
import { groundOf } from "./profile";
import { Questions } from "./questions";
import { applySettings, areSame, settingsOf, watchSettings } from "./settings";
import type { SharedView } from "./share";
import { ShownScene } from "./shown_scene";
import type { State } from "./state";
import { watchingText } from "./state";
import { Arrivals } from "./view/arrivals";
import { PictureCanvas } from "./view/canvas";
import { Walker } from "./walker";
import { FrameRate } from "./view/measure";
import { numbersOf } from "./view/numbers";
import type { WantedView } from "./view/sender";
import { ViewSender } from "./view/sender";
import type { Size } from "./view/size";
import { pictureSize } from "./view/size";
import { canShowVideo } from "./view/video";

/** Null: by the camera alone. */
const seenOf = (frame: Frame) => (frame.throughWall ? frame.seen : null);

/** A view without its picture for so long is stale. */
const staleAfter = 2000;

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
  readonly questions: Questions;
  private readonly walker: Walker;
  private readonly rate = new FrameRate();
  private readonly sender = new ViewSender({
    wantedView: () => this.wantedView(),
    sendView: (view) => this.socket.sendView(view),
    isConnected: () => this.state.connection.value.kind === "connected",
  });
  readonly arrivals: Arrivals;
  private readonly ticker: number;

  /** The picture on the canvas as the server's PNG, while it is exact. */
  private exactPicture: Blob | undefined;

  /** How often the camera was moved, by whomever. */
  movements = 0;

  /** What the server notes next may be why what was asked of it came to nothing. */
  private isAsking = false;

  /** H.264 can be decoded, and none has failed to be. */
  private showsVideo = false;
  private size: Size;
  /** The screen that the server knows of, as a query. */
  private sentScreen = "";
  /** What the last frame said of the camera of its view. */
  private lifted: { camera: Camera | undefined; sequence: number } = {
    camera: undefined,
    sequence: 0,
  };
  /** What who leads the session, or a program, has asked for, while that is not this page. */
  private led: LedView | undefined;
  /** What a program has asked for in this page's place, as text, once it has been adopted. */
  private followed = "";
  private readonly scene = new ShownScene();
  /** The camera with which a walk has ended. */
  private walked: Camera | null = null;
  /** The last camera of a flight. */
  private flown: Camera | null = null;

  constructor(
    canvas: HTMLCanvasElement,
    url: string | (() => string),
    private readonly state: State,
  ) {
    this.canvas = new PictureCanvas(canvas, {
      drawn: (frameNumber, time, isExact) => this.drawn(frameNumber, time, isExact),
      failed: (frameNumber) => this.arrivals.failed(frameNumber),
      ready: (frameNumber, time) => this.arrivals.ready(frameNumber, time),
      videoFailed: () => this.setVideo(false),
      workerFailed: () => state.cannotDraw.set(true),
      resized: () => this.resize(),
    });
    this.arrivals = new Arrivals(this.canvas, {
      acknowledge: (frameNumber, decodeMilliseconds) => {
        // The server may start a frame for each that is acknowledged: it is to be of the newest view.
        this.sender.sendNow();
        this.socket.acknowledge(frameNumber, decodeMilliseconds);
      },
      ready: (swap) => this.socket.ready(swap),
    });
    this.size = this.wantedSize();
    this.controls = new Controls(canvas, this);
    this.socket = new Socket(url, {
      opened: () => this.opened(),
      lost: () => this.lost(),
      refused: (text) => this.refused(text),
      closed: () => {
        this.lost();
        this.state.connection.set({ kind: "closed" });
      },
      state: (session) => this.sessionChanged(session),
      frame: (frame, picture) => this.arrivals.arrived(frame, picture),
      picked: (answer) => this.questions.picked(answer),
      profiled: (answer) => this.questions.profiled(answer),
      swap: (swap) => this.arrivals.swap(swap),
    });
    this.questions = new Questions(this.socket, state, (to) => {
      if (this.camera !== null) this.move(lookAt(this.camera, to));
    });
    this.walker = new Walker({
      moved: (camera, time) => this.moveTo(camera, time),
      ask: (from, to, samples, answered) =>
        this.questions.askGround([...from, 0], [...to, 0], samples, (answer) =>
          answered(answer && groundOf(answer, from, to, state.look.value.exaggeration)),
        ),
      failed: (isAnswered) => {
        state.walking.set(false);
        state.notice.set(
          isAnswered
            ? "There is no ground to stand on there"
            : "The ground cannot be asked for now: try again when pictures come",
        );
      },
    });
    state.walking.watch((isWalking) => this.walkingChanged(isWalking));
    this.keepWalkerOnGround();
    state.shown.watch((shown) => this.canvas.setFilled(shown?.isPacked === true));
    watchSettings(
      state,
      () => this.sender.request(performance.now()),
      () => this.keepLed(),
    );
    state.output.watch(() => {
      this.sender.request(performance.now());
      this.sendScreen();
    });
    this.ticker = window.setInterval(() => this.tick(), 250);
    void canShowVideo().then((can) => this.setVideo(can));
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
    if (isFlying) this.state.walking.set(false);
    this.state.flying.set(isFlying);
  }

  get isWalking(): boolean {
    return this.state.walking.value;
  }

  setWalking(isWalking: boolean): void {
    if (isWalking && this.isWatching) return this.state.notice.set(watchingText);
    if (isWalking) this.state.flying.set(false);
    this.state.walking.set(isWalking);
  }

  walk(keys: Keys, isFast: boolean, seconds: number, time: number): void {
    this.walker.walk(keys, isFast, seconds, time);
  }

  scaleWalker(factor: number, time: number): void {
    this.walker.scale(factor, time);
  }

  private walkingChanged(isWalking: boolean): void {
    if (isWalking && this.camera !== null) this.walker.begin(this.camera);
    else {
      this.walker.end();
      this.walked = this.camera;
    }
    this.sender.request();
  }

  private keepWalkerOnGround(): void {
    const { look } = this.state;
    let [exaggeration, hidden] = [look.value.exaggeration, look.value.hidden];
    look.watch((now) => {
      const isSame = now.exaggeration === exaggeration && now.hidden === hidden;
      ({ exaggeration, hidden } = now);
      if (!isSame) this.walker.groundChanged();
    });
  }

  move(camera: Camera, inputTime?: number): void {
    if (this.isWalking && isUsable(camera)) {
      if (this.walker.isAt(camera)) this.walker.turned(camera);
      else this.state.walking.set(false);
    }
    this.moveTo(camera, inputTime);
  }

  private moveTo(camera: Camera, inputTime?: number): void {
    if (!isUsable(camera)) return;
    if (this.isWatching) {
      if (inputTime !== undefined) this.state.notice.set(watchingText);
      return;
    }
    this.camera = camera;
    this.movements += 1;
    this.sender.request(inputTime);
    this.sender.sendUnlessWaiting();
  }

  /** To a camera of a flight, which may have been recorded walking: nothing lifts it. */
  moveAlong(camera: Camera): void {
    this.flown = camera;
    this.move(camera);
  }

  goHome(inputTime?: number): void {
    const session = this.state.session.value;
    const home = session && homeOf(session, this.state.look.value.exaggeration, this.aspect);
    if (home) this.move(home, inputTime);
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
    this.move(standardCamera(from, bounds, this.aspect, fovyDegrees), inputTime);
  }

  private get aspect(): number {
    const { width, height } = this.canvas.size();
    return width / Math.max(1, height);
  }

  /** Clicks at the middle of the picture, for those without a pointer. */
  clickMiddle(): void {
    const { width, height } = this.canvas.size();
    this.clicked({ x: width / 2, y: height / 2 });
  }

  /** For everybody; what comes of it is in the session's state. False for who watches. */
  switchLayout(canvas: string, layout: string): boolean {
    if (this.isWatching) {
      this.state.notice.set("You watch this session: take the lead to switch layouts");
      return false;
    }
    this.isAsking = true;
    this.socket.switchLayout(canvas, layout);
    return true;
  }

  /** Another moves the view, or nobody: this one only sees it. */
  get isWatching(): boolean {
    return this.state.session.value?.place?.leads === false;
  }

  /** Goes on from what is seen now. */
  takeLead(): void {
    this.isAsking = true;
    this.state.output.set(this.output);
    this.socket.takeLead();
  }

  // ---- Views

  /** What is wanted now, to be found again; null before there is a camera. */
  sharedView(): SharedView | null {
    if (this.camera === null) return null;
    const settings = settingsOf(this.state);
    return { camera: this.camera, ...settings, look: { ...this.seenLook(), frozen: null } };
  }

  /** Which picture is seen: who watches names one in the address, or sees what the leader does. */
  get output(): Output {
    const { value } = this.state.output;
    if (!this.isWatching || queryOf(value) !== "") return value;
    return this.led?.output ?? value;
  }

  /** Of the picture that is asked for, in pixels. */
  get pictureSize(): Size {
    return this.size;
  }

  /** The exact picture of what is wanted now, or of what is led, once it is on the canvas. */
  exactNow(): Blob | undefined {
    const isNewest = this.sender.isNewest(this.state.numbers.value?.viewSequence);
    return isNewest || this.isWatching ? this.exactPicture : undefined;
  }

  /** How long the oldest view has waited at `now` that no picture has shown yet; 0: none waits. */
  waitingMilliseconds(now: number): number {
    return now - (this.sender.waitingSince() ?? now);
  }

  private get waits(): boolean {
    return this.sender.waitingSince() !== undefined || this.state.connection.value.kind === "lost";
  }

  show(view: SharedView): void {
    applySettings(this.state, view);
    this.leaveOutAbsent();
    this.move(view.camera, performance.now());
  }

  /** A link may be of another scene; it can be held against this one once that is there. */
  private leaveOutAbsent(): void {
    const { sceneBounds, objectNames = [] } = this.state.session.value ?? {};
    if (sceneBounds === undefined || this.isWatching) return;
    const look = ofScene(this.state.look.value, objectNames.length);
    if (look === this.state.look.value) return;
    this.state.look.set(look);
    this.state.notice.set("This view is of more objects than the scene has; they are left out");
  }

  /** Who watches cannot change what is led: the controls go back to it. */
  private keepLed(): void {
    if (!this.isWatching || this.led === undefined || areSame(settingsOf(this.state), this.led))
      return;
    this.state.notice.set("You watch this session: take the lead to change what is seen");
    applySettings(this.state, this.led);
  }

  /** Null before there is a camera, and while another moves it. */
  private wantedView(): WantedView | null {
    if (this.camera === null || this.isWatching) return null;
    return {
      camera: this.camera,
      ...this.size,
      tauPixels: this.state.tau.value,
      budgetMilliseconds: this.state.budget.value,
      shading: this.state.shading.value,
      look: this.seenLook(),
      output: this.state.output.value,
    };
  }

  /**
   * Nothing lifts a walk out of the ground, which is nearer to it than the server would let, nor what
   * is shown of a flight.
   */
  private seenLook(): Look {
    const look = this.state.look.value;
    const isFlown = this.camera !== null && this.camera === this.flown;
    return this.isWalking || isFlown ? { ...look, underground: true } : look;
  }

  /** Whoever leads, this page shows what its address says; where that says nothing, what is led. */
  private sendScreen(): void {
    const { value } = this.state.output;
    const text = queryOf(value);
    if (text === this.sentScreen || this.state.connection.value.kind !== "connected") return;
    this.sentScreen = text;
    this.socket.sendScreen(text === "" ? null : value);
  }

  private wantedSize(): Size {
    return pictureSize(this.canvas.size(), window.devicePixelRatio);
  }

  private resize(): void {
    const size = this.wantedSize();
    if (size.width === this.size.width && size.height === this.size.height) return;
    this.size = size;
    this.sender.request();
  }

  // ---- The server

  private opened(): void {
    this.state.connection.set({ kind: "connected" });
    this.socket.tellAbilities(this.showsVideo);
    this.sentScreen = "";
    this.sendScreen();
    this.sender.request();
  }

  private lost(): void {
    this.sender.lost();
    this.arrivals.forget();
    this.questions.lost();
    this.state.connection.set({ kind: "lost", since: performance.now(), refusal: "" });
  }

  private refused(refusal: string): void {
    const { value } = this.state.connection;
    if (value.kind === "lost" && value.refusal !== refusal)
      this.state.connection.set({ ...value, refusal });
  }

  private sessionChanged(session: SessionState): void {
    const isTold = session.note !== "" && session.note !== this.state.session.value?.note;
    if (this.isAsking && isTold) {
      this.isAsking = false;
      this.state.notice.set(session.note);
    }
    this.state.session.set(session);
    this.placeChanged();
    const { min, max } = session.sceneBounds ?? {};
    if (min !== undefined && max !== undefined)
      this.limits = distanceLimits(Math.hypot(max.x - min.x, max.y - min.y, max.z - min.z));
    const { isElsewhere, hasOtherObjects } = this.scene.next(session);
    if (this.camera === null || isElsewhere) this.goHome();
    if (hasOtherObjects) this.forgetScene();
    this.leaveOutAbsent();
    this.resize();
  }

  /** What was found in another scene, and said of its objects, and the cut that was held there. */
  private forgetScene(): void {
    this.state.pick.set(null);
    this.state.measured.set([]);
    this.state.profile.set(null);
    if (this.isWatching) return;
    this.state.look.set({ ...this.state.look.value, hidden: [], objects: [], frozen: null });
  }

  /** What was sent while another leads is not answered; who leads now has to say where to. */
  private placeChanged(): void {
    if (this.isWatching) {
      this.state.walking.set(false);
      this.sender.forgetAll();
    } else if (this.led !== undefined) {
      this.led = undefined;
      this.sender.request();
    }
  }

  private setVideo(isShown: boolean): void {
    if (isShown === this.showsVideo) return;
    this.showsVideo = isShown;
    this.socket.tellAbilities(isShown);
  }

  private drawn(frameNumber: number, time: number, isExact: boolean): void {
    const arrived = this.arrivals.drawn(frameNumber, time);
    this.exactPicture = undefined;
    if (arrived === undefined) return;
    const { frame, picture } = arrived;
    this.rate.drawn(time);
    this.sender.drawn(Number(frame.viewSequence), time);
    this.lifted = { camera: cameraOf(frame.liftedCamera), sequence: Number(frame.viewSequence) };
    this.adoptLifted();
    this.noteShown(frame);
    const seen = {
      exact: isExact,
      fps: this.rate.perSecond(time),
      waits: this.waits,
      inputToDrawnMilliseconds: this.sender.medianLatency(),
      frozen: this.state.look.value.frozen !== null,
    };
    this.state.numbers.set(numbersOf(frame, seen, this.state.numbers.value?.limitedBy ?? ""));
    if (isExact) this.exactPicture = picture;
  }

  private noteShown(frame: Frame): void {
    this.led = frame.ledView && ledViewOf(frame.ledView);
    if (this.led !== undefined) {
      this.noteLed(this.led, frame);
      return;
    }
    this.followed = "";
    const sent = this.sender.shownBy(Number(frame.viewSequence));
    if (sent === undefined) return;
    const camera = cameraOf(frame.liftedCamera) ?? sent.camera;
    const { width, height } = frame;
    this.state.shown.set({ ...sent, camera, width, height, seen: seenOf(frame) });
  }

  /** A program has moved the view: this page goes on from there, unless its user has by now. */
  private follow(view: LedView): void {
    const content = JSON.stringify(view);
    if (content === this.followed || this.controls.isDragging) return;
    this.followed = content;
    this.sender.forgetLast();
    if (queryOf(view.output) !== queryOf(this.state.output.value))
      this.state.output.set(view.output);
    this.show(view);
  }

  private noteLed({ camera: asked, look, ...rest }: LedView, frame: Frame): void {
    const camera = cameraOf(frame.liftedCamera) ?? asked;
    if (this.isWatching) {
      this.camera = camera;
      applySettings(this.state, { look, ...rest });
    } else this.follow({ camera: asked, look, ...rest });
    const { width, height } = frame;
    const { exaggeration, hidden } = look;
    const shown = { camera, width, height, exaggeration, hidden };
    this.state.shown.set({ ...shown, seen: seenOf(frame), isPacked: isPacked(this.output) });
  }

  // ---- Picks

  clicked(at: Point): void {
    this.pick(at, false);
  }

  /** Turns to the point and, from then on, about it. */
  doubleClicked(at: Point): void {
    this.pick(at, true);
  }

  private pick(at: Point, turns: boolean): void {
    this.questions.pick(at, this.canvas.size(), turns);
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
    const isNewest = this.sender.isNewest(sequence);
    if (camera === undefined || !isNewest || this.controls.isDragging) return;
    // What a walk looks at is near: with the eye alone lifted one would look down at it.
    if (this.camera !== null && this.camera === this.walked)
      this.moveTo(seenFrom(this.camera, camera.eye));
    else this.camera = camera;
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
    const { waits } = this;
    if (numbers !== null && (numbers.fps !== fps || numbers.waits !== waits))
      this.state.numbers.set({ ...numbers, fps, waits });
    this.state.stale.set(this.waitingMilliseconds(now) > staleAfter);
  }
}
