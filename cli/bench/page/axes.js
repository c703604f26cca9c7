// SPDX-License-Identifier: Apache-2.0
// What the curves of speed against error are drawn in.

/** The axes: errors in powers of two to the right, milliseconds upwards from zero. */
function curveAxes(svg, box, errorRange, mostMs) {
  const x = logarithmic(errorRange, [box.left, box.right]);
  const y = linear([0, mostMs], [box.bottom, box.top]);
  for (const ms of ticks(mostMs))
    svg.append(mark("line", { class: ms === 0 ? "axis" : "grid", x1: box.left, x2: box.right, y1: y(ms), y2: y(ms) }),
               mark("text", { x: box.left - 10, y: y(ms) + 4, "text-anchor": "end" }, number(ms)));
  for (const pixels of powers(2, ...errorRange))
    svg.append(mark("line", { class: "axis", x1: x(pixels), x2: x(pixels), y1: box.bottom, y2: box.bottom + 5 }),
               mark("text", { x: x(pixels), y: box.bottom + 20, "text-anchor": "middle" }, `${number(pixels)} px`));
  let free = box.bottom;
  for (const fps of [240, 120, 60, 30, 15, 5, 2, 1].filter((f) => 1000 / f < mostMs * 0.97)) {
    if (free - y(1000 / fps) < 16) continue;
    free = y(1000 / fps);
    svg.append(mark("line", { class: "guide", x1: box.left, x2: box.right, y1: y(1000 / fps), y2: y(1000 / fps) }),
               mark("text", { x: box.right + 8, y: y(1000 / fps) + 4 }, `${fps} fps`));
  }
  svg.append(mark("text", { x: box.left - 44, y: box.top - 14 }, "milliseconds a frame"),
             mark("text", { x: box.right, y: box.bottom + 42, "text-anchor": "end" }, "screen-space error  →  coarser"));
  return { x, y };
}
