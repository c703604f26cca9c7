// SPDX-License-Identifier: Apache-2.0
// What the pictures are and how they come.
import type { Numbers, State } from "../state";
import { byId, make, setText } from "./element";
import { count, milliseconds } from "./format";

export function triangleText(drawn: number, total: number): string {
  return total > 0 ? `${count(drawn)} of ${count(total)}` : count(drawn);
}

/** How a picture was sent. */
export function sentText({
  exact,
  quality,
  isVideo,
  tiles,
}: Pick<Numbers, "exact" | "quality" | "isVideo" | "tiles">): string {
  if (exact) return "exact";
  if (isVideo) return "H.264";
  if (quality === 0) return "lossless";
  return tiles > 1 ? `JPEG ${quality} in ${tiles} tiles` : `JPEG ${quality}`;
}

/** How pictures come. */
export function frameText({ fps, waits }: Pick<Numbers, "fps" | "waits">, unit: string): string {
  if (fps > 0) return `${fps} ${unit}`;
  return waits ? "waiting" : "at rest";
}

interface Row {
  name: string;
  title: string;
  text(numbers: Numbers, totalTriangles: number): string;
}

const rows: readonly Row[] = [
  {
    name: "Frames",
    title: "Drawn in the last second; none are made while nothing changes",
    text: (numbers) => frameText(numbers, "/ s"),
  },
  {
    name: "Input to drawn",
    title: "From a hand's movement to the picture that shows it, median of the last ones",
    text: ({ inputToDrawnMilliseconds }) => milliseconds(inputToDrawnMilliseconds),
  },
  {
    name: "Rendering",
    title: "The renderers' part of that",
    text: ({ renderMilliseconds }) => milliseconds(renderMilliseconds),
  },
  {
    name: "Limited by",
    title:
      "The renderers' stage that takes longest, measured every 32nd frame: the cut, vertices, " +
      "pixels or the readback",
    text: ({ limitedBy }) => limitedBy || "–",
  },
  {
    name: "Triangles",
    title: "Drawn, and in the scene at full resolution",
    text: ({ triangles }, total) => triangleText(triangles, total),
  },
  {
    name: "Picture",
    title:
      "Size in pixels, and how it was sent: while the view moves as JPEG of a quality that the link " +
      "allows or, over a slow one, H.264, which only come near to the server's picture; exact: every pixel here has been compared with the server's",
    text: ({ width, height, ...sent }) => `${width} × ${height} · ${sentText(sent)}`,
  },
];

export function showNumbers(state: State): void {
  const list = make("dl", "numbers");
  const updates = rows.map((row) => {
    const value = make("dd", "value", "–");
    const name = make("dt", "label", row.name);
    name.title = row.title;
    list.append(name, value);
    return (numbers: Numbers, totalTriangles: number): void =>
      setText(value, row.text(numbers, totalTriangles));
  });
  byId("numbers", HTMLElement).append(make("h2", "heading", "Numbers"), list);
  state.numbers.watch((numbers) => {
    if (numbers === null) return;
    const total = Number(state.session.value?.sceneTriangles ?? 0n);
    for (const update of updates) update(numbers, total);
  });
}
