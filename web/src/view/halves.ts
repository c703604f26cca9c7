// SPDX-License-Identifier: Apache-2.0
// A JPEG whose lower half is coded apart from its upper one, as the server makes them
// (wire/jpeg_halves.h), as two: browsers decode each on a thread of its own. Markers and segments:
// ITU-T T.81 (JPEG), annex B.

const marker = 0xff;
const baselineFrame = 0xc0; // SOF0
const scan = 0xda; // SOS
const restartEvery = 0xdd; // DRI
const firstRestart = 0xd0; // RST0
const lastRestart = 0xd7;
const end = Uint8Array.of(marker, 0xd9);

/** What is known of a JPEG before its coded blocks. */
interface Head {
  /** Where the picture's height is. */
  heightAt: number;
  height: number;
  /** Rows of pixels before the restart marker. */
  upperHeight: number;
  /** Where coded blocks begin. */
  codedAt: number;
}

function headOf(bytes: Uint8Array): Head | null {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let [frameAt, interval] = [0, 0];
  for (let at = 2; at + 4 <= bytes.length && bytes[at] === marker; ) {
    const [kind, length] = [bytes[at + 1], view.getUint16(at + 2)];
    if (at + 2 + length > bytes.length || length < 2) return null;
    if (kind === baselineFrame && length >= 11) frameAt = at + 4;
    else if (kind === restartEvery && length === 4) interval = view.getUint16(at + 4);
    else if (kind === scan)
      return frameAt > 0 ? head(view, frameAt, interval, at + 2 + length) : null;
    at += 2 + length;
  }
  return null;
}

function head(view: DataView, frameAt: number, interval: number, codedAt: number): Head | null {
  const [height, width] = [view.getUint16(frameAt + 1), view.getUint16(frameAt + 3)];
  // Of its first component, brightness, a block has so many.
  const sampling = view.getUint8(frameAt + 7);
  const columns = Math.ceil(width / (8 * (sampling >> 4)));
  const upperHeight = (interval / columns) * 8 * (sampling & 15);
  const isHalf = interval > 0 && interval % columns === 0 && upperHeight < height;
  return isHalf ? { heightAt: frameAt + 1, height, upperHeight, codedAt } : null;
}

/** Where the only restart marker is; -1: there is none, or more than one. */
function restartIn(bytes: Uint8Array, from: number): number {
  let found = -1;
  for (let at = bytes.indexOf(marker, from); at >= 0; at = bytes.indexOf(marker, at + 2)) {
    const kind = bytes[at + 1] ?? 0;
    if (kind < firstRestart || kind > lastRestart) continue;
    if (found >= 0) return -1;
    found = at;
  }
  return found;
}

/** The upper and the lower half of a picture, or null where it is not made of such. */
export function halvesOf(bytes: Uint8Array<ArrayBuffer>): { upper: Blob; lower: Blob } | null {
  const known = headOf(bytes);
  if (known === null) return null;
  const { heightAt, height, upperHeight, codedAt } = known;
  const restart = restartIn(bytes, codedAt);
  if (restart < 0) return null;
  const withHeight = (rows: number): Uint8Array<ArrayBuffer> => {
    const changed = bytes.slice(0, codedAt);
    new DataView(changed.buffer).setUint16(heightAt, rows);
    return changed;
  };
  const type = "image/jpeg";
  const upper = [withHeight(upperHeight), bytes.subarray(codedAt, restart), end];
  const lower = [withHeight(height - upperHeight), bytes.subarray(restart + 2)];
  return { upper: new Blob(upper, { type }), lower: new Blob(lower, { type }) };
}
