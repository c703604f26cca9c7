// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { FrameSchema } from "../protocol/gen/eyrie/v1/viewer_pb";
import type { EncodedPicture } from "../protocol/parts";
import { Arrivals } from "./arrivals";

interface Kind {
  swap?: number;
  type?: EncodedPicture["type"];
}

describe("Arrivals", () => {
  let now = 0;
  beforeEach(() => {
    now = 100;
    vi.spyOn(performance, "now").mockImplementation(() => now);
  });
  afterEach(() => vi.restoreAllMocks());

  const arriving = () => {
    const canvas = { show: vi.fn(), present: vi.fn(), forget: vi.fn() };
    const sender = { acknowledge: vi.fn(), ready: vi.fn() };
    const arrivals = new Arrivals(canvas, sender);
    const arrive = (frameNumber: number, { swap = 0, type = "image/jpeg" }: Kind = {}) =>
      arrivals.arrived(
        create(FrameSchema, { frameNumber: BigInt(frameNumber), swap: BigInt(swap) }),
        {
          type,
          bytes: new Uint8Array([1, 2, 3]),
          tiles: [],
          pixelHash: undefined,
          video: undefined,
        },
      );
    return { canvas, sender, arrivals, arrive };
  };

  it("acknowledges what is drawn with the time since it came, and forgets those before", () => {
    const { canvas, sender, arrivals, arrive } = arriving();
    arrive(1);
    now += 5;
    arrive(2);
    expect(canvas.show.mock.calls.map(([frame, , waits]) => [frame, waits])).toEqual([
      [1, false],
      [2, false],
    ]);
    now += 7;
    expect(Number(arrivals.drawn(2, now)?.frame.frameNumber)).toBe(2);
    expect(sender.acknowledge).toHaveBeenCalledWith(2, 7);
    expect(arrivals.drawn(1, now)).toBeUndefined();
  });

  it("keeps the file of exact pictures, although the canvas takes their bytes", async () => {
    const { canvas, arrivals, arrive } = arriving();
    canvas.show.mockImplementation((_frame, { bytes }) => bytes.fill(0));
    arrive(1, { type: "image/png" });
    const file = arrivals.drawn(1, 0)?.picture;
    expect(new Uint8Array(await file!.arrayBuffer())).toEqual(new Uint8Array([1, 2, 3]));
    arrive(2);
    expect(arrivals.drawn(2, 0)?.picture).toBeUndefined();
  });

  it("shows a picture behind a swap barrier when all screens have it", () => {
    const { canvas, sender, arrivals, arrive } = arriving();
    arrive(1, { swap: 9 });
    expect(canvas.show).toHaveBeenCalledWith(1, expect.anything(), true);
    arrivals.ready(1, 10);
    expect(sender.ready).toHaveBeenCalledWith(9n);
    expect(canvas.present).not.toHaveBeenCalled();
    arrivals.swap(8n);
    expect(canvas.present).not.toHaveBeenCalled();
    arrivals.swap(9n);
    expect(canvas.present).toHaveBeenCalledWith(1);
    arrivals.drawn(1, 30);
    const [{ ready, drawn } = { ready: 0, drawn: 0 }] = arrivals.swaps.recent;
    expect(drawn - ready).toBeCloseTo(20, 6);
  });

  it("lets the other screens go on where a picture cannot be decoded", () => {
    const { sender, arrivals, arrive } = arriving();
    arrive(1, { swap: 9 });
    arrivals.failed(1);
    expect(sender.ready).toHaveBeenCalledWith(9n);
    expect(sender.acknowledge).toHaveBeenCalledWith(1, 0);
  });

  it("knows nothing of a connection that is gone", () => {
    const { canvas, sender, arrivals, arrive } = arriving();
    arrive(1, { swap: 9 });
    arrivals.forget();
    expect(canvas.forget).toHaveBeenCalled();
    arrivals.ready(1, 10);
    expect(sender.ready).not.toHaveBeenCalled();
    expect(arrivals.drawn(1, 10)).toBeUndefined();
  });
});
