// SPDX-License-Identifier: Apache-2.0
// A ZIP archive of files that are compressed already: stored as they are (APPNOTE 6.3.10, without
// the 64-bit extensions).

export interface ZipEntry {
  name: string;
  content: Blob;
}

/** Of files that a ZIP holds. */
export const mostEntries = 0xffff;
const mostBytes = 0xffff_ffff;
/** 1980-01-01, the first day a ZIP knows: the same files make the same archive. */
const firstDay = 0x21;

const table = Uint32Array.from({ length: 256 }, (_, byte) => {
  let c = byte;
  for (let bit = 0; bit < 8; ++bit) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c >>> 0;
});

export function crc32(bytes: Uint8Array): number {
  let crc = 0xffff_ffff;
  for (const byte of bytes) crc = (table[(crc ^ byte) & 0xff] ?? 0) ^ (crc >>> 8);
  return (crc ^ 0xffff_ffff) >>> 0;
}

/** Little-endian; [value, bytes] one after the other. */
function fields(...values: readonly (readonly [number, 2 | 4])[]): Uint8Array<ArrayBuffer> {
  const size = values.reduce((sum, [, bytes]) => sum + bytes, 0);
  const view = new DataView(new ArrayBuffer(size));
  let at = 0;
  for (const [value, bytes] of values) {
    if (bytes === 2) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    at += bytes;
  }
  return new Uint8Array(view.buffer);
}

/** Takes files one at a time, so that none but the newest is in memory as bytes. */
export class ZipWriter {
  private readonly parts: BlobPart[] = [];
  private readonly directory: Uint8Array<ArrayBuffer>[] = [];
  private offset = 0;
  private count = 0;

  /** False where a ZIP holds no more: it is as it was. */
  async add({ name, content }: ZipEntry): Promise<boolean> {
    if (this.count === mostEntries || this.offset + content.size > mostBytes - 2 ** 24)
      return false;
    const path = new TextEncoder().encode(name) as Uint8Array<ArrayBuffer>;
    const crc = crc32(new Uint8Array(await content.arrayBuffer()));
    const common = [
      [20, 2], // version that reads it
      [0x0800, 2], // the name is UTF-8
      [0, 2], // stored
      [0, 2],
      [firstDay, 2],
      [crc, 4],
      [content.size, 4],
      [content.size, 4],
      [path.length, 2],
      [0, 2],
    ] as const;
    const header = fields([0x04034b50, 4], ...common);
    const entry = fields(
      [0x02014b50, 4],
      [20, 2],
      ...common,
      [0, 2],
      [0, 2],
      [0, 2],
      [0, 4],
      [this.offset, 4],
    );
    this.parts.push(header, path, content);
    this.directory.push(entry, path);
    this.offset += header.length + path.length + content.size;
    this.count += 1;
    return true;
  }

  finish(): Blob {
    const size = this.directory.reduce((sum, { length }) => sum + length, 0);
    const end = fields(
      [0x06054b50, 4],
      [0, 2],
      [0, 2],
      [this.count, 2],
      [this.count, 2],
      [size, 4],
      [this.offset, 4],
      [0, 2],
    );
    return new Blob([...this.parts, ...this.directory, end], { type: "application/zip" });
  }
}
