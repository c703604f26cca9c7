// SPDX-License-Identifier: Apache-2.0
// Pictures, of which still ones come in parts so that something newer never waits for them.
import type { Frame, FramePart } from "./messages";

/** Where in which stream of H.264 a picture is, and how much of it is seen: it is coded with even sides. */
export interface VideoPlace {
  stream: bigint;
  picture: bigint;
  isKey: boolean;
  width: number;
  height: number;
}

/** One of the JPEGs that a picture is laid out of, by its upper left corner. */
export interface Tile {
  x: number;
  y: number;
  bytes: Uint8Array<ArrayBuffer>;
}

/** A whole picture as it came. */
export interface EncodedPicture {
  type: "image/jpeg" | "image/png" | "video/h264";
  bytes: Uint8Array<ArrayBuffer>;
  /** Of several JPEGs, each; none: it is one. */
  tiles: readonly Tile[];
  /** Of the server's pixels; undefined where the picture has others. */
  pixelHash: number | undefined;
  /** Of H.264. */
  video: VideoPlace | undefined;
}

/** How many bytes of a frame's picture have come, and the picture once that is all of them. */
export interface Arrival {
  frame: Frame;
  receivedBytes: number;
  picture: EncodedPicture | undefined;
}

/** No picture is larger: 4096 x 4096 pixels an eye, two eyes at most, three bytes a pixel. */
const mostBytes = 2 ** 27;

const types = { jpeg: "image/jpeg", png: "image/png", h264: "video/h264" } as const;

function placeOf({ video, width, height }: Frame): VideoPlace {
  if (video === undefined) throw new Error("H.264 of no stream");
  return { stream: video.stream, picture: video.picture, isKey: video.key, width, height };
}

/** Throws where they are not just as many bytes as the picture has. */
function tilesOf({ tiles }: Frame, bytes: Uint8Array<ArrayBuffer>): Tile[] {
  let at = 0;
  const pieces = tiles.map((tile) => {
    const from = at;
    at += Number(tile.bytes);
    return { x: tile.x, y: tile.y, bytes: bytes.subarray(from, at) };
  });
  if (tiles.length > 0 && at !== bytes.length)
    throw new Error(`tiles of ${at} bytes in a picture of ${bytes.length}`);
  return pieces;
}

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
    const kind = frame.picture.case ?? "jpeg";
    const picture: EncodedPicture = {
      type: types[kind],
      bytes: this.bytes,
      tiles: tilesOf(frame, this.bytes),
      pixelHash: kind === "png" ? frame.pixelHash : undefined,
      video: kind === "h264" ? placeOf(frame) : undefined,
    };
    this.frame = undefined;
    this.bytes = new Uint8Array(0);
    return { frame, receivedBytes, picture };
  }
}
