// SPDX-License-Identifier: Apache-2.0
// Not a test: prints how pictures follow the hand over slow links, in Chromium, with pictures that
// the fake server makes up; with --h264 as H.264 where that is taken. docs/benchmarks.md has what it
// said.
import { environment, run, ServerProcess } from "./support.mjs";
import { slowLink } from "./slow_link.mjs";

const seconds = 8;

/** Drags for a while, and records what is drawn: "[time, input to drawn, quality, width]". */
async function record(page, during) {
  await page.evaluate(() => {
    window.drawn = [];
    let last = window.eyrie.frameNumber;
    window.recorder = setInterval(() => {
      const { frameNumber, inputToDrawnMilliseconds, quality, video, width } = window.eyrie;
      if (frameNumber === last) return;
      last = frameNumber;
      const kind = video ? "H.264" : quality;
      window.drawn.push([performance.now(), inputToDrawnMilliseconds, kind, width]);
    }, 2);
  });
  const { mouse } = page;
  await mouse.move(500, 400);
  await mouse.down();
  const start = Date.now();
  let halfway = false;
  for (let i = 0; Date.now() - start < seconds * 1000; ++i) {
    await mouse.move(500 + 200 * Math.sin(i / 50), 400 + 60 * Math.cos(i / 40));
    if (!halfway && Date.now() - start > (seconds * 1000) / 2) {
      halfway = true;
      during?.();
    }
  }
  await mouse.up();
  return page.evaluate(() => {
    clearInterval(window.recorder);
    return window.drawn;
  });
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

function tell(name, drawn) {
  const end = drawn[drawn.length - 1][0];
  const late = drawn.filter(([time]) => time > end - 2500);
  const gaps = drawn.slice(1).map(([time], i) => time - drawn[i][0]);
  const kinds = [...new Set(late.map(([, , quality, width]) => `${width}/${quality}`))];
  console.log(
    `${name}: ${(late.length / 2.5).toFixed(1)} frames/s, input to drawn ` +
      `${median(late.map(([, latency]) => latency)).toFixed(0)} ms median, longest gap ` +
      `${Math.max(...gaps).toFixed(0)} ms, width/quality ${kinds.join(" ")}`,
  );
}

await run("link_figures", async (browser, started) => {
  const { page } = browser;
  const server = started(
    await ServerProcess.start(
      environment("EYRIE_FAKE_SERVER"),
      [environment("EYRIE_WEB_FOLDER"), ...process.argv.slice(2)],
      20,
    ),
  );
  for (const [name, megabits, delay, after] of [
    ["loopback", 10_000, 0],
    ["20 Mbit/s, 50 ms", 20, 25],
    ["5 Mbit/s, 50 ms", 5, 25],
    ["50 then 5 Mbit/s, 50 ms", 50, 25, 5],
  ]) {
    const link = { megabits, delay };
    const { url, close } = await slowLink(server.url, link);
    await page.goto(url);
    await browser.settled();
    const drawn = await record(page, () => (link.megabits = after ?? megabits));
    tell(name, drawn);
    const times = await browser.timesToExact();
    console.log(
      `  from a key: drawn ${times.drawn.toFixed(0)} ms, nearly exact ` +
        `${times.fine.toFixed(0)} ms, exact ${times.exact.toFixed(0)} ms`,
    );
    close();
  }
});
