// SPDX-License-Identifier: Apache-2.0
import type { Vec3 } from "../camera/camera";
import type { Output } from "../output";
import type {
  Frame,
  Place,
  SessionState,
  Shown,
  View,
  ViewerPicked,
  ViewerProfiled,
} from "./messages";
import {
  decodeResponse,
  encodeAbilities,
  encodeAck,
  encodeLead,
  encodePartAck,
  encodePick,
  encodeProfile,
  encodeReady,
  encodeScreen,
  encodeSwitch,
  encodeView,
} from "./messages";
import type { Arrival, EncodedPicture } from "./parts";
import { Parts } from "./parts";
import type { Refusal } from "./refusal";
import { refusalOf } from "./refusal";

export interface SocketEvents {
  opened(): void;
  /** Called once per loss, not per failed attempt to connect again. */
  lost(): void;
  /** After a loss, and each attempt in vain: why the server takes no connection; "": none says. */
  refused(text: string): void;
  /** A program has closed the session: there will be no other attempt to connect. */
  closed(): void;
  state(state: SessionState): void;
  frame(frame: Frame, picture: EncodedPicture): void;
  picked(picked: ViewerPicked): void;
  profiled(profiled: ViewerProfiled): void;
  /** The picture with that swap is to be shown now. */
  swap(swap: bigint): void;
}

/**
 * How long to wait before attempt number `attempt` (0 is the first after a loss), in ms: a server
 * that starts again is noticed within half a second.
 */
export function reconnectDelay(attempt: number): number {
  return attempt === 0 ? 0 : Math.min(500, 250 * attempt);
}

/** How a WebSocket ends whose session a program has closed (viewer.proto). */
const sessionClosed = 4001;

/**
 * A server says every three seconds that it is there (viewer.proto): after so many with nothing from
 * it a connection has died without being closed, or an attempt to make one leads nowhere.
 */
const silentSeconds = 10;

/** So much unsent means that the network stalls; views are coalesced meanwhile. */
const maxBufferedBytes = 16 * 1024;

/** The connection to the server, made again whenever it is lost. */
export class Socket {
  private socket: WebSocket | null = null;
  private attempt = 0;
  private isLossTold = false;
  private isClosed = false;
  private timer: number | undefined;
  private secondsSilent = 0;
  private readonly watch: number;
  private readonly parts = new Parts();

  constructor(
    /** A function is asked before each attempt. */
    private readonly url: string | (() => string),
    private readonly events: SocketEvents,
  ) {
    this.watch = window.setInterval(() => this.secondPassed(), 1000);
    this.connect();
  }

  /** False when the view could not be sent now; try again with the newest one. */
  sendView(view: View): boolean {
    if (!this.canSend()) return false;
    this.socket?.send(encodeView(view));
    return true;
  }

  acknowledge(frameNumber: number, decodeMilliseconds: number): void {
    if (this.isOpen) this.socket?.send(encodeAck(frameNumber, decodeMilliseconds));
  }

  /** False when it could not be sent; who clicks may click again. */
  pick(sequence: number, shown: Shown, place: Place): boolean {
    if (!this.canSend()) return false;
    this.socket?.send(encodePick(sequence, shown, place));
    return true;
  }

  /** False when it could not be sent. */
  profile(
    sequence: number,
    from: Vec3,
    to: Vec3,
    samples: number,
    hidden: readonly number[],
  ): boolean {
    if (!this.canSend()) return false;
    this.socket?.send(encodeProfile(sequence, from, to, samples, hidden));
    return true;
  }

  switchLayout(canvas: string, layout: string): void {
    if (this.isOpen) this.socket?.send(encodeSwitch(canvas, layout));
  }

  /** Null: what the leader asks for. */
  sendScreen(output: Output | null): void {
    if (this.isOpen) this.socket?.send(encodeScreen(output));
  }

  ready(swap: bigint): void {
    if (this.isOpen) this.socket?.send(encodeReady(swap));
  }

  takeLead(): void {
    if (this.isOpen) this.socket?.send(encodeLead());
  }

  /** What can be shown, H.264 perhaps; the server takes it that nothing can until it is told. */
  tellAbilities(h264: boolean): void {
    if (this.isOpen) this.socket?.send(encodeAbilities(h264));
  }

  close(): void {
    this.isClosed = true;
    clearInterval(this.watch);
    clearTimeout(this.timer);
    this.detach();
  }

  /** Not any more once the server has begun to close it. */
  private get isOpen(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  private canSend(): boolean {
    return this.isOpen && this.socket !== null && this.socket.bufferedAmount < maxBufferedBytes;
  }

  private connect(): void {
    const url = typeof this.url === "string" ? this.url : this.url();
    const socket = new WebSocket(url);
    let hasOpened = false;
    this.socket = socket;
    this.secondsSilent = 0;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      hasOpened = true;
      this.secondsSilent = 0;
      this.isLossTold = false;
      this.events.opened();
    };
    socket.onclose = ({ code }) => {
      if (code === sessionClosed) {
        this.detach();
        this.events.closed();
      } else if (hasOpened) this.reconnect();
      else void this.failed(url);
    };
    socket.onmessage = (event: MessageEvent<unknown>) => this.received(event.data);
  }

  /**
   * Counted, not told by a clock: in a page that was frozen, or on a machine that slept, messages may
   * only now be about to come, and in one that nobody sees timers and messages wait as they like.
   */
  private secondPassed(): void {
    if (this.socket === null || document.hidden) {
      this.secondsSilent = 0;
      return;
    }
    this.secondsSilent += 1;
    if (this.secondsSilent >= silentSeconds) this.reconnect();
  }

  private received(data: unknown): void {
    this.secondsSilent = 0;
    let tell: () => void;
    try {
      if (!(data instanceof ArrayBuffer)) throw new Error("a text message");
      tell = this.understood(data);
    } catch (error) {
      // Another protocol, most likely of a newer server: only loading the page again can help.
      console.error("Eyrie: not understood:", error);
      this.reconnect();
      return;
    }
    // Only now: who takes connections and closes them at once is asked no oftener than who is away.
    this.attempt = 0;
    // What a listener throws is the listener's, and no reason to connect again.
    tell();
  }

  /** How to tell of it. Throws what cannot be decoded. */
  private understood(data: ArrayBuffer): () => void {
    const { response } = decodeResponse(data);
    switch (response.case) {
      case "frame": {
        const arrival = this.parts.begin(response.value);
        return () => this.arrived(arrival);
      }
      case "framePart": {
        const arrival = this.parts.add(response.value);
        return () => this.arrived(arrival);
      }
      case "state":
        return () => this.events.state(response.value);
      case "picked":
        return () => this.events.picked(response.value);
      case "profiled":
        return () => this.events.profiled(response.value);
      case "swap":
        return () => this.events.swap(response.value.swap);
      default:
        return () => {};
    }
  }

  private arrived(arrival: Arrival | undefined): void {
    if (arrival === undefined) return; // of a picture that is no longer wanted
    const { frame, picture, receivedBytes } = arrival;
    const isInParts = frame.picture.value?.length !== Number(frame.pictureBytes);
    if (isInParts && this.isOpen)
      this.socket?.send(encodePartAck(frame.frameNumber, receivedBytes));
    if (picture !== undefined) this.events.frame(frame, picture);
  }

  private reconnect(refusal?: Refusal): void {
    this.detach();
    if (!this.isLossTold) {
      this.isLossTold = true;
      this.events.lost();
      if (this.isClosed) return; // by whom it told
    }
    this.events.refused(refusal?.text ?? "");
    if (this.isClosed) return;
    const delay = Math.max(refusal?.retryAfter ?? 0, reconnectDelay(this.attempt));
    this.timer = window.setTimeout(() => this.connect(), delay);
    this.attempt += 1;
  }

  /** An attempt did not come to a connection. */
  private async failed(url: string): Promise<void> {
    this.detach();
    const refusal = await refusalOf(url);
    if (!this.isClosed) this.reconnect(refusal);
  }

  private detach(): void {
    if (this.socket === null) return;
    this.socket.onopen = this.socket.onclose = this.socket.onmessage = null;
    this.socket.close();
    this.socket = null;
  }
}
