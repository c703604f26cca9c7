// SPDX-License-Identifier: Apache-2.0

/**
 * What proto/fabric/pixel_hash.h says of a picture, from pixels of red, green, blue and alpha, rows
 * from the top: equal where red, green and blue are. A single wrong pixel always shows.
 */
export function pixelHash(rgba: Uint8ClampedArray): number {
  let hash = 2166136261;
  for (let i = 0; i + 3 < rgba.length; i += 4) {
    const word = rgba[i]! | (rgba[i + 1]! << 8) | (rgba[i + 2]! << 16);
    hash = Math.imul(hash ^ word, 16777619);
  }
  return hash >>> 0;
}
