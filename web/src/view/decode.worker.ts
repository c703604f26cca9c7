// SPDX-License-Identifier: Apache-2.0
// Decodes pictures and shows them on the canvas, off the page's thread: half the time until drawn
// of doing it there, and input stays smooth. While a picture is decoded, only the newest of those
// that arrive is kept. Pixels that are to be exact are read back and compared with what the server
// says of its own. Pictures of streams are all decoded, as each needs the one before, and shown in
// the same way.
import type { EncodedPicture, Tile } from "../protocol/parts";
import { halvesOf } from "./halves";
import { pixelHash } from "./pixel_hash";
import { Presenter } from "./presenter";
import { VideoPictures } from "./video";

/** To the worker: the canvas once, then pictures. Their bytes are transferred. */
export type ToWorker =
  | { kind: "canvas"; canvas: OffscreenCanvas }
  /** `waits`: it is kept until it is presented. */
  | { kind: "picture"; frameNumber: number; picture: EncodedPicture; waits: boolean }
  | { kind: "present"; frameNumber: number }
  /** Numbers begin anew. */
  | { kind: "forget" };

/** From the worker: `time` is when, in ms since 1970. */
export type FromWorker =
  /** `isVideo`: and no other of a stream will be decoded. */
  | { kind: "failed"; frameNumber: number; time: number; isVideo: boolean }
  | { kind: "ready"; frameNumber: number; time: number }
  /** `exact`: its pixels are the server's, as compared here. */
  | { kind: "drawn"; frameNumber: number; time: number; exact: boolean };

/** Of which the first columns and rows are seen. */
interface DecodedVideo {
  type: "decoded";
  frame: VideoFrame;
  width: number;
  height: number;
}

/** A part of a picture, by its upper left corner. */
interface Piece {
  x: number;
  y: number;
  bitmap: ImageBitmap;
}

/** A picture in one piece or in several, which are all of it. */
interface Decoded {
  pieces: readonly Piece[];
  isExact: boolean;
}

let context: OffscreenCanvasRenderingContext2D | null = null;
let arrivals = 0;
/** The order of the newest that was ever to be shown. */
let newestOrder = 0;
let videos: VideoPictures | null = null;
/** Pictures of streams that are being decoded, by the order of their arrival. */
const decoding = new Map<number, { frameNumber: number; width: number; height: number }>();

/** Drawn to by the processor, as pictures are decoded by it: their pixels come as they are. */
function contextOf(canvas: OffscreenCanvas): OffscreenCanvasRenderingContext2D | null {
  return canvas.getContext("2d", { alpha: false, willReadFrequently: true });
}

/** On a canvas that becomes as large as they are. */
function paint(on: OffscreenCanvasRenderingContext2D, pieces: readonly Piece[]): void {
  const width = Math.max(...pieces.map(({ x, bitmap }) => x + bitmap.width));
  const height = Math.max(...pieces.map(({ y, bitmap }) => y + bitmap.height));
  if (on.canvas.width !== width) on.canvas.width = width;
  if (on.canvas.height !== height) on.canvas.height = height;
  for (const { x, y, bitmap } of pieces) on.drawImage(bitmap, x, y);
}

function close(pieces: readonly Piece[]): void {
  for (const { bitmap } of pieces) bitmap.close();
}

/** Its pixels, read back from another canvas, which need not be waited for until it is shown. */
function hashOf(pieces: readonly Piece[]): number {
  const reader = contextOf(new OffscreenCanvas(1, 1));
  if (reader === null) return Number.NaN;
  paint(reader, pieces);
  const { width, height } = reader.canvas;
  return pixelHash(reader.getImageData(0, 0, width, height).data);
}

async function tile({ x, y, bytes }: Tile): Promise<Piece> {
  return { x, y, bitmap: await createImageBitmap(new Blob([bytes], { type: "image/jpeg" })) };
}

async function piecesOf(picture: EncodedPicture | DecodedVideo): Promise<readonly Piece[]> {
  const [x, y] = [0, 0];
  if (picture.type === "decoded") {
    const { frame, width, height } = picture;
    const bitmap = createImageBitmap(frame, 0, 0, width, height);
    return [{ x, y, bitmap: await bitmap.finally(() => frame.close()) }];
  }
  const { type, bytes, tiles } = picture;
  if (tiles.length > 1) return Promise.all(tiles.map(tile));
  const halves = type === "image/jpeg" ? halvesOf(bytes) : null;
  if (halves !== null) {
    const both = [createImageBitmap(halves.upper), createImageBitmap(halves.lower)] as const;
    const [upper, lower] = await Promise.all(both);
    return [
      { x, y, bitmap: upper },
      { x, y: upper.height, bitmap: lower },
    ];
  }
  const colorSpaceConversion = type === "image/png" ? "none" : "default";
  const blob = new Blob([bytes], { type });
  return [{ x, y, bitmap: await createImageBitmap(blob, { colorSpaceConversion }) }];
}

async function decode(picture: EncodedPicture | DecodedVideo): Promise<Decoded> {
  const pieces = await piecesOf(picture);
  const wanted = picture.type === "decoded" ? undefined : picture.pixelHash;
  return { pieces, isExact: wanted !== undefined && hashOf(pieces) === wanted };
}

function report(told: FromWorker): void {
  self.postMessage(told);
}

const now = (): number => performance.timeOrigin + performance.now();

function skip(picture: EncodedPicture | DecodedVideo): void {
  if (picture.type === "decoded") picture.frame.close();
}

const presenter = new Presenter<EncodedPicture | DecodedVideo, Decoded>({
  decode,
  skip,
  draw: (frameNumber, { pieces, isExact }) => {
    if (context !== null) paint(context, pieces);
    close(pieces);
    report({ kind: "drawn", frameNumber, time: now(), exact: isExact });
  },
  drop: ({ pieces }) => close(pieces),
  ready: (frameNumber) => report({ kind: "ready", frameNumber, time: now() }),
  failed: (frameNumber) => report({ kind: "failed", frameNumber, time: now(), isVideo: false }),
});

/** Unless a later one has come before it; `order`: of its arrival, over all connections. */
function show(
  order: number,
  frameNumber: number,
  picture: EncodedPicture | DecodedVideo,
  waits: boolean,
): void {
  if (order < newestOrder) {
    skip(picture);
    return;
  }
  newestOrder = order;
  presenter.show(frameNumber, picture, waits);
}

/** What was known of it; of those before it nothing is kept. */
function takeDecoding(order: number) {
  const known = decoding.get(order);
  for (const each of decoding.keys()) if (each <= order) decoding.delete(each);
  return known;
}

function videoDecoded(order: number, frame: VideoFrame): void {
  const known = takeDecoding(order);
  if (known === undefined) frame.close();
  else show(order, known.frameNumber, { type: "decoded", frame, ...known }, false);
}

function videoFailed(order: number): void {
  const known = takeDecoding(order);
  if (known === undefined) return;
  report({ kind: "failed", frameNumber: known.frameNumber, time: now(), isVideo: true });
}

function decodeVideo(order: number, frameNumber: number, picture: EncodedPicture): void {
  if (picture.video === undefined) return;
  videos ??= new VideoPictures({ decoded: videoDecoded, failed: videoFailed });
  const { width, height } = picture.video;
  decoding.set(order, { frameNumber, width, height });
  videos.decode(order, picture.bytes, picture.video);
}

function take({ frameNumber, picture, waits }: ToWorker & { kind: "picture" }): void {
  const order = ++arrivals;
  if (picture.type === "video/h264") decodeVideo(order, frameNumber, picture);
  else show(order, frameNumber, picture, waits);
}

self.addEventListener("message", ({ data }: MessageEvent<ToWorker>) => {
  if (data.kind === "canvas") context = contextOf(data.canvas);
  else if (data.kind === "present") presenter.present(data.frameNumber);
  else if (data.kind === "forget") presenter.forget();
  else take(data);
});
