// SPDX-License-Identifier: Apache-2.0
// Not a test: prints how long it takes on loopback from an input until its picture is on the canvas,
// all but rendering: the fake server has made its pictures beforehand, and what it takes for a copy
// is taken off. One input after the other, so that none waits for the picture of another.
// docs/benchmarks.md has what it said.
import { environment, run, ServerProcess, panelWidth } from "./support.mjs";

const inputs = 300;
const barHeight = 46; // above the picture

/**
 * Before the page: keeps the worker's word of when a picture is on the canvas, by which the page
 * counts, too. To ask again and again would take one of two cores from those who make the picture.
 */
function listenToWorker() {
  window.Worker = class extends Worker {
    constructor(...given) {
      super(...given);
      this.addEventListener("message", ({ data }) => {
        if (data.kind === "drawn") window.drawnAt?.(data.time - performance.timeOrigin);
      });
    }
  };
}

/** Turns the wheel to and fro, and returns how long each notch took to be seen. */
async function timesToDrawn(count) {
  const canvas = document.querySelector("canvas");
  const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));
  const times = [];
  for (let i = 0; i < count; ++i) {
    const drawn = new Promise((resolve) => (window.drawnAt = resolve));
    const start = performance.now();
    const deltaY = i % 2 === 0 ? 20 : -20;
    canvas.dispatchEvent(new WheelEvent("wheel", { deltaY, cancelable: true, bubbles: true }));
    const end = await drawn;
    await pause(20 + 15 * Math.random()); // at any phase of the screen's frames, the page's numbers there
    times.push(end - start - window.eyrie.renderMilliseconds);
  }
  return times;
}

const share = (sorted, of) => sorted[Math.min(sorted.length - 1, Math.floor(of * sorted.length))];

await run("latency_figures", async (browser, started) => {
  const { page } = browser;
  await page.addInitScript(listenToWorker);
  const server = started(
    await ServerProcess.start(
      environment("EYRIE_FAKE_SERVER"),
      [environment("EYRIE_WEB_FOLDER"), "--film"],
      20,
    ),
  );
  for (const [width, height] of [
    [1280, 720],
    [1920, 1080],
  ]) {
    await page.setViewportSize({ width: width + panelWidth, height: height + barHeight });
    await page.goto(server.url);
    await browser.settled();
    await page.evaluate(timesToDrawn, 30); // warm
    const sorted = (await page.evaluate(timesToDrawn, inputs)).sort((a, b) => a - b);
    const drawn = await page.evaluate(() => [window.eyrie.width, window.eyrie.quality]);
    console.log(
      `${width}x${height}: input to drawn without rendering ${share(sorted, 0.5).toFixed(1)} ms ` +
        `median, ${share(sorted, 0.95).toFixed(1)} ms p95, width/quality ${drawn.join("/")}`,
    );
  }
});
