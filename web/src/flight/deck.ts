// SPDX-License-Identifier: Apache-2.0
// Records, plays and draws a flight.
import type { Camera } from "../camera/camera";
import type { SharedView } from "../share";
import { Value } from "../state";
import type { Size } from "../view/size";
import type { ExactPicture } from "../viewer";
import { flightJson } from "./file";
import { fitKeys, offBy } from "./fit";
import type { Flight, FlightKey } from "./flight";
import { cameraAt, secondsOf } from "./flight";
import { mostEntries, ZipWriter } from "./zip";

/** Where a flight is flown. */
export interface Stage {
  readonly camera: Camera | null;
  /** Counts up with each movement, whoever makes it. */
  readonly movements: number;
  /** Another moves the view: moveAlong() does nothing. */
  readonly isWatching: boolean;
  /** For the user, where that keeps the view from moving. */
  readonly watchingText: string;
  /** Shows a camera of the flight. */
  moveAlong(camera: Camera): void;
}

/** What is seen of it. */
export interface Pictures {
  readonly pictureSize: Size;
  /** The newest view, with its settings and look. */
  sharedView(): SharedView | null;
  /** The picture of the newest view, once it is exact. */
  exactNow(): ExactPicture | undefined;
}

export type Activity =
  | { kind: "idle" }
  | { kind: "recording" }
  | { kind: "playing" }
  | { kind: "drawing"; frame: number; frames: number };

/**
 * As a share of the distance looked at: some eight pixels of a picture 720 high. An eighth of it
 * takes twice the keys and plays the hand's tremor.
 */
const tolerance = 0.01;
const longestSeconds = 600;
/** A hand presses Record and Stop: nothing moves meanwhile. */
const stillness = 1e-9;
const exactWithin = 60_000;
const idle: Activity = { kind: "idle" };

/** Without what stood still before and after the movement; from 0 s on. */
export function trimmed(views: readonly FlightKey[]): FlightKey[] {
  const isStill = (a: FlightKey | undefined, b: FlightKey | undefined): boolean =>
    a !== undefined && b !== undefined && offBy(a.camera, b.camera) <= stillness;
  let [first, last] = [0, views.length - 1];
  while (first < last && isStill(views[first], views[first + 1])) first += 1;
  while (last > first && isStill(views[last], views[last - 1])) last -= 1;
  const start = views[first]?.seconds ?? 0;
  return views.slice(first, last + 1).map((key) => ({ ...key, seconds: key.seconds - start }));
}

export class FlightDeck {
  readonly flight = new Value<Flight>({ name: "", keys: [] });
  /** After the first key. */
  readonly seconds = new Value(0);
  readonly activity = new Value<Activity>(idle);
  private views: FlightKey[] = [];
  /** In ms of performance.now(). */
  private recordedSince = 0;
  private frame: number | undefined;
  private expected = 0;

  constructor(
    private readonly stage: Stage,
    private readonly pictures: Pictures,
    /** Tells the user what came of something. */
    private readonly tell: (text: string) => void,
  ) {}

  get length(): number {
    return secondsOf(this.flight.value);
  }

  load(flight: Flight): void {
    this.stop();
    this.flight.set(flight);
    this.seconds.set(0);
  }

  /** `by` is given the keys that there are once whatever went on has ended. */
  edit(by: (keys: readonly FlightKey[]) => readonly FlightKey[]): void {
    this.stop();
    const before = this.flight.value.keys;
    const keys = by(before);
    if (keys === before) return;
    this.flight.set({ ...this.flight.value, keys });
    this.seconds.set(Math.min(this.seconds.value, this.length));
  }

  /** Shows where the flight is then. */
  seek(seconds: number): void {
    this.stop();
    this.show(seconds);
    if (this.stage.isWatching) this.tell(this.stage.watchingText);
  }

  private show(seconds: number): void {
    this.seconds.set(seconds);
    if (this.flight.value.keys.length === 0) return;
    this.stage.moveAlong(cameraAt(this.flight.value, seconds));
    this.expected = this.stage.movements;
  }

  /** Ends whatever goes on; a recording becomes the flight, of which is told, after `why`. */
  stop(why = ""): void {
    const { kind } = this.activity.value;
    if (this.frame !== undefined) cancelAnimationFrame(this.frame);
    this.frame = undefined;
    this.activity.set(idle);
    if (kind === "recording") this.tell(`${why}${this.finishRecording()}`);
  }

  // ---- Recording

  record(): void {
    this.stop();
    this.views = [];
    this.activity.set({ kind: "recording" });
    this.recordedSince = performance.now();
    const step = (): void => {
      const seconds = this.recordView();
      this.seconds.set(seconds);
      if (seconds > longestSeconds)
        this.stop(`A recording ends after ${longestSeconds / 60} minutes: `);
      else this.frame = requestAnimationFrame(step);
    };
    step();
  }

  /** Of now; returns its time. */
  private recordView(): number {
    const seconds = (performance.now() - this.recordedSince) / 1000;
    const before = this.views[this.views.length - 1]?.seconds ?? -1;
    if (this.stage.camera !== null && seconds > before)
      this.views.push({ seconds, camera: this.stage.camera });
    return seconds;
  }

  /** Returns what came of it. */
  private finishRecording(): string {
    // What moved since the last animation frame is part of it.
    this.recordView();
    const views = trimmed(this.views);
    this.views = [];
    if (views.length < 2) {
      this.seconds.set(0);
      return "Nothing moved: the flight stays as it was";
    }
    const { keys, error } = fitKeys(views, tolerance);
    this.flight.set({ ...this.flight.value, keys });
    this.seconds.set(this.length);
    const percent = Number((100 * error).toPrecision(2));
    return `${views.length} views as ${keys.length} keys, off by ${percent} % of the distance at most`;
  }

  // ---- Playing

  play(): void {
    this.stop();
    if (this.flight.value.keys.length === 0) return this.tell("There is no flight to play yet");
    if (this.stage.isWatching) return this.tell(this.stage.watchingText);
    const from = this.seconds.value < this.length ? this.seconds.value : 0;
    const start = performance.now() - 1000 * from;
    this.activity.set({ kind: "playing" });
    this.show(from);
    const step = (): void => {
      // A hand that steers takes over, as does who takes the lead.
      if (this.stage.movements !== this.expected || this.stage.isWatching) return this.stop();
      const seconds = (performance.now() - start) / 1000;
      this.show(Math.min(seconds, this.length));
      if (seconds >= this.length) this.stop();
      else this.frame = requestAnimationFrame(step);
    };
    this.frame = requestAnimationFrame(step);
  }

  // ---- Pictures

  /** Throws an Error for the user to read where a ZIP does not hold so many pictures. */
  private checkFits(frames: number): void {
    const most = mostEntries - 1; // the flight is one, too
    if (frames <= most) return;
    const rate = Math.floor((most - 1) / this.length);
    const remedy = rate < 1 ? "shorten the flight" : `up to ${rate} a second fit`;
    throw new Error(`A ZIP file holds ${most} pictures, and these are ${frames}: ${remedy}`);
  }

  /** All that the page asks of pictures of a flight alike but their size, as text. */
  private settings(): string {
    return JSON.stringify({ ...this.pictures.sharedView(), camera: null });
  }

  /**
   * The flight and every picture of it, exact, as a ZIP file, or as many as that holds; undefined
   * where it was stopped. Throws an Error for the user to read where a picture does not come.
   */
  async draw(framesPerSecond: number): Promise<Blob | undefined> {
    this.stop();
    const flight = this.flight.value;
    const frames = Math.floor(this.length * framesPerSecond + 1e-6) + 1;
    this.checkFits(frames);
    const size = JSON.stringify(this.pictures.pictureSize);
    let settings: string | undefined;
    let revision: bigint | undefined;
    const zip = new ZipWriter();
    const mine = (frame: number): Activity => ({ kind: "drawing", frame, frames });
    let activity = mine(0);
    this.activity.set(activity);
    try {
      await zip.add({ name: "flight.json", content: new Blob([flightJson(flight)]) });
      for (let i = 0; i < frames; ++i) {
        this.show(i / framesPerSecond);
        settings ??= this.settings(); // not before: the eye of a flight may go under ground
        const picture = await this.exact(() => this.activity.value === activity);
        if (picture === undefined) return undefined;
        if (JSON.stringify(this.pictures.pictureSize) !== size)
          throw new Error("The window has changed its size meanwhile: pictures would differ");
        if (this.settings() !== settings)
          throw new Error("Settings have changed meanwhile: pictures would differ");
        revision ??= picture.revision;
        if (picture.revision !== revision)
          throw new Error("What is shown was changed meanwhile: no pictures are saved");
        const name = `${String(i + 1).padStart(5, "0")}.png`;
        const hasRoom = await zip.add({ name, content: picture.png });
        if (this.activity.value !== activity) return undefined;
        if (!hasRoom) {
          this.tell(`A ZIP file holds 4 GiB: ${i} of ${frames} pictures are saved`);
          break;
        }
        activity = mine(i + 1);
        this.activity.set(activity);
      }
      return zip.finish();
    } finally {
      if (this.activity.value === activity) this.activity.set(idle);
    }
  }

  /** Undefined where it is no longer wanted. */
  private async exact(isWanted: () => boolean): Promise<ExactPicture | undefined> {
    const deadline = performance.now() + exactWithin;
    while (performance.now() < deadline) {
      if (!isWanted()) return undefined;
      // What is exact then is another's picture.
      if (this.stage.isWatching) throw new Error(this.stage.watchingText);
      if (this.stage.movements !== this.expected)
        throw new Error("The view was moved meanwhile: no pictures are saved");
      const picture = this.pictures.exactNow();
      if (picture !== undefined) return picture;
      await new Promise((resolve) => setTimeout(resolve, 5));
    }
    throw new Error("A picture did not become exact within a minute");
  }
}
