// SPDX-License-Identifier: Apache-2.0

const second = 1000;
const rememberedLatencies = 31;
/** Views that were never shown, because a newer one came before, are forgotten by this. */
const rememberedViews = 256;

/** Frames drawn in the last second: an inter-arrival mean would call two quick frames "fast". */
export class FrameRate {
  private times: number[] = [];

  drawn(now: number): void {
    this.times.push(now);
  }

  /** At `now`, in ms. */
  perSecond(now: number): number {
    this.times = this.times.filter((time) => time > now - second);
    return this.times.length;
  }
}

/** From an input to the frame that shows it. */
export class Latency {
  private readonly waiting = new Map<number, { sentAt: number; inputTime: number | undefined }>();
  private readonly recent: number[] = [];

  /** View `sequence` was sent because of an input at `inputTime`, or of none (on connecting). */
  sent(sequence: number, sentAt: number, inputTime?: number): void {
    this.waiting.set(sequence, { sentAt, inputTime });
    if (this.waiting.size > rememberedViews) this.forget(sequence - rememberedViews);
  }

  /** A frame that shows view `sequence` is on the canvas; the first one counts. */
  drawn(sequence: number, now: number): void {
    const inputTime = this.waiting.get(sequence)?.inputTime;
    this.forget(sequence);
    if (inputTime === undefined) return;
    this.recent.push(now - inputTime);
    if (this.recent.length > rememberedLatencies) this.recent.shift();
  }

  /** When the oldest view was sent that no frame has shown yet, if any. */
  waitingSince(): number | undefined {
    const [oldest] = this.waiting.values(); // in the order of sending
    return oldest?.sentAt;
  }

  /** Of the last few; NaN before any. */
  median(): number {
    const sorted = [...this.recent].sort((a, b) => a - b);
    return sorted[Math.floor(sorted.length / 2)] ?? Number.NaN;
  }

  /** Nothing is under way any more. */
  reset(): void {
    this.waiting.clear();
  }

  private forget(upTo: number): void {
    for (const sequence of this.waiting.keys()) if (sequence <= upTo) this.waiting.delete(sequence);
  }
}

/** Milliseconds that stages of rendering took; vertices and fill are 0 where not measured. */
export interface Stages {
  cull: number;
  vertices: number;
  fill: number;
  readback: number;
}

/** What a person calls the stage that took longest; "" where they were not measured. */
export function limitingStage(stages: Stages | undefined): string {
  if (stages === undefined || stages.vertices + stages.fill <= 0) return "";
  const named: readonly (readonly [number, string])[] = [
    [stages.cull, "the cut"],
    [stages.vertices, "vertices"],
    [stages.fill, "pixels"],
    [stages.readback, "readback"],
  ];
  return named.reduce((most, one) => (one[0] > most[0] ? one : most))[1];
}
