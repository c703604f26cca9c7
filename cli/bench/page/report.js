// SPDX-License-Identifier: Apache-2.0
// Words, tables and pictures of the report, and the order in which all is drawn.

/** The run a reader asks for first: that of one process nearest to a pixel. */
function headline() {
  const own = runs.filter((run) => run.renderers === runs[0].renderers && errorOf(run) > 0);
  return own.sort((a, b) => Math.abs(Math.log(errorOf(a))) - Math.abs(Math.log(errorOf(b))))[0] ?? runs[0];
}

function tile(value, unit, words, colour = "") {
  return html("div", {}, html("dt", {}, words), html("dd", { class: colour }, value, " ", html("small", {}, unit)));
}

function fillTiles(list) {
  const run = headline();
  if (!run) return;
  list.append(tile(number(run.fpsMedian), "frames/s", `median at ${run.label}, ${number(run.frameMs.p50)} ms a frame`, "time"),
              tile(`≤ ${number(run.tauAchievedMax)}`, "px", "error promised for every pixel of every frame"));
  if (run.errorPx)
    list.append(tile(number(run.errorPx.max), "px", run.measuredWithinPromise ? `worst pixel measured against the source${shareOfPromise(run) && `, ${shareOfPromise(run)} of the promise and what rasterisation rounds`}` : `worst pixel measured; the promise was broken: ${breachOf(run)}`,
                     run.measuredWithinPromise ? "truth" : "bad"));
  if (run.efficiency) {
    const isFewer = run.efficiency >= 1;
    list.append(tile(`${number(isFewer ? run.efficiency : 1 / run.efficiency, 2)}×`, isFewer ? "fewer" : "more", "triangles than uniform decimation has in view at the same measured p99 error", isFewer ? "truth" : ""));
  } else list.append(tile(compact(run.trianglesMean + run.pointsMean), "", run.pointsMean > 0 ? "triangles and points a frame, in the mean" : "triangles a frame, in the mean"));
}

/** [group, [name, value of a run], ...]: rows of the table. */
function rowGroups() {
  const part = (all) => (field) => (run) => number(all(run)[field]);
  const [warm, first, latency] = [part((run) => run.frameMs), part((run) => run.firstPassMs), part((run) => run.latencyMs)];
  const measured = (value) => (run) => (run.errorPx ? value(run) : "–");
  const groups = [
    ["Promised", ["error of every frame, at most, px", (run) => number(run.tauAchievedMax)], ["half of the warm frames, at most, px", (run) => number(run.tauAchieved.p50)], ["95 in 100 of them", (run) => number(run.tauAchieved.p95)],
      ["frames that promise more than tau", (run) => number(run.framesBeyondTau)],
      ["frames drawn smaller than asked for, and how far the smallest is stretched", (run) => (run.framesSmaller > 0 ? `${number(run.framesSmaller)}, ${number(run.stretchMax)}×` : "–")],
      ["normals of meshes, on average over any node, degrees", (run) => (run.normalErrorDegreesMax > 0 ? number(run.normalErrorMeanDegreesMax) : "–")]],
    ["Measured against the source", ["median, px", measured((run) => number(run.errorPx.p50))], ["p99 of the worst frame, px", measured((run) => number(run.errorPx.p99))],
      ["worst pixel, px", measured((run) => number(run.errorPx.max))], ["outline, at most, px", measured((run) => number(run.silhouettePx))],
      ["holes, false hits, misplaced, pixels", measured((run) => `${number(run.holes)}, ${number(run.falseHits)}, ${number(run.misplaced)}`)],
      ["PSNR of the worst frame, dB", measured((run) => number(run.psnrDb))], ["SSIM of the worst frame", measured((run) => number(run.ssim, 4))], ["FLIP of the worst frame", measured((run) => number(run.flip, 2))]],
    ["Warm, ms a frame", ["median", warm("p50")], ["p95", warm("p95")], ["p99", warm("p99")], ["longest", warm("max")], ["frames a second, median", (run) => number(run.fpsMedian)],
      ["medians of the passes, least to most", (run) => `${number(Math.min(...run.passes.map((pass) => pass.p50)))} – ${number(Math.max(...run.passes.map((pass) => pass.p50)))}`]],
    ["From a view to its picture, warm, ms", ["median", latency("p50")], ["p95", latency("p95")], ["frames in flight, at most", (run) => number(run.framesInFlight)]],
    ["First pass, ms a frame", ["median", first("p50")], ["p95", first("p95")], ["p99", first("p99")], ["longest", first("max")], ["loaded", (run) => mebibytes(run.bytesLoadedFirstPass)]],
    ["Work", ["triangles a warm frame, mean", (run) => number(run.trianglesMean)], ["points a warm frame, mean", (run) => number(run.pointsMean)], ["triangles and points a measured frame, mean", measured((run) => number(run.trianglesMeasured))], ["triangles of uniform decimation in view, times these", (run) => (run.efficiency ? `${number(run.efficiency, 2)}×` : (run.efficiencyMissing ?? "–"))],
      ["triangles of all of uniform decimation, times these", (run) => (run.efficiencyWhole ? `${number(run.efficiencyWhole, 2)}×` : "–")],
      ["loaded in all passes", (run) => mebibytes(run.bytesLoaded)], ["memory, at most", (run) => mebibytes(run.peakResidentBytes)],
      ["takes longest", (run) => run.limitingStage || "–"], ["the bench itself, of the frames’ time", (run) => `${number(run.overheadPercent, 2)} %`]],
  ];
  return runs.some((run) => run.errorPx) ? groups : groups.filter(([name]) => !name.startsWith("Measured"))
    .map(([name, ...rows]) => [name, ...rows.filter(([row]) => !row.includes("uniform") && !row.includes("measured"))]);
}

function fillTable(table) {
  table.append(html("thead", {}, html("tr", {}, html("td"), ...runs.map((run) =>
    html("th", { scope: "col" }, html("strong", {}, run.label), html("br"), processes(run))))));
  for (const [group, ...rows] of rowGroups()) {
    const body = html("tbody", {}, html("tr", { class: "group" }, html("th", { scope: "rowgroup", colspan: runs.length + 1 }, group)));
    for (const [name, value] of rows)
      body.append(html("tr", {}, html("th", { scope: "row" }, name), ...runs.map((run) => html("td", {}, value(run)))));
    table.append(body);
  }
}

function fillWorst(place) {
  const shown = runs.flatMap((run, i) => worst[i].map((frame) => [run, frame]));
  if (shown.length === 0) return byId("worst-section").remove();
  place.before(html("p", { class: "ramp" }, html("span", {}, "0 px off"), html("i"), html("span", {}, "tau"), html("b"), html("span", {}, "more than tau")));
  const picture = (bytes, words) => html("img", { alt: words, ["s" + "rc"]: `data:image/png;base64,${bytes}` });
  for (const [run, frame] of shown) {
    const words = `${run.label}, second ${number(frame.seconds)}`;
    const used = `${number(frame.max)} px off, ${number(frame.promised)} px promised; p99 ${number(frame.p99)} px${wrongPixelsOf(frame) && `; ${wrongPixelsOf(frame)}`}`;
    place.append(html("figure", {}, html("figcaption", {}, html("strong", {}, words), ` · worst pixel ${used}`),
      html("div", { class: "pair" }, picture(frame.picture, `The picture at ${words}`), picture(frame.heatMap, `Its displacement per pixel: ${used}`))));
  }
}

function sayWhatIsSeen() {
  const run = headline();
  const measured = runs.filter((one) => one.errorPx);
  say(byId("what"), `**${bench.scene}**, flight **${bench.flight}**, ${bench.width} × ${bench.height} pixels, ${bench.frames} frames × ${bench.repeats} ${bench.repeats === 1 ? "pass" : "passes"} after one that loads`);
  if (!run) return;
  say(byId("curve-says"), `At ${run.label} half of all frames take **${number(run.frameMs.p50)} ms** or less and 95 % at most **${number(run.frameMs.p95)} ms**` +
    (run.errorPx ? `, and the worst pixel is **${number(run.errorPx.max)} px** from where the source has it. The shaded gap is error that was promised for but not made.` : ". What each frame promises is a bound; errors were not measured.") + runs.filter(smaller).map((one) => ` At ${one.label}, ${processes(one)}, **${smaller(one)}**.`).join(""));
  byId("curve-note").textContent = measured.length > 0
    ? "Promised is a bound that holds before a frame is drawn; measured is what an independent ray caster in double precision finds against the full-resolution source. Measured must never be to the right of promised by more than the 1/256 of a drawn pixel that rasterisation rounds: promises less than that may seem broken here."
    : "Promised is a bound, derived in docs/errors.md. With --reference it is held against the full-resolution source.";
  const broken = measured.filter((one) => one.measuredWithinPromise === false);
  if (measured.length > 0)
    say(byId("errors-says"), broken.length === 0 ? `No pixel of **${number(measured.reduce((sum, one) => sum + one.framesMeasured, 0))} measured frames** is off by more than its frame promised and the 1/256 of a drawn pixel that rasterisation rounds.` : `**${broken.length} of ${measured.length} runs** have frames that break their promise: ${broken.map((one) => `${one.label}, ${processes(one)}: ${breachOf(one)}`).join("; ")}.`);
  say(byId("strips-says"), `At ${run.label} the slowest frame in a hundred takes **${number(run.frameMs.p99 / run.frameMs.p50, 2)} times** the median. ` + (run.framesInFlight > 1
      ? `Several frames are in flight: a frame’s time is that since the one before it, and has in it what the bench itself does with each, **${number(run.overheadPercent, 2)} %** of it.`
      : `What the bench itself does with each is in none of them: **${number(run.overheadPercent, 2)} %** of their time.`));
  say(byId("stages-says"), run.limitingStage ? `At ${run.label}, **${run.limitingStage}** takes longest.` : "");
  const best = runs.filter((one) => one.efficiency);
  const factors = (name) => [Math.min, Math.max].map((end) => number(end(...best.map((one) => one[name])), 2)).join(" to ");
  say(byId("triangles-says"), best.length > 0 ? `For the same measured error uniform decimation needs **${factors("efficiency")} times** the triangles in view, and ${factors("efficiencyWhole")} times where what is out of view is drawn, too.` : `At ${run.label} a frame has **${compact(run.trianglesMean)} triangles**, in the mean.`);
}

sayWhatIsSeen();
fillTiles(byId("tiles"));
drawCurve(byId("curve"));
fillTable(byId("numbers"));
drawAllErrors(byId("errors"));
byId("strips").before(legend([["first pass, which loads", "var(--cold)"], ["warm passes", "var(--time)"], ["promises more than tau", "var(--bad)"]]));
drawStrips(byId("strips"));
drawStages(byId("stages"));
drawTriangles(byId("triangles"));
fillWorst(byId("worst"));
byId("command").textContent = bench.command;
const shownAs = { memoryBytes: ["memory", (bytes) => mebibytes(bytes)], eyrie: ["Eyrie", String], software: ["drawn in software", (is) => (is ? "yes" : "no")] };
for (const [key, value] of Object.entries(machine)) {
  const [name, words] = shownAs[key] ?? [key, String];
  byId("machine").append(html("dt", {}, name), html("dd", {}, words(value)));
}
