// SPDX-License-Identifier: Apache-2.0
// Frame time against the error promised, and the error measured beside it.

/** "12 %" of its promise and what rasterisation rounds, of the worst pixel measured; nothing where there is no bound. */
const shareOfPromise = (run) => (measuredPromiseOf(run) === null ? "" : `${number((100 * run.errorPx.max) / (measuredPromiseOf(run) + run.errorPx.rounded), 2)} %`);

/** Holes, false hits and misplaced pixels of a run or a frame, in words; nothing where there are none. */
function wrongPixelsOf({ holes, falseHits, misplaced }) {
  const count = holes + falseHits + misplaced;
  return count > 0 ? `${number(count)} holes, false hits or misplaced pixels` : "";
}

/** How a run breaks its promise, in words. */
function breachOf(run) {
  const { max, promised, rounded } = run.errorPx;
  const isBeyond = !wrongPixelsOf(run) || (promised !== null && max > promised + rounded);
  return [isBeyond && "more than was promised", wrongPixelsOf(run)].filter(Boolean).join("; ");
}

/** Whether a run held a frame time, with a median of promises that has a place on the axis. */
const hasMedian = (run) => run.budgetMs > 0 && run.tauAchieved.p50 !== 0;
/** Where p99 is drawn: it may be 0, which has no place. */
const p99Of = (run) => Math.max(run.errorPx.p99, run.errorPx.max / 64);

/** What is between the worst pixel measured and the promise: error that was not used. */
function drawMeasured(svg, list, { x, y }) {
  const at = (run, error) => [x(error), y(run.frameMs.p50)];
  const promised = list.map((run) => at(run, measuredPromiseOf(run)));
  const worstPixels = list.map((run) => at(run, run.errorPx.max));
  svg.append(mark("path", { d: `${path([...promised, ...worstPixels.reverse()])}Z`, fill: "var(--truth)", opacity: 0.09 }));
  worstPixels.reverse();
  svg.append(curve(worstPixels, "var(--truth)"),
             curve(list.map((run) => at(run, p99Of(run))), "var(--truth)", { "stroke-dasharray": "1 5", "stroke-linecap": "round" }));
  for (const run of list) {
    const [left, level] = at(run, p99Of(run));
    const broken = run.measuredWithinPromise === false;
    svg.append(mark("line", { x1: left, x2: x(measuredPromiseOf(run)), y1: level, y2: level, stroke: "var(--truth)", opacity: 0.45 }));
    const dot = mark("circle", { cx: x(run.errorPx.max), cy: level, r: 5, fill: broken ? "var(--bad)" : "var(--truth)", stroke: "var(--panel)", "stroke-width": 1.5 });
    if (!broken)
      svg.append(mark("text", { x: x(run.errorPx.max) - 2, y: level + 18, "text-anchor": "end", style: "fill: var(--truth)" }, shareOfPromise(run)));
    svg.append(mark("circle", { cx: left, cy: level, r: 3.5, fill: "var(--panel)", stroke: "var(--truth)", "stroke-width": 1.75 }),
               explained(dot, `${run.label}: the worst pixel of ${run.framesMeasured} frames is ${number(run.errorPx.max)} px off,\n` +
                 `99 in 100 of any frame are within ${number(run.errorPx.p99)} px\n` +
                 (broken ? breachOf(run) : `${shareOfPromise(run)} of the ${number(measuredPromiseOf(run))} px promised and the ${number(run.errorPx.rounded)} px that rasterisation rounds`)));
  }
}

/** How many frames of a run have fewer pixels than were asked for, in words; nothing where none has. */
const smaller = (run) =>
  run.framesSmaller > 0
    ? `${number(run.framesSmaller)} of ${number(bench.frames * (bench.repeats + 1))} frames were drawn smaller, their pixels stretched up to ${number(run.stretchMax)} times`
    : "";

/** What a run's frames promise, in words. */
const promiseOf = (run) =>
  run.budgetMs > 0
    ? `half of the warm frames promise at most ${number(run.tauAchieved.p50)} px, 95 in 100 ${number(run.tauAchieved.p95)} px;\nthe worst of all, that load too, ${number(run.tauAchievedMax)} px${smaller(run) && `;\n${smaller(run)}`}`
    : `every frame promises at most ${number(run.tauAchievedMax)} px`;

function drawSeries(svg, list, colour, { x, y }, labelled) {
  const at = (run, ms) => [x(errorOf(run)), y(ms)];
  const band = [...list.map((run) => at(run, run.frameMs.p95)), ...list.map((run) => at(run, run.frameMs.p50)).reverse()];
  svg.append(mark("path", { d: `${path(band)}Z`, fill: colour, opacity: 0.13 }),
             curve(list.map((run) => at(run, run.frameMs.p50)), colour));
  for (const run of list) {
    const [cx, cy] = at(run, run.frameMs.p50);
    const [, top] = at(run, run.frameMs.p95);
    if (hasMedian(run))
      svg.append(mark("line", { x1: x(run.tauAchieved.p50), x2: cx, y1: cy, y2: cy, stroke: colour, opacity: 0.5, "stroke-width": 4, "stroke-linecap": "round" }));
    svg.append(mark("line", { x1: cx, x2: cx, y1: cy, y2: top, stroke: colour, opacity: 0.5, "stroke-width": 1.5 }),
               explained(mark("circle", { cx, cy, r: 5.5, fill: colour, stroke: "var(--panel)", "stroke-width": 1.5 }),
                 `${run.label}, ${processes(run)}: median ${number(run.frameMs.p50)} ms, p95 ${number(run.frameMs.p95)} ms,\n${promiseOf(run)}`));
    if (labelled)
      svg.append(mark("text", { class: "strong", x: cx + 9, y: cy - 9 }, `${number(run.fpsMedian)} fps`));
  }
}

function drawCurve(place) {
  const shown = runs.filter(isOnAxis);
  if (shown.length === 0) return sayLeftOut(place, runs);
  const measured = shown.filter((run) => run.errorPx && run.errorPx.max > 0 && measuredPromiseOf(run) !== 0);
  const all = [...shown.map(errorOf), ...shown.filter(hasMedian).map((run) => run.tauAchieved.p50), ...measured.flatMap((run) => [measuredPromiseOf(run), p99Of(run), run.errorPx.max])];
  const box = { left: 56, right: 860, top: 34, bottom: 380 };
  const svg = drawing(930, 430, `Frame time against error. ${shown.map((run) =>
    `${run.label}, ${processes(run)}: ${number(run.frameMs.p50)} milliseconds, promised ${number(errorOf(run))} pixels`).join("; ")}.`);
  const axes = curveAxes(svg, box, all, Math.max(...shown.map((run) => run.frameMs.p95)) * 1.12);
  const groups = series(byError(shown));
  const own = groups.map(([, list]) => list.filter((run) => measured.includes(run))).find((list) => list.length > 0);
  if (own) drawMeasured(svg, own, axes);
  groups.forEach(([, list], i) => drawSeries(svg, list, seriesColours[i % 4], axes, groups.length === 1));
  const entries = groups.map(([name, list], i) => [`promised${shown.some((run) => run.budgetMs > 0) ? "" : " for every frame"}${groups.length > 1 ? `, ${name}` : ""} (median, shaded to p95)`, seriesColours[i % 4]]);
  if (measured.length > 0) entries.push([`measured${groups.length > 1 ? `, ${processes(own[0])}` : ""}: worst pixel (filled) and p99 (hollow)`, "var(--truth)"]);
  place.append(legend(entries), svg);
  sayLeftOut(place, runs.filter((run) => !isOnAxis(run)));
}
