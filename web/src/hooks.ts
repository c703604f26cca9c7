// SPDX-License-Identifier: Apache-2.0
import type { Camera } from "./camera/camera";
import type { State } from "./state";
import type { Swap } from "./view/swaps";
import type { Viewer } from "./viewer";

/** What `window.eyrie` tells, for tests and for pages that embed this one. Read only. */
export interface Hooks {
  /** Of the picture on the canvas; 0 before the first. Counts from 1 on each connection. */
  readonly frameNumber: number;
  /** Of the view that it shows. */
  readonly viewSequence: number;
  readonly triangles: number;
  readonly tauAchieved: number;
  /** The frame time that it was to hold; 0: none, or the view is at rest. */
  readonly budgetMilliseconds: number;
  /** It is of a view at rest, nearly exact or exact. */
  readonly still: boolean;
  /** Its pixels are the server's, bit for bit; nothing more comes. */
  readonly exact: boolean;
  /** What the server says of them. */
  readonly pixelHash: number;
  /** Of its JPEG; 0: it is none. */
  readonly quality: number;
  /** How many JPEGs it is, each as a renderer encoded it; 0: it is one picture. */
  readonly tiles: number;
  /** It is one of a stream of H.264. */
  readonly video: boolean;
  readonly width: number;
  readonly height: number;
  readonly fps: number;
  /** Median of the last ones; NaN before any. */
  readonly inputToDrawnMilliseconds: number;
  /** How long the oldest view has waited that no picture has shown yet; 0: none waits. */
  readonly waitingMilliseconds: number;
  /** Wall-clock time of rendering the picture on the server. */
  readonly renderMilliseconds: number;
  readonly connection: "connecting" | "connected" | "lost" | "closed";
  readonly camera: Camera | null;
  /** The last pictures behind a swap barrier; what is drawn at 0 has been decoded only. */
  readonly swaps: readonly Swap[];
}

declare global {
  interface Window {
    readonly eyrie: Hooks;
  }
}

export function exposeHooks(state: State, viewer: Viewer): void {
  const numbers = () => state.numbers.value;
  const hooks: Hooks = {
    get frameNumber() {
      return numbers()?.frameNumber ?? 0;
    },
    get viewSequence() {
      return numbers()?.viewSequence ?? 0;
    },
    get triangles() {
      return numbers()?.triangles ?? 0;
    },
    get tauAchieved() {
      return numbers()?.tauAchieved ?? 0;
    },
    get budgetMilliseconds() {
      return numbers()?.budgetMilliseconds ?? 0;
    },
    get still() {
      return numbers()?.still ?? false;
    },
    get exact() {
      return numbers()?.exact ?? false;
    },
    get pixelHash() {
      return numbers()?.pixelHash ?? 0;
    },
    get quality() {
      return numbers()?.quality ?? 0;
    },
    get tiles() {
      return numbers()?.tiles ?? 0;
    },
    get video() {
      return numbers()?.isVideo ?? false;
    },
    get width() {
      return numbers()?.width ?? 0;
    },
    get height() {
      return numbers()?.height ?? 0;
    },
    get fps() {
      return numbers()?.fps ?? 0;
    },
    get inputToDrawnMilliseconds() {
      return numbers()?.inputToDrawnMilliseconds ?? Number.NaN;
    },
    get waitingMilliseconds() {
      return viewer.waitingMilliseconds(performance.now());
    },
    get renderMilliseconds() {
      return numbers()?.renderMilliseconds ?? 0;
    },
    get connection() {
      return state.connection.value.kind;
    },
    get camera() {
      return viewer.camera;
    },
    get swaps() {
      return viewer.arrivals.swaps.recent;
    },
  };
  Object.defineProperty(window, "eyrie", { value: Object.freeze(hooks) });
}
