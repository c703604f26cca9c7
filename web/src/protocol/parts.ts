// SPDX-License-Identifier: Apache-2.0
// Pictures, of which still ones come in parts so that something newer never waits for them.
import type { Frame, FramePart } from "./messages";

/** A whole picture as it came. */
export interface EncodedPicture {
  type: "image/jpeg" | "image/png";
  bytes: Uint8Array<ArrayBuffer>;
  /** Of the server's pixels; undefined where the picture has others. */
  pixelHash: number | undefined;
}

/** How many bytes of a frame's picture have come, and the picture once that is all of them. */
export interface Arrival {
  frame: Frame;
  receivedBytes: number;
  picture: EncodedPicture | undefined;
}

/** No picture of 4096 x 4096 pixels is larger. */
const mostBytes = 2 ** 27;

export class Parts {
  private frame: Frame | undefined;
  private bytes = new Uint8Array(0);
  private received = 0;

  /** A frame, with the first part of its picture. What was left of the one before never comes. */
  begin(frame: Frame): Arrival {
    const first = (frame.picture.value ?? new Uint8Array(0)) as Uint8Array<ArrayBuffer>;
    const size = Number(frame.pictureBytes);
    if (size > mostBytes) throw new Error(`a picture of ${size} bytes`);
    this.frame = frame;
    this.received = first.length;
    this.bytes = first;
    if (first.length < size) {
      this.bytes = new Uint8Array(size);
      this.bytes.set(first);
    }
    return this.arrival(frame);
  }

  /** More of it; undefined when it belongs to another frame or elsewhere. */
  add(part: FramePart): Arrival | undefined {
    const { frame } = this;
    if (frame === undefined || part.frameNumber !== frame.frameNumber) return undefined;
    if (Number(part.offset) !== this.received) return undefined;
    if (this.received + part.bytes.length > this.bytes.length) return undefined;
    this.bytes.set(part.bytes, this.received);
    this.received += part.bytes.length;
    return this.arrival(frame);
  }

  private arrival(frame: Frame): Arrival {
    const receivedBytes = this.received;
    if (receivedBytes < this.bytes.length) return { frame, receivedBytes, picture: undefined };
    const isPng = frame.picture.case === "png";
    const picture: EncodedPicture = {
      type: isPng ? "image/png" : "image/jpeg",
      bytes: this.bytes,
      pixelHash: isPng ? frame.pixelHash : undefined,
    };
    this.frame = undefined;
    this.bytes = new Uint8Array(0);
    return { frame, receivedBytes, picture };
  }
}
