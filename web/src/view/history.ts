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

/** What came when. */
export type Arrival = Pick<Entry, "time" | "bytes">;

const remembered = 120;
/** For how long it is known what came, however many frames that are; in ms. */
export const arrivalsKept = 30_000;

export class FrameHistory {
  private list: Entry[] = [];
  private came: Arrival[] = [];

  get entries(): readonly Entry[] {
    return this.list;
  }

  get arrivals(): readonly Arrival[] {
    return this.came;
  }

  add(entry: Entry): void {
    this.list.push(entry);
    if (this.list.length > remembered) this.list.shift();
    const { time, bytes } = entry;
    this.came = this.came.filter((one) => one.time > time - arrivalsKept);
    this.came.push({ time, bytes });
  }
}

/** Bits a second in each of `count` spans of `span` ms before `now`, oldest first. */
export function bandwidth(
  arrivals: readonly Arrival[],
  now: number,
  span: number,
  count: number,
): number[] {
  const bits = new Array<number>(count).fill(0);
  for (const { time, bytes } of arrivals) {
    const index = count - 1 - Math.floor((now - time) / span);
    if (index >= 0 && index < count) bits[index] = (bits[index] ?? 0) + (8000 * bytes) / span;
  }
  return bits;
}
