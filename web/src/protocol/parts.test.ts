// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { FramePartSchema, FrameSchema } from "./gen/eyrie/v1/viewer_pb";
import { Parts } from "./parts";

const png = (frameNumber: bigint, first: number[], size: number) =>
  create(FrameSchema, {
    frameNumber,
    picture: { case: "png", value: new Uint8Array(first) },
    pictureBytes: BigInt(size),
    pixelHash: 7,
  });

const part = (frameNumber: bigint, offset: number, bytes: number[]) =>
  create(FramePartSchema, { frameNumber, offset: BigInt(offset), bytes: new Uint8Array(bytes) });

describe("Parts", () => {
  it("hand a whole picture on as it is", () => {
    const value = new Uint8Array([1, 2]);
    const frame = create(FrameSchema, { picture: { case: "jpeg", value }, pictureBytes: 2n });
    const { picture } = new Parts().begin(frame);
    expect(picture?.bytes).toBe(value);
    expect(picture?.type).toBe("image/jpeg");
    expect(picture?.pixelHash).toBeUndefined();
  });

  it("cut a picture of several JPEGs into them", () => {
    const value = new Uint8Array([1, 2, 3, 4, 5]);
    const tiles = [
      { x: 0, y: 0, bytes: 2n },
      { x: 40, y: 8, bytes: 3n },
    ];
    const frame = { picture: { case: "jpeg", value }, pictureBytes: 5n, tiles } as const;
    const { picture } = new Parts().begin(create(FrameSchema, frame));
    expect(picture?.tiles.map(({ x, y, bytes }) => [x, y, ...bytes])).toEqual([
      [0, 0, 1, 2],
      [40, 8, 3, 4, 5],
    ]);
    const short = { ...frame, tiles: tiles.slice(1) };
    expect(() => new Parts().begin(create(FrameSchema, short))).toThrow("tiles of 3 bytes");
  });

  it("put a picture together", () => {
    const parts = new Parts();
    expect(parts.begin(png(4n, [1, 2], 5)).picture).toBeUndefined();
    expect(parts.add(part(4n, 2, [3]))?.receivedBytes).toBe(3);
    const whole = parts.add(part(4n, 3, [4, 5]));
    expect([...(whole?.picture?.bytes ?? [])]).toEqual([1, 2, 3, 4, 5]);
    expect(whole?.picture?.pixelHash).toBe(7);
    expect(parts.add(part(4n, 5, []))).toBeUndefined();
  });

  it("forget what is left of a picture when another comes", () => {
    const parts = new Parts();
    parts.begin(png(4n, [1, 2], 5));
    parts.begin(png(5n, [9], 2));
    expect(parts.add(part(4n, 2, [3]))).toBeUndefined();
    expect([...(parts.add(part(5n, 1, [8]))?.picture?.bytes ?? [])]).toEqual([9, 8]);
  });

  it("take nothing that belongs elsewhere", () => {
    const parts = new Parts();
    parts.begin(png(4n, [1, 2], 5));
    expect(parts.add(part(4n, 3, [3]))).toBeUndefined();
    expect(parts.add(part(4n, 2, [3, 4, 5, 6]))).toBeUndefined();
    expect(() => parts.begin(png(5n, [], 2 ** 40))).toThrow();
  });
});
