// SPDX-License-Identifier: Apache-2.0
// Not a test: prints what every process takes while a page is open and the view rests, and what is
// sent. docs/benchmarks.md has what it said.
import { readFileSync, readdirSync } from "node:fs";
import { check, environment, run, ServerProcess } from "./support.mjs";

const seconds = 30;
const ticksASecond = 100; // Linux shows processor time in these

/** Processes that this one has started, and those that they have. */
function descendants() {
  const processes = [];
  for (const id of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const stat = readFileSync(`/proc/${id}/stat`, "utf8");
      const fields = stat.slice(stat.lastIndexOf(")") + 2).split(" ");
      const line = readFileSync(`/proc/${id}/cmdline`, "utf8").split("\0");
      const ticks = Number(fields[11]) + Number(fields[12]);
      processes.push({ id: Number(id), parent: Number(fields[1]), line, ticks });
    } catch {
      // It has ended meanwhile.
    }
  }
  const mine = new Set([process.pid]);
  for (let before = 0; before !== mine.size; ) {
    before = mine.size;
    for (const { id, parent } of processes) if (mine.has(parent)) mine.add(id);
  }
  return processes.filter(({ id }) => mine.has(id) && id !== process.pid);
}

function nameOf([program, ...rest]) {
  const kind = rest.find((word) => word.startsWith("--type="));
  return `${program.split(" ")[0].split("/").pop()} ${kind ?? rest[0] ?? ""}`;
}

await run("idle_figures", async (browser, started) => {
  const { page } = browser;
  const server = started(
    await ServerProcess.start(
      environment("EYRIE_BINARY"),
      ["serve", environment("EYRIE_SCENE"), "--listen", "127.0.0.1:0"],
      120,
    ),
  );
  let messages = 0;
  page.on("websocket", (socket) => socket.on("framereceived", () => (messages += 1)));
  await page.goto(server.url);
  await browser.settled();
  await browser.drag(120, 40);
  await browser.settled();
  await page.waitForTimeout(2000);
  const metrics = async () => (await fetch(new URL("metrics", server.url))).text();
  const framesOf = (text) =>
    [...text.matchAll(/^eyrie_frames_total\{.*\} (\S+)$/gm)].reduce((sum, m) => sum + +m[1], 0);
  const [framesBefore, messagesBefore] = [framesOf(await metrics()), messages];
  const before = new Map(descendants().map(({ id, ticks }) => [id, ticks]));
  await page.waitForTimeout(seconds * 1000);
  for (const { id, line, ticks } of descendants()) {
    const share = (100 * (ticks - (before.get(id) ?? ticks))) / ticksASecond / seconds;
    console.log(`${nameOf(line)}: ${share.toFixed(2)} % of a core`);
  }
  console.log(`messages to the page in ${seconds} s: ${messages - messagesBefore}`);
  check(framesOf(await metrics()) === framesBefore, "no frame was made");
});
