// SPDX-License-Identifier: Apache-2.0
import type { Camera } from "./camera/camera";
import type { Look } from "./look";
import { ofScene } from "./look";
import { distanceLimits, lookAt } from "./camera/orbit";
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
import { Steering } from "./steering";
import { Arrivals } from "./view/arrivals";
import { PictureCanvas } from "./view/canvas";
import { FrameRate } from "./view/measure";
import { numbersOf } from "./view/numbers";
import type { WantedView } from "./view/sender";
import { ViewSender } from "./view/sender";
import type { Size } from "./view/size";
import { pictureSize } from "./view/size";
import { canShowVideo } from "./view/video";

/** Null: by the camera alone. */
const seenOf = (frame: Frame) => (frame.throughWall ? frame.seen : null);

/** As the server has it, bit for bit. */
export interface ExactPicture {
  png: Blob;
  /** Of what it shows beside the view; pictures with different ones do not belong together. */
  revision: bigint;
}

/** A view without its picture for so long is stale. */
const staleAfter = 2000;
const noticeShownFor = 4000;

/**
 * A scene on a canvas: sends views, draws frames, moves the camera. Works without any panel:
 *
 *     const state = new State();
 *     new Viewer(canvas, "ws://127.0.0.1:8080/ws", state);
 */
export class Viewer {
  private readonly canvas: PictureCanvas;
  private readonly socket: Socket;
  readonly steering: Steering;
  readonly questions: Questions;
  private readonly rate = new FrameRate();
  private readonly sender = new ViewSender({
    wantedView: () => this.wantedView(),
    sendView: (view) => this.socket.sendView(view),
    isConnected: () => !this.isClosed && this.state.connection.value.kind === "connected",
  });
  readonly arrivals: Arrivals;
  private readonly ticker: number;
  /** How to hear no more of the state, which may outlast this viewer. */
  private readonly unwatch: readonly (() => void)[];
  private noticeTimer: ReturnType<typeof setTimeout> | undefined;
  private isClosed = false;

  /** The picture on the canvas, while it is exact. */
  private exactPicture: ExactPicture | undefined;

  /** What the server notes next may be why what was asked of it came to nothing. */
  private isAsking = false;

  /** H.264 can be decoded, and none has failed to be. */
  private showsVideo = false;
  private size: Size;
  /** The screen that the server knows of, as a query. */
  private sentScreen = "";
  /** What who leads the session, or a program, has asked for, while that is not this page. */
  private led: LedView | undefined;
  /** What a program has asked for in this page's place, as text, once it has been adopted. */
  private followed = "";
  private readonly scene = new ShownScene();

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
      const { camera } = this.steering;
      if (camera !== null) this.steering.move(lookAt(camera, to));
    });
    this.steering = new Steering(canvas, state, {
      moved: (inputTime) => {
        this.sender.request(inputTime);
        this.sender.sendUnlessWaiting();
      },
      changed: () => this.sender.request(),
      clicked: (at, turns) => this.questions.pick(at, this.canvas.size(), turns),
      ask: (from, to, samples, answered) =>
        this.questions.askGround([...from, 0], [...to, 0], samples, (answer) =>
          answered(answer && groundOf(answer, from, to, state.look.value.exaggeration)),
        ),
      isNewest: (sequence) => this.sender.isNewest(sequence),
      canvasSize: () => this.canvas.size(),
    });
    this.unwatch = [
      state.notice.watch((text) => {
        clearTimeout(this.noticeTimer);
        if (text !== "") this.noticeTimer = setTimeout(() => state.notice.set(""), noticeShownFor);
      }),
      state.shown.watch((shown) => this.canvas.setFilled(shown?.isPacked === true)),
      watchSettings(
        state,
        () => this.sender.request(performance.now()),
        () => this.keepLed(),
      ),
      state.output.watch(() => {
        this.sender.request(performance.now());
        this.sendScreen();
      }),
    ];
    this.ticker = window.setInterval(() => this.tick(), 250);
    void canShowVideo().then((can) => this.setVideo(can));
  }

  close(): void {
    this.isClosed = true;
    window.clearInterval(this.ticker);
    for (const end of this.unwatch) end();
    clearTimeout(this.noticeTimer);
    this.questions.close();
    this.steering.close();
    this.socket.close();
    this.canvas.close();
  }

  get camera(): Camera | null {
    return this.steering.camera;
  }

  /** For everybody; what comes of it is in the session's state. False for who watches. */
  switchLayout(canvas: string, layout: string): boolean {
    if (this.state.isWatching) {
      this.state.notice.set(this.state.watchingText("switch layouts"));
      return false;
    }
    this.isAsking = true;
    this.socket.switchLayout(canvas, layout);
    return true;
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
    if (!this.state.isWatching || queryOf(value) !== "") return value;
    return this.led?.output ?? value;
  }

  /** Of the picture that is asked for, in pixels. */
  get pictureSize(): Size {
    return this.size;
  }

  /** The exact picture of what is wanted now, or of what is led, once it is on the canvas. */
  exactNow(): ExactPicture | undefined {
    const isNewest = this.sender.isNewest(this.state.numbers.value?.viewSequence);
    return isNewest || this.state.isWatching ? this.exactPicture : undefined;
  }

  /** How long the oldest view has waited at `now` that no picture has shown yet; 0: none waits. */
  waitingMilliseconds(now: number): number {
    return now - (this.sender.waitingSince() ?? now);
  }

  private get waits(): boolean {
    return this.sender.waitingSince() !== undefined || this.state.connection.value.kind === "lost";
  }

  /** `staysUnderground`: until the eye comes out, whatever the view's look says. */
  show(view: SharedView, staysUnderground = false): void {
    applySettings(this.state, view);
    this.leaveOutAbsent();
    this.steering.jumpTo(view.camera, performance.now(), staysUnderground);
  }

  /** A link may be of another scene; it can be held against this one once that is there. */
  private leaveOutAbsent(): void {
    const { sceneBounds, objectNames = [] } = this.state.session.value ?? {};
    if (sceneBounds === undefined || this.state.isWatching) return;
    const look = ofScene(this.state.look.value, objectNames.length);
    if (look === this.state.look.value) return;
    this.state.look.set(look);
    this.state.notice.set("This view is of more objects than the scene has; they are left out");
  }

  /** Who watches cannot change what is led: the controls go back to it. */
  private keepLed(): void {
    if (
      !this.state.isWatching ||
      this.led === undefined ||
      areSame(settingsOf(this.state), this.led)
    )
      return;
    this.state.notice.set(this.state.watchingText("change what is seen"));
    applySettings(this.state, this.led);
  }

  /** Null before there is a camera, and while another moves it. */
  private wantedView(): WantedView | null {
    if (this.camera === null || this.state.isWatching) return null;
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

  private seenLook(): Look {
    const look = this.state.look.value;
    return this.steering.goesUnderground ? { ...look, underground: true } : look;
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
    this.questions.opened();
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
    const hasWatched = this.state.isWatching;
    this.state.session.set(session);
    if (hasWatched && !this.state.isWatching) this.takeOver();
    this.placeChanged();
    const { min, max } = session.sceneBounds ?? {};
    if (min !== undefined && max !== undefined)
      this.steering.limits = distanceLimits(
        Math.hypot(max.x - min.x, max.y - min.y, max.z - min.z),
      );
    const { isElsewhere, hasOtherObjects } = this.scene.next(session);
    if (this.camera === null || isElsewhere) this.steering.goHome();
    if (hasOtherObjects) this.forgetScene();
    this.leaveOutAbsent();
    this.resize();
  }

  /** What was found in another scene, and said of its objects, and the cut that was held there. */
  private forgetScene(): void {
    this.state.pick.set(null);
    this.state.measured.set([]);
    this.state.profile.set(null);
    if (this.state.isWatching) return;
    this.state.look.set({ ...this.state.look.value, hidden: [], objects: [], frozen: null });
  }

  /**
   * Who led may have walked or flown under ground: what is seen stays there until the eye comes out,
   * and *Underground* is no setting of this page for that.
   */
  private takeOver(): void {
    const look = this.state.look.value;
    if (!look.underground) return;
    this.steering.stayUnderground();
    this.state.look.set({ ...look, underground: false });
  }

  /** What was sent while another leads is not answered; who leads now has to say where to. */
  private placeChanged(): void {
    if (this.state.isWatching) {
      this.state.walking.set(false);
      this.state.flying.set(false);
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
    const { liftedCamera, lift, viewSequence } = frame;
    const up = lift && ([lift.x, lift.y, lift.z] as const);
    this.steering.liftedTo(cameraOf(liftedCamera), up, Number(viewSequence));
    this.noteShown(frame);
    const seen = {
      exact: isExact,
      fps: this.rate.perSecond(time),
      waits: this.waits,
      inputToDrawnMilliseconds: this.sender.medianLatency(),
      frozen: this.state.look.value.frozen !== null,
    };
    if (isExact && picture !== undefined)
      this.exactPicture = { png: picture, revision: frame.revision };
    this.state.numbers.set(numbersOf(frame, seen, this.state.numbers.value?.limitedBy ?? ""));
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
    if (content === this.followed || this.steering.isDragging) return;
    this.followed = content;
    this.sender.forgetLast();
    if (queryOf(view.output) !== queryOf(this.state.output.value))
      this.state.output.set(view.output);
    // As one takes over.
    const underground = this.state.look.value.underground && view.look.underground;
    this.show({ ...view, look: { ...view.look, underground } }, view.look.underground);
  }

  private noteLed({ camera: asked, look, ...rest }: LedView, frame: Frame): void {
    const camera = cameraOf(frame.liftedCamera) ?? asked;
    if (this.state.isWatching) {
      this.steering.camera = camera;
      applySettings(this.state, { look, ...rest });
    } else this.follow({ camera: asked, look, ...rest });
    const { width, height } = frame;
    const { exaggeration, hidden } = look;
    const shown = { camera, width, height, exaggeration, hidden };
    this.state.shown.set({ ...shown, seen: seenOf(frame), isPacked: isPacked(this.output) });
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
