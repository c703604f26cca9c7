// SPDX-License-Identifier: Apache-2.0

export interface Size {
  width: number;
  height: number;
}

/** The server makes pictures of 16 to 4096 pixels a side. */
const minSide = 16;
const maxSide = 4096;

/** What a CPU rasteriser is asked for at most: about 1460 x 820. */
export const softwarePixels = 1.2e6;

/**
 * The picture for a canvas of `css` CSS pixels: one pixel per device pixel while that is not more
 * than `maxPixels`, otherwise the same shape with fewer.
 */
export function pictureSize(css: Size, devicePixelRatio: number, maxPixels: number): Size {
  const width = Math.max(1, css.width);
  const height = Math.max(1, css.height);
  const ratio = Math.min(
    Math.max(devicePixelRatio, 1),
    Math.sqrt(maxPixels / (width * height)),
    maxSide / width,
    maxSide / height,
  );
  const side = (pixels: number): number => Math.max(minSide, Math.floor(pixels * ratio));
  return { width: side(width), height: side(height) };
}
