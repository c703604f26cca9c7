// SPDX-License-Identifier: Apache-2.0
// What the curves of speed against error are drawn in.

/** The error a run stands for: what all of its frames promise or, where a frame time was held and each frame has its
 *  own, what 95 in 100 of the warm ones do. null: there is no bound. */
const errorOf = (run) => (run.budgetMs > 0 ? run.tauAchieved.p95 : run.tauAchievedMax);
/** What the frames promised that were measured: at a frame time it is of pictures of its own pass. */
const measuredPromiseOf = (run) => (run.budgetMs > 0 ? run.errorPx.promised : errorOf(run));
/** Of a scale of powers, which has no place for 0. */
const isOnAxis = (run) => errorOf(run) !== 0;

/** Along the axis, whatever the order they were measured in; what has no bound comes last. */
const byError = (list, error = errorOf) =>
  [...list].sort((a, b) => (error(a) ?? Infinity) - (error(b) ?? Infinity));

/** Says which runs a drawing leaves out; nothing where it has them all. */
function sayLeftOut(place, left) {
  if (left.length === 0) return;
  place.append(html("p", { class: "note" }, `Not in the drawing: ${left.map((run) => `${run.label}, ${processes(run)}`).join("; ")}, whose frames promise an error of 0.`));
}

/** Where errors are from left to right; those without a bound are at the right edge, which is then kept for them. */
function errorScale(errors, box) {
  const finite = errors.filter((error) => error !== null);
  const range = finite.length > 0 ? [Math.min(...finite) / 1.5, Math.max(...finite) * 1.35] : [0.5, 2];
  const hasUnbounded = finite.length < errors.length;
  const scale = logarithmic(range, [box.left, box.right - (hasUnbounded ? 60 : 0)]);
  return { range, hasUnbounded, x: (error) => (error === null ? box.right : scale(error)) };
}

/** The axes: errors in powers of two to the right, milliseconds upwards from zero. */
function curveAxes(svg, box, errors, mostMs) {
  const { range: errorRange, hasUnbounded, x } = errorScale(errors, box);
  const y = linear([0, mostMs], [box.bottom, box.top]);
  for (const ms of ticks(mostMs))
    svg.append(mark("line", { class: ms === 0 ? "axis" : "grid", x1: box.left, x2: box.right, y1: y(ms), y2: y(ms) }),
               mark("text", { x: box.left - 10, y: y(ms) + 4, "text-anchor": "end" }, number(ms)));
  for (const pixels of powers(2, ...errorRange))
    svg.append(mark("line", { class: "axis", x1: x(pixels), x2: x(pixels), y1: box.bottom, y2: box.bottom + 5 }),
               mark("text", { x: x(pixels), y: box.bottom + 20, "text-anchor": "middle" }, `${number(pixels)} px`));
  if (hasUnbounded)
    svg.append(mark("line", { class: "axis", x1: box.right, x2: box.right, y1: box.bottom, y2: box.bottom + 5 }),
               mark("text", { x: box.right, y: box.bottom + 20, "text-anchor": "middle" }, "∞"));
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
