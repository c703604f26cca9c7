// SPDX-License-Identifier: Apache-2.0
// A PNG from rows that come a band at a time (W3C PNG, 2003): red, green and blue, 8 bits each. What
// is written is compressed by the browser, and kept as its blobs: no more than a band is in memory
// as pixels.
import { crc32 } from "../flight/zip";

const signature = Uint8Array.of(0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a);

function bigEndian(...values: readonly number[]): Uint8Array<ArrayBuffer> {
  const view = new DataView(new ArrayBuffer(4 * values.length));
  values.forEach((value, i) => view.setUint32(4 * i, value));
  return new Uint8Array(view.buffer);
}

/** Length, name, content and checksum. */
export function chunk(name: string, content: Uint8Array<ArrayBuffer>): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(12 + content.length);
  bytes.set(bigEndian(content.length));
  bytes.set(new TextEncoder().encode(name), 4);
  bytes.set(content, 8);
  bytes.set(bigEndian(crc32(bytes.subarray(4, 8 + content.length))), 8 + content.length);
  return bytes;
}

function header(width: number, height: number): Uint8Array<ArrayBuffer> {
  const content = new Uint8Array(13);
  content.set(bigEndian(width, height));
  content.set([8, 2, 0, 0, 0], 8); // bits, true colour, and the only methods there are
  return chunk("IHDR", content);
}

/**
 * Rows as PNG has them: each less the row above it, byte by byte, which compresses well where
 * surfaces are smooth. `rgba` has whole rows, from the top down; `above`, red, green and blue of the
 * row before them, gets those of the last.
 */
export function filtered(
  rgba: Uint8Array,
  width: number,
  above: Uint8Array,
): Uint8Array<ArrayBuffer> {
  const rows = rgba.length / (4 * width);
  const bytes = new Uint8Array(rows * (1 + 3 * width));
  let to = 0;
  let from = 0;
  for (let row = 0; row < rows; ++row) {
    bytes[to++] = 2; // "up"
    for (let i = 0; i < 3 * width; i += 3, from += 4)
      for (let channel = 0; channel < 3; ++channel) {
        const value = rgba[from + channel] ?? 0;
        bytes[to++] = value - (above[i + channel] ?? 0);
        above[i + channel] = value;
      }
  }
  return bytes;
}

export class PngWriter {
  private readonly parts: BlobPart[];
  private readonly above: Uint8Array;
  private readonly compressor = new CompressionStream("deflate");
  private readonly input = this.compressor.writable.getWriter();
  private readonly compressed: Promise<void>;

  constructor(
    private readonly width: number,
    height: number,
  ) {
    this.parts = [signature, header(width, height)];
    this.above = new Uint8Array(3 * width);
    this.compressed = this.collect();
  }

  /** Whole rows, from the top down. */
  async add(rgba: Uint8Array): Promise<void> {
    await this.input.write(filtered(rgba, this.width, this.above));
  }

  async finish(): Promise<Blob> {
    await this.input.close();
    await this.compressed;
    return new Blob([...this.parts, chunk("IEND", new Uint8Array())], { type: "image/png" });
  }

  /** Ends it without a picture. */
  cancel(): void {
    this.input.abort().catch(() => undefined);
    this.compressed.catch(() => undefined);
  }

  private async collect(): Promise<void> {
    const reader = this.compressor.readable.getReader();
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      this.parts.push(new Blob([chunk("IDAT", value as Uint8Array<ArrayBuffer>)]));
    }
  }
}
