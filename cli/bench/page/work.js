// SPDX-License-Identifier: Apache-2.0
// What frames are made of: stages of time, and triangles.

const stageNames = ["cull", "vertices", "fill", "readback", "encode", "rest"];

/** Means of the stages, and what is left of the frame's. */
function stagesOf(run) {
  const stages = { ...run.stageMeansMs };
  if (!(stages.vertices + stages.fill > 0)) stages.fill = stages.draw; // not told apart
  const sum = stages.cull + stages.vertices + stages.fill + stages.readback + stages.encode;
  return { ...stages, rest: Math.max(0, stages.total - sum) };
}

function drawStages(place) {
  const [width, row, left, right] = [930, 38, 170, 850];
  const all = runs.map(stagesOf);
  const sums = all.map((stages) => stageNames.reduce((sum, name) => sum + stages[name], 0));
  const length = linear([0, Math.max(...sums)], [0, right - left]);
  const svg = drawing(width, row * runs.length, runs.map((run, i) =>
    `${run.label}: ${stageNames.map((name) => `${name} ${number(all[i][name])}`).join(", ")} milliseconds`).join("; "));
  runs.forEach((run, i) => {
    const y = row * i + 4;
    let x = left;
    svg.append(mark("text", { class: "strong", x: 0, y: y + 18, "font-size": 13 }, run.label),
               mark("text", { x: 62, y: y + 18 }, processes(run)));
    for (const name of stageNames) {
      const size = length(all[i][name]);
      if (size < 0.4) continue;
      const share = `${name}: ${number(all[i][name])} ms, ${number((100 * all[i][name]) / sums[i], 2)} %`;
      svg.append(explained(mark("rect", { x, y, width: Math.max(size - 1.5, 0.4), height: 27, rx: 2, fill: `var(--${name})` }), `${run.label}, ${share}`));
      if (size > 46)
        svg.append(mark("text", { x: x + 7, y: y + 18, style: `fill: ${name === "rest" ? "var(--ink)" : "var(--panel)"}; pointer-events: none` }, number(all[i][name])));
      x += size;
    }
    svg.append(mark("text", { class: "strong", x: x + 8, y: y + 18 }, `${number(run.stageMeansMs.total)} ms`));
  });
  place.append(legend(stageNames.map((name) => [name, `var(--${name})`])), svg);
}

/** What runs cost in triangles at the error they have: both of the measured frames where there are some. */
function trianglePoints() {
  const measured = runs.filter((run) => run.errorPx && run.errorPx.p99 > 0);
  const chosen = measured.length > 0 ? measured : runs.filter(isOnAxis);
  const isMeasured = measured.length > 0;
  const trianglesOf = (run) => (isMeasured ? run.trianglesMeasured : run.trianglesMean + run.pointsMean);
  const first = chosen.filter((run) => run.renderers === chosen[0].renderers && trianglesOf(run) > 0);
  return { isMeasured, points: byError(first.map((run) => ({ run, error: isMeasured ? run.errorPx.p99 : errorOf(run), triangles: trianglesOf(run) })), ({ error }) => error) };
}

/** From a run down from what uniform decimation needs for the same error. */
function drawEfficiency(svg, { run, error, triangles }, { x, y }) {
  if (!run.efficiency) return;
  const [at, from, to] = [x(error), y(triangles * run.efficiency), y(triangles)];
  svg.append(mark("line", { x1: at, x2: at, y1: from, y2: to - 8, stroke: "var(--truth)", "stroke-width": 1.25, "stroke-dasharray": "2 3" }),
             mark("text", { class: "strong", x: at + 7, y: (from + to) / 2 + 4, style: "fill: var(--truth)" }, `${number(run.efficiency, 2)}×`));
}

function drawTriangles(place) {
  const { isMeasured, points } = trianglePoints();
  const levels = isMeasured ? uniform.filter((level) => level.p99Px > 0) : [];
  if (points.length === 0) return place.parentElement.remove();
  const errorsShown = [...points.map((p) => p.error), ...levels.map((level) => level.p99Px)];
  const counts = [...points.map((p) => p.triangles), ...levels.map((level) => level.triangles)];
  const box = { left: 56, right: 860, top: 26, bottom: 330 };
  const { range: errorRange, hasUnbounded, x } = errorScale(errorsShown, box);
  const countRange = [Math.min(...counts) / 1.8, Math.max(...counts) * 1.5];
  const axes = { x, y: logarithmic(countRange, [box.bottom, box.top]) };
  const svg = drawing(930, 380, points.map((p) => `${number(p.error)} pixels with ${compact(p.triangles)} triangles`).join("; "));
  const lines = powers(10, countRange[0] / 5, countRange[1]).flatMap((power) => [1, 2, 5].map((m) => m * power));
  for (const count of lines.filter((one) => one >= countRange[0] && one <= countRange[1]))
    svg.append(mark("line", { class: "grid", x1: box.left, x2: box.right, y1: axes.y(count), y2: axes.y(count) }),
               mark("text", { x: box.left - 10, y: axes.y(count) + 4, "text-anchor": "end" }, compact(count)));
  for (const pixels of powers(2, ...errorRange))
    svg.append(mark("line", { class: "axis", x1: axes.x(pixels), x2: axes.x(pixels), y1: box.bottom, y2: box.bottom + 5 }),
               mark("text", { x: axes.x(pixels), y: box.bottom + 20, "text-anchor": "middle" }, `${number(pixels)} px`));
  if (hasUnbounded) svg.append(mark("text", { x: box.right, y: box.bottom + 20, "text-anchor": "middle" }, "∞"));
  svg.append(mark("text", { x: box.left - 44, y: box.top - 12 }, isMeasured ? "triangles a frame measured" : "triangles a frame"),
             mark("text", { x: box.right, y: box.bottom + 42, "text-anchor": "end" }, isMeasured ? "measured error, p99  →  coarser" : "promised error  →  coarser"));
  const place2d = (error, triangles) => [axes.x(error), axes.y(triangles)];
  if (levels.length > 0) {
    svg.append(curve(levels.map((level) => place2d(level.p99Px, level.triangles)), "var(--quiet)", { "stroke-dasharray": "6 4" }));
    for (const level of levels) {
      const [cx, cy] = place2d(level.p99Px, level.triangles);
      svg.append(explained(mark("circle", { cx, cy, r: 4, fill: "var(--quiet)" }), `uniform decimation: ${compact(level.triangles)} triangles in view of ${compact(level.trianglesWhole)}, p99 ${number(level.p99Px)} px`));
    }
    for (const point of points) drawEfficiency(svg, point, axes);
  }
  svg.append(curve(points.map((p) => place2d(p.error, p.triangles)), "var(--time)"));
  for (const p of points) {
    const [cx, cy] = place2d(p.error, p.triangles);
    svg.append(explained(mark("circle", { cx, cy, r: 5.5, fill: "var(--time)", stroke: "var(--panel)", "stroke-width": 1.5 }), `${p.run.label}: ${compact(p.triangles)} triangles, ${number(p.error)} px`),
               mark("text", { x: cx, y: cy + 20, "text-anchor": "middle" }, compact(p.triangles)));
  }
  const entries = [["Eyrie: by view, within the error asked", "var(--time)"]];
  if (levels.length > 0) entries.push(["uniform decimation: the same spacing everywhere, what is in view", "var(--quiet)"]);
  place.append(legend(entries), svg);
}
