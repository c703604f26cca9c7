// SPDX-License-Identifier: Apache-2.0
// Not a test: prints what it costs, while somebody drags, that pictures go to the browser as the
// tiles that renderers encoded, beside pictures that the coordinator puts together and encodes: in
// turn, in pages of one server, of which every other one does not say that it shows tiles.
// docs/benchmarks.md has what it said. EYRIE_SERVE: more options for `eyrie serve`.
import { readFileSync, readdirSync } from "node:fs";
import { environment, run, ServerProcess } from "./support.mjs";

const rounds = 3;
const millisecondsATick = 10; // Linux shows processor time in ticks of 1/100 s

/** Before the page: it says nothing of what it can show (ViewerRequest.abilities). */
function keepAbilitiesBack() {
  const abilities = (7 << 3) | 2;
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (data) {
    if (new Uint8Array(data.buffer ?? data)[0] !== abilities) send.call(this, data);
  };
}

/** Processor time so far of the coordinator and of all its renderers, in milliseconds. */
function processorTimes(coordinator) {
  const times = { coordinator: 0, renderers: 0 };
  for (const id of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const stat = readFileSync(`/proc/${id}/stat`, "utf8");
      const fields = stat.slice(stat.lastIndexOf(")") + 2).split(" ");
      const isCoordinator = Number(id) === coordinator;
      if (!isCoordinator && Number(fields[1]) !== coordinator) continue;
      const kind = isCoordinator ? "coordinator" : "renderers";
      times[kind] += (Number(fields[11]) + Number(fields[12])) * millisecondsATick;
    } catch {
      // It has ended meanwhile.
    }
  }
  return times;
}

async function measure(page, coordinator) {
  await page.waitForFunction(() => window.eyrie?.exact);
  const before = processorTimes(coordinator);
  const frames = await page.evaluate(() => window.eyrie.frameNumber);
  const start = Date.now();
  await page.mouse.move(500, 400);
  await page.mouse.down();
  const tiles = new Set();
  for (let i = 1; i <= 250; ++i) {
    await page.mouse.move(500 + i, 400 + 40 * Math.sin(i / 20));
    await page.waitForTimeout(20);
    if (i % 50 === 0) tiles.add(await page.evaluate(() => window.eyrie.tiles));
  }
  const seconds = (Date.now() - start) / 1000;
  const drawn = (await page.evaluate(() => window.eyrie.frameNumber)) - frames;
  const after = processorTimes(coordinator);
  const late = await page.evaluate(() => window.eyrie.inputToDrawnMilliseconds);
  await page.mouse.up();
  const each = (kind) => ((after[kind] - before[kind]) / drawn).toFixed(1);
  console.log(
    `tiles ${[...tiles].join(", ")}: ${(drawn / seconds).toFixed(1)} frames/s, input to drawn ` +
      `${late.toFixed(1)} ms; processor time a frame: coordinator ${each("coordinator")} ms, ` +
      `renderers ${each("renderers")} ms`,
  );
}

await run("tile_figures", async (browser, started) => {
  const more = (process.env.EYRIE_SERVE ?? "").split(" ").filter(Boolean);
  const serve = ["serve", environment("EYRIE_SCENE"), "--listen", "127.0.0.1:0", ...more];
  const server = started(await ServerProcess.start(environment("EYRIE_BINARY"), serve, 90));
  for (let i = 0; i < 2 * rounds; ++i) {
    const page = await browser.page.context().browser().newPage();
    if (i % 2 === 1) await page.addInitScript(keepAbilitiesBack);
    await page.goto(server.url);
    await measure(page, server.process.pid);
    await page.close();
  }
});
