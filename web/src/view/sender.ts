// SPDX-License-Identifier: Apache-2.0
import { isPacked } from "../output";
import type { Shown, View } from "../protocol/messages";
import { Latency } from "./measure";

export type WantedView = Omit<View, "sequence">;

export interface ViewSource {
  /** Null while there is nothing to ask for. */
  wantedView(): WantedView | null;
  /** False when the view could not be sent now. */
  sendView(view: View): boolean;
  /** Whether it may be sent with the next frame; if not, who connects asks for it. */
  isConnected(): boolean;
}

/** Sends the newest view, once a frame at most, and remembers what was sent until it is shown. */
export class ViewSender {
  private sequence = 0;
  /** What was sent and not drawn yet. */
  private readonly sent = new Map<number, Shown>();
  /** Of the last view, as text; empty before any on this connection. */
  private content = "";
  private sendAt: number | undefined;
  private inputTime: number | undefined;
  private readonly latency = new Latency();

  constructor(private readonly source: ViewSource) {}

  /**
   * Sends the view with the next animation frame, or before that with an acknowledgement: the
   * newest one then. `inputTime` is of the input that caused it, if one did.
   */
  request(inputTime?: number): void {
    this.inputTime ??= inputTime;
    this.sendAt ??= requestAnimationFrame(() => this.send());
  }

  /** What was asked for, without waiting for the next animation frame. */
  sendNow(): void {
    if (this.sendAt === undefined) return;
    cancelAnimationFrame(this.sendAt);
    this.send();
  }

  /** While no picture is on its way there is nothing to wait for. */
  sendUnlessWaiting(): void {
    if (this.waitingSince() === undefined) this.sendNow();
  }

  /** Whether no newer view than that was sent or asked for, nor could be on a lost connection. */
  isNewest(sequence: number | undefined): boolean {
    return this.content !== "" && sequence === this.sequence && this.sendAt === undefined;
  }

  /** A frame of that view is on the canvas. */
  drawn(sequence: number, time: number): void {
    this.latency.drawn(sequence, time);
  }

  /** What was sent as that view, if it was sent here. Forgets all before. */
  shownBy(sequence: number): Shown | undefined {
    for (const known of this.sent.keys()) if (known < sequence) this.sent.delete(known);
    return this.sent.get(sequence);
  }

  /** When the oldest view was sent that no frame has shown yet, if any. */
  waitingSince(): number | undefined {
    return this.latency.waitingSince();
  }

  /** From an input to its picture: the median of the last few. */
  medianLatency(): number {
    return this.latency.median();
  }

  /** The server does not know the last view, or has another by now: the next one goes in any case. */
  forgetLast(): void {
    this.content = "";
  }

  /** What was sent will not be answered. */
  forgetAll(): void {
    this.latency.reset();
    this.forgetLast();
  }

  /** As forgetAll; what was put in before is no latency of the next connection's. */
  lost(): void {
    this.forgetAll();
    this.inputTime = undefined;
  }

  private send(): void {
    this.sendAt = undefined;
    const inputTime = this.inputTime;
    this.inputTime = undefined;
    const view = this.source.wantedView();
    if (view === null) return;
    // The server has nothing to draw for the same view again.
    const content = JSON.stringify(view);
    if (content === this.content) return;
    // A view that cannot go now goes when the connection opens, or with the next frame.
    if (!this.source.sendView({ sequence: this.sequence + 1, ...view })) {
      if (this.source.isConnected()) this.request(inputTime);
      return;
    }
    this.content = content;
    this.sequence += 1;
    const { camera, width, height, look, output } = view;
    const { exaggeration, hidden } = look;
    const shown = { camera, width, height, exaggeration, hidden };
    this.sent.set(this.sequence, { ...shown, seen: null, isPacked: isPacked(output) });
    this.latency.sent(this.sequence, performance.now(), inputTime);
  }
}
