// SPDX-License-Identifier: Apache-2.0
// Decodes pictures and shows them on the canvas, off the page's thread: half the time until drawn
// of doing it there, and input stays smooth. While a picture is decoded, only the newest of those
// that arrive is kept.

/** To the worker: the canvas once, then pictures. `jpeg` is transferred. */
export type ToWorker =
  | { kind: "canvas"; canvas: OffscreenCanvas }
  | { kind: "picture"; frameNumber: number; jpeg: Uint8Array<ArrayBuffer> };

/** From the worker: `time` is when, in ms since 1970. */
export type FromWorker = { kind: "drawn" | "failed"; frameNumber: number; time: number };

type Picture = Extract<ToWorker, { kind: "picture" }>;

let context: ImageBitmapRenderingContext | null = null;
let newest: Picture | null = null;
let isBusy = false;

async function draw(picture: Picture): Promise<FromWorker["kind"]> {
  try {
    const bitmap = await createImageBitmap(new Blob([picture.jpeg], { type: "image/jpeg" }));
    context?.transferFromImageBitmap(bitmap);
    return "drawn";
  } catch {
    return "failed";
  }
}

async function drawNewest(): Promise<void> {
  if (isBusy) return;
  isBusy = true;
  while (newest !== null) {
    const picture = newest;
    newest = null;
    const kind = await draw(picture);
    const time = performance.timeOrigin + performance.now();
    const report: FromWorker = { kind, frameNumber: picture.frameNumber, time };
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
