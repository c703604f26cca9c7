// SPDX-License-Identifier: Apache-2.0
// Two reports: both curves, and each figure with what is beyond noise.

const medianOf = (run) => run.figures[0];
/** Of a figure, where null is an error without a bound. */
const size = (value) => value ?? Infinity;
const verdictClass = (figure) =>
  !figure.beyondNoise ? "" : figure.unit === "ms" || figure.unit === "px" ? (size(figure.b) < size(figure.a) ? "truth" : "bad") : "time";
/** Where both are finite. */
const ratioOf = ({ a, b, ratio }) => ratio ?? (a > 0 && b !== null ? b / a : undefined);

function drawBoth(place) {
  const shown = runs.filter((run) => isOnAxis(run.a) && isOnAxis(run.b));
  if (shown.length === 0) return sayLeftOut(place, runs);
  const box = { left: 56, right: 860, top: 34, bottom: 360 };
  const all = shown.flatMap((run) => [errorOf(run.a), errorOf(run.b)]);
  const most = Math.max(...shown.flatMap((run) => [run.a.p50, run.b.p50, ...run.a.passes.map((p) => p.p50), ...run.b.passes.map((p) => p.p50)])) * 1.15;
  const svg = drawing(930, 410, shown.map((run) => `${run.label}, ${processes(run)}: ${number(run.a.p50)} and ${number(run.b.p50)} milliseconds`).join("; "));
  const axes = curveAxes(svg, box, all, most);
  for (const [, list] of series(shown))
    for (const [side, colour, offset, dashes] of [["a", "var(--quiet)", -4, "5 4"], ["b", "var(--time)", 4, "none"]]) {
      const at = (run, ms) => [axes.x(errorOf(run[side])) + offset, axes.y(ms)];
      svg.append(curve(byError(list, (run) => errorOf(run[side])).map((run) => at(run, run[side].p50)), colour, { "stroke-dasharray": dashes }));
      for (const run of list) {
        for (const pass of run[side].passes) {
          const [cx, cy] = at(run, pass.p50);
          svg.append(mark("circle", { cx, cy, r: 2.5, fill: colour, opacity: 0.55 }));
        }
        const [cx, cy] = at(run, run[side].p50);
        svg.append(explained(mark("circle", { cx, cy, r: 5.5, fill: colour, stroke: "var(--panel)", "stroke-width": 1.5 }),
          `${side.toUpperCase()}, ${run.label}, ${processes(run)}: median ${number(run[side].p50)} ms,\nof the passes ${run[side].passes.map((pass) => number(pass.p50)).join(", ")} ms`));
      }
    }
  place.append(legend([[`A: ${a.name}`, "var(--quiet)"], [`B: ${b.name}`, "var(--time)"]]), svg);
  sayLeftOut(place, runs.filter((run) => !shown.includes(run)));
}

/** A line a run: the estimate of the median's ratio and its interval around 1. */
function drawRatios(place) {
  const shown = runs.filter((run) => medianOf(run).ratio !== undefined);
  if (shown.length === 0) return place.parentElement.remove();
  const [row, left, right] = [34, 190, 760];
  const reach = Math.max(1.05, ...shown.map((run) => Math.max(medianOf(run).high, 1 / medianOf(run).low))) ** 1.1;
  const x = logarithmic([1 / reach, reach], [left, right]);
  const bottom = shown.length * row + 8;
  const svg = drawing(930, bottom + 28, shown.map((run) => `${run.label}: ${number(medianOf(run).ratio, 4)}, ${medianOf(run).verdict}`).join("; "));
  const steps = [0.5, 0.67, 0.8, 0.9, 0.95, 0.98, 0.99, 1, 1.01, 1.02, 1.05, 1.1, 1.25, 1.5, 2].filter((one) => one >= 1 / reach && one <= reach);
  let last = -100;
  for (const ratio of steps) {
    if (ratio !== 1 && (x(ratio) - last < 40 || Math.abs(x(ratio) - x(1)) < 40)) continue;
    last = x(ratio);
    svg.append(mark("line", { class: ratio === 1 ? "axis" : "grid", x1: x(ratio), x2: x(ratio), y1: 0, y2: bottom }),
               mark("text", { x: x(ratio), y: bottom + 18, "text-anchor": "middle", class: ratio === 1 ? "strong" : "" }, `${ratio}×`));
  }
  shown.forEach((run, i) => {
    const figure = medianOf(run);
    const y = row * i + row / 2;
    const colour = figure.beyondNoise ? (figure.ratio < 1 ? "var(--truth)" : "var(--bad)") : "var(--quiet)";
    svg.append(mark("text", { class: "strong", x: 0, y: y + 5, "font-size": 13 }, run.label), mark("text", { x: 70, y: y + 5 }, processes(run)),
               mark("line", { x1: x(figure.low), x2: x(figure.high), y1: y, y2: y, stroke: colour, "stroke-width": 5, "stroke-linecap": "round", opacity: 0.4 }),
               explained(mark("circle", { cx: x(figure.ratio), cy: y, r: 5.5, fill: colour }),
                 `${run.label}: B takes ${number(figure.ratio, 4)} times as long,\n${number(figure.low, 4)} to ${number(figure.high, 4)} in ${number(100 * figure.confidence)} % of such comparisons`),
               mark("text", { x: right + 18, y: y + 5, class: "strong", style: `fill: ${colour}` }, figure.verdict));
  });
  place.append(svg);
}

function fillFigures(table) {
  table.append(html("thead", {}, html("tr", {}, html("td"), ...["A", "B", "B / A", "interval", "B is"].map((name) => html("th", { scope: "col" }, html("strong", {}, name))))));
  for (const run of runs) {
    const body = html("tbody", {}, html("tr", { class: "group" }, html("th", { scope: "rowgroup", colspan: 6 }, `${run.label}, ${processes(run)}`)));
    for (const figure of run.figures) {
      const ratio = ratioOf(figure);
      body.append(html("tr", {}, html("th", { scope: "row" }, figure.name + (figure.unit ? `, ${figure.unit}` : "")),
        html("td", {}, number(figure.a, 4)), html("td", {}, number(figure.b, 4)), html("td", {}, ratio === undefined ? "–" : number(ratio, 4)),
        html("td", {}, figure.ratio === undefined ? "–" : `${number(figure.low, 4)} to ${number(figure.high, 4)}`),
        html("td", { class: verdictClass(figure) }, figure.verdict)));
    }
    table.append(body);
  }
}

function fillTiles(list) {
  const told = runs.map(medianOf).filter((figure) => figure.ratio !== undefined);
  const count = (word) => told.filter((figure) => figure.verdict === word).length;
  const tile = (value, words, colour) => html("div", {}, html("dt", {}, words), html("dd", { class: colour }, value));
  list.append(tile(`${beyondNoise}`, "figures beyond noise, of all", beyondNoise > 0 ? "time" : ""),
              tile(`${count("faster")} of ${runs.length}`, "runs with a median that B is faster in", count("faster") > 0 ? "truth" : ""),
              tile(`${count("slower")} of ${runs.length}`, "runs with a median that B is slower in", count("slower") > 0 ? "bad" : ""));
}

say(byId("what"), `**${a.scene}**, flight **${a.flight}**, ${a.width} × ${a.height} pixels, ${a.frames} frames a pass`);
say(byId("curve-says"), `Median frame of all passes against the error promised; each pass’s own median is a small dot: **where the dots of A and B mingle, there is no difference to be seen**.`);
fillTiles(byId("tiles"));
if (notes.length === 0) byId("notes-section").remove();
for (const { note } of notes) byId("notes").append(html("li", {}, note));
drawBoth(byId("curve"));
drawRatios(byId("ratios"));
fillFigures(byId("numbers"));
for (const [name, report] of [["A", a], ["B", b]])
  byId("machine").append(html("dt", {}, name), html("dd", {}, `${report.name}: ${report.processor}, ${report.device}`), html("dt", {}), html("dd", {}, html("code", {}, report.command)));
