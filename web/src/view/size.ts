// SPDX-License-Identifier: Apache-2.0

export interface Size {
  width: number;
  height: number;
}

/** The server makes pictures of 16 to 4096 pixels a side. */
const minSide = 16;
const maxSide = 4096;

/**
 * The picture for a canvas of `css` CSS pixels: one pixel per device pixel while the server makes
 * that, otherwise the same shape with fewer.
 */
export function pictureSize(css: Size, devicePixelRatio: number): Size {
  const width = Math.max(1, css.width);
  const height = Math.max(1, css.height);
  const ratio = Math.min(Math.max(devicePixelRatio, 1), maxSide / width, maxSide / height);
  const side = (pixels: number): number => Math.max(minSide, Math.floor(pixels * ratio));
  return { width: side(width), height: side(height) };
}
