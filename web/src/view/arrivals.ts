// SPDX-License-Identifier: Apache-2.0
import type { Frame } from "../protocol/messages";
import type { EncodedPicture } from "../protocol/parts";
import type { PictureCanvas } from "./canvas";
import { Swaps } from "./swaps";

/** To whom it is told what has become of a frame. */
export interface Sender {
  /** It is on the canvas, or never will be, and so are all before it. */
  acknowledge(frameNumber: number, decodeMilliseconds: number): void;
  /** It has been decoded, and waits until all screens of the swap barrier have. */
  ready(swap: bigint): void;
}

interface Arrived {
  frame: Frame;
  /** When, in ms of performance.now(). */
  at: number;
  picture: Blob | undefined;
}

export interface Drawn {
  frame: Frame;
  /** As the server has encoded it, where it may be saved as a file. */
  picture: Blob | undefined;
}

/** Frames on their way from the server to the canvas. Times are of performance.now(). */
export class Arrivals {
  readonly swaps = new Swaps();
  private readonly frames = new Map<number, Arrived>();

  constructor(
    private readonly canvas: Pick<PictureCanvas, "show" | "present" | "forget">,
    private readonly sender: Sender,
  ) {}

  /** Takes the picture's buffer away. */
  arrived(frame: Frame, picture: EncodedPicture): void {
    const frameNumber = Number(frame.frameNumber);
    frame.picture = { case: undefined };
    // The worker takes the bytes; those of an exact picture may be saved as a file.
    const kept = picture.type === "image/png" ? new Blob([picture.bytes], picture) : undefined;
    this.frames.set(frameNumber, { frame, at: performance.now(), picture: kept });
    this.canvas.show(frameNumber, picture, frame.swap !== 0n);
  }

  ready(frameNumber: number, time: number): void {
    const swap = this.frames.get(frameNumber)?.frame.swap ?? 0n;
    if (swap === 0n) return;
    this.sender.ready(swap);
    this.swaps.ready(swap, time);
  }

  /** All screens have it. */
  swap(swap: bigint): void {
    for (const [frameNumber, { frame }] of this.frames)
      if (frame.swap === swap) this.canvas.present(frameNumber);
  }

  failed(frameNumber: number): void {
    const now = performance.now();
    this.ready(frameNumber, now); // the other screens need not wait
    this.acknowledge(frameNumber, now);
  }

  /** Undefined: of a connection that is gone. */
  drawn(frameNumber: number, time: number): Drawn | undefined {
    const arrived = this.acknowledge(frameNumber, time);
    if (arrived !== undefined) this.swaps.drawn(arrived.frame.swap, time);
    return arrived;
  }

  /** The connection is lost, and numbers begin anew. */
  forget(): void {
    this.frames.clear();
    this.canvas.forget();
  }

  private acknowledge(frameNumber: number, time: number): Arrived | undefined {
    const arrived = this.frames.get(frameNumber);
    this.sender.acknowledge(frameNumber, Math.max(0, time - (arrived?.at ?? time)));
    for (const known of this.frames.keys()) if (known <= frameNumber) this.frames.delete(known);
    return arrived;
  }
}
