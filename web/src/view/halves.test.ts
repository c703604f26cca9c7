// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { halvesOf } from "./halves";

const begin = [0xff, 0xd8];
/** 4:2:0, so of blocks of 16 x 16 pixels: three side by side. */
const frame = [0xff, 0xc0, 0, 17, 8, 0, 50, 0, 40, 3, 1, 0x22, 0, 2, 0x11, 1, 3, 0x11, 1];
const restartEvery = (blocks: number) => [0xff, 0xdd, 0, 4, 0, blocks];
const scan = [0xff, 0xda, 0, 3, 0];
const upper = [1, 0xff, 0, 0xd0, 2];
const lower = [3, 0xff, 0, 4];
const end = [0xff, 0xd9];

const jpeg = (...segments: number[][]) => Uint8Array.from(segments.flat());
const whole = jpeg(begin, frame, restartEvery(6), scan, upper, [0xff, 0xd0], lower, end);
const bytesOf = async (blob: Blob) => [...new Uint8Array(await blob.arrayBuffer())];
const withHeight = (rows: number) => frame.map((byte, i) => (i === 6 ? rows : byte));

describe("a JPEG whose lower half is coded apart", () => {
  it("is two of the same head but for their heights, cut where the marker is", async () => {
    const halves = halvesOf(whole);
    if (halves === null) throw new Error("no halves");
    const [head, rest] = [begin, [...restartEvery(6), ...scan]];
    expect(await bytesOf(halves.upper)).toEqual([
      ...head,
      ...withHeight(32),
      ...rest,
      ...upper,
      ...end,
    ]);
    expect(await bytesOf(halves.lower)).toEqual([
      ...head,
      ...withHeight(18),
      ...rest,
      ...lower,
      ...end,
    ]);
    expect(halves.upper.type).toBe("image/jpeg");
  });

  it("is left whole where it is no such one", () => {
    const coded = [...upper, 0xff, 0xd0, ...lower];
    expect(halvesOf(jpeg(begin, frame, scan, upper, end))).toBeNull();
    expect(halvesOf(jpeg(begin, frame, restartEvery(6), scan, upper, end))).toBeNull();
    // Neither in the middle of a row of blocks, nor below the picture.
    expect(halvesOf(jpeg(begin, frame, restartEvery(7), scan, coded, end))).toBeNull();
    expect(halvesOf(jpeg(begin, frame, restartEvery(12), scan, coded, end))).toBeNull();
    const another = [...coded, 0xff, 0xd1, ...lower];
    expect(halvesOf(jpeg(begin, frame, restartEvery(3), scan, another, end))).toBeNull();
  });

  it("is left whole where its bytes end early or are none of a JPEG", () => {
    for (let length = 0; length < 39; ++length) expect(halvesOf(whole.slice(0, length))).toBeNull();
    expect(halvesOf(new Uint8Array(100).fill(0xff))).toBeNull();
    expect(halvesOf(new Uint8Array(100))).toBeNull();
  });
});
