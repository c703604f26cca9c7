// SPDX-License-Identifier: Apache-2.0
// Every frame's time, as thin bars; and where the promise and the truth are in each.

const bar = (x, width, base, top) => `M${x.toFixed(2)} ${base}h${width.toFixed(2)}V${top.toFixed(1)}h${(-width).toFixed(2)}z`;

/** Where frames go: one after another, passes a little apart. At most `most` bars, of the longest each. */
function placed(own, left, right, most = 1600) {
  const bars = [];
  const step = Math.max(1, Math.ceil(own.length / most));
  for (let i = 0; i < own.length; ) {
    const pass = own[i][1];
    const some = own.slice(i, i + step).filter((frame) => frame[1] === pass);
    bars.push({ pass, ms: Math.max(...some.map((frame) => frame[3])), beyond: some.some((frame) => frame[4]) });
    i += some.length;
  }
  const passes = Math.max(...bars.map((one) => one.pass));
  const width = (right - left - passes * 5) / bars.length;
  bars.forEach((one, i) => { one.x = left + i * width + one.pass * 5; });
  return { bars, width };
}

function drawStrip(run, own) {
  const [left, right, top, base] = [0, 690, 10, 84];
  const warm = own.filter((frame) => frame[1] > 0);
  const most = Math.max(run.frameMs.p99 * 1.2, Math.min(warm.reduce((longest, frame) => Math.max(longest, frame[3]), 0), run.frameMs.p99 * 1.6)) || 1;
  const y = linear([0, most], [base, top]);
  const { bars, width } = placed(own, left, right);
  const svg = drawing(780, 104, `${run.label}: median ${number(run.frameMs.p50)}, p95 ${number(run.frameMs.p95)}, p99 ${number(run.frameMs.p99)}, longest ${number(run.frameMs.max)} milliseconds`);
  const drawn = Math.max(width > 2.5 ? width - 0.75 : width * 0.86, 0.3);
  const shapes = (chosen) => chosen.map((one) => bar(one.x, drawn, base, y(Math.min(one.ms, most)))).join("");
  svg.append(mark("path", { d: shapes(bars.filter((one) => one.pass === 0)), fill: "var(--cold)" }),
             mark("path", { d: shapes(bars.filter((one) => one.pass > 0)), fill: "var(--time)", opacity: 0.75 }),
             mark("path", { d: bars.filter((one) => one.ms > most).map((one) => `M${one.x - 2} ${top - 2}l${drawn / 2 + 2} -5l${drawn / 2 + 2} 5z`).join(""), fill: "var(--cold)" }),
             mark("path", { d: bars.filter((one) => one.beyond).map((one) => bar(one.x, Math.max(drawn, 1.5), base + 7, base + 3)).join(""), fill: "var(--bad)" }),
             mark("line", { class: "axis", x1: left, x2: right, y1: base, y2: base }));
  const labels = ["p50", "p95", "p99"].map((name) => ({ name, ms: run.frameMs[name], y: y(run.frameMs[name]) }));
  for (const { ms } of labels)
    svg.append(mark("line", { x1: left, x2: right + 6, y1: y(ms), y2: y(ms), stroke: "var(--ink)", "stroke-width": 0.75, "stroke-dasharray": "3 3", opacity: 0.55 }));
  for (const label of apart(labels, 13))
    svg.append(mark("text", { x: right + 12, y: label.y + 4, class: label.name === "p50" ? "strong" : "" }, `${label.name === "p50" ? "median" : label.name} ${number(label.ms)}`));
  svg.append(mark("text", { x: left, y: base + 19 }, "first pass"));
  return svg;
}

function drawStrips(place) {
  runs.forEach((run, index) => {
    const own = frames.filter((frame) => frame[0] === index);
    const name = html("div", {}, html("h3", {}, run.label),
      html("p", {}, processes(run)), html("p", {}, `longest ${number(run.frameMs.max)} ms`),
      html("p", {}, `loading ${number(run.firstPassMs.max)} ms`));
    if (run.framesBeyondTau > 0) name.append(html("p", { class: "bad" }, `${number(run.framesBeyondTau)} over tau`));
    place.append(html("div", { class: "strip" }, name, drawStrip(run, own)));
  });
}

/** One run's frames that were held against the source. */
function drawErrors(run, own) {
  const [left, right, top, base] = [34, 320, 8, 120];
  const most = Math.max(...own.map((one) => Math.max(one.max, one.promised ?? 0))) * 1.12;
  const last = own.at(-1).seconds;
  const x = linear([own[0].seconds, last], [left + 4, right - 4]);
  const y = linear([0, most], [base, top]);
  const broken = own.filter((one) => !one.kept).length;
  const svg = drawing(330, 142, `${run.label}: worst pixel of each measured frame beside its promise, which ${own.length - broken} of ${own.length} frames keep`);
  for (const pixels of ticks(most))
    svg.append(mark("line", { class: pixels === 0 ? "axis" : "grid", x1: left, x2: right, y1: y(pixels), y2: y(pixels) }),
               mark("text", { x: left - 6, y: y(pixels) + 4, "text-anchor": "end" }, number(pixels)));
  for (const one of own) {
    const colour = !one.kept ? "var(--bad)" : "var(--truth)";
    svg.append(mark("line", { x1: x(one.seconds), x2: x(one.seconds), y1: y(0), y2: y(one.max), stroke: colour, "stroke-width": Math.min(7, 190 / own.length), opacity: 0.4 }),
               mark("line", { x1: x(one.seconds), x2: x(one.seconds), y1: y(0), y2: y(one.p99), stroke: colour, "stroke-width": Math.min(7, 190 / own.length) }));
  }
  const promised = own.filter((one) => one.promised !== null);
  svg.append(curve(promised.map((one) => [x(one.seconds), y(one.promised)]), "var(--time)"),
             mark("text", { x: left, y: base + 17 }, `${number(own[0].seconds)} s`),
             mark("text", { x: right, y: base + 17, "text-anchor": "end" }, `${number(last)} s of the flight`));
  return html("figure", {}, html("figcaption", {}, html("strong", {}, run.label), ` · ${processes(run)} · ${own.length} frames`), svg);
}

function drawAllErrors(place) {
  const measured = runs.map((run, i) => [run, errors[i]]).filter(([, own]) => own.length > 0);
  if (measured.length === 0) return byId("errors-section").remove();
  place.before(legend([["promised", "var(--time)"], ["measured, p99 of the pixels", "var(--truth)"], ["worst pixel", "color-mix(in srgb, var(--truth) 40%, transparent)"]]));
  for (const [run, own] of measured) place.append(drawErrors(run, own));
}
