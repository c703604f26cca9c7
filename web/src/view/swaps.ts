// SPDX-License-Identifier: Apache-2.0

/** A picture behind a swap barrier: when it was decoded and drawn (0: not yet), in ms since 1970. */
export interface Swap {
  /** The same on all screens of the session. */
  swap: number;
  ready: number;
  drawn: number;
}

const swapsKept = 256;

/** The last pictures that were shown behind a swap barrier. Times are of performance.now(). */
export class Swaps {
  readonly recent: Swap[] = [];

  ready(swap: bigint, time: number): void {
    this.recent.push({ swap: Number(swap), ready: performance.timeOrigin + time, drawn: 0 });
    if (this.recent.length > swapsKept) this.recent.shift();
  }

  drawn(swap: bigint, time: number): void {
    const last = this.recent.at(-1);
    if (last?.swap === Number(swap)) last.drawn = performance.timeOrigin + time;
  }
}
