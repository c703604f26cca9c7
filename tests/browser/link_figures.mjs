// SPDX-License-Identifier: Apache-2.0
// Not a test: prints how pictures follow the hand over slow links, in Chromium, with pictures that
// the fake server makes up on another host (network.mjs); with --h264 as H.264 where that is taken.
// Is run by network_link, as root. docs/benchmarks.md has what it said.
import { Network } from "./network.mjs";
import { lastSeconds, median, recordDrag } from "./recorded_drag.mjs";
import { environment, run, ServerProcess } from "./support.mjs";

const seconds = 8;
const observedSeconds = 2.5; // at the end
const port = 8080;
const lateAtMost = 150; // milliseconds, of pictures that have settled on a rate

/** Seconds from the change until pictures are in time again, and stay so: by the half second. */
function settledAfter(drawn) {
  const after = drawn.filter(({ isAfter }) => isAfter);
  const start = after[0].time;
  let settled = 0;
  for (const { time } of after) {
    const within = after.filter((other) => other.time > time - 500 && other.time <= time);
    if (median(within.map(({ late }) => late)) > lateAtMost) settled = time - start;
  }
  return settled / 1000;
}

function tell(name, drawn, isChanged) {
  const last = lastSeconds(drawn, observedSeconds);
  const gaps = drawn.slice(1).map(({ time }, i) => time - drawn[i].time);
  const kinds = [...new Set(last.map(({ quality, width }) => `${width}/${quality}`))];
  console.log(
    `${name}: ${(last.length / observedSeconds).toFixed(1)} frames/s, input to drawn ` +
      `${median(last.map(({ latency }) => latency)).toFixed(0)} ms median, longest gap ` +
      `${Math.max(...gaps).toFixed(0)} ms, at most ` +
      `${Math.max(...drawn.map(({ late }) => late)).toFixed(0)} ms late, ` +
      (isChanged ? `settled after ${settledAfter(drawn).toFixed(1)} s, ` : "") +
      `width/quality ${kinds.join(" ")}`,
  );
}

const network = new Network();
const origin = `http://${network.address}:${port}`;
// Browsers decode H.264 for pages of https and of their own machine.
const options = { chromium: [`--unsafely-treat-insecure-origin-as-secure=${origin}`] };
await run(
  "link_figures",
  async (browser, started) => {
    const { page } = browser;
    const own = [environment("EYRIE_WEB_FOLDER"), String(port), "--host", network.address];
    const command = network.there(environment("EYRIE_FAKE_SERVER"), [
      ...own,
      ...process.argv.slice(2),
    ]);
    const server = started(await ServerProcess.start(...command, 20));
    for (const [name, megabits, delay, after] of [
      ["no limit", 0, 0],
      ["20 Mbit/s, 50 ms", 20, 25],
      ["5 Mbit/s, 50 ms", 5, 25],
      ["50 then 5 Mbit/s, 50 ms", 50, 25, 5],
    ]) {
      network.set({ megabits, delay });
      await page.goto(server.url);
      await browser.settled();
      const change = after === undefined ? undefined : () => network.set({ megabits: after });
      tell(name, await recordDrag(page, seconds, { during: change }), after !== undefined);
      const times = await browser.timesToExact();
      console.log(
        `  from a key: drawn ${times.drawn.toFixed(0)} ms, nearly exact ` +
          `${times.fine.toFixed(0)} ms, exact ${times.exact.toFixed(0)} ms`,
      );
    }
  },
  options,
);
