// SPDX-License-Identifier: Apache-2.0
// A picture larger than the window: bands of the one view, each drawn by the server as it is in the
// whole (docs/decisions/0036-posters-by-bands.md), put together here.
import type { ImageRequest } from "../command";
import { imageAddress } from "../command";
import { ask } from "../protocol/ask";
import type { Size } from "../view/size";
import { PngWriter } from "./png";

export const largestSide = 16384;
const smallestSide = 256;
/** Of a band: some 32 MB as pixels. */
const bandPixels = 8 << 20;
/** That one answer of the server may have a side. */
const largestPart = 8192;

/** Of the shape of `shown`, with so many pixels on its longer side, rounded. */
export function posterSize(shown: Size, longer: number): Size {
  const side = Math.min(largestSide, Math.max(smallestSide, Math.round(longer)));
  const scale = side / Math.max(shown.width, shown.height);
  return {
    width: Math.max(1, Math.round(shown.width * scale)),
    height: Math.max(1, Math.round(shown.height * scale)),
  };
}

/** A part of a picture, pixels from its lower left corner. */
export interface Part {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** Whole rows from the top down, each of one part or of several side by side. */
export function bandsOf({ width, height }: Size, most = bandPixels): Part[][] {
  const rows = Math.max(1, Math.min(largestPart, Math.floor(most / width)));
  const bands: Part[][] = [];
  for (let top = height; top > 0; top -= rows) {
    const y = Math.max(0, top - rows);
    const band: Part[] = [];
    for (let x = 0; x < width; x += largestPart)
      band.push({ x, y, width: Math.min(largestPart, width - x), height: top - y });
    bands.push(band);
  }
  return bands;
}

interface Drawn {
  rgba: Uint8Array;
  /** Pixels of error. */
  error: number;
  /** Of what was drawn: parts of one picture have the same. */
  revision: string | null;
}

async function draw(request: ImageRequest, part: Part, signal: AbortSignal): Promise<Drawn> {
  const response = await ask(imageAddress(window.location.href), {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ ...request, format: "IMAGE_FORMAT_RAW", part }),
    signal,
  });
  if (!response.ok) {
    const problem = (await response.json().catch(() => ({}))) as { detail?: string };
    throw new Error(problem.detail ?? `the server answers ${response.status}`);
  }
  const rgba = new Uint8Array(await response.arrayBuffer());
  if (rgba.length !== 4 * part.width * part.height)
    throw new Error("the server sent a picture of another size");
  const { headers } = response;
  return {
    rgba,
    error: Number(headers.get("Eyrie-Tau-Achieved") ?? Number.NaN),
    revision: headers.get("Eyrie-Revision"),
  };
}

/** Parts of one band, side by side, as whole rows. */
export function sideBySide(
  parts: readonly { rgba: Uint8Array; width: number }[],
  width: number,
): Uint8Array {
  const [first] = parts;
  if (parts.length === 1 && first !== undefined) return first.rgba;
  const rows = (first?.rgba.length ?? 0) / (4 * (first?.width ?? 1));
  const whole = new Uint8Array(4 * width * rows);
  let left = 0;
  for (const part of parts) {
    const stride = 4 * part.width;
    for (let row = 0; row < rows; ++row)
      whole.set(part.rgba.subarray(row * stride, (row + 1) * stride), 4 * (row * width + left));
    left += part.width;
  }
  return whole;
}

export interface Poster {
  file: Blob;
  /** The largest of its parts' bounds on the error, pixels of the poster. */
  error: number;
}

/** Throws an Error, for the user to read; `tell` hears of each band that is done. */
export async function drawPoster(
  request: ImageRequest,
  tell: (done: number, all: number) => void,
  signal: AbortSignal,
): Promise<Poster> {
  const bands = bandsOf(request);
  const png = new PngWriter(request.width, request.height);
  let error = 0;
  let revision: string | null | undefined;
  try {
    for (const [i, band] of bands.entries()) {
      tell(i, bands.length);
      const parts = [];
      for (const part of band) {
        const drawn = await draw(request, part, signal);
        revision ??= drawn.revision;
        if (drawn.revision !== revision)
          throw new Error("what is shown was changed meanwhile; nothing is saved");
        error = Math.max(error, drawn.error);
        parts.push({ rgba: drawn.rgba, width: part.width });
      }
      await png.add(sideBySide(parts, request.width));
    }
    return { file: await png.finish(), error };
  } catch (failure) {
    png.cancel();
    throw failure;
  }
}
