// SPDX-License-Identifier: Apache-2.0
// Decodes pictures and shows them on the canvas, off the page's thread: half the time until drawn
// of doing it there, and input stays smooth. While a picture is decoded, only the newest of those
// that arrive is kept. Pixels that are to be exact are read back and compared with what the server
// says of its own. Pictures of streams are all decoded, as each needs the one before, and shown in
// the same way.
import type { EncodedPicture } from "../protocol/parts";
import { pixelHash } from "./pixel_hash";
import { VideoPictures } from "./video";

/** To the worker: the canvas once, then pictures. Their bytes are transferred. */
export type ToWorker =
  | { kind: "canvas"; canvas: OffscreenCanvas }
  | { kind: "picture"; frameNumber: number; picture: EncodedPicture };

/** From the worker: `time` is when, in ms since 1970. */
export type FromWorker =
  /** `isVideo`: and no other of a stream will be decoded. */
  | { kind: "failed"; frameNumber: number; time: number; isVideo: boolean }
  /** `exact`: its pixels are the server's, as compared here. */
  | { kind: "drawn"; frameNumber: number; time: number; exact: boolean };

/** What to show next; `order`: of its arrival, over all connections. */
interface Work {
  order: number;
  frameNumber: number;
  picture: EncodedPicture | DecodedVideo;
}

/** Of which the first columns and rows are seen. */
interface DecodedVideo {
  type: "decoded";
  frame: VideoFrame;
  width: number;
  height: number;
}

let context: ImageBitmapRenderingContext | null = null;
let newest: Work | null = null;
let isBusy = false;
let arrivals = 0;
/** The order of the newest that was ever to be shown. */
let newestOrder = 0;
let videos: VideoPictures | null = null;
/** Pictures of streams that are being decoded, by their order. */
const decoding = new Map<number, { frameNumber: number; width: number; height: number }>();

/** The pixels of a picture, read back from another canvas: this one's cannot be. */
function hashOf(bitmap: ImageBitmap): number {
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const reader = canvas.getContext("2d", { willReadFrequently: true, alpha: false });
  reader?.drawImage(bitmap, 0, 0);
  return pixelHash(
    reader?.getImageData(0, 0, bitmap.width, bitmap.height).data ?? new Uint8ClampedArray(),
  );
}

async function bitmapOf(picture: EncodedPicture | DecodedVideo): Promise<ImageBitmap> {
  if (picture.type === "decoded") {
    const bitmap = createImageBitmap(picture.frame, 0, 0, picture.width, picture.height);
    return bitmap.finally(() => picture.frame.close());
  }
  const { type, bytes } = picture;
  return createImageBitmap(new Blob([bytes], { type }), {
    colorSpaceConversion: type === "image/png" ? "none" : "default",
  });
}

/** Whether it is exact. */
async function draw(picture: EncodedPicture | DecodedVideo): Promise<boolean> {
  const bitmap = await bitmapOf(picture);
  const wanted = picture.type === "decoded" ? undefined : picture.pixelHash;
  const isExact = wanted !== undefined && hashOf(bitmap) === wanted;
  context?.transferFromImageBitmap(bitmap);
  return isExact;
}

async function drawNewest(): Promise<void> {
  if (isBusy) return;
  isBusy = true;
  while (newest !== null) {
    const { frameNumber, picture } = newest;
    newest = null;
    const exact = await draw(picture).catch(() => null);
    const time = performance.timeOrigin + performance.now();
    const report: FromWorker =
      exact === null
        ? { kind: "failed", frameNumber, time, isVideo: false }
        : { kind: "drawn", frameNumber, time, exact };
    self.postMessage(report);
  }
  isBusy = false;
}

/** In place of one that has not been shown yet. */
function show(work: Work): void {
  const picture = work.picture;
  if (work.order < newestOrder) {
    if (picture.type === "decoded") picture.frame.close();
    return;
  }
  if (newest?.picture.type === "decoded") newest.picture.frame.close();
  newestOrder = work.order;
  newest = work;
  void drawNewest();
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
  else show({ order, ...known, picture: { type: "decoded", frame, ...known } });
}

function videoFailed(order: number): void {
  const known = takeDecoding(order);
  if (known === undefined) return;
  const time = performance.timeOrigin + performance.now();
  const { frameNumber } = known;
  const report: FromWorker = { kind: "failed", frameNumber, time, isVideo: true };
  self.postMessage(report);
}

function decodeVideo(order: number, frameNumber: number, picture: EncodedPicture): void {
  if (picture.video === undefined) return;
  videos ??= new VideoPictures({ decoded: videoDecoded, failed: videoFailed });
  const { width, height } = picture.video;
  decoding.set(order, { frameNumber, width, height });
  videos.decode(order, picture.bytes, picture.video);
}

self.addEventListener("message", (event: MessageEvent<ToWorker>) => {
  const message = event.data;
  if (message.kind === "canvas") {
    context = message.canvas.getContext("bitmaprenderer");
    return;
  }
  const { frameNumber, picture } = message;
  const order = ++arrivals;
  if (picture.type === "video/h264") decodeVideo(order, frameNumber, picture);
  else show({ order, frameNumber, picture });
});
