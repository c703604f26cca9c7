// SPDX-License-Identifier: Apache-2.0
import type { Look } from "./look";
import { defaultLook } from "./look";
import type { Vec3 } from "./camera/camera";
import type { Output } from "./output";
import { usualOutput } from "./output";
import type { Profile } from "./profile";
import type { PartStatistics, SessionState, Shown } from "./protocol/messages";
import { Shading } from "./protocol/messages";

/** A value that tells its listeners when it becomes another. */
export class Value<T> {
  private readonly listeners = new Set<(value: T) => void>();

  constructor(private current: T) {}

  get value(): T {
    return this.current;
  }

  set(value: T): void {
    if (Object.is(value, this.current)) return;
    this.current = value;
    for (const listener of this.listeners) {
      // One of them has set another, of which all have heard by now.
      if (!Object.is(value, this.current)) return;
      listener(value);
    }
  }

  /** Calls `listener` now and after each change; returns how to end that. */
  watch(listener: (value: T) => void): () => void {
    this.listeners.add(listener);
    listener(this.current);
    return () => this.listeners.delete(listener);
  }
}

export type Connection =
  | { kind: "connecting" }
  | { kind: "connected" }
  /**
   * `since`: when it was lost, or was first tried in vain, in ms of performance.now();
   * `refusal`: why the server that answers takes no connection, "" where none answers.
   */
  | { kind: "lost"; since: number; refusal: string }
  /** By a program, for good. */
  | { kind: "closed" };

/** What the last drawn frame was, and how frames come. */
export interface Numbers {
  frameNumber: number;
  viewSequence: number;
  width: number;
  height: number;
  still: boolean;
  /** Its pixels are the server's, bit for bit, as compared here. */
  exact: boolean;
  /** What the server says of its pixels; 0 while they are not sent as they are. */
  pixelHash: number;
  /** Of a JPEG; 0: it is none. */
  quality: number;
  /** How many JPEGs it is, each as a renderer encoded it; 0: it is one picture. */
  tiles: number;
  /** It is one of a stream of H.264. */
  isVideo: boolean;
  /** What the link carries, as the server estimates; 0: not known. */
  linkBytesPerSecond: number;
  pictureBytes: number;
  tauAsked: number;
  /** The frame time that was to be held, and what was foreseen for this frame; 0: none was. */
  budgetMilliseconds: number;
  predictedMilliseconds: number;
  /** The tau that it was given for that. */
  budgetTau: number;
  tauAchieved: number;
  /** How far normals of meshes may turn from the source's: on average over any node, and at most. */
  normalMeanDegrees: number;
  normalDegrees: number;
  complete: boolean;
  /** Pages that coarser data stand in for, and those of them that could not be read. */
  pagesMissing: number;
  pagesFailed: number;
  triangles: number;
  /** Wall-clock time of rendering on the server. */
  renderMilliseconds: number;
  /** Of the slowest renderer, the stages of it. */
  cullMilliseconds: number;
  drawMilliseconds: number;
  readbackMilliseconds: number;
  /** The stage of rendering that took longest when they were last measured; "" before that. */
  limitedBy: string;
  /** Frames drawn in the last second. */
  fps: number;
  /** A view has no picture yet, or the connection is lost. */
  waits: boolean;
  /** From an input to the picture that shows it: median of the last ones; NaN before any. */
  inputToDrawnMilliseconds: number;
  /** It shows a cut that was chosen for another camera. */
  frozen: boolean;
  /** Who drew what of it. */
  parts: readonly PartStatistics[];
}

/** A point of the scene, in world metres, that was clicked at. */
export interface PickedPoint {
  kind: "point";
  /** Name of the object it is on. */
  object: string;
  position: Vec3;
  /** Of terrain, not exaggerated. */
  elevation: number | undefined;
  /** Of the elevation, in the terrain's own metres. */
  elevationError: number;
  /** The source's surface is so near to it. */
  error: number;
  /** From the eye; and between which distances the line of sight meets the source. */
  distance: number;
  nearest: number;
  farthest: number;
  /** That terrain was drawn with. */
  exaggeration: number;
}

export type Pick =
  | PickedPoint
  | { kind: "asking" }
  | { kind: "nothing" }
  /** For the user to read. */
  | { kind: "problem"; text: string };

/** Heights along a line: found, asked for, or why there are none. */
export type ProfileState =
  | ({ kind: "found" } & Profile)
  | { kind: "asking"; from: Vec3; to: Vec3 }
  | { kind: "problem"; text: string };

/** Everything the page shows. The viewer writes it; panels read it. */
export class State {
  readonly connection = new Value<Connection>({ kind: "connecting" });
  readonly session = new Value<SessionState | null>(null);
  readonly numbers = new Value<Numbers | null>(null);
  /** What the picture on the canvas shows. */
  readonly shown = new Value<Shown | null>(null);
  /** What the last click found. */
  readonly pick = new Value<Pick | null>(null);
  /** The worker that draws did not start: the browser may be too old for it. */
  readonly cannotDraw = new Value(false);
  /** A view has been waiting for its picture for long. */
  readonly stale = new Value(false);
  /** Clicks add points to what is measured. */
  readonly measuring = new Value(false);
  readonly measured = new Value<readonly PickedPoint[]>([]);
  readonly profile = new Value<ProfileState | null>(null);
  /** What came of a command, for the user to read; goes by itself. */
  readonly notice = new Value("");
  readonly flying = new Value(false);
  /** The eye follows the ground. */
  readonly walking = new Value(false);
  readonly tau = new Value(1);
  /** Milliseconds a frame may take while the view moves; null: tau is kept. */
  readonly budget = new Value<number | null>(null);
  readonly shading = new Value<Shading>(Shading.SMOOTH);
  readonly look = new Value<Look>(defaultLook);
  /** Which picture of the configuration is seen here. */
  readonly output = new Value<Output>(usualOutput);

  /** Another moves the view, or nobody: this page only sees it. */
  get isWatching(): boolean {
    return this.session.value?.place?.leads === false;
  }

  /** For who watches, and tries what only who leads can. */
  watchingText(what: string): string {
    const mayLead = this.session.value?.place?.mayControl === true;
    return `You watch this session${mayLead ? `: take the lead to ${what}` : ` and may not ${what}`}`;
  }
}
