// SPDX-License-Identifier: Apache-2.0
// Decodes pictures and shows them on the canvas, off the page's thread: half the time until drawn
// of doing it there, and input stays smooth. While a picture is decoded, only the newest of those
// that arrive is kept. Pixels that are to be exact are read back and compared with what the server
// says of its own.
import type { EncodedPicture } from "../protocol/parts";
import { pixelHash } from "./pixel_hash";

/** To the worker: the canvas once, then pictures. Their bytes are transferred. */
export type ToWorker =
  | { kind: "canvas"; canvas: OffscreenCanvas }
  | { kind: "picture"; frameNumber: number; picture: EncodedPicture };

/** From the worker: `time` is when, in ms since 1970. */
export type FromWorker =
  | { kind: "failed"; frameNumber: number; time: number }
  /** `exact`: its pixels are the server's, as compared here. */
  | { kind: "drawn"; frameNumber: number; time: number; exact: boolean };

type Work = Extract<ToWorker, { kind: "picture" }>;

let context: ImageBitmapRenderingContext | null = null;
let newest: Work | null = null;
let isBusy = false;

/** The pixels of a picture, read back from another canvas: this one's cannot be. */
function hashOf(bitmap: ImageBitmap): number {
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const reader = canvas.getContext("2d", { willReadFrequently: true, alpha: false });
  reader?.drawImage(bitmap, 0, 0);
  return pixelHash(
    reader?.getImageData(0, 0, bitmap.width, bitmap.height).data ?? new Uint8ClampedArray(),
  );
}

/** Whether it is exact. */
async function draw({ type, bytes, pixelHash: wanted }: EncodedPicture): Promise<boolean> {
  const bitmap = await createImageBitmap(new Blob([bytes], { type }), {
    colorSpaceConversion: type === "image/png" ? "none" : "default",
  });
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
        ? { kind: "failed", frameNumber, time }
        : { kind: "drawn", frameNumber, time, exact };
    self.postMessage(report);
  }
  isBusy = false;
}

self.addEventListener("message", (event: MessageEvent<ToWorker>) => {
  if (event.data.kind === "canvas") {
    context = event.data.canvas.getContext("bitmaprenderer");
  } else {
    newest = event.data;
    void drawNewest();
  }
});
