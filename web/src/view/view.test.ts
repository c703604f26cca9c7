// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { FrameRate, Latency, limitingStage } from "./measure";
import { pixelHash } from "./pixel_hash";
import { pictureSize } from "./size";
import { canShowVideo, follows } from "./video";

describe("pictureSize", () => {
  it("is the canvas in device pixels", () => {
    expect(pictureSize({ width: 800, height: 600 }, 1.5)).toEqual({
      width: 1200,
      height: 900,
    });
  });

  it("keeps the shape when it must be smaller", () => {
    const size = pictureSize({ width: 2560, height: 1440 }, 2);
    expect(size.width).toBe(4096);
    expect(size.width / size.height).toBeCloseTo(16 / 9, 2);
  });

  it("stays within what the server makes", () => {
    expect(pictureSize({ width: 10000, height: 10 }, 1).width).toBeLessThanOrEqual(4096);
    expect(pictureSize({ width: 0, height: 0 }, 1)).toEqual({ width: 16, height: 16 });
  });
});

describe("pixelHash", () => {
  it("is the server's", () => {
    const rows = [250, 128, 0, 255, 255, 255, 255, 255, 1, 2, 3, 255, 4, 5, 6, 255];
    expect(pixelHash(new Uint8ClampedArray(rows))).toBe(1337354147);
  });

  it("leaves alpha out and tells pixels apart", () => {
    const hash = (...rgba: number[]) => pixelHash(new Uint8ClampedArray(rgba));
    expect(hash(1, 2, 3, 0)).toBe(hash(1, 2, 3, 255));
    expect(hash(1, 2, 3, 0)).not.toBe(hash(1, 2, 4, 0));
  });
});

describe("FrameRate", () => {
  it("counts the frames of the last second", () => {
    const rate = new FrameRate();
    for (let time = 0; time <= 2000; time += 50) rate.drawn(time);
    expect(rate.perSecond(2000)).toBe(20);
    expect(rate.perSecond(2500)).toBe(10);
    expect(rate.perSecond(9000)).toBe(0);
  });
});

describe("Latency", () => {
  it("is counted for the first frame of a view, and for coalesced ones not at all", () => {
    const latency = new Latency();
    latency.sent(1, 105, 100);
    latency.sent(2, 115, 110);
    latency.drawn(2, 150);
    latency.drawn(2, 900); // the still picture
    latency.drawn(1, 901);
    expect(latency.median()).toBe(40);
    expect(latency.waitingSince()).toBeUndefined();
  });

  it("is the median of the last ones", () => {
    const latency = new Latency();
    expect(latency.median()).toBeNaN();
    [10, 500, 20].forEach((time, i) => {
      latency.sent(i, 5, 0);
      latency.drawn(i, time);
    });
    expect(latency.median()).toBe(20);
  });

  it("knows since when a view waits", () => {
    const latency = new Latency();
    latency.sent(1, 100);
    latency.sent(2, 110);
    latency.drawn(1, 120);
    expect(latency.waitingSince()).toBe(110);
    latency.drawn(2, 130);
    expect(latency.median()).toBeNaN(); // no input caused these views
    latency.sent(3, 140);
    latency.reset();
    expect(latency.waitingSince()).toBeUndefined();
  });
});

describe("limitingStage", () => {
  it("is the longest of those that were measured", () => {
    const stages = { cull: 1, vertices: 2, fill: 5, readback: 3 };
    expect(limitingStage(stages)).toBe("pixels");
    expect(limitingStage({ ...stages, readback: 6 })).toBe("readback");
    expect(limitingStage({ ...stages, vertices: 0, fill: 0 })).toBe("");
    expect(limitingStage(undefined)).toBe("");
  });
});

describe("A picture of a stream", () => {
  const place = (stream: bigint, picture: bigint, isKey = false) => ({
    stream,
    picture,
    isKey,
    width: 64,
    height: 48,
  });

  it("is decoded right after the one that it is made from", () => {
    expect(follows(place(1n, 4n), place(1n, 5n))).toBe(true);
    expect(follows(place(1n, 4n, true), place(1n, 5n))).toBe(true);
  });

  it("is not decoded without it", () => {
    expect(follows(undefined, place(1n, 1n))).toBe(false);
    expect(follows(place(1n, 4n), place(1n, 6n))).toBe(false);
    expect(follows(place(1n, 4n), place(1n, 4n))).toBe(false);
    expect(follows(place(1n, 4n), place(2n, 5n))).toBe(false);
  });

  it("can be a key, which needs none", () => {
    expect(follows(undefined, place(1n, 1n, true))).toBe(true);
    expect(follows(place(1n, 4n), place(1n, 9n, true))).toBe(true);
  });

  it("is not asked for where nothing decodes it", async () => {
    expect(await canShowVideo()).toBe(false);
  });
});
