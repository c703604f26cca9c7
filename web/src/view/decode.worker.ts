// SPDX-License-Identifier: Apache-2.0
// Decodes pictures and shows them on the canvas, off the page's thread: half the time until drawn
// of doing it there, and input stays smooth. While a picture is decoded, only the newest of those
// that arrive is kept. Pixels that are to be exact are read back and compared with what the server
// says of its own.
import type { EncodedPicture } from "../protocol/parts";
import { pixelHash } from "./pixel_hash";
import { Presenter } from "./presenter";

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
  | { kind: "failed"; frameNumber: number; time: number }
  | { kind: "ready"; frameNumber: number; time: number }
  /** `exact`: its pixels are the server's, as compared here. */
  | { kind: "drawn"; frameNumber: number; time: number; exact: boolean };

interface Decoded {
  bitmap: ImageBitmap;
  isExact: boolean;
}

let context: ImageBitmapRenderingContext | null = null;

/** The pixels of a picture, read back from another canvas: this one's cannot be. */
function hashOf(bitmap: ImageBitmap): number {
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const reader = canvas.getContext("2d", { willReadFrequently: true, alpha: false });
  reader?.drawImage(bitmap, 0, 0);
  return pixelHash(
    reader?.getImageData(0, 0, bitmap.width, bitmap.height).data ?? new Uint8ClampedArray(),
  );
}

async function decode({ type, bytes, pixelHash: wanted }: EncodedPicture): Promise<Decoded> {
  const bitmap = await createImageBitmap(new Blob([bytes], { type }), {
    colorSpaceConversion: type === "image/png" ? "none" : "default",
  });
  return { bitmap, isExact: wanted !== undefined && hashOf(bitmap) === wanted };
}

function report(told: FromWorker): void {
  self.postMessage(told);
}

const now = (): number => performance.timeOrigin + performance.now();

const presenter = new Presenter<EncodedPicture, Decoded>({
  decode,
  draw: (frameNumber, { bitmap, isExact }) => {
    context?.transferFromImageBitmap(bitmap);
    report({ kind: "drawn", frameNumber, time: now(), exact: isExact });
  },
  drop: ({ bitmap }) => bitmap.close(),
  ready: (frameNumber) => report({ kind: "ready", frameNumber, time: now() }),
  failed: (frameNumber) => report({ kind: "failed", frameNumber, time: now() }),
});

self.addEventListener("message", ({ data }: MessageEvent<ToWorker>) => {
  if (data.kind === "canvas") context = data.canvas.getContext("bitmaprenderer");
  else if (data.kind === "present") presenter.present(data.frameNumber);
  else if (data.kind === "forget") presenter.forget();
  else presenter.show(data.frameNumber, data.picture, data.waits);
});
