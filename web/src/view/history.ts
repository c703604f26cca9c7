// SPDX-License-Identifier: Apache-2.0
// The last frames, for plots of them.

export interface Entry {
  /** In ms of performance.now(). */
  time: number;
  cull: number;
  draw: number;
  readback: number;
  /** The whole, all of that and composition. */
  total: number;
  tauAsked: number;
  tauAchieved: number;
  bytes: number;
  /** What the link carries, as estimated; 0: not known. */
  linkBytesPerSecond: number;
}

const remembered = 120;

export class FrameHistory {
  private list: Entry[] = [];

  get entries(): readonly Entry[] {
    return this.list;
  }

  add(entry: Entry): void {
    this.list.push(entry);
    if (this.list.length > remembered) this.list.shift();
  }
}

/** Bits a second in each of `count` spans of `span` ms before `now`, oldest first. */
export function bandwidth(
  entries: readonly Pick<Entry, "time" | "bytes">[],
  now: number,
  span: number,
  count: number,
): number[] {
  const bits = new Array<number>(count).fill(0);
  for (const { time, bytes } of entries) {
    const index = count - 1 - Math.floor((now - time) / span);
    if (index >= 0 && index < count) bits[index] = (bits[index] ?? 0) + (8000 * bytes) / span;
  }
  return bits;
}
