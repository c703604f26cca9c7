// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { crc32, ZipWriter } from "./zip";

it("crc32 is the one of the standard's check value", () => {
  expect(crc32(new TextEncoder().encode("123456789"))).toBe(0xcbf43926);
});

/** As readers do: from the end, by the directory, to each file; and each sum made anew. */
function entriesOf(bytes: Uint8Array): [string, number][] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const end = bytes.length - 22;
  expect(view.getUint32(end, true)).toBe(0x06054b50);
  const count = view.getUint16(end + 10, true);
  let at = view.getUint32(end + 16, true);
  expect(at + view.getUint32(end + 12, true)).toBe(end);
  return Array.from({ length: count }, () => {
    expect(view.getUint32(at, true)).toBe(0x02014b50);
    const nameSize = view.getUint16(at + 28, true);
    const name = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + nameSize));
    const [sum, size, local] = [16, 24, 42].map((i) => view.getUint32(at + i, true));
    expect(view.getUint32(local ?? 0, true)).toBe(0x04034b50);
    const start = (local ?? 0) + 30 + view.getUint16((local ?? 0) + 26, true);
    expect(crc32(bytes.subarray(start, start + (size ?? 0)))).toBe(sum);
    at += 46 + nameSize;
    return [name, size ?? 0];
  });
}

it("An archive holds its files, found by its directory and with their sums", async () => {
  const zip = new ZipWriter();
  await zip.add({ name: "00001.png", content: new Blob([new Uint8Array([1, 2, 0, 255])]) });
  await zip.add({ name: "Flüge/leer.txt", content: new Blob([]) });
  await zip.add({ name: "flight.json", content: new Blob(["{}".repeat(5000)]) });
  expect(entriesOf(new Uint8Array(await zip.finish().arrayBuffer()))).toEqual([
    ["00001.png", 4],
    ["Flüge/leer.txt", 0],
    ["flight.json", 10_000],
  ]);
});
