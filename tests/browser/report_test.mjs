// SPDX-License-Identifier: Apache-2.0
// The pages of `eyrie bench` show every run of a report, also what holds a frame time and what has
// frames without a bound.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

import { Browser, check, environment } from "./support.mjs";

const folder = mkdtempSync(join(tmpdir(), "eyrie-report-"));
const eyrie = (...args) =>
  execFileSync(environment("EYRIE_BINARY"), args, {
    cwd: folder,
    stdio: ["ignore", "pipe", "pipe"],
  });

/** Circles of a drawing, with their words and places. */
function marks(page, selector) {
  return page.$$eval(`${selector} svg circle[aria-label]`, (circles) =>
    circles.map((circle) => ({
      words: circle.getAttribute("aria-label"),
      x: Number(circle.getAttribute("cx")),
    })),
  );
}

const browser = await Browser.open();
try {
  // Onto a floor that ends at a wall: an eye in a surface has no bound for its error.
  const corners = ["-2 -2 0", "2 -2 0", "2 2 0", "-2 2 0", "-2 -2 1", "-2 2 1"];
  writeFileSync(
    join(folder, "room.ply"),
    "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n" +
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n" +
      `${corners.join("\n")}\n4 0 1 2 3\n4 0 3 5 4\n`,
  );
  const key = (seconds, x) => ({ seconds, camera: { eye: [x, 0, 0], target: [0, 0, 0] } });
  writeFileSync(join(folder, "near.json"), JSON.stringify({ keys: [key(0, 4), key(1, 0.98)] }));
  eyrie("synth", "mesh", "--size", "6000", "--seed", "3", "-o", "ball.ply");
  eyrie("import", "mesh", "ball.ply", "-o", "ball.eym");
  eyrie("import", "mesh", "room.ply", "-o", "room.eym");
  const bench = (mesh, flight, ...more) =>
    eyrie(
      "bench",
      mesh,
      "--flight",
      flight,
      "--frames",
      "6",
      "--repeats",
      "2",
      "--size",
      "160x90",
      ...more,
    );
  bench("room.eym", "near.json", "--tau", "1,8", "-o", "near");
  bench("ball.eym", "orbit", "--tau", "1,4", "--budget-ms", "10,1000", "--reference", "-o", "held");

  const runs = JSON.parse(readFileSync(join(folder, "near/summary.json"), "utf8")).runs;
  check(
    runs.every((run) => run.tauAchievedMax === "Infinity"),
    "frames from within a surface have no bound",
  );
  await browser.page.goto(pathToFileURL(join(folder, "near/index.html")).href);
  const near = await marks(browser.page, "#curve");
  check(
    near.length === 2 && near.every(({ x }) => x === 860),
    "they are at the curve's right edge",
  );
  check(
    near.every(({ words }) => words.includes("∞ px")),
    "and say so",
  );
  const ticks = await browser.page.$$eval("#curve svg text", (texts) =>
    texts.map((t) => t.textContent),
  );
  check(ticks.includes("∞"), "which the axis names");

  await browser.page.goto(pathToFileURL(join(folder, "held/index.html")).href);
  const all = await marks(browser.page, "#curve");
  const held = all.filter(({ words }) => words.includes(": median"));
  check(held.length === 4, "runs at an error and at a frame time are in one curve");
  const atATime = held.filter(({ words }) => /^(10|1000) ms/.test(words));
  check(
    atATime.length === 2 && atATime.every(({ words }) => words.includes("95 in 100")),
    "those that hold a time stand where 95 in 100 of their warm frames are",
  );
  const shrunk = readFileSync(join(folder, "held/index.html"), "utf8").replaceAll(
    /"framesSmaller": \d+, "stretchMax": [\d.]+/g,
    '"framesSmaller": 7, "stretchMax": 2',
  );
  writeFileSync(join(folder, "shrunk.html"), shrunk);
  await browser.page.goto(pathToFileURL(join(folder, "shrunk.html")).href);
  check(
    (await marks(browser.page, "#curve")).filter(({ words }) =>
      words.includes("7 of 18 frames were drawn smaller, their pixels stretched up to 2 times"),
    ).length === 2,
    "and say how many of their frames were drawn smaller, and by how much",
  );
  check(
    (await browser.page.textContent("#curve-says")).includes("At 10 ms, one process, 7 of 18"),
    "as the words above them do",
  );

  const measured = all.filter(({ words }) => /^(10|1000) ms: the worst pixel of/.test(words));
  check(
    measured.length === 2 && measured.every(({ words }) => / % of the .* px promised/.test(words)),
    "whose pictures are measured, and are off by a share of what they promised",
  );

  // Away from the ball for most of the time: half of the frames promise nothing.
  const look = (seconds, x) => ({ seconds, camera: { eye: [4, 0, 0], target: [x, 0, 0] } });
  const keys = [look(0, 0), look(3, 0), look(3.01, 8), look(10, 8)];
  writeFileSync(join(folder, "away.json"), JSON.stringify({ keys }));
  bench("ball.eym", "away.json", "--budget-ms", "1000", "--reference", "-o", "away");
  const away = readFileSync(join(folder, "away/index.html"), "utf8");
  check(away.includes('"tauAchieved": {"p50": 0,'), "a run of which most frames show nothing");
  for (const [name, field] of [
    ["as it is", /$^/g],
    ["with measured frames that promise 0", /(?<="promised": )[\d.]+/g],
    ["with 99 in 100 pixels off by 0", /(?<="p99": )[\d.]+(?=, "max": [\d.]+, "promised")/g],
  ]) {
    writeFileSync(join(folder, "none.html"), away.replaceAll(field, "0"));
    await browser.page.goto(pathToFileURL(join(folder, "none.html")).href);
    const drawn = await browser.page.innerHTML("#curve");
    check(/circle/.test(drawn) && !/Infinity|NaN/.test(drawn), `is in the curve, ${name}`);
  }

  eyrie("synth", "mesh", "--size", "2000", "--seed", "3", "-o", "fine.ply");
  eyrie("import", "mesh", "fine.ply", "-o", "fine.eym");
  const few = ["--tau", "1", "--frames", "4", "--repeats", "1", "--size", "320x240"];
  eyrie("bench", "fine.eym", ...few, "--reference", "-o", "fine");
  const fine = JSON.parse(readFileSync(join(folder, "fine/summary.json"), "utf8")).runs[0].errorPx;
  check(fine.max > fine.promised, "a promise of next to nothing is less than what is rounded");
  await browser.page.goto(pathToFileURL(join(folder, "fine/index.html")).href);
  const [dot] = (await marks(browser.page, "#curve")).filter(({ words }) =>
    words.includes("the worst pixel of"),
  );
  const share = Number(/([\d.]+) % of the .* px promised and the/.exec(dot.words)[1]);
  check(share <= 100, "both together are not");
  for (const place of ["#errors-says", "#curve-note"])
    check((await browser.page.textContent(place)).includes("1/256"), `${place} tells of it`);

  const misplaced = readFileSync(join(folder, "fine/index.html"), "utf8")
    .replace('"misplaced": 0', '"misplaced": 9')
    .replace('"measuredWithinPromise": true', '"measuredWithinPromise": false');
  writeFileSync(join(folder, "misplaced.html"), misplaced);
  await browser.page.goto(pathToFileURL(join(folder, "misplaced.html")).href);
  const [broken] = (await marks(browser.page, "#curve")).filter(({ words }) =>
    words.includes("the worst pixel of"),
  );
  for (const words of [broken.words, await browser.page.textContent("#errors-says")])
    check(
      words.includes("9 holes, false hits or misplaced") && !words.includes("more than"),
      "a promise broken by misplaced pixels is not one that a surface is beyond",
    );

  eyrie("bench", "fine.eym", ...few, "--reference", "--reference-frames", "1", "-o", "one");
  await browser.page.goto(pathToFileURL(join(folder, "one/index.html")).href);
  const ends = await browser.page.$$eval("#errors svg text", (texts) =>
    texts.slice(-2).map((t) => t.textContent),
  );
  check(ends[1] === `${ends[0]} of the flight`, "a single measured frame is at its second");

  const page = readFileSync(join(folder, "near/index.html"), "utf8");
  const many = JSON.stringify(Array.from({ length: 300000 }, (_, i) => [i % 2, 1, 0, 5, 0]));
  const long = page.replace(/frames: \[\[[^{]*\]\], errors/, `frames: ${many}, errors`);
  check(long.length > 1e6, "a page of 150,000 frames a run");
  writeFileSync(join(folder, "long.html"), long);
  await browser.page.goto(pathToFileURL(join(folder, "long.html")).href);
  check((await browser.page.$$("#strips svg")).length === 2, "shows all runs");

  eyrie("bench", "--compare", "near", "near", "-o", "compared");
  await browser.page.goto(pathToFileURL(join(folder, "compared/index.html")).href);
  check((await marks(browser.page, "#curve")).length === 4, "a comparison has both of each run");
  const summary = readFileSync(join(folder, "near/summary.json"), "utf8");
  const bounded = summary.replaceAll('"tauAchievedMax": "Infinity"', '"tauAchievedMax": 0.9');
  writeFileSync(join(folder, "bounded.json"), bounded);
  for (const [a, b, colour] of [
    ["bounded.json", "near", "bad"],
    ["near", "bounded.json", "truth"],
  ]) {
    const table = eyrie("bench", "--compare", a, b, "-o", "lost").toString();
    check(
      /error promised, px +(0.9 +inf|inf +0.9) +(more|less)/.test(table),
      "a table has no ratio where one has no bound",
    );
    await browser.page.goto(pathToFileURL(join(folder, "lost/index.html")).href);
    const [, , ratio, , verdict] = await browser.page.$$eval(
      "#numbers tr:has(th:text('error promised, px')) >> nth=0 >> td",
      (cells) => cells.map((cell) => ({ words: cell.textContent, colour: cell.className })),
    );
    check(ratio.words === "–", `nor has the page, of ${a} and ${b}`);
    check(verdict.colour === colour, `B is ${verdict.words}, which is ${colour}`);
  }
  check(browser.errors.length === 0, `no page has an error: ${browser.errors.join("; ")}`);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true });
}
