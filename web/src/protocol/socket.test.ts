// SPDX-License-Identifier: Apache-2.0
import { create, fromBinary, toBinary } from "@bufbuild/protobuf";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { defaultLook } from "../look";
import {
  ShownEye,
  ShownStereo,
  ViewerRequestSchema,
  ViewerResponseSchema,
} from "./gen/eyrie/v1/viewer_pb";
import { cameraOf, decodeResponse, encodeAck, encodeView, Shading } from "./messages";
import type { SocketEvents } from "./socket";
import { reconnectDelay, Socket } from "./socket";

describe("reconnectDelay", () => {
  it("is none at first and never more than half a second", () => {
    expect([0, 1, 2, 3, 4, 100].map(reconnectDelay)).toEqual([0, 250, 500, 500, 500, 500]);
  });
});

describe("a socket", () => {
  beforeEach(() => {
    vi.useFakeTimers();
    vi.stubGlobal("window", globalThis);
    vi.stubGlobal("document", { hidden: false });
  });

  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  /** Connections that end only when they are told to, and what the socket on them tells. */
  class FakeSocket {
    static made: FakeSocket[] = [];
    onopen: (() => void) | null = null;
    onclose: ((event: { code: number }) => void) | null = null;
    onmessage: ((event: { data: ArrayBuffer }) => void) | null = null;
    constructor() {
      FakeSocket.made.push(this);
    }
    close(): void {
      this.onclose = null;
    }
  }

  function connecting(): { socket: Socket; told: string[] } {
    FakeSocket.made = [];
    vi.stubGlobal("WebSocket", FakeSocket);
    const told: string[] = [];
    const tells = new Proxy({} as SocketEvents, {
      get: (_, name) => (text: unknown) => {
        if (name !== "refused") told.push(String(name));
        else if (text !== "") told.push(String(text));
      },
    });
    return { socket: new Socket("ws://host/ws", tells), told };
  }

  function connected(): { socket: Socket; told: string[] } {
    const made = connecting();
    FakeSocket.made[0]?.onopen?.();
    return made;
  }

  /** How often it has connected a second after its connection ended so, and what it told. */
  function after(code: number): { connections: number; told: string[] } {
    const { socket, told } = connected();
    FakeSocket.made[0]?.onclose?.({ code });
    vi.advanceTimersByTime(1000);
    socket.close();
    return { connections: FakeSocket.made.length, told };
  }

  it("asks no oftener where its connections are taken and closed at once", () => {
    let connections = 0;
    class ClosingSocket {
      onopen: (() => void) | null = null;
      onclose: ((event: { code: number }) => void) | null = null;
      constructor() {
        connections += 1;
        setTimeout(() => {
          this.onopen?.();
          this.onclose?.({ code: 1009 });
        }, 1);
      }
      close(): void {}
    }
    vi.stubGlobal("WebSocket", ClosingSocket);
    const socket = new Socket(
      "ws://host/ws",
      new Proxy({} as SocketEvents, { get: () => () => {} }),
    );
    vi.advanceTimersByTime(3000);
    socket.close();
    expect(connections).toBeLessThan(10);
  });

  it("connects again when the connection is lost", () => {
    expect(after(1006)).toEqual({ connections: 2, told: ["opened", "lost"] });
  });

  it("that is closed when it tells of its loss stays closed", () => {
    FakeSocket.made = [];
    vi.stubGlobal("WebSocket", FakeSocket);
    for (const closesAt of ["lost", "refused"]) {
      FakeSocket.made = [];
      const events = new Proxy({} as SocketEvents, {
        get: (_, name) => () => {
          if (name === closesAt) socket.close();
        },
      });
      const socket = new Socket("ws://host/ws", events);
      FakeSocket.made[0]?.onopen?.();
      FakeSocket.made[0]?.onclose?.({ code: 1006 });
      vi.advanceTimersByTime(60_000);
      expect(FakeSocket.made.length).toBe(1);
    }
  });

  it("is not lost by what those throw whom it tells, only by what it cannot read", () => {
    FakeSocket.made = [];
    vi.stubGlobal("WebSocket", FakeSocket);
    const told: string[] = [];
    const events = new Proxy({} as SocketEvents, {
      get: (_, name) => () => {
        told.push(String(name));
        if (name === "state") throw new Error("the page's own");
      },
    });
    const socket = new Socket("ws://host/ws", events);
    FakeSocket.made[0]?.onopen?.();
    const state = create(ViewerResponseSchema, { response: { case: "state", value: {} } });
    const { buffer } = Uint8Array.from(toBinary(ViewerResponseSchema, state));
    expect(() => FakeSocket.made[0]?.onmessage?.({ data: buffer })).toThrow("the page's own");
    expect(told).toEqual(["opened", "state"]);
    const error = vi.spyOn(console, "error").mockImplementation(() => {});
    FakeSocket.made[0]?.onmessage?.({ data: new Uint8Array([255]).buffer });
    expect(told).toEqual(["opened", "state", "lost", "refused"]);
    error.mockRestore();
    socket.close();
  });

  const sayNothing = { data: new ArrayBuffer(0) };

  it("is lost when nothing at all has come for ten seconds, though nobody closed it", () => {
    const { socket, told } = connected();
    for (let i = 0; i < 10; ++i) {
      vi.advanceTimersByTime(9000);
      FakeSocket.made[0]?.onmessage?.(sayNothing);
    }
    expect(told).toEqual(["opened"]);
    vi.advanceTimersByTime(11_000);
    expect(told).toEqual(["opened", "lost"]);
    expect(FakeSocket.made.length).toBe(2);
    socket.close();
  });

  it("gives up attempts to connect that lead nowhere, and tells of them once", () => {
    const { socket, told } = connected();
    vi.advanceTimersByTime(35_000);
    expect(FakeSocket.made.length).toBe(4);
    expect(told).toEqual(["opened", "lost"]);
    socket.close();
  });

  it("is not lost by silence while nobody sees the page, nor by a sleep of the machine", () => {
    const { socket, told } = connected();
    vi.stubGlobal("document", { hidden: true });
    vi.advanceTimersByTime(100_000);
    vi.stubGlobal("document", { hidden: false });
    vi.advanceTimersByTime(9000);
    expect(told).toEqual(["opened"]);
    vi.setSystemTime(Date.now() + 3_600_000);
    FakeSocket.made[0]?.onmessage?.(sayNothing);
    vi.advanceTimersByTime(9000);
    expect(told).toEqual(["opened"]);
    socket.close();
    vi.advanceTimersByTime(100_000);
    expect(FakeSocket.made.length).toBe(1);
  });

  it("says why the server refuses it, and leaves it alone for as long as that wants", async () => {
    const answer = new Response('{"detail":"too many sessions"}', {
      status: 429,
      headers: { "Content-Type": "application/problem+json", "Retry-After": "5" },
    });
    vi.stubGlobal("location", { origin: "http://host" });
    vi.stubGlobal("fetch", () => Promise.resolve(answer));
    const { socket, told } = connecting();
    FakeSocket.made[0]?.onclose?.({ code: 1006 });
    await vi.advanceTimersByTimeAsync(4900);
    expect(told).toEqual(["lost", "too many sessions"]);
    expect(FakeSocket.made.length).toBe(1);
    await vi.advanceTimersByTimeAsync(200);
    expect(FakeSocket.made.length).toBe(2);
    socket.close();
  });

  it("tries on at its own pace where nobody answers", async () => {
    vi.stubGlobal("location", { origin: "http://host" });
    vi.stubGlobal("fetch", () => Promise.reject(new Error("refused")));
    const { socket, told } = connecting();
    FakeSocket.made[0]?.onclose?.({ code: 1006 });
    await vi.advanceTimersByTimeAsync(10);
    expect(told).toEqual(["lost"]);
    expect(FakeSocket.made.length).toBe(2);
    socket.close();
  });

  it("stays away when its session was closed", () => {
    expect(after(4001)).toEqual({ connections: 1, told: ["opened", "closed"] });
  });
});

describe("messages", () => {
  it("carry a view", () => {
    const bytes = encodeView({
      sequence: 7,
      camera: { eye: [1, 2, 3], target: [4, 5, 6], up: [0, 0, 1], fovyDegrees: 45 },
      width: 640,
      height: 480,
      tauPixels: 2,
      budgetMilliseconds: 33,
      shading: Shading.FLAT,
      look: { ...defaultLook, underground: true },
      output: { canvas: "wall", segment: "1", eye: "left", stereo: "side-by-side" },
    });
    const { request } = fromBinary(ViewerRequestSchema, bytes);
    expect(request.case).toBe("view");
    if (request.case !== "view") return;
    expect(request.value.sequence).toBe(7n);
    expect(request.value.camera?.eye).toEqual([1, 2, 3]);
    expect(request.value.tauPixels).toBe(2);
    expect(request.value.budgetMilliseconds).toBe(33);
    expect(request.value.shading).toBe(Shading.FLAT);
    expect(request.value.underground).toBe(true);
    expect(request.value.look?.exaggeration).toBe(1);
    expect(request.value.shown).toMatchObject({ canvas: "wall", segment: "1" });
    expect(request.value.shown?.eye).toBe(ShownEye.LEFT);
    expect(request.value.shown?.stereo).toBe(ShownStereo.SIDE_BY_SIDE);
  });

  it("carry an acknowledgement", () => {
    const { request } = fromBinary(ViewerRequestSchema, encodeAck(9));
    expect(request.case === "frameAck" && request.value.frameNumber).toBe(9n);
  });

  it("keep a picture's bytes as a part of the message, without a copy", () => {
    const response = create(ViewerResponseSchema, {
      response: {
        case: "frame",
        value: {
          frameNumber: 3n,
          picture: { case: "jpeg", value: new Uint8Array([1, 2, 3]) },
        },
      },
    });
    const bytes = toBinary(ViewerResponseSchema, response);
    const decoded = decodeResponse(bytes.buffer as ArrayBuffer).response;
    expect(decoded.case).toBe("frame");
    if (decoded.case !== "frame") return;
    const { value } = decoded.value.picture;
    expect([...(value ?? [])]).toEqual([1, 2, 3]);
    expect(value?.buffer).toBe(bytes.buffer);
  });

  it("have no camera when numbers are missing", () => {
    expect(cameraOf(undefined)).toBeUndefined();
  });
});
