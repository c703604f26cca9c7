// SPDX-License-Identifier: Apache-2.0
import type { EncodedPicture } from "../protocol/parts";
import type { FromWorker, ToWorker } from "./decode.worker";
import type { Size } from "./size";

export interface CanvasEvents {
  /** The picture of this frame is on the canvas; `time` in ms of performance.now(). `isExact`: its pixels are the server's. */
  drawn(frameNumber: number, time: number, isExact: boolean): void;
  /** This frame's picture could not be decoded. */
  failed(frameNumber: number): void;
  /** Nor will those of any other stream of H.264 be. */
  videoFailed(): void;
  /** This frame's picture has been decoded, and is kept until it is presented; `time` as of drawn(). */
  ready(frameNumber: number, time: number): void;
  /** The worker did not start: no picture will ever be drawn. */
  workerFailed(): void;
  /** The canvas has another size, in CSS pixels, and has kept it for a moment. */
  resized(size: Size): void;
}

const resizeSettlesAfter = 150;

/** The canvas and the worker that draws on it. */
export class PictureCanvas {
  private readonly worker: Worker;
  private readonly observer: ResizeObserver;
  private readonly closed = new AbortController();
  private resizeTimer: number | undefined;
  private hasReported = false;

  constructor(
    readonly element: HTMLCanvasElement,
    private readonly events: CanvasEvents,
  ) {
    this.setFilled(false); // whoever the canvas is of
    this.worker = new Worker(new URL("./decode.worker.ts", import.meta.url), { type: "module" });
    this.worker.onmessage = (event: MessageEvent<FromWorker>) => this.reported(event.data);
    this.worker.onerror = () => {
      if (!this.hasReported) this.events.workerFailed();
    };
    const canvas = element.transferControlToOffscreen();
    this.post({ kind: "canvas", canvas }, [canvas]);
    this.observer = new ResizeObserver(() => this.resizeSoon());
    this.observer.observe(element);
    this.watchPixelRatio();
  }

  static isSupported(): boolean {
    return typeof OffscreenCanvas !== "undefined" && typeof createImageBitmap !== "undefined";
  }

  /** Whether pictures fill it whatever their shape, or cover it and lose two sides. */
  setFilled(isFilled: boolean): void {
    this.element.style.objectFit = isFilled ? "fill" : "cover"; // as pick.ts reckons
  }

  size(): Size {
    return { width: this.element.clientWidth, height: this.element.clientHeight };
  }

  /**
   * Shows a picture soon, or, where it `waits`, once it is presented; unless a newer one comes first.
   * Takes the bytes' buffer away.
   */
  show(frameNumber: number, picture: EncodedPicture, waits = false): void {
    this.post({ kind: "picture", frameNumber, picture, waits }, [picture.bytes.buffer]);
  }

  /** Shows the picture that waits, if it still does. */
  present(frameNumber: number): void {
    this.post({ kind: "present", frameNumber }, []);
  }

  /** What waits to be presented never will be, and numbers begin anew. */
  forget(): void {
    this.post({ kind: "forget" }, []);
  }

  close(): void {
    clearTimeout(this.resizeTimer);
    this.observer.disconnect();
    this.closed.abort();
    this.worker.terminate();
  }

  private post(message: ToWorker, transfer: Transferable[]): void {
    this.worker.postMessage(message, transfer);
  }

  private reported(report: FromWorker): void {
    this.hasReported = true;
    const time = report.time - performance.timeOrigin;
    if (report.kind === "failed") {
      if (report.isVideo) this.events.videoFailed();
      this.events.failed(report.frameNumber);
    } else if (report.kind === "ready") this.events.ready(report.frameNumber, time);
    else this.events.drawn(report.frameNumber, time, report.exact);
  }

  /** It changes where a window goes to another screen, or its page is zoomed. */
  private watchPixelRatio(): void {
    window.matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`).addEventListener(
      "change",
      () => {
        this.resizeSoon();
        this.watchPixelRatio();
      },
      { once: true, signal: this.closed.signal },
    );
  }

  private resizeSoon(): void {
    clearTimeout(this.resizeTimer);
    this.resizeTimer = window.setTimeout(
      () => this.events.resized(this.size()),
      resizeSettlesAfter,
    );
  }
}
