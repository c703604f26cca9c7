// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { chunk, filtered, PngWriter } from "./png";
import type { ImageRequest } from "../command";
import { bandsOf, drawPoster, posterSize, sideBySide } from "./poster";

async function inflated(data: Blob): Promise<Uint8Array> {
  const stream = data.stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Red, green and blue of a PNG of one kind: that of PngWriter, whose filter is "up". */
async function pixelsOf(file: Blob): Promise<{ width: number; height: number; rgb: number[] }> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const view = new DataView(bytes.buffer);
  expect([...bytes.subarray(1, 4)]).toEqual([0x50, 0x4e, 0x47]);
  const data: BlobPart[] = [];
  let [width, height] = [0, 0];
  for (let at = 8; at < bytes.length; at += 12 + view.getUint32(at)) {
    const name = new TextDecoder().decode(bytes.subarray(at + 4, at + 8));
    const content = bytes.slice(at + 8, at + 8 + view.getUint32(at));
    expect(chunk(name, content)).toEqual(bytes.slice(at, at + 12 + content.length));
    if (name === "IHDR") [width, height] = [view.getUint32(at + 8), view.getUint32(at + 12)];
    if (name === "IDAT") data.push(content);
  }
  const rows = await inflated(new Blob(data));
  expect(rows.length).toBe(height * (1 + 3 * width));
  const rgb: number[] = [];
  for (let y = 0; y < height; ++y) {
    expect(rows[y * (1 + 3 * width)]).toBe(2);
    for (let i = 0; i < 3 * width; ++i) {
      const above = y === 0 ? 0 : (rgb[(y - 1) * 3 * width + i] ?? 0);
      rgb.push(((rows[y * (1 + 3 * width) + 1 + i] ?? 0) + above) & 255);
    }
  }
  return { width, height, rgb };
}

describe("a PNG", () => {
  it("holds the rows that it was given, band by band", async () => {
    const [width, height] = [5, 7];
    const rgba = Uint8Array.from({ length: 4 * width * height }, (_, i) => (i * 37) & 255);
    const writer = new PngWriter(width, height);
    for (const [from, to] of [
      [0, 3],
      [3, 4],
      [4, 7],
    ] as const)
      await writer.add(rgba.subarray(4 * width * from, 4 * width * to));
    const found = await pixelsOf(await writer.finish());
    expect([found.width, found.height]).toEqual([width, height]);
    expect(found.rgb).toEqual([...rgba].filter((_, i) => i % 4 !== 3));
  });

  it("has the checksum that others find", () => {
    // The last chunk of every PNG.
    expect([...chunk("IEND", new Uint8Array())]).toEqual([
      0, 0, 0, 0, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82,
    ]);
  });

  it("carries the row above from band to band", () => {
    const above = Uint8Array.of(1, 2, 3);
    expect([...filtered(Uint8Array.of(5, 5, 5, 255, 6, 7, 8, 255), 1, above)]).toEqual([
      2, 4, 3, 2, 2, 1, 2, 3,
    ]);
    expect([...above]).toEqual([6, 7, 8]);
  });
});

describe("a poster", () => {
  it("has the shape of the window, up to 16384 pixels", () => {
    const shown = { width: 1280, height: 720 };
    expect(posterSize(shown, 4096)).toEqual({ width: 4096, height: 2304 });
    expect(posterSize({ width: 720, height: 1280 }, 4096)).toEqual({ width: 2304, height: 4096 });
    expect(posterSize(shown, 1e9).width).toBe(16384);
    expect(posterSize({ width: 4000, height: 1 }, 256)).toEqual({ width: 256, height: 1 });
  });

  it("is covered by its parts once, from the top down, none too large", () => {
    for (const size of [
      { width: 16384, height: 16384 },
      { width: 16384, height: 9216 },
      { width: 100, height: 16384 },
      { width: 1, height: 1 },
    ]) {
      const bands = bandsOf(size);
      let top = size.height;
      for (const band of bands) {
        let left = 0;
        for (const part of band) {
          expect([part.x, part.y + part.height]).toEqual([left, top]);
          expect(Math.max(part.width, part.height)).toBeLessThanOrEqual(8192);
          expect(part.width * part.height).toBeLessThanOrEqual(33554432);
          left += part.width;
        }
        expect(left).toBe(size.width);
        top = band[0]?.y ?? -1;
      }
      expect(top).toBe(0);
    }
  });

  it("puts parts of a band beside each other", () => {
    const part = (value: number, width: number) => ({
      rgba: new Uint8Array(4 * width * 2).fill(value),
      width,
    });
    const whole = sideBySide([part(1, 2), part(2, 1)], 3);
    expect([...whole].filter((_, i) => i % 4 === 0)).toEqual([1, 1, 2, 1, 1, 2]);
    const one = part(3, 2);
    expect(sideBySide([one], 2)).toBe(one.rgba);
  });
});

describe("a poster of a server", () => {
  beforeEach(() => void vi.stubGlobal("window", { location: { href: "http://127.0.0.1/" } }));
  afterEach(() => void vi.unstubAllGlobals());
  /** Of two parts: one above the other, and side by side. */
  const sizes = [
    { width: 1, height: 16384 },
    { width: 16384, height: 1 },
  ];
  const draw = (size: { width: number; height: number }) =>
    drawPoster(size as ImageRequest, () => {}, new AbortController().signal);

  /** Answers with parts of these revisions. */
  function serve(...revisions: string[]): void {
    vi.stubGlobal("fetch", (_: string, { body }: { body: string }) => {
      const { part } = JSON.parse(body) as { part: { width: number; height: number } };
      const headers = { "Eyrie-Tau-Achieved": "0.5", "Eyrie-Revision": revisions.shift() ?? "" };
      return Promise.resolve(
        new Response(new Uint8Array(4 * part.width * part.height), { headers }),
      );
    });
  }

  it("is saved where all of it is of one scene", async () => {
    for (const size of sizes) {
      serve("7", "7");
      expect((await draw(size)).error).toBe(0.5);
    }
  });

  it("is not where its second part is of another", async () => {
    for (const size of sizes) {
      serve("7", "8");
      await expect(draw(size)).rejects.toThrow("what is shown was changed meanwhile");
    }
  });

  it("says that it is away", async () => {
    vi.stubGlobal("fetch", () => Promise.reject(new TypeError("Failed to fetch")));
    await expect(draw({ width: 64, height: 36 })).rejects.toThrow("the server does not answer");
  });
});
