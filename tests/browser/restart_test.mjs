// SPDX-License-Identifier: Apache-2.0
// The real program ends politely and starts again at the same address, under an open page.
import { check, colourCount, difference, environment, run, ServerProcess } from "./support.mjs";

const settings = () => {
  const { camera } = window.eyrie;
  return JSON.stringify({ camera, tau: document.querySelector("#tau").value });
};

await run("restart_test", async (browser, started) => {
  const { page } = browser;
  const start = async (listen) => {
    const serve = ["serve", environment("EYRIE_SCENE"), "--listen", listen];
    return started(await ServerProcess.start(environment("EYRIE_BINARY"), serve, 90));
  };

  const first = await start("127.0.0.1:0");
  await page.goto(first.url);
  await browser.until(() => window.eyrie?.frameNumber > 0, 60_000);
  await browser.drag(170, 40, 10);
  await browser.setTau(1);
  await browser.settled();
  const before = await page.evaluate(settings);
  const picture = await browser.picture();

  // It ends while the view changes: what was asked for still comes.
  await browser.setTau(2);
  await browser.setTau(1);
  check((await page.evaluate(settings)) === before, "what is asked for last is what was before");
  const told = Date.now();
  process.kill(first.process.pid, "SIGTERM");
  const status = await first.ended;
  console.log(`ended after ${Date.now() - told} ms`);
  check(status === 0, `the server ends with exit status 0 (${status}) ${first.output}`);
  await browser.until(() => window.eyrie.connection === "lost");
  const kept = colourCount(await browser.picture());
  check(kept > 10, `the last picture stays, dimmed, until the server is back (${kept} colours)`);

  await page.waitForTimeout(2_000); // the page has tried, and failed, some times
  await start(new URL(first.url).host);
  const listening = Date.now();
  await browser.until(() => window.eyrie.connection === "connected", 60_000);
  await browser.until(() => window.eyrie.exact, 60_000);
  console.log(`exact ${Date.now() - listening} ms after its address was printed`);
  await browser.settled();
  check((await page.evaluate(settings)) === before, "the camera and the error asked for are kept");
  check(difference(picture, await browser.picture()) === 0, "and the picture is the same");
});
