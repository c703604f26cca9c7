// SPDX-License-Identifier: Apache-2.0
// The page and its server on two hosts, with a slow network between them that parts for a while.
import { Network } from "./network.mjs";
import { lastSeconds, recordDrag } from "./recorded_drag.mjs";
import { check, environment, run, ServerProcess } from "./support.mjs";

const delay = 25; // milliseconds, either way
const attempts = 4; // on a machine that has other things to do
const smaller = 0.75; // more than the step between two levels of quality

/** Of the last moving pictures the one that takes most bytes; `weight` grows with those. */
function largest(drawn) {
  const moving = drawn.filter(({ still }) => !still);
  if (moving.length === 0) return null;
  const weighed = lastSeconds(moving, 2).map(({ width, quality }) => {
    return { kind: `${width}/${quality}`, weight: width * width * (quality + 30) };
  });
  return weighed.reduce((most, one) => (one.weight > most.weight ? one : most));
}

await run("link_test", async (browser, started) => {
  const { page } = browser;
  const network = new Network();
  const command = network.there(environment("EYRIE_FAKE_SERVER"), [
    environment("EYRIE_WEB_FOLDER"),
    "--host",
    network.address,
  ]);
  const server = started(await ServerProcess.start(...command, 60));
  network.set({ megabits: 20, delay });
  await page.goto(server.url);
  await browser.settled();

  const isTrue = async (sentence) => {
    check((await browser.canvasHash()) === (await browser.hook("pixelHash")), sentence);
  };
  await isTrue("over 20 Mbit/s and 50 ms of round trip the first picture becomes exact");

  // A busy browser is given smaller pictures, too: then another attempt tells.
  let over20 = 0;
  let over5 = Infinity;
  for (let i = 0; i < attempts && over5 >= smaller * over20; ++i)
    for (const megabits of [20, 5]) {
      network.set({ megabits });
      const drawn = await recordDrag(page, 4, { least: 10 });
      const views = new Set(drawn.map(({ view }) => view));
      const { latency } = drawn.at(-1);
      const picture = largest(drawn);
      check(
        views.size >= 8 && picture !== null,
        `over ${megabits} Mbit/s pictures follow the hand: ${views.size}, ${picture?.kind}`,
      );
      check(latency > 2 * delay, `none sooner than there and back: ${latency.toFixed(0)} ms`);
      if (megabits === 20) over20 = Math.max(over20, picture.weight);
      else over5 = Math.min(over5, picture.weight);
      await browser.settled();
      await isTrue("at rest the picture becomes exact");
    }
  check(over5 < smaller * over20, "moving pictures take fewer bytes over 5 Mbit/s than over 20");

  const before = await page.evaluate(() => ({ ...window.eyrie }));
  network.set({ loss: 1 });
  await page.focus("#view");
  await page.keyboard.press("ArrowLeft");
  const turned = JSON.stringify(await browser.hook("camera"));
  check(
    turned !== JSON.stringify(before.camera),
    "a key turns the view while the hosts are parted",
  );
  await page.waitForTimeout(2000);
  check(
    (await browser.hook("pixelHash")) === before.pixelHash &&
      (await browser.hook("waitingMilliseconds")) > 1000,
    "of which no picture comes, and the last one stays",
  );
  network.set({ loss: 0 });
  const healed = Date.now();
  await browser.until(() => {
    const { connection, waitingMilliseconds, exact } = window.eyrie;
    return connection === "connected" && waitingMilliseconds === 0 && exact;
  }, 30_000);
  console.log(`exact ${Date.now() - healed} ms after the network has healed`);
  await browser.settled();
  check(
    (await browser.hook("pixelHash")) !== before.pixelHash,
    "it comes by itself when the network has healed",
  );
  await isTrue("and is exact");
  check(
    JSON.stringify(await browser.hook("camera")) === turned,
    "of the camera that was asked for",
  );
});
